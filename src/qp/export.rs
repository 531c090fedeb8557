//! The quadratic program as a file, for any other solver.

use std::io::{self, Seek, Write};

use sprs::CsMat;

use super::QpProblem;
use crate::discretization::{GapRow, PairDiscretization, StackDiscretization};
use crate::formats::matrix_market::{write_array, write_coordinates};
use crate::formats::npz::NpzWriter;
use crate::formats::qps::Qps;
use crate::mesh::Mesh;

/// Writes the program and the mesh behind it as a numpy archive, which scipy loads without further help.
///
/// | key | shape | |
/// |---|---|---|
/// | `P_data`, `P_indices`, `P_indptr`, `P_shape` | | `P`, full and symmetric, in compressed columns: the arguments of `scipy.sparse.csc_matrix` |
/// | `A_data`, `A_indices`, `A_indptr`, `A_shape` | | `A` likewise |
/// | `q`, `b` | `2n`, `n` | the vectors of `1/2 x'P x + q'x + constant` and `A x >= b` |
/// | `constant` | | with it, the optimum is the energy in `summary.json` |
/// | `displacement_scale`, `force_scale` | | the sizes of `x` and of `P x + q`, against which residuals are measured: of [`Scales`](crate::discretization::Scales), `displacement` and `force_density * dual_area` |
/// | `interior` | `n` | the vertex of each unknown: that of membrane 1 is `x[k]`, of membrane 2 `x[n + k]` |
/// | `dual_area` | `n` | the areas `\|D_a\|`, so that `y_a = lambda_a \|D_a\|` |
/// | `points`, `triangles` | `vertices x 2`, `triangles x 3` | the mesh |
///
/// # Errors
/// When writing fails.
pub fn write_npz(d: &PairDiscretization, qp: &QpProblem, out: impl Write + Seek) -> io::Result<()> {
    let mut archive = NpzWriter::deflated(out);
    write_program(&mut archive, qp)?;
    archive.integers("interior", d.interior(), &[d.interior().len()])?;
    let dual_area: Vec<f64> = d.interior().iter().map(|&a| d.dual_area()[a]).collect();
    archive.floats("dual_area", &dual_area, &[dual_area.len()])?;
    write_mesh(&mut archive, d.mesh())?;
    archive.finish()
}

/// Likewise the program of a stack, with these arrays in place of `interior` and `dual_area`, for `n` variables and `m` rows:
///
/// | key | shape | |
/// |---|---|---|
/// | `variable_membrane`, `variable_vertex` | `n` | the membrane, from 1 at the top, and the vertex of each variable |
/// | `row_gap`, `row_vertex` | `m` | the gap `k`, between layers `k` and `k + 1` (0 is the ceiling), and the vertex of each row |
/// | `row_dual_area` | `m` | the areas `\|D_a\|`, so that `y = lambda_k \|D_a\|` |
///
/// # Errors
/// When writing fails.
pub fn write_stack_npz(d: &StackDiscretization, qp: &QpProblem, out: impl Write + Seek) -> io::Result<()> {
    let mut archive = NpzWriter::deflated(out);
    write_program(&mut archive, qp)?;
    let of_membrane = |i: usize| d.free_vertices(i).iter().map(move |&a| (i, a));
    let (membrane, vertex): (Vec<usize>, Vec<usize>) = (1..=d.membranes()).flat_map(of_membrane).unzip();
    archive.integers("variable_membrane", &membrane, &[membrane.len()])?;
    archive.integers("variable_vertex", &vertex, &[vertex.len()])?;
    let rows = d.rows();
    let of_rows = |value: fn(&GapRow) -> usize| rows.iter().map(value).collect::<Vec<usize>>();
    archive.integers("row_gap", &of_rows(|row| row.gap), &[rows.len()])?;
    archive.integers("row_vertex", &of_rows(|row| row.vertex), &[rows.len()])?;
    let dual_area: Vec<f64> = rows.iter().map(|row| d.dual_area()[row.vertex]).collect();
    archive.floats("row_dual_area", &dual_area, &[rows.len()])?;
    write_mesh(&mut archive, d.mesh())?;
    archive.finish()
}

fn write_program(archive: &mut NpzWriter<impl Write + Seek>, qp: &QpProblem) -> io::Result<()> {
    write_matrix(archive, "P", &symmetric(qp.p_upper()))?;
    write_matrix(archive, "A", qp.a())?;
    archive.floats("q", qp.q(), &[qp.q().len()])?;
    archive.floats("b", qp.b(), &[qp.b().len()])?;
    archive.floats("constant", &[qp.constant()], &[])?;
    archive.floats("displacement_scale", &[qp.primal_scale()], &[])?;
    archive.floats("force_scale", &[qp.dual_scale()], &[])
}

fn write_mesh(archive: &mut NpzWriter<impl Write + Seek>, mesh: &Mesh) -> io::Result<()> {
    let (points, triangles) = (mesh.points(), mesh.triangles());
    archive.floats("points", points.as_flattened(), &[points.len(), 2])?;
    archive.integers("triangles", triangles.as_flattened(), &[triangles.len(), 3])
}

/// The arrays of which scipy makes a matrix.
fn write_matrix(
    archive: &mut NpzWriter<impl Write + Seek>,
    name: &str,
    matrix: &CsMat<f64>,
) -> io::Result<()> {
    archive.floats(&format!("{name}_data"), matrix.data(), &[matrix.nnz()])?;
    archive.integers(&format!("{name}_indices"), matrix.indices(), &[matrix.nnz()])?;
    let start = matrix.indptr();
    archive.integers(&format!("{name}_indptr"), start.into_raw_storage(), &[matrix.cols() + 1])?;
    archive.integers(&format!("{name}_shape"), &[matrix.rows(), matrix.cols()], &[2])
}

/// The full matrix from its upper triangle in compressed columns.
fn symmetric(upper: &CsMat<f64>) -> CsMat<f64> {
    let strictly_lower = strict_upper(upper).transpose_into().to_csc();
    &strictly_lower + upper
}

fn strict_upper(upper: &CsMat<f64>) -> CsMat<f64> {
    let mut triplets = sprs::TriMat::with_capacity(upper.shape(), upper.nnz());
    for (value, (row, column)) in upper.iter().filter(|(_, (row, column))| row < column) {
        triplets.add_triplet(row, column, *value);
    }
    triplets.to_csc()
}

/// A part of the program that has a MatrixMarket file of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum QpPart {
    /// `P`, symmetric.
    P,
    /// `A`.
    A,
    /// `q`, an array.
    Q,
    /// `b`, an array.
    B,
    /// The constant of the objective, an array of one number.
    Constant,
}

impl QpPart {
    /// Every part.
    pub const ALL: [Self; 5] = [Self::P, Self::A, Self::Q, Self::B, Self::Constant];

    /// Its letter in the formulas.
    pub fn letter(self) -> char {
        match self {
            Self::P => 'P',
            Self::A => 'A',
            Self::Q => 'q',
            Self::B => 'b',
            Self::Constant => 'c',
        }
    }
}

/// Writes one part of the program in MatrixMarket form.
///
/// # Errors
/// When writing fails.
pub fn write_matrix_market(qp: &QpProblem, part: QpPart, mut out: impl Write) -> io::Result<()> {
    match part {
        QpPart::P => write_coordinates(qp.p_upper(), true, &mut out),
        QpPart::A => write_coordinates(qp.a(), false, &mut out),
        QpPart::Q => write_array(qp.q(), &mut out),
        QpPart::B => write_array(qp.b(), &mut out),
        QpPart::Constant => write_array(&[qp.constant()], &mut out),
    }?;
    out.flush()
}

/// Writes the program in QPS form: variables `x1`, `x2`, ... without bounds, rows `c1`, `c2`, ... of kind `G`, the constant as the
/// negative right-hand side of the objective `obj`.
///
/// # Errors
/// When writing fails.
pub fn write_qps(qp: &QpProblem, out: impl Write) -> io::Result<()> {
    let program = Qps { p_upper: qp.p_upper(), q: qp.q(), a: qp.a(), b: qp.b(), constant: qp.constant() };
    program.write("contact", out)
}

#[cfg(test)]
mod tests;
