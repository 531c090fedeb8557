//! The limits on the unit square: no contact (H1), contact everywhere (H2), and that without action (H3).

use std::sync::Arc;

use super::decoupled::{Companion, Decoupled};
use super::description::Description;
use super::jet::Jet;
use super::parameter::{CaseError, MU1, MU2, Parameter, Values};
use crate::geometry::Interface;
use crate::problem::Domain;

const AMPLITUDE: Parameter = Parameter::any("c", 0.2, "height of membrane 2 in the middle");

pub(super) static NO_CONTACT: Description<dyn Decoupled> = Description {
    name: "no-contact",
    title: "unit square, nowhere in contact",
    letter: "H1",
    formulas: &[
        "Omega = (0,1)^2, z = sin(pi x) sin(pi y), g = 1 + x, lambda = 0",
        "u1     = 1 + x + (c + k) z, u2 = c z",
        "f1     = 2 pi^2 mu1 (c + k) z, f2 = 2 pi^2 mu2 c z",
    ],
    parameters: &[MU1, MU2, AMPLITUDE, Parameter::non_negative("k", 0.5, "what the gap gains in the middle")],
    build: |values| Ok(Arc::new(NoContact { amplitude: values.get("c"), gain: values.get("k") })),
};

pub(super) static FULL_CONTACT: Description<dyn Decoupled> = Description {
    name: "full-contact",
    title: "unit square, everywhere in contact",
    letter: "H2",
    formulas: FULL_CONTACT_FORMULAS,
    parameters: &[MU1, MU2, AMPLITUDE, Parameter::non_negative("q", 10.0, "action at the origin")],
    build: full_contact,
};

pub(super) static BIACTIVE: Description<dyn Decoupled> = Description {
    name: "biactive",
    title: "unit square, everywhere in contact without action: tests for cycling",
    letter: "H3",
    formulas: FULL_CONTACT_FORMULAS,
    parameters: &[
        MU1,
        MU2,
        AMPLITUDE,
        Parameter::non_negative("q", 0.0, "action at the origin; also try 1e-8, 1e-12"),
    ],
    build: full_contact,
};

const FULL_CONTACT_FORMULAS: &[&str] = &[
    "Omega = (0,1)^2, z = sin(pi x) sin(pi y), g = 0",
    "u1     = u2 = c z",
    "lambda = q (1 + x y)",
    "f1     = 2 pi^2 mu1 c z - lambda, f2 = 2 pi^2 mu2 c z + lambda",
];

fn full_contact(values: &Values) -> Result<Arc<dyn Decoupled>, CaseError> {
    Ok(Arc::new(FullContact { amplitude: values.get("c"), action: values.get("q") }))
}

#[derive(Debug)]
struct NoContact {
    amplitude: f64,
    gain: f64,
}

impl Decoupled for NoContact {
    fn domain(&self) -> Domain {
        Domain::unit_square()
    }

    fn interfaces(&self) -> Vec<Interface> {
        Vec::new()
    }

    fn gap(&self, x: f64, y: f64) -> Jet {
        let plane = Jet { value: self.height(x, y), gradient: [1.0, 0.0], laplacian: 0.0 };
        Jet::combination(1.0, plane, 1.0, Jet::sine(self.gain, x, y))
    }

    fn companion(&self, x: f64, y: f64) -> Companion {
        Companion::Lower(Jet::sine(self.amplitude, x, y))
    }

    fn lambda(&self, _x: f64, _y: f64) -> f64 {
        0.0
    }

    fn height(&self, x: f64, _y: f64) -> f64 {
        1.0 + x
    }
}

#[derive(Debug)]
struct FullContact {
    amplitude: f64,
    action: f64,
}

impl Decoupled for FullContact {
    fn domain(&self) -> Domain {
        Domain::unit_square()
    }

    fn interfaces(&self) -> Vec<Interface> {
        Vec::new()
    }

    fn gap(&self, _x: f64, _y: f64) -> Jet {
        Jet::ZERO
    }

    fn companion(&self, x: f64, y: f64) -> Companion {
        Companion::Lower(Jet::sine(self.amplitude, x, y))
    }

    fn lambda(&self, x: f64, y: f64) -> f64 {
        self.action * (1.0 + x * y)
    }
}
