//! Contact in a strip of the unit square that reaches the boundary: case C.

use std::sync::Arc;

use super::decoupled::{Companion, Decoupled};
use super::description::Description;
use super::jet::Jet;
use super::parameter::{MU1, MU2, Parameter};
use crate::geometry::Interface;
use crate::problem::Domain;

pub(super) static STRIP: Description<dyn Decoupled> = Description {
    name: "strip",
    title: "unit square, contact left of x0, exact at the nodes of aligned meshes",
    letter: "C",
    formulas: &[
        "Omega = (0,1)^2, q = 2 m A0",
        "w      = A0 (x - x0)_+^2",
        "lambda = q for x < x0, else 0",
        "g      = w",
        "u2     = c x (1 - x) y (1 - y)",
        "f1     = 2 mu1 c (x (1-x) + y (1-y)) - (q for x < x0, else 2 mu1 A0)",
        "f2     = 2 mu2 c (x (1-x) + y (1-y)) + lambda, F = -q",
        "On a uniform right-triangle mesh with x0 on a mesh line, at every node:",
        "w_h = w; lambda_h = q, q/2, 0 for x < x0, x = x0, x > x0;",
        "with c = 0 also u1h = u1 and u2h = u2 = 0.",
    ],
    parameters: &[
        MU1,
        MU2,
        Parameter::between("x0", [0.0, 0.5, 1.0], "where the contact ends"),
        Parameter::positive("A0", 1.0, "half the curvature of the gap"),
        Parameter::any("c", 0.0, "16 times the height of membrane 2 in the middle"),
    ],
    build: |values| {
        let curvature = 2.0 * values.get("A0");
        Ok(Arc::new(Strip {
            end: values.get("x0"),
            curvature,
            action: values.reduced_tension() * curvature,
            amplitude: values.get("c"),
        }))
    },
};

#[derive(Debug)]
struct Strip {
    end: f64,
    curvature: f64,
    action: f64,
    amplitude: f64,
}

impl Decoupled for Strip {
    fn domain(&self) -> Domain {
        Domain::unit_square()
    }

    fn interfaces(&self) -> Vec<Interface> {
        vec![Interface::VerticalLine { x: self.end }]
    }

    fn rim(&self) -> Option<Interface> {
        Some(Interface::VerticalLine { x: self.end })
    }

    fn gap(&self, x: f64, _y: f64) -> Jet {
        if x < self.end {
            return Jet::ZERO;
        }
        let (beyond, curvature) = (x - self.end, self.curvature);
        Jet {
            value: 0.5 * curvature * beyond * beyond,
            gradient: [curvature * beyond, 0.0],
            laplacian: curvature,
        }
    }

    fn companion(&self, x: f64, y: f64) -> Companion {
        Companion::Lower(Jet::bubble(self.amplitude, x, y))
    }

    fn lambda(&self, x: f64, _y: f64) -> f64 {
        if x < self.end { self.action } else { 0.0 }
    }
}
