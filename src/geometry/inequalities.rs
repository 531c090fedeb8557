//! Constants of inequalities between norms.

use std::f64::consts::PI;

/// The constant of Friedrichs on a rectangle with these sides: `||v|| <= C |v|_{H1}` for functions that vanish on the boundary of
/// a domain in it.
pub(crate) fn friedrichs(sides: [f64; 2]) -> f64 {
    1.0 / (PI * (1.0 / sides[0]).hypot(1.0 / sides[1]))
}

/// The constant of Poincare on a convex set of this diameter: `||v|| <= C |v|_{H1}` for functions with the mean zero (Payne,
/// Weinberger, Arch. Ration. Mech. Anal. 5 (1960) 286).
pub(crate) fn poincare(diameter: f64) -> f64 {
    diameter / PI
}
