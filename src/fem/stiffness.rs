//! The stiffness matrix.

use sprs::CsMat;

use super::local_stiffness;
use crate::mesh::{Mesh, VertexTriangles, corner_of};
use crate::parallel::blocks;
use crate::parallel::prelude::*;

/// An entry whose contributions cancel to this fraction of their size is an exact zero, spoilt by rounding (the
/// diagonals of right-angled cells): it is left out, which keeps factorisations and products sparse.
const CANCELLATION: f64 = 16.0 * f64::EPSILON;

/// The P1 stiffness matrix `K_ab = int grad phi_a . grad phi_b` with unit coefficient, on all vertices.
///
/// Shape: `vertices x vertices`, rows compressed; symmetric to the last bit; rows of unused vertices are empty.
/// Linear time, in parallel; the result does not depend on the number of threads.
pub fn stiffness(mesh: &Mesh) -> CsMat<f64> {
    stiffness_around(mesh, &VertexTriangles::new(mesh.points().len(), mesh.triangles()))
}

/// [`stiffness`], with the triangles around the vertices at hand.
pub(crate) fn stiffness_around(mesh: &Mesh, around: &VertexTriangles) -> CsMat<f64> {
    weighted_stiffness(mesh, around, |_| 1.0)
}

/// The P1 stiffness matrix `K_ab = int mu grad phi_a . grad phi_b` of a tension `mu` that is one number on each triangle.
pub(crate) fn weighted_stiffness(
    mesh: &Mesh,
    around: &VertexTriangles,
    mu: impl Fn(usize) -> f64 + Sync,
) -> CsMat<f64> {
    let vertices = mesh.points().len();
    let rows_of = |block| assemble_rows(mesh, around, &mu, block);
    let blocks: Vec<Rows> = blocks(vertices).into_par_iter().map(rows_of).collect();

    let entries = blocks.iter().map(|rows| rows.columns.len()).sum();
    let mut start = Vec::with_capacity(vertices + 1);
    let mut columns = Vec::with_capacity(entries);
    let mut values = Vec::with_capacity(entries);
    start.push(0);
    for rows in blocks {
        let offset = columns.len();
        start.extend(rows.ends.iter().map(|end| offset + end));
        columns.extend(rows.columns);
        values.extend(rows.values);
    }
    CsMat::new((vertices, vertices), start, columns, values)
}

/// Consecutive rows of a compressed matrix.
#[derive(Default)]
struct Rows {
    /// Where each row ends among the entries.
    ends: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

fn assemble_rows(
    mesh: &Mesh,
    around: &VertexTriangles,
    mu: &impl Fn(usize) -> f64,
    vertices: std::ops::Range<usize>,
) -> Rows {
    let mut rows = Rows::default();
    // (column, triangle, contribution) of one row: sorted by the first two, so that sums have one order
    let mut contributions: Vec<(usize, usize, f64)> = Vec::new();
    for a in vertices {
        contributions.clear();
        for &t in around.of(a) {
            let corners = mesh.triangles()[t];
            let local = local_stiffness(mesh.corners(t));
            let row = corner_of(corners, a);
            contributions.extend((0..3).map(|column| (corners[column], t, mu(t) * local[row][column])));
        }
        contributions.sort_unstable_by_key(|&(column, t, _)| (column, t));
        for entry in contributions.chunk_by(|p, q| p.0 == q.0) {
            let sum: f64 = entry.iter().map(|&(_, _, value)| value).sum();
            let size: f64 = entry.iter().map(|&(_, _, value)| value.abs()).sum();
            if sum.abs() > CANCELLATION * size {
                rows.columns.push(entry[0].0);
                rows.values.push(sum);
            }
        }
        rows.ends.push(rows.columns.len());
    }
    rows
}

#[cfg(test)]
mod tests;
