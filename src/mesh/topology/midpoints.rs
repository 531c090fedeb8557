//! The midpoints of the edges.

use super::Edges;
use crate::mesh::Mesh;
use crate::parallel::prelude::*;

/// The midpoints of all edges, numbered after the vertices of the mesh.
pub(in crate::mesh) struct Midpoints {
    /// Coordinates, in the order of their numbers.
    pub(in crate::mesh) points: Vec<[f64; 2]>,
    /// The edges, in the same order.
    pub(in crate::mesh) edges: Edges,
    /// The number of the first.
    first: usize,
}

impl Midpoints {
    pub(in crate::mesh) fn new(mesh: &Mesh) -> Self {
        let edges = Edges::new(mesh);
        let points = edges.ends.par_iter().map(|&ends| mesh.midpoint(ends)).collect();
        Self { points, edges, first: mesh.points.len() }
    }

    /// The numbers of the midpoints of the edges from corner `i` to corner `i + 1` of triangle `t`, for `i = 0, 1, 2`.
    pub(in crate::mesh) fn of_triangle(&self, t: usize) -> [usize; 3] {
        self.edges.of_triangle(t).map(|edge| self.first + edge)
    }
}

impl Mesh {
    /// The midpoint of an edge.
    pub(in crate::mesh) fn midpoint(&self, ends: [usize; 2]) -> [f64; 2] {
        let [p, q] = ends.map(|a| self.points[a]);
        [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]
    }
}
