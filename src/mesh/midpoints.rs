//! The midpoints of the edges.

use super::Mesh;
use super::adjacency::HalfEdges;

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
        let vertices = mesh.points.len();
        let (mut points, mut ends, mut on_boundary) = (Vec::new(), Vec::new(), Vec::new());
        let mut of_triangle = vec![[0; 3]; mesh.triangles.len()];
        for (lower, upper, sides) in HalfEdges::new(vertices, &mesh.triangles).edges() {
            for side in sides {
                let from = if side.reversed { upper } else { lower };
                let corner = mesh.triangles[side.triangle].iter().position(|&a| a == from);
                let corner = corner.expect("a half edge starts at a corner of its triangle");
                of_triangle[side.triangle][corner] = vertices + points.len();
            }
            let [p, q] = [mesh.points[lower], mesh.points[upper]];
            points.push([0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]);
            ends.push([lower, upper]);
            on_boundary.push(sides.len() == 1);
        }
        Self { points, ends, on_boundary, of_triangle }
    }
}
