//! The action `lambda_h` of section 4.1, and the certificate that ties it to the displacements.

mod certificate;
mod contact_solution;
mod extension;
mod pairing;
mod projection;
mod recovery;
mod residuals;
mod rim;
mod solution;
mod stack;
#[cfg(all(test, feature = "clarabel"))]
mod tests;

pub use certificate::{Reason, Rejected, certify_pair};
pub use contact_solution::{ContactSolution, Gap, certify};
pub(crate) use extension::{extend_to_boundary, extend_to_held};
pub use pairing::{equilibrium, is_in_cone, pairing, project, variation};
pub use projection::CutOff;
pub use recovery::Action;
pub use residuals::{Residual, Residuals};
pub use rim::Rim;
pub use solution::PairSolution;
pub use stack::{GapSolution, StackSolution, certify_stack};
