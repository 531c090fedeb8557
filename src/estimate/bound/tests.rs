//! The bound against true errors, and its parts against their definitions.

mod identity;
#[cfg(feature = "clarabel")]
mod never_below;
mod parts;
mod rounding;

use super::ErrorBound;
use crate::discretization::{Displacement, PairDiscretization};
use crate::estimate::norms::cut_rule;
use crate::problem::{ContactProblem, Domain};

/// The bound on the mesh's polygon, or on the disk.
fn bound(
    problem: &ContactProblem,
    domain: &Domain,
    d: &PairDiscretization,
    displacement: &Displacement,
) -> ErrorBound {
    ErrorBound::new(problem, Some(domain), d, displacement).unwrap()
}
