//! Files of other programs, as they stand: readers and writers that know no mesh and no quadratic program.

pub mod gmsh;
pub(crate) mod matrix_market;
pub(crate) mod npz;
mod regular;
pub(crate) mod vtk;

pub use regular::{open_regular, read_regular};
