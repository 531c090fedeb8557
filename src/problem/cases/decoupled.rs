//! The form in which a case states its solution.

use std::fmt::Debug;

use super::jet::Jet;
use crate::geometry::Interface;
use crate::problem::Domain;

/// An exact solution of one decoupled problem: gap, action, and what is missing to find both membranes.
///
/// Everything is a formula: it also holds, or is at least finite, at points slightly outside the domain.
pub(super) trait Decoupled: Debug + Send + Sync {
    /// The domain on which the formulas solve the problem.
    fn domain(&self) -> Domain;

    /// The curves across which the solution is less smooth.
    fn interfaces(&self) -> Vec<Interface>;

    /// The curve that bounds the contact set: pressed on its negative side, apart on the positive one.
    fn rim(&self) -> Option<Interface> {
        None
    }

    /// `w = u1 - u2`.
    fn gap(&self, x: f64, y: f64) -> Jet;

    /// The second function of the pair.
    fn companion(&self, x: f64, y: f64) -> Companion;

    /// The action `lambda`, a force per area; where it jumps, it takes the side that the Laplacian of the gap
    /// takes.
    fn lambda(&self, x: f64, y: f64) -> f64;

    /// The boundary height `g`.
    fn height(&self, x: f64, y: f64) -> f64 {
        self.gap(x, y).value
    }
}

/// The function that, with the gap, determines both membranes.
pub(super) enum Companion {
    /// `u2`.
    Lower(Jet),
    /// `s = mu1 u1 + mu2 u2`.
    Sum(Jet),
}
