//! A membrane over a ball: case S2, the obstacle problem of p4pdes.

use std::sync::Arc;

use super::layers::{Layers, Sheet, Surface, circle};
use crate::geometry::Interface;
use crate::problem::cases::description::Description;
use crate::problem::cases::parameter::Parameter;
use crate::problem::{Domain, Function};

/// From this radius on, the ball is continued by its tangent.
const TANGENT_FROM: f64 = 0.9;

pub(super) static BALL: Description<dyn Layers> = Description {
    name: "ball",
    title: "square, an unloaded membrane over a ball",
    letter: "S2",
    formulas: &[
        "Omega = (-2,2)^2, N = 1, mu1 = 1, f1 = 0",
        "floor  = sqrt(1 - r^2) for r < 0.9, then straight on",
        "u1     = sqrt(1 - R^2) - A ln(r/R) for r > R, else the floor,",
        "A      = R^2/sqrt(1 - R^2)",
        "lambda = (2 - r^2)/(1 - r^2)^(3/2) for r < R, else 0",
        "u1 = A ln(2/r) for the default of R, R^2 (ln 2 - ln R) = 1 - R^2.",
        "Source: E. Bueler, PETSc for Partial Differential Equations (2021)",
    ],
    parameters: &[Parameter::between(
        "R",
        [0.0, 0.697_965_148_223_374, TANGENT_FROM],
        "radius of the contact with the ball",
    )],
    build: |values| Ok(Arc::new(Ball { radius: values.get("R") })),
};

/// Value and slope of the floor.
fn floor(r: f64) -> [f64; 2] {
    let on_ball = |r: f64| {
        let height = (1.0 - r * r).sqrt();
        [height, -r / height]
    };
    if r <= TANGENT_FROM {
        return on_ball(r);
    }
    let [height, slope] = on_ball(TANGENT_FROM);
    [height + slope * (r - TANGENT_FROM), slope]
}

#[derive(Debug)]
struct Ball {
    radius: f64,
}

impl Layers for Ball {
    fn domain(&self) -> Domain {
        Domain::Rectangle { lower: [-2.0; 2], upper: [2.0; 2] }
    }

    fn sheets(&self) -> Vec<Sheet> {
        vec![Sheet::new(1.0.into(), 0.0)]
    }

    fn floor(&self) -> Option<Function> {
        Some(Function::from_fn(|x, y| floor(x.hypot(y))[0]))
    }

    fn surface(&self, _i: usize, x: f64, y: f64) -> Surface {
        let (r, radius) = (x.hypot(y), self.radius);
        let profile = if r <= radius {
            floor(r)
        } else {
            let [height, slope] = floor(radius);
            let a = -radius * slope;
            [height - a * (r / radius).ln(), -a / r]
        };
        Surface::around_origin(x, y, profile)
    }

    fn action(&self, _k: usize, x: f64, y: f64) -> f64 {
        let r = x.hypot(y);
        if r < self.radius { (2.0 - r * r) / (1.0 - r * r).powf(1.5) } else { 0.0 }
    }

    fn rim(&self, _k: usize) -> Option<Interface> {
        Some(circle(self.radius))
    }

    fn interfaces(&self) -> Vec<Interface> {
        self.rim(1).into_iter().collect()
    }
}
