//! The midpoints of the edges.

use crate::mesh::Mesh;
use crate::mesh::topology::Edges;

/// The midpoints of all edges, numbered after the vertices of the mesh.
pub(in crate::mesh) struct Midpoints {
    /// Coordinates, in the order of their numbers.
    pub(in crate::mesh) points: Vec<[f64; 2]>,
    /// The ends of each edge.
    pub(in crate::mesh) ends: Vec<[usize; 2]>,
    /// Whether each edge lies on the boundary.
    pub(in crate::mesh) on_boundary: Vec<bool>,
    /// `of_triangle[t][i]`: the number of the midpoint of the edge from corner `i` to corner `i + 1` of triangle `t`.
    pub(in crate::mesh) of_triangle: Vec<[usize; 3]>,
}

impl Midpoints {
    pub(in crate::mesh) fn new(mesh: &Mesh) -> Self {
        let edges = Edges::new(mesh);
        let number = |edge: usize| mesh.points.len() + edge;
        Self {
            points: edges.ends.iter().map(|&ends| mesh.midpoint(ends)).collect(),
            on_boundary: (0..edges.ends.len()).map(|edge| edges.on_boundary(edge)).collect(),
            of_triangle: edges.of_triangle.iter().map(|edges| edges.map(number)).collect(),
            ends: edges.ends,
        }
    }
}

impl Mesh {
    /// The midpoint of an edge.
    pub(in crate::mesh) fn midpoint(&self, ends: [usize; 2]) -> [f64; 2] {
        let [p, q] = ends.map(|a| self.points[a]);
        [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]
    }
}
