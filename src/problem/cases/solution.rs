//! From the decoupled form of a case to membranes, loads and boundary height.

use std::sync::Arc;

use super::decoupled::{Companion, Decoupled};
use super::jet::Jet;
use crate::geometry::Interface;
use crate::problem::{Domain, Function};

/// The exact solution of a case, with the data of the problem that it solves.
///
/// At the re-entrant corner of an L-shape the gradient of the membranes is infinite; everything else is
/// finite, also slightly outside the domain.
#[derive(Debug, Clone)]
pub struct ExactSolution {
    tension: [f64; 2],
    decoupled: Arc<dyn Decoupled>,
}

impl ExactSolution {
    pub(super) fn new(tension: [f64; 2], decoupled: Arc<dyn Decoupled>) -> Self {
        Self { tension, decoupled }
    }

    /// The tensions `[mu1, mu2]`.
    pub fn tension(&self) -> [f64; 2] {
        self.tension
    }

    /// The domain.
    pub fn domain(&self) -> Domain {
        self.decoupled.domain()
    }

    /// The curves across which the solution is less smooth: free boundaries and borders of biactive sets.
    pub fn interfaces(&self) -> Vec<Interface> {
        self.decoupled.interfaces()
    }

    /// The curve that bounds the contact set, the membranes pressed on the negative side of it and apart on the positive one;
    /// `None` where there is no such curve, for instance with a biactive set in between.
    pub fn rim(&self) -> Option<Interface> {
        self.decoupled.rim()
    }

    /// The displacements `[u1, u2]` at a point.
    pub fn u(&self, x: f64, y: f64) -> [f64; 2] {
        self.membranes(x, y).map(|u| u.value)
    }

    /// The gradients `[grad u1, grad u2]` at a point.
    ///
    /// At the corner of an L-shape: the limit along the positive x axis, which has an infinite component.
    pub fn grad_u(&self, x: f64, y: f64) -> [[f64; 2]; 2] {
        self.membranes(x, y).map(|u| u.gradient)
    }

    /// The action `lambda` at a point, a force per area.
    pub fn lambda(&self, x: f64, y: f64) -> f64 {
        self.decoupled.lambda(x, y)
    }

    /// The loads `[f1, f2]` at a point, by (1.1): `f1 = -mu1 Lap u1 - lambda`, `f2 = -mu2 Lap u2 + lambda`.
    pub fn load(&self, x: f64, y: f64) -> [f64; 2] {
        let ([u1, u2], [mu1, mu2]) = (self.membranes(x, y), self.tension);
        let lambda = self.lambda(x, y);
        [-mu1 * u1.laplacian - lambda, -mu2 * u2.laplacian + lambda]
    }

    /// The boundary height `g`, by a formula that holds also off the boundary.
    pub fn height(&self, x: f64, y: f64) -> f64 {
        self.decoupled.height(x, y)
    }

    /// The loads `[f1, f2]`, as data of a problem: integrals are cut along the [`interfaces`](Self::interfaces).
    pub fn load_functions(&self) -> [Function; 2] {
        [0, 1].map(|membrane| {
            let solution = self.clone();
            Function::piecewise(move |x, y| solution.load(x, y)[membrane], self.interfaces())
        })
    }

    /// The boundary height `g`, as data of a problem.
    pub fn height_function(&self) -> Function {
        let solution = self.clone();
        Function::from_fn(move |x, y| solution.height(x, y))
    }

    /// Both membranes with their derivatives at a point.
    fn membranes(&self, x: f64, y: f64) -> [Jet; 2] {
        let w = self.decoupled.gap(x, y);
        match self.decoupled.companion(x, y) {
            Companion::Lower(u2) => [Jet::combination(1.0, u2, 1.0, w), u2],
            Companion::Sum(s) => {
                let [mu1, mu2] = self.tension;
                let total = mu1 + mu2;
                [
                    Jet::combination(1.0 / total, s, mu2 / total, w),
                    Jet::combination(1.0 / total, s, -mu1 / total, w),
                ]
            }
        }
    }
}
