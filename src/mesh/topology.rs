//! The edges of a mesh.

mod boundary;
mod edges;
mod midpoints;

pub(crate) use boundary::boundary_edges;
pub(super) use edges::Edges;
pub(super) use midpoints::Midpoints;
