//! What is drawn.

use crate::action::ContactSolution;
use crate::mesh::Mesh;

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
    pub fn of(title: &'a str, mesh: &'a Mesh, solution: &'a ContactSolution) -> Self {
        let [upper, lower] = solution.displacement();
        Self {
            title,
            points: mesh.points(),
            triangles: mesh.triangles(),
            upper,
            lower,
            lambda: solution.lambda(),
            contact: solution.contact(),
        }
    }
}

/// Why no picture could be drawn.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The mesh is empty.
    #[error("picture: the mesh has no triangles; pass at least one")]
    NoTriangles,
    /// A triangle refers to a vertex that does not exist.
    #[error(
        "picture: triangle {triangle} has vertex {vertex}, but there are {count} vertices; number them from 0"
    )]
    Vertex {
        /// The triangle.
        triangle: usize,
        /// Its vertex.
        vertex: usize,
        /// The number of vertices.
        count: usize,
    },
    /// A slice has the wrong length.
    #[error("picture: {name} has {found} values for {expected} vertices; pass one per vertex")]
    Length {
        /// The quantity.
        name: &'static str,
        /// How many values it has.
        found: usize,
        /// The number of vertices.
        expected: usize,
    },
    /// A value cannot be drawn.
    #[error("picture: {name} = {value} at vertex {vertex}; pass finite values below {limit:e} in magnitude")]
    Value {
        /// The quantity.
        name: &'static str,
        /// The vertex.
        vertex: usize,
        /// The value.
        value: f64,
        /// The greatest magnitude that can be drawn.
        limit: f64,
    },
}
