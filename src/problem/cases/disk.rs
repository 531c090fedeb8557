//! Contact in a disk: cases B (in the unit disk) and D (in the unit square).

use std::sync::Arc;

use super::decoupled::{Companion, Decoupled};
use super::description::Description;
use super::jet::Jet;
use super::parameter::{MU1, MU2, Parameter, Values};
use crate::geometry::Interface;
use crate::problem::Domain;

pub(super) static DISK: Description<dyn Decoupled> = Description {
    name: "disk",
    title: "unit disk, constant data, contact in the disk of radius R",
    letter: "B",
    formulas: &[
        "Omega = { r < 1 }, kappa = q/(4 m)",
        "w      = kappa (r^2 - R^2 - 2 R^2 ln(r/R)) for r > R, else 0",
        "lambda = q for r < R, else 0",
        "g      = kappa (1 - R^2 + 2 R^2 ln R)",
        "s      = mu1 g + s0 (1 - r^2)/4",
        "f1     = mu1 s0/M - q, f2 = mu2 s0/M + q",
    ],
    parameters: &[
        MU1,
        MU2,
        Parameter::between("R", [0.0, 0.5, 1.0], "radius of the contact zone"),
        Parameter::positive("q", 10.0, "action in the contact zone"),
        Parameter::any("s0", 4.0, "sum of the loads"),
    ],
    build: |values| {
        let zone = RoundZone::new(values, [0.0, 0.0]);
        let [mu1, _] = values.tension();
        Ok(Arc::new(Disk { zone, mu1, total_load: values.get("s0") }))
    },
};

pub(super) static CIRCLE: Description<dyn Decoupled> = Description {
    name: "circle",
    title: "unit square, contact in a disk, discontinuous action",
    letter: "D",
    formulas: &[
        "Omega = (0,1)^2, rho = |(x,y) - (1/2,1/2)|, kappa = q/(4 m)",
        "w      = kappa (rho^2 - R^2 - 2 R^2 ln(rho/R)) for rho > R, else 0",
        "lambda = q for rho < R, else 0",
        "g      = w",
        "u2     = c sin(pi x) sin(pi y)",
        "f1     = 2 pi^2 mu1 u2 - q for rho < R, else 2 pi^2 mu1 u2 - mu1 q/m",
        "f2     = 2 pi^2 mu2 u2 + lambda",
    ],
    parameters: &[
        MU1,
        MU2,
        Parameter::between("R", [0.0, 0.3, 0.5], "radius of the contact zone"),
        Parameter::positive("q", 10.0, "action in the contact zone"),
        Parameter::any("c", 0.2, "height of membrane 2 in the middle"),
    ],
    build: |values| {
        Ok(Arc::new(Circle { zone: RoundZone::new(values, [0.5, 0.5]), amplitude: values.get("c") }))
    },
};

/// A disk of contact under the constant pressure `action`, and the gap around it.
#[derive(Debug)]
struct RoundZone {
    centre: [f64; 2],
    radius: f64,
    action: f64,
    /// `q / (4 m)`.
    kappa: f64,
}

impl RoundZone {
    fn new(values: &Values, centre: [f64; 2]) -> Self {
        let action = values.get("q");
        Self { centre, radius: values.get("R"), action, kappa: action / (4.0 * values.reduced_tension()) }
    }

    fn interface(&self) -> Interface {
        Interface::Circle { centre: self.centre, radius: self.radius }
    }

    fn distance(&self, x: f64, y: f64) -> f64 {
        (x - self.centre[0]).hypot(y - self.centre[1])
    }

    fn gap(&self, x: f64, y: f64) -> Jet {
        let (rho, radius) = (self.distance(x, y), self.radius);
        if rho < radius {
            return Jet::ZERO;
        }
        let slope = 2.0 * self.kappa * (1.0 - (radius / rho).powi(2));
        Jet {
            value: self.gap_at(rho),
            gradient: [slope * (x - self.centre[0]), slope * (y - self.centre[1])],
            laplacian: 4.0 * self.kappa,
        }
    }

    /// The gap at the distance `rho >= R`; cut at zero, because the terms cancel near the free boundary.
    fn gap_at(&self, rho: f64) -> f64 {
        let radius = self.radius;
        let terms = (rho - radius) * (rho + radius) - 2.0 * radius * radius * (rho.ln() - radius.ln());
        self.kappa * terms.max(0.0)
    }

    fn lambda(&self, x: f64, y: f64) -> f64 {
        if self.distance(x, y) < self.radius { self.action } else { 0.0 }
    }
}

#[derive(Debug)]
struct Disk {
    zone: RoundZone,
    mu1: f64,
    total_load: f64,
}

impl Decoupled for Disk {
    fn domain(&self) -> Domain {
        Domain::Disk { centre: self.zone.centre, radius: 1.0 }
    }

    fn interfaces(&self) -> Vec<Interface> {
        vec![self.zone.interface()]
    }

    fn rim(&self) -> Option<Interface> {
        Some(self.zone.interface())
    }

    fn gap(&self, x: f64, y: f64) -> Jet {
        self.zone.gap(x, y)
    }

    fn companion(&self, x: f64, y: f64) -> Companion {
        let load = self.total_load;
        Companion::Sum(Jet {
            value: self.mu1 * self.height(x, y) + load * (1.0 - x * x - y * y) / 4.0,
            gradient: [-load * x / 2.0, -load * y / 2.0],
            laplacian: -load,
        })
    }

    fn lambda(&self, x: f64, y: f64) -> f64 {
        self.zone.lambda(x, y)
    }

    fn height(&self, _x: f64, _y: f64) -> f64 {
        self.zone.gap_at(1.0)
    }
}

#[derive(Debug)]
struct Circle {
    zone: RoundZone,
    amplitude: f64,
}

impl Decoupled for Circle {
    fn domain(&self) -> Domain {
        Domain::unit_square()
    }

    fn interfaces(&self) -> Vec<Interface> {
        vec![self.zone.interface()]
    }

    fn rim(&self) -> Option<Interface> {
        Some(self.zone.interface())
    }

    fn gap(&self, x: f64, y: f64) -> Jet {
        self.zone.gap(x, y)
    }

    fn companion(&self, x: f64, y: f64) -> Companion {
        Companion::Lower(Jet::sine(self.amplitude, x, y))
    }

    fn lambda(&self, x: f64, y: f64) -> f64 {
        self.zone.lambda(x, y)
    }
}
