//! The midpoints of the edges.

use super::Mesh;
use super::edges::Edges;

/// The midpoints of all edges, numbered after the vertices of the mesh.
pub(super) struct Midpoints {
    /// Coordinates, in the order of their numbers.
    pub(super) points: Vec<[f64; 2]>,
    /// The ends of each edge.
    pub(super) ends: Vec<[usize; 2]>,
    /// Whether each edge lies on the boundary.
    pub(super) on_boundary: Vec<bool>,
    /// `of_triangle[t][i]`: the number of the midpoint of the edge from corner `i` to corner `i + 1` of triangle `t`.
    pub(super) of_triangle: Vec<[usize; 3]>,
}

impl Midpoints {
    pub(super) fn new(mesh: &Mesh) -> Self {
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
    pub(super) fn midpoint(&self, ends: [usize; 2]) -> [f64; 2] {
        let [p, q] = ends.map(|a| self.points[a]);
        [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]
    }
}
