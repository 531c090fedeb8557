//! Files of other programs, as they stand: readers and writers that know no mesh and no quadratic program.

pub mod gmsh;
pub(crate) mod matrix_market;
pub(crate) mod npz;
pub(crate) mod qps;
pub(crate) mod vtk;
