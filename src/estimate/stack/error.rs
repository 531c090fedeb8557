//! Why there is no bound.

use thiserror::Error;

use crate::discretization::StackError;

/// Why there is no bound of the error.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum NoBound {
    /// The values at vertices say nothing of what the data are between them.
    #[error("the data are integrated by their values at vertices: use the quadrature")]
    VertexRule,
    /// The residual would have no mean of zero.
    #[error(
        "the foundation of membrane {membrane} varies inside triangles: give one value per region or triangle"
    )]
    VaryingFoundation {
        /// From 1.
        membrane: usize,
    },
    /// Parts of the domain that meet in a single vertex cannot be balanced one by one.
    #[error(
        "parts of the mesh meet in the single vertex {vertex}, around which membrane {membrane} has no flux: join or part them"
    )]
    MeetInAVertex {
        /// The vertex.
        vertex: usize,
        /// From 1.
        membrane: usize,
    },
    /// The norm of what the solver has left is not known where nothing but a neighbour holds a membrane.
    #[error("a membrane is held by its neighbours alone: fix it somewhere, or give it a foundation")]
    Pressed,
    /// A datum has no value inside a triangle.
    #[error(transparent)]
    Data(#[from] StackError),
    /// Solution and discretization do not belong together.
    #[error("the solution belongs to another discretization: give the one that was solved")]
    OtherMesh,
}
