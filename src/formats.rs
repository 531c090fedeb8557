//! Files of other programs, as they stand: readers and writers that know no mesh and no quadratic program.

pub mod gmsh;
#[cfg(feature = "files")]
pub(crate) mod matrix_market;
#[cfg(feature = "files")]
pub(crate) mod npz;
#[cfg(feature = "files")]
pub(crate) mod qps;
mod regular;
#[cfg(feature = "files")]
pub(crate) mod vtk;

pub use regular::{open_regular, read_regular};
