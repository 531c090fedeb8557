//! P1 finite elements (3.1): quadrature, stiffness matrix, load vectors.

mod cut;
mod dual_norm;
mod element;
mod load;
mod means;
mod moments;
mod quadrature;
mod second_rule;
mod stiffness;

pub use load::{element_loads, load};
pub use means::element_means;
pub use quadrature::{DEGREE_4, TriangleRule};
pub use stiffness::{StiffnessMatrix, stiffness};

pub(crate) use cut::CutRule;
pub(crate) use element::gradient;
pub(crate) use moments::{LoadMoments, SeenLoad, moments_on};
pub(crate) use stiffness::{row_of, weighted_stiffness};
