//! P1 finite elements (3.1): quadrature, stiffness matrix, load vectors.

mod element;
mod load;
mod quadrature;
mod stiffness;

pub use load::{NotFinite, load};
pub use quadrature::{DEGREE_4, TriangleRule};
pub use stiffness::stiffness;

pub(crate) use element::local_stiffness;
pub(crate) use load::load_around;
pub(crate) use stiffness::stiffness_around;
