//! What is drawn.

use std::sync::Arc;

use crate::action::PairSolution;
use crate::mesh::{Mesh, Parents};

/// Width and height of the picture in pixels.
pub const SIZE: [usize; 2] = [1800, 1330];

/// A discrete solution to be drawn, one value per vertex.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// The heading; what does not fit into two lines is cut off.
    pub title: &'a str,
    /// The vertices; those that no triangle uses are ignored.
    pub points: &'a [[f64; 2]],
    /// The triangles, as indices into `points`.
    pub triangles: &'a [[usize; 3]],
    /// The refinements that made the mesh, as [`Mesh::ancestry`](crate::mesh::Mesh::ancestry); none when they are not known. Of more
    /// triangles than can be seen, those of a coarser mesh are drawn.
    pub ancestry: &'a [Arc<Parents>],
    /// Membrane 1, `u1`.
    pub upper: &'a [f64],
    /// Membrane 2, `u2`.
    pub lower: &'a [f64],
    /// The action `lambda_a`, constant on the dual cell of each vertex, zero on the boundary.
    pub lambda: &'a [f64],
    /// Whether the membranes touch at the vertex.
    pub contact: &'a [bool],
}

impl<'a> Picture<'a> {
    /// That of a solution on its mesh.
    pub fn of(title: &'a str, mesh: &'a Mesh, solution: &'a PairSolution) -> Self {
        let [upper, lower] = solution.displacement();
        Self {
            title,
            points: mesh.points(),
            triangles: mesh.triangles(),
            ancestry: mesh.ancestry(),
            upper,
            lower,
            lambda: solution.lambda(),
            contact: solution.contact(),
        }
    }
}
