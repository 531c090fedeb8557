//! Finer meshes from coarse ones: uniform refinement, bisection, grading; and how each vertex has come about.

mod ancestry;
mod bisect;
mod circle;
mod family;
mod grade;
mod uniform;

pub use ancestry::Parents;
pub use bisect::Bisection;
pub use family::MeshFamily;
pub use uniform::Refinement;

pub(crate) use circle::Circle;
