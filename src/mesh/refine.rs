//! Finer meshes from coarse ones: uniform refinement, bisection, grading.

mod bisect;
mod circle;
mod family;
mod grade;
mod uniform;

pub use bisect::Bisection;
pub use family::MeshFamily;
pub use uniform::Refinement;

pub(crate) use circle::Circle;
