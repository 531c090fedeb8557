//! The edges of a mesh, numbered.

use crate::mesh::Mesh;
use crate::mesh::topology::{HalfEdges, corner_of};

/// The edges, in increasing order of their ends.
pub(in crate::mesh) struct Edges {
    /// The ends of each edge, the lower one first.
    pub(in crate::mesh) ends: Vec<[usize; 2]>,
    /// The triangles on both sides of each edge; twice the same on the boundary.
    pub(in crate::mesh) triangles: Vec<[usize; 2]>,
    /// `of_triangle[t][i]`: the number of the edge from corner `i` to corner `i + 1` of triangle `t`.
    pub(in crate::mesh) of_triangle: Vec<[usize; 3]>,
}

impl Edges {
    pub(in crate::mesh) fn new(mesh: &Mesh) -> Self {
        let (mut ends, mut triangles) = (Vec::new(), Vec::new());
        let mut of_triangle = vec![[0; 3]; mesh.triangles.len()];
        for (lower, upper, sides) in HalfEdges::new(mesh.points.len(), &mesh.triangles).edges() {
            for side in sides {
                let from = if side.reversed { upper } else { lower };
                let corner = corner_of(mesh.triangles[side.triangle], from);
                of_triangle[side.triangle][corner] = ends.len();
            }
            ends.push([lower, upper]);
            triangles.push([sides[0].triangle, sides[sides.len() - 1].triangle]);
        }
        Self { ends, triangles, of_triangle }
    }

    /// Whether the edge lies on the boundary.
    pub(in crate::mesh) fn on_boundary(&self, edge: usize) -> bool {
        let [one, other] = self.triangles[edge];
        one == other
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::samples::assorted;

    #[test]
    fn edges_and_triangles_know_each_other() {
        for mesh in assorted() {
            let edges = Edges::new(&mesh);
            let mut seen = vec![0; edges.ends.len()];
            for (t, corners) in mesh.triangles().iter().enumerate() {
                for i in 0..3 {
                    let edge = edges.of_triangle[t][i];
                    let [a, b] = [corners[i], corners[(i + 1) % 3]];
                    assert_eq!(edges.ends[edge], [a.min(b), a.max(b)]);
                    assert!(edges.triangles[edge].contains(&t));
                    seen[edge] += 1;
                }
            }
            let sides = |edge: usize| if edges.on_boundary(edge) { 1 } else { 2 };
            assert!((0..seen.len()).all(|edge| seen[edge] == sides(edge)));
            assert!(seen.contains(&1) && seen.contains(&2), "there are both kinds");
        }
    }
}
