//! The triangulation `T_h` of the domain: checked construction, generators, the Gmsh reader, refinement.

mod ancestry;
mod check;
mod dual;
mod generate;
mod groups;
mod naming;
mod read;
mod refine;
#[cfg(test)]
pub(crate) mod samples;
mod topology;
mod triangulation;
mod views;

pub use ancestry::Parents;
pub use check::{MeshError, MeshQuality};
pub use dual::{DualMesh, SubTriangulation};
pub use generate::{
    GenerateError, MeshSize, Pattern, disk, estimated_vertices, generate, l_shape, polygon, rectangle,
};
pub use groups::{Groups, Names};
pub use naming::GroupError;
#[cfg(feature = "cli")]
pub(crate) use read::gmsh_nodes;
pub use read::{GmshMesh, ReadError};
pub use refine::{Bisection, MeshFamily, Refinement};
pub use triangulation::{Mesh, VertexKind};
pub use views::{View, ViewError, ViewPlace, Views};

#[cfg(feature = "cli")]
pub(crate) use generate::MAX_VERTICES;
pub(crate) use refine::Circle;
pub(crate) use topology::boundary_edges;
pub(crate) use triangulation::{HalfEdge, HalfEdges, corner_of};
