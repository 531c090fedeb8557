//! Which triangles, edges and vertices of a mesh meet.

mod adjacency;
mod boundary;
mod edges;
mod midpoints;

pub(crate) use adjacency::{HalfEdge, HalfEdges, VertexTriangles, corner_of};
pub(crate) use boundary::boundary_edges;
pub(super) use edges::Edges;
pub(super) use midpoints::Midpoints;
