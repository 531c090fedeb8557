//! Uniform refinement: each triangle into four, by the midpoints of its edges.

use super::adjacency::HalfEdges;
use super::{Mesh, VertexKind};

/// A refined mesh and where its vertices come from.
#[derive(Debug, Clone)]
pub struct Refinement {
    /// The refined mesh. Its first vertices are those of the coarse mesh, in their order.
    pub mesh: Mesh,
    /// For each further vertex the ends of the coarse edge whose midpoint it is: the prolongation of a P1 function
    /// takes the mean of its values there. Shape: new vertices x 2.
    pub parents: Vec<[usize; 2]>,
}

impl Mesh {
    /// Divides every triangle into four similar ones. Linear time.
    ///
    /// Curved boundaries are not followed: the domain stays the polygon that the coarse mesh covers.
    pub fn refine(&self) -> Refinement {
        let coarse = self.points.len();
        let mut points = self.points.clone();
        let mut kind = self.kind.clone();
        let mut parents = Vec::new();
        // midpoints[t][i]: the midpoint of the edge from corner i to corner i + 1 of triangle t
        let mut midpoints = vec![[0; 3]; self.triangles.len()];
        for (lower, upper, sides) in HalfEdges::new(coarse, &self.triangles).edges() {
            let [p, q] = [self.points[lower], self.points[upper]];
            let midpoint = points.len();
            points.push([0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]);
            kind.push(if sides.len() == 1 { VertexKind::Boundary } else { VertexKind::Interior });
            parents.push([lower, upper]);
            for side in sides {
                let from = if side.reversed { upper } else { lower };
                let corner = self.triangles[side.triangle].iter().position(|&a| a == from);
                midpoints[side.triangle][corner.expect("a half edge starts at a corner of its triangle")] =
                    midpoint;
            }
        }
        let triangles = self
            .triangles
            .iter()
            .zip(&midpoints)
            .flat_map(|(&[a, b, c], &[ab, bc, ca])| [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]])
            .collect();
        Refinement { mesh: Mesh { points, triangles, kind }, parents }
    }
}
