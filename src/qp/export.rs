//! The quadratic program as a file, for any other solver.

use std::io::{self, Seek, Write};

use sprs::CsMat;

use super::QpProblem;
use crate::discretization::Discretization;
use crate::formats::matrix_market::{write_array, write_coordinates};
use crate::formats::npz::NpzWriter;

/// Writes the program and the mesh behind it as a numpy archive, which scipy loads without further help.
///
/// Arrays: for `M` in `P` (full, symmetric) and `A`, in compressed columns, `M_data`, `M_indices`, `M_indptr`,
/// `M_shape`; `q`, `b`; `interior` (vertex of each unknown: unknown `k` of membrane 1 is `x[k]`, of membrane 2
/// `x[n + k]`), `dual_area` (`|D_a|` of each unknown, so that `y_a = lambda_a |D_a|`), `points`, `triangles`.
///
/// # Errors
/// When writing fails.
pub fn write_npz(d: &Discretization, qp: &QpProblem, out: impl Write + Seek) -> io::Result<()> {
    let mut archive = NpzWriter::deflated(out);
    write_matrix(&mut archive, "P", &symmetric(qp.p_upper()))?;
    write_matrix(&mut archive, "A", qp.a())?;
    archive.floats("q", qp.q(), &[qp.q().len()])?;
    archive.floats("b", qp.b(), &[qp.b().len()])?;
    archive.integers("interior", d.interior(), &[d.interior().len()])?;
    let dual_area: Vec<f64> = d.interior().iter().map(|&a| d.dual_area()[a]).collect();
    archive.floats("dual_area", &dual_area, &[dual_area.len()])?;
    let (points, triangles) = (d.mesh().points(), d.mesh().triangles());
    archive.floats("points", points.as_flattened(), &[points.len(), 2])?;
    archive.integers("triangles", triangles.as_flattened(), &[triangles.len(), 3])?;
    archive.finish()
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
pub enum QpPart {
    /// `P`, symmetric.
    P,
    /// `A`.
    A,
    /// `q`, an array.
    Q,
    /// `b`, an array.
    B,
}

impl QpPart {
    /// Every part.
    pub const ALL: [Self; 4] = [Self::P, Self::A, Self::Q, Self::B];

    /// Its letter in the formulas.
    pub fn letter(self) -> char {
        match self {
            Self::P => 'P',
            Self::A => 'A',
            Self::Q => 'q',
            Self::B => 'b',
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
    }?;
    out.flush()
}

/// Writes the program in QPS form (free format; Maros, Meszaros, Optim. Methods Softw. 11 (1999) 671): variables `x1`,
/// `x2`, ... without bounds, rows `c1`, `c2`, ... of kind `G`, one triangle of `P` under `QUADOBJ`.
///
/// # Errors
/// When writing fails.
pub fn write_qps(qp: &QpProblem, mut out: impl Write) -> io::Result<()> {
    writeln!(out, "NAME contact\nROWS\n N obj")?;
    (1..=qp.b().len()).try_for_each(|row| writeln!(out, " G c{row}"))?;
    writeln!(out, "COLUMNS")?;
    for (column, (entries, q)) in qp.a().outer_iterator().zip(qp.q()).enumerate() {
        writeln!(out, " x{} obj {q:e}", column + 1)?;
        entries
            .iter()
            .try_for_each(|(row, value)| writeln!(out, " x{} c{} {value:e}", column + 1, row + 1))?;
    }
    writeln!(out, "RHS")?;
    let bounds = qp.b().iter().enumerate().filter(|(_, b)| **b != 0.0);
    for (row, b) in bounds {
        writeln!(out, " rhs c{} {b:e}", row + 1)?;
    }
    writeln!(out, "BOUNDS")?;
    (1..=qp.q().len()).try_for_each(|column| writeln!(out, " FR bnd x{column}"))?;
    writeln!(out, "QUADOBJ")?;
    for (value, (row, column)) in qp.p_upper().iter() {
        writeln!(out, " x{} x{} {value:e}", row + 1, column + 1)?;
    }
    writeln!(out, "ENDATA")?;
    out.flush()
}

#[cfg(test)]
mod tests;
