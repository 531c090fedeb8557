//! The stiffness matrix.

use std::ops::Range;

use sprs::CsMatI;

use super::element::local_stiffness_row;
use crate::mesh::{Mesh, corner_of};
use crate::parallel::prelude::*;
use crate::parallel::{blocks, concat};

/// A stiffness matrix: rows compressed, symmetric, with 32-bit indices.
pub type StiffnessMatrix = CsMatI<f64, u32>;

/// The columns and entries of row `a`.
pub(crate) fn row_of(matrix: &StiffnessMatrix, a: usize) -> impl Iterator<Item = (usize, f64)> {
    let range = matrix.indptr().outer_inds_sz(a);
    let columns = matrix.indices()[range.clone()].iter().map(|&b| b as usize);
    columns.zip(matrix.data()[range].iter().copied())
}

/// An entry whose contributions cancel to this fraction of their size is an exact zero, spoilt by rounding (the
/// diagonals of right-angled cells): it is left out, which keeps factorisations and products sparse.
const CANCELLATION: f64 = 16.0 * f64::EPSILON;

/// The P1 stiffness matrix `K_ab = int grad phi_a . grad phi_b` with unit coefficient, on all vertices.
///
/// Shape: `vertices x vertices`, rows compressed; symmetric to the last bit; rows of unused vertices are empty.
/// Linear time, in parallel; the result does not depend on the number of threads.
pub fn stiffness(mesh: &Mesh) -> StiffnessMatrix {
    weighted_stiffness(mesh, |_| 1.0)
}

/// The P1 stiffness matrix `K_ab = int mu grad phi_a . grad phi_b` of a tension `mu` that is one number on each triangle.
pub(crate) fn weighted_stiffness(mesh: &Mesh, mu: impl Fn(usize) -> f64 + Sync) -> StiffnessMatrix {
    let vertices = mesh.points().len();
    let blocks: Vec<Rows> =
        blocks(vertices).into_par_iter().map(|block| assemble_rows(mesh, &mu, block)).collect();
    let mut start = Vec::with_capacity(vertices + 1);
    start.push(0);
    for rows in &blocks {
        let offset = start[start.len() - 1];
        start.extend(rows.ends.iter().map(|end| offset + end));
    }
    let columns = concat(blocks.iter().map(|rows| rows.columns.as_slice()).collect());
    let values = concat(blocks.iter().map(|rows| rows.values.as_slice()).collect());
    StiffnessMatrix::new((vertices, vertices), start, columns, values)
}

/// Consecutive rows of a compressed matrix.
#[derive(Default)]
struct Rows {
    /// Where each row ends among the entries.
    ends: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

fn assemble_rows(mesh: &Mesh, mu: &impl Fn(usize) -> f64, vertices: Range<usize>) -> Rows {
    let mut rows = Rows::default();
    // The contributions to one row, and where they belong: the column, then the place among the contributions, so that sums have the order of
    // the triangles.
    let (mut order, mut contributions): (Vec<u64>, Vec<f64>) = (Vec::new(), Vec::new());
    for a in vertices {
        order.clear();
        contributions.clear();
        for t in mesh.around().triangles(a) {
            let triangle = mesh.triangles()[t];
            let row = local_stiffness_row(mesh.corners(t), corner_of(triangle, a));
            for (column, value) in triangle.into_iter().zip(row) {
                order.push((column as u64) << 32 | contributions.len() as u64);
                contributions.push(mu(t) * value);
            }
        }
        order.sort_unstable();
        for entry in order.chunk_by(|p, q| p >> 32 == q >> 32) {
            let (mut sum, mut size) = (0.0, 0.0);
            for place in entry.iter().map(|&key| key as u32 as usize) {
                sum += contributions[place];
                size += contributions[place].abs();
            }
            if sum.abs() > CANCELLATION * size {
                rows.columns.push((entry[0] >> 32) as u32);
                rows.values.push(sum);
            }
        }
        rows.ends.push(rows.columns.len() as u32);
    }
    rows
}

#[cfg(test)]
mod tests;
