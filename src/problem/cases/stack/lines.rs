//! Actions along lines: cases S7 (where a tension jumps) and S10 (on a free side).

use std::sync::Arc;

use super::layers::{LONG_SIDES, Layers, LineAction, STRIP, Sheet, Surface, Tension};
use crate::geometry::Interface;
use crate::problem::Domain;
use crate::problem::cases::description::Description;
use crate::problem::cases::parameter::Parameter;

pub(super) static TENSION_JUMP: Description<dyn Layers> = Description {
    name: "tension-jump",
    title: "strip, two membranes, a tension jumps in the contact zone: a line action",
    letter: "S7",
    formulas: &[
        "Omega = (0,1) x (0,1/2), N = 2, long sides free, f1 = -4, f2 = 2,",
        "mu1 = 1 for x < xm, mu beyond (the region `stiff`), mu2 = 1",
        "(mu1 + mu2) u' = P = -2 + 2 x for u1 = u2 in x < x1",
        "From there on with the same value and slope, u1'' = 4/mu, u2'' = -2",
        "lambda = 3 for x < xm, 2 + 2/(1 + mu) for x < x1, else 0, and on x = xm",
        "the density (2 - 2 xm) (mu/(1 + mu) - 1/2) per length",
        "On meshes with xm, x1 on mesh lines exact at the nodes.",
    ],
    parameters: &[
        Parameter::positive("mu", 4.0, "tension of membrane 1 beyond xm, above 1"),
        Parameter::between("xm", [0.0, 0.25, 1.0], "where the tension jumps, below x1"),
        Parameter::between("x1", [0.0, 0.5, 1.0], "where the contact ends"),
    ],
    build: |values| {
        let [tension, jump, end] = values.all(["mu", "xm", "x1"]);
        if tension <= 1.0 {
            return Err(values.out_of_range("mu", "mu > 1".into()));
        }
        if jump >= end {
            return Err(values.out_of_range("xm", format!("0 < xm < x1 = {end}")));
        }
        Ok(Arc::new(TensionJump { tension, jump, end }))
    },
};

pub(super) static FREE_END: Description<dyn Layers> = Description {
    name: "free-end",
    title: "strip, line loads press two membranes together at their free ends",
    letter: "S10",
    formulas: &[
        "Omega = (0,1) x (0,1/2), N = 2, held on the left only, f1 = -q, f2 = q,",
        "line loads t1, t2 on the right",
        "u1 = u2 = (t1 + t2)/(mu1 + mu2) x, lambda = q, and on x = 1",
        "the density (mu1 t2 - mu2 t1)/(mu1 + mu2) per length",
        "On every mesh exact at the nodes.",
    ],
    parameters: &[
        Parameter::positive("mu1", 1.0, "tension of membrane 1"),
        Parameter::positive("mu2", 1.0, "tension of membrane 2"),
        Parameter::positive("q", 2.0, "action"),
        Parameter::any("t1", -1.0, "line load on membrane 1, t1/mu1 <= t2/mu2"),
        Parameter::any("t2", 0.0, "line load on membrane 2"),
    ],
    build: |values| {
        let ([mu1, mu2], [action, t1, t2]) = (values.tension(), values.all(["q", "t1", "t2"]));
        if t1 / mu1 > t2 / mu2 {
            return Err(values.out_of_range("t1", format!("t1/mu1 <= t2/mu2 = {}", t2 / mu2)));
        }
        Ok(Arc::new(FreeEnd { tension: [mu1, mu2], action, traction: [t1, t2] }))
    },
};

/// The loads of case S7.
const LOAD: [f64; 2] = [-4.0, 2.0];

#[derive(Debug)]
struct TensionJump {
    /// Of membrane 1 beyond the jump.
    tension: f64,
    jump: f64,
    end: f64,
}

impl TensionJump {
    /// `mu1 + mu2` on either side of the jump.
    fn totals(&self) -> [f64; 2] {
        [2.0, 1.0 + self.tension]
    }

    /// Value and slope where the membranes touch: `(mu1 + mu2) u' = P`, `P = -2 + 2 x`.
    fn together(&self, x: f64) -> [f64; 2] {
        let integral = |x: f64| -2.0 * x + x * x;
        let [before, beyond] = self.totals();
        let flux = -2.0 + 2.0 * x;
        if x <= self.jump {
            return [integral(x) / before, flux / before];
        }
        let to_jump = integral(self.jump);
        [to_jump / before + (integral(x) - to_jump) / beyond, flux / beyond]
    }
}

impl Layers for TensionJump {
    fn domain(&self) -> Domain {
        STRIP
    }

    fn sheets(&self) -> Vec<Sheet> {
        let beyond = Interface::VerticalLine { x: self.jump };
        let tension = Tension::InRegion { name: "stiff", beyond, values: [1.0, self.tension] };
        let [f1, f2] = LOAD;
        [Sheet::new(tension, f1), Sheet::new(1.0.into(), f2)].map(|s| s.free_on(LONG_SIDES)).into()
    }

    fn surface(&self, i: usize, x: f64, _y: f64) -> Surface {
        if x <= self.end {
            return Surface::along_x(self.together(x));
        }
        let (beyond, [value, slope]) = (x - self.end, self.together(self.end));
        let k = [-LOAD[0] / self.tension, -LOAD[1]][i - 1];
        Surface::along_x([value + beyond * (slope + 0.5 * k * beyond), slope + k * beyond])
    }

    /// `lambda = f2 + mu2 u''`.
    fn action(&self, _k: usize, x: f64, _y: f64) -> f64 {
        let [before, beyond] = self.totals();
        if x < self.jump {
            LOAD[1] + 2.0 / before
        } else if x < self.end {
            LOAD[1] + 2.0 / beyond
        } else {
            0.0
        }
    }

    /// `-P [mu1/(mu1 + mu2)]`.
    fn line_actions(&self, _k: usize) -> Vec<LineAction> {
        let [before, beyond] = self.totals();
        let density = (2.0 - 2.0 * self.jump) * (self.tension / beyond - 1.0 / before);
        vec![LineAction { curve: Interface::VerticalLine { x: self.jump }, density }]
    }

    fn rim(&self, _k: usize) -> Option<Interface> {
        Some(Interface::VerticalLine { x: self.end })
    }

    fn interfaces(&self) -> Vec<Interface> {
        [self.jump, self.end].map(|x| Interface::VerticalLine { x }).into()
    }
}

#[derive(Debug)]
struct FreeEnd {
    tension: [f64; 2],
    action: f64,
    traction: [f64; 2],
}

impl Layers for FreeEnd {
    fn domain(&self) -> Domain {
        STRIP
    }

    fn sheets(&self) -> Vec<Sheet> {
        let loads = [-self.action, self.action];
        let sheet = |i: usize| {
            let mut sheet = Sheet::new(self.tension[i].into(), loads[i]).free_on(LONG_SIDES);
            sheet.free.push(("right", self.traction[i].into()));
            sheet
        };
        [0, 1].map(sheet).into()
    }

    fn surface(&self, _i: usize, x: f64, _y: f64) -> Surface {
        let slope = self.traction.iter().sum::<f64>() / self.tension.iter().sum::<f64>();
        Surface::along_x([slope * x, slope])
    }

    fn action(&self, _k: usize, _x: f64, _y: f64) -> f64 {
        self.action
    }

    fn line_actions(&self, _k: usize) -> Vec<LineAction> {
        let ([mu1, mu2], [t1, t2]) = (self.tension, self.traction);
        let density = (mu1 * t2 - mu2 * t1) / (mu1 + mu2);
        vec![LineAction { curve: Interface::VerticalLine { x: 1.0 }, density }]
    }

    fn rim(&self, _k: usize) -> Option<Interface> {
        None
    }

    fn interfaces(&self) -> Vec<Interface> {
        Vec::new()
    }
}
