//! The bound against true errors, and its parts against their definitions.

mod identity;
mod never_below;
mod parts;

use super::ErrorBound;
use crate::discretization::Discretization;
use crate::error::ErrorNorms;
use crate::error::norms::{Fields, cut_rule};
use crate::problem::{ContactProblem, Domain, ExactSolution};

/// Subdivisions along curves for true errors.
const DEPTH: usize = 3;

/// The bound on the mesh's polygon, or on the disk.
fn bound(
    problem: &ContactProblem,
    domain: &Domain,
    d: &Discretization,
    displacement: &[Vec<f64>; 2],
) -> ErrorBound {
    ErrorBound::new(problem, Some(domain), d, displacement).unwrap()
}

/// `|||u - u_h|||` of any displacements.
fn energy_error(d: &Discretization, displacement: &[Vec<f64>; 2], exact: &ExactSolution) -> f64 {
    let lambda = vec![0.0; d.mesh().points().len()];
    let fields = Fields { displacement, lambda: &lambda };
    ErrorNorms::of_fields(d, fields, 0.0, &cut_rule(exact, DEPTH), exact).unwrap().energy
}
