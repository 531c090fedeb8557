//! The form in which a case states its solution.

use std::fmt::Debug;

use super::jet::Jet;
use crate::problem::Domain;

/// An exact solution of one decoupled problem: gap, action, and what is missing to find both membranes.
///
/// Everything is a formula: it also holds, or is at least finite, at points slightly outside the domain.
pub(super) trait Decoupled: Debug + Send + Sync {
    /// The domain on which the formulas solve the problem.
    fn domain(&self) -> Domain;

    /// The curves across which the solution is less smooth.
    fn interfaces(&self) -> Vec<Interface>;

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

/// A curve across which the action or a second or higher derivative of the gap may jump: the free boundary
/// and the borders of biactive sets. An error norm has to cut its quadrature there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Interface {
    /// A circle.
    Circle {
        /// Centre.
        centre: [f64; 2],
        /// Radius.
        radius: f64,
    },
    /// The line of all points with this abscissa.
    VerticalLine {
        /// The abscissa.
        x: f64,
    },
}

impl Interface {
    /// The signed distance of a point from the curve: negative inside the circle or left of the line.
    pub fn signed_distance(&self, x: f64, y: f64) -> f64 {
        match *self {
            Self::Circle { centre, radius } => (x - centre[0]).hypot(y - centre[1]) - radius,
            Self::VerticalLine { x: position } => x - position,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_has_its_sign_and_size() {
        let circle = Interface::Circle { centre: [1.0, 2.0], radius: 2.5 };
        let line = Interface::VerticalLine { x: 0.25 };
        assert_eq!([(4.0, 6.0), (1.0, 2.0)].map(|(x, y)| circle.signed_distance(x, y)), [2.5, -2.5]);
        assert_eq!([(1.0, 9.0), (0.0, 9.0)].map(|(x, y)| line.signed_distance(x, y)), [0.75, -0.25]);
    }
}
