//! A membrane on an elastic foundation, pressed on a floor: case S9.

use std::sync::Arc;

use super::layers::{LONG_SIDES, Layers, STRIP, Sheet, Surface};
use crate::geometry::Interface;
use crate::problem::cases::description::Description;
use crate::problem::cases::parameter::Parameter;
use crate::problem::{Domain, Function};

pub(super) static FOUNDATION: Description<dyn Layers> = Description {
    name: "foundation",
    title: "strip, one membrane on an elastic foundation, on a floor left of x0",
    letter: "S9",
    formulas: &[
        "Omega = (0,1) x (0,1/2), N = 1, long sides free, f1 = -q, floor 0",
        "u1     = q/c (cosh(kappa (x - x0)) - 1) for x > x0, else 0, kappa^2 = c/mu",
        "lambda = q for x < x0, else 0",
    ],
    parameters: &[
        Parameter::positive("mu", 1.0, "tension"),
        Parameter::positive("c", 20.0, "stiffness of the foundation"),
        Parameter::positive("q", 10.0, "downward load, and action in the contact zone"),
        Parameter::between("x0", [0.0, 0.25, 1.0], "where the contact ends"),
    ],
    build: |values| {
        let [tension, stiffness, action, end] = values.all(["mu", "c", "q", "x0"]);
        Ok(Arc::new(Foundation { tension, stiffness, action, end }))
    },
};

#[derive(Debug)]
struct Foundation {
    tension: f64,
    stiffness: f64,
    action: f64,
    end: f64,
}

impl Layers for Foundation {
    fn domain(&self) -> Domain {
        STRIP
    }

    fn sheets(&self) -> Vec<Sheet> {
        let sheet = Sheet::new(self.tension.into(), -self.action).free_on(LONG_SIDES);
        vec![Sheet { foundation: self.stiffness, ..sheet }]
    }

    fn floor(&self) -> Option<Function> {
        Some(0.0.into())
    }

    fn surface(&self, _i: usize, x: f64, _y: f64) -> Surface {
        let Self { tension, stiffness, action, end } = *self;
        if x <= end {
            return Surface::along_x([0.0; 2]);
        }
        let kappa = (stiffness / tension).sqrt();
        // cosh z - 1 = 2 sinh^2(z/2), without cancellation.
        let half = (0.5 * kappa * (x - end)).sinh();
        let slope = kappa * (kappa * (x - end)).sinh();
        Surface::along_x([2.0 * half * half, slope].map(|f| action / stiffness * f))
    }

    fn action(&self, _k: usize, x: f64, _y: f64) -> f64 {
        if x < self.end { self.action } else { 0.0 }
    }

    fn rim(&self, _k: usize) -> Option<Interface> {
        Some(Interface::VerticalLine { x: self.end })
    }

    fn interfaces(&self) -> Vec<Interface> {
        self.rim(1).into_iter().collect()
    }
}
