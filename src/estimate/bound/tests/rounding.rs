//! What rounding leaves of large displacements is no action, and membranes at rest have no error.

use super::*;
use crate::mesh::samples::square;
use crate::solver::{ActiveSet, ContactSolver, SolverOptions};

/// Loads that the digits of this height do not show any more: the rounding of its stiffness is larger than they are.
const HEIGHT: f64 = 1e12;

fn solved(load: f64, height: f64) -> ErrorBound {
    let problem = ContactProblem::builder().load(-load, load).height(height).build().unwrap();
    let mesh = square(8);
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let candidate = ActiveSet.solve_pair(&d, &SolverOptions::default()).unwrap();
    ErrorBound::new(&problem, None, &d, candidate.as_pair().unwrap()).unwrap()
}

#[test]
fn the_rounding_of_a_large_height_is_no_action() {
    let bound = solved(1e-6, HEIGHT);
    assert!(bound.actions[0].iter().all(|&lambda| lambda == 0.0), "{:?}", bound.actions[0]);
    assert_eq!(bound.parts.contact, 0.0);
    let pressed = solved(15.0, 0.1);
    assert!(pressed.actions[0].iter().any(|&lambda| lambda > 1.0), "an action is one");
}

#[test]
fn membranes_at_rest_have_no_relative_error() {
    assert_eq!(solved(0.0, 0.0).relative(), Some(0.0));
    assert_eq!(solved(0.0, HEIGHT).relative(), None, "rounding is all that there is");
    assert!(solved(15.0, 0.1).relative().is_none_or(|relative| relative > 0.1));
}
