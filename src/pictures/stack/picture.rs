//! What is drawn.

use std::sync::Arc;

use crate::action::StackSolution;
use crate::discretization::StackDiscretization;
use crate::mesh::Parents;

/// Width of the picture in pixels.
pub const WIDTH: usize = 1800;

/// A discrete solution of a stack to be drawn, one value per vertex; the layers in order from the top.
#[derive(Clone, Debug)]
pub struct StackPicture<'a> {
    /// The heading; what does not fit into two lines is cut off.
    pub title: &'a str,
    /// The vertices; those that no triangle uses are ignored.
    pub points: &'a [[f64; 2]],
    /// The triangles, as indices into `points`.
    pub triangles: &'a [[usize; 3]],
    /// The refinements that made the mesh, as [`Mesh::ancestry`](crate::mesh::Mesh::ancestry); none when they are not known. Of more
    /// triangles than can be seen, those of a coarser mesh are drawn.
    pub ancestry: &'a [Arc<Parents>],
    /// The displacements `u_1 >= ... >= u_N`.
    pub membranes: Vec<&'a [f64]>,
    /// The heights of ceiling and floor.
    pub obstacles: [Option<&'a [f64]>; 2],
    /// The gaps from the top.
    pub gaps: Vec<GapPicture<'a>>,
}

/// What happens in one gap, one value per vertex.
#[derive(Clone, Copy, Debug)]
pub struct GapPicture<'a> {
    /// `k`: the gap lies between layers `k` and `k + 1`, counted from the ceiling, layer 0.
    pub number: usize,
    /// The action `lambda_a`, constant on the dual cell of each vertex.
    pub lambda: &'a [f64],
    /// Whether the layers touch at the vertex.
    pub contact: &'a [bool],
    /// The sum of the nodal forces.
    pub total_force: f64,
}

impl<'a> StackPicture<'a> {
    /// That of a solution of a discrete problem.
    pub fn of(title: &'a str, d: &'a StackDiscretization, solution: &'a StackSolution) -> Self {
        let gaps = solution.gaps().iter().map(|gap| GapPicture {
            number: gap.number,
            lambda: &gap.lambda,
            contact: &gap.contact,
            total_force: gap.total_force,
        });
        Self {
            title,
            points: d.mesh().points(),
            triangles: d.mesh().triangles(),
            ancestry: d.mesh().ancestry(),
            membranes: solution.displacement().iter().map(Vec::as_slice).collect(),
            obstacles: d.obstacles(),
            gaps: gaps.collect(),
        }
    }
}
