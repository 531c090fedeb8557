//! A biactive annulus, with continuous action: case E.

use std::sync::Arc;

use super::decoupled::{Companion, Decoupled};
use super::description::Description;
use super::jet::Jet;
use super::parameter::{MU1, MU2, Parameter};
use crate::geometry::Interface;
use crate::problem::Domain;

const CENTRE: [f64; 2] = [0.5, 0.5];

pub(super) static ANNULUS: Description<dyn Decoupled> = Description {
    name: "annulus",
    title: "unit square, continuous action, neither gap nor action in an annulus",
    letter: "E",
    formulas: &[
        "Omega = (0,1)^2, t = |(x,y) - (1/2,1/2)|^2",
        "w      = A (t - R1^2)_+^3, Lap w = 12 A (t - R1^2)_+ (3 t - R1^2)",
        "lambda = q (R0^2 - t)_+^2",
        "g      = w",
        "u2     = c x (1 - x) y (1 - y)",
    ],
    parameters: &[
        MU1,
        MU2,
        Parameter::between("R0", [0.0, 0.25, 0.5], "inner radius of the annulus, below R1"),
        Parameter::between("R1", [0.0, 0.35, 0.5], "outer radius of the annulus, above R0"),
        Parameter::positive("A", 20.0, "size of the gap"),
        Parameter::positive("q", 2000.0, "size of the action"),
        Parameter::any("c", 1.0, "16 times the height of membrane 2 in the middle"),
    ],
    build: |values| {
        let [inner, outer] = ["R0", "R1"].map(|name| values.get(name));
        if inner < outer {
            let [size, action, amplitude] = ["A", "q", "c"].map(|name| values.get(name));
            Ok(Arc::new(Annulus { inner, outer, size, action, amplitude }))
        } else {
            Err(values.out_of_range("R0", format!("0 < R0 < R1 = {outer}")))
        }
    },
};

#[derive(Debug)]
struct Annulus {
    inner: f64,
    outer: f64,
    size: f64,
    action: f64,
    amplitude: f64,
}

/// The squared distance from the centre.
fn distance_sq(x: f64, y: f64) -> f64 {
    (x - CENTRE[0]).powi(2) + (y - CENTRE[1]).powi(2)
}

impl Decoupled for Annulus {
    fn domain(&self) -> Domain {
        Domain::unit_square()
    }

    fn interfaces(&self) -> Vec<Interface> {
        [self.inner, self.outer].map(|radius| Interface::Circle { centre: CENTRE, radius }).to_vec()
    }

    fn gap(&self, x: f64, y: f64) -> Jet {
        let (t, outer_sq, size) = (distance_sq(x, y), self.outer.powi(2), self.size);
        let beyond = (t - outer_sq).max(0.0);
        Jet {
            value: size * beyond.powi(3),
            gradient: [x - CENTRE[0], y - CENTRE[1]].map(|offset| 6.0 * size * beyond * beyond * offset),
            laplacian: 12.0 * size * beyond * (3.0 * t - outer_sq),
        }
    }

    fn companion(&self, x: f64, y: f64) -> Companion {
        Companion::Lower(Jet::bubble(self.amplitude, x, y))
    }

    fn lambda(&self, x: f64, y: f64) -> f64 {
        self.action * (self.inner.powi(2) - distance_sq(x, y)).max(0.0).powi(2)
    }
}
