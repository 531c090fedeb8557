//! The family of problems that solvers are compared on when nothing else is said.

use std::f64::consts::PI;

use crate::mesh::{Mesh, MeshError, Pattern, rectangle};
use crate::problem::{ContactProblem, Function, ProblemError};

/// Its name in the rows.
pub const SQUARE: &str = "square";

/// Two membranes of tension 1 on the unit square, held `g = 0.05` apart; `f1 = -10` presses the upper one down,
/// `f2 = 30 sin(4 pi x) sin(3 pi y)` lifts the lower one in six places and sinks it in six: several contact regions with a
/// long free boundary.
///
/// # Errors
/// None in fact; the data are valid.
pub fn square_problem() -> Result<ContactProblem, ProblemError> {
    let load = |x: f64, y: f64| 30.0 * (4.0 * PI * x).sin() * (3.0 * PI * y).sin();
    ContactProblem::builder().tension(1.0, 1.0).load(-10.0, Function::from_fn(load)).height(0.05).build()
}

/// The unit square in `n` x `n` cells of two triangles each.
///
/// # Errors
/// When there are too many, or none.
pub fn square_mesh(n: usize) -> Result<Mesh, MeshError> {
    rectangle([0.0, 0.0], [1.0, 1.0], [n, n], Pattern::Right)
}
