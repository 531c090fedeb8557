//! Tensions that grow with the distance from the origin: cases S5 (over a floor) and S6 (in one of two membranes).

use std::sync::Arc;

use super::layers::{Layers, Sheet, Surface, Tension, UNIT_DISK, circle};
use crate::geometry::Interface;
use crate::problem::cases::description::Description;
use crate::problem::cases::parameter::Parameter;
use crate::problem::{Domain, Function};

pub(super) static GRADED_DISK: Description<dyn Layers> = Description {
    name: "graded-disk",
    title: "unit disk, one membrane of growing tension pressed on a floor",
    letter: "S5",
    formulas: &[
        "Omega = { r < 1 }, N = 1, mu1 = 1 + s r^2, f1 = -q, floor 0",
        "u1     = q/2 (L/(2 s) + R^2 L/2 - R^2 ln(r/R)) for r > R, else 0,",
        "L      = ln((1 + s r^2)/(1 + s R^2))",
        "lambda = q for r < R, else 0",
    ],
    parameters: &[
        Parameter::positive("s", 1.0, "growth of the tension"),
        Parameter::positive("q", 10.0, "downward load, and action in the contact zone"),
        Parameter::between("R", [0.0, 0.4, 1.0], "radius of the contact zone"),
    ],
    build: |values| {
        let [growth, action, radius] = values.all(["s", "q", "R"]);
        Ok(Arc::new(Graded { growth, action, radius }))
    },
};

pub(super) static TWO_TENSIONS: Description<dyn Layers> = Description {
    name: "two-tensions",
    title: "unit disk, two membranes whose tensions are not in proportion",
    letter: "S6",
    formulas: &[
        "Omega = { r < 1 }, N = 2, mu1 = 1 + r^2, mu2 = 1",
        "u1 = u2 = -(f1 + f2)/4 ln(2 + r^2) for r < R",
        "u1'    = (-f1 r/2 + c1/r)/(1 + r^2) for r > R",
        "u2'    = -f2 r/2 + c2/r for r > R; c1, c2: continuous slopes",
        "lambda = (f2 (r^4 + 4 r^2 + 2) - 2 f1)/(r^2 + 2)^2 for r < R, else 0",
    ],
    parameters: &[
        Parameter::any("f1", -8.0, "load of membrane 1, below zero"),
        Parameter::positive("f2", 6.0, "load of membrane 2"),
        Parameter::between("R", [0.0, 0.3, 1.0], "radius of the contact zone"),
    ],
    build: |values| {
        let [f1, f2, radius] = values.all(["f1", "f2", "R"]);
        if f1 >= 0.0 {
            return Err(values.out_of_range("f1", "f1 < 0".into()));
        }
        let slope = together([f1, f2], radius)[1];
        let c1 = radius * (1.0 + radius * radius) * slope + 0.5 * f1 * radius * radius;
        let c2 = radius * slope + 0.5 * f2 * radius * radius;
        Ok(Arc::new(TwoTensions { load: [f1, f2], radius, constants: [c1, c2] }))
    },
};

#[derive(Debug)]
struct Graded {
    growth: f64,
    action: f64,
    radius: f64,
}

impl Layers for Graded {
    fn domain(&self) -> Domain {
        UNIT_DISK
    }

    fn sheets(&self) -> Vec<Sheet> {
        let growth = self.growth;
        let tension = Function::from_fn(move |x, y| 1.0 + growth * (x * x + y * y));
        vec![Sheet::new(Tension::Everywhere(tension), -self.action)]
    }

    fn floor(&self) -> Option<Function> {
        Some(0.0.into())
    }

    fn surface(&self, _i: usize, x: f64, y: f64) -> Surface {
        let Self { growth: s, action: q, radius } = *self;
        let (r, square) = (x.hypot(y), radius * radius);
        let profile = if r <= radius {
            [0.0; 2]
        } else {
            let log = ((1.0 + s * r * r) / (1.0 + s * square)).ln();
            let value = 0.5 * q * (0.5 * log / s + 0.5 * square * log - square * (r / radius).ln());
            [value, 0.5 * q * (r - square / r) / (1.0 + s * r * r)]
        };
        Surface::around_origin(x, y, profile)
    }

    fn action(&self, _k: usize, x: f64, y: f64) -> f64 {
        if x.hypot(y) < self.radius { self.action } else { 0.0 }
    }

    fn rim(&self, _k: usize) -> Option<Interface> {
        Some(circle(self.radius))
    }

    fn interfaces(&self) -> Vec<Interface> {
        self.rim(1).into_iter().collect()
    }
}

/// Value and slope of both membranes where they touch.
fn together([f1, f2]: [f64; 2], r: f64) -> [f64; 2] {
    let load = f1 + f2;
    [-0.25 * load * (2.0 + r * r).ln(), -0.5 * load * r / (2.0 + r * r)]
}

#[derive(Debug)]
struct TwoTensions {
    load: [f64; 2],
    radius: f64,
    /// `c1`, `c2`.
    constants: [f64; 2],
}

impl TwoTensions {
    /// Value, up to a constant, and slope of a membrane where they are apart.
    fn apart(&self, i: usize, r: f64) -> [f64; 2] {
        let ([f1, f2], [c1, c2]) = (self.load, self.constants);
        let square = r * r;
        if i == 1 {
            let log = (1.0 + square).ln();
            let value = -0.25 * f1 * log + c1 * (r.ln() - 0.5 * log);
            [value, (-0.5 * f1 * r + c1 / r) / (1.0 + square)]
        } else {
            [-0.25 * f2 * square + c2 * r.ln(), -0.5 * f2 * r + c2 / r]
        }
    }
}

impl Layers for TwoTensions {
    fn domain(&self) -> Domain {
        UNIT_DISK
    }

    fn sheets(&self) -> Vec<Sheet> {
        let tension = Function::from_fn(|x, y| 1.0 + x * x + y * y);
        let [f1, f2] = self.load;
        vec![Sheet::new(Tension::Everywhere(tension), f1), Sheet::new(1.0.into(), f2)]
    }

    fn surface(&self, i: usize, x: f64, y: f64) -> Surface {
        let (r, radius) = (x.hypot(y), self.radius);
        let profile = if r <= radius {
            together(self.load, r)
        } else {
            let ([value, slope], [at_rim, _]) = (self.apart(i, r), self.apart(i, radius));
            [together(self.load, radius)[0] + value - at_rim, slope]
        };
        Surface::around_origin(x, y, profile)
    }

    fn action(&self, _k: usize, x: f64, y: f64) -> f64 {
        let ([f1, f2], square) = (self.load, x * x + y * y);
        if x.hypot(y) >= self.radius {
            return 0.0;
        }
        (f2 * (square * square + 4.0 * square + 2.0) - 2.0 * f1) / (square + 2.0).powi(2)
    }

    fn rim(&self, _k: usize) -> Option<Interface> {
        Some(circle(self.radius))
    }

    fn interfaces(&self) -> Vec<Interface> {
        self.rim(1).into_iter().collect()
    }
}
