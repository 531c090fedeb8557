//! Any number of membranes, of which everything is chosen: cases S12 and S13.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::layers::{Layers, Sheet, Surface, Tension};
use crate::geometry::Interface;
use crate::problem::cases::description::Description;
use crate::problem::cases::jet::Jet;
use crate::problem::cases::parameter::Parameter;
use crate::problem::{Domain, Function};

/// The centres of the discs of contact lie on a circle of this radius.
const OFFSET: f64 = 0.1;

/// That many of them would close the circle.
const DISCS: f64 = 5.0;

pub(super) static MANUFACTURED: Description<dyn Layers> = Description {
    name: "manufactured",
    title: "unit square, N membranes, contact in overlapping discs",
    letter: "S12",
    formulas: &[
        "Omega = (0,1)^2, mu_i = i + s x, foundation c, d_k = |(x,y) - m_k|^2 - R^2,",
        "m_k    = (1/2,1/2) + (cos a, sin a)/10, a = 2 pi k/5",
        "B      = 40 x (1 - x) y (1 - y), with free = 1: 40 x y (1 - y)",
        "w_k    = (d_k)_+^2 B, lambda_k = q (-d_k)_+, k = 1 .. N (floor) or N - 1",
        "u_N    = B/10 without a floor, w_N over the floor 0; u_i = u_(i+1) + w_i",
        "f_i    = -div(mu_i grad u_i) + c u_i - lambda_i + lambda_(i-1),",
        "with free = 1 the right side is free, t_i = mu_i d_x u_i",
    ],
    parameters: &[
        Parameter::whole("membranes", [1, 3, 5], "N, above 1 without a floor"),
        Parameter::whole("floor", [0, 1, 1], "1: over a floor"),
        Parameter::whole("free", [0, 0, 1], "1: the right side is free"),
        Parameter::non_negative("s", 1.0, "growth of the tensions"),
        Parameter::non_negative("c", 0.0, "stiffness of the foundations"),
        Parameter::positive("q", 400.0, "size of the actions"),
        Parameter::between("R", [0.0, 0.2, 0.4], "radius of the discs"),
    ],
    build: |values| {
        let [growth, foundation, action, radius] = values.all(["s", "c", "q", "R"]);
        let [membranes, floor, free] = ["membranes", "floor", "free"].map(|name| values.count(name));
        let (floor, free) = (floor == 1, free == 1);
        if membranes == 1 && !floor {
            return Err(values.out_of_range("membranes", "2 to 5 without a floor".into()));
        }
        Ok(Arc::new(Manufactured { membranes, floor, free, growth, foundation, action, radius }))
    },
};

pub(super) static BIACTIVE_STACK: Description<dyn Layers> = Description {
    name: "biactive-stack",
    title: "unit square, N membranes that touch in the left half without action",
    letter: "S13",
    formulas: &[
        "Omega = (0,1)^2, mu_i = i, z = sin(pi x) sin(pi y)",
        "u_i      = c z + k (N - i) (x - 1/2)_+^3",
        "lambda_i = 0, f_i = -mu_i Lap u_i",
        "With k = 0 they touch everywhere.",
    ],
    parameters: &[
        Parameter::whole("membranes", [2, 3, 5], "N"),
        Parameter::any("c", 0.2, "height of membrane N in the middle"),
        Parameter::non_negative("k", 1.0, "size of the gaps"),
    ],
    build: |values| {
        let [amplitude, size] = values.all(["c", "k"]);
        Ok(Arc::new(Biactive { membranes: values.count("membranes"), amplitude, size }))
    },
};

#[derive(Debug, Clone, Copy)]
struct Manufactured {
    membranes: usize,
    floor: bool,
    free: bool,
    growth: f64,
    foundation: f64,
    action: f64,
    radius: f64,
}

impl Manufactured {
    fn gaps(&self) -> usize {
        if self.floor { self.membranes } else { self.membranes - 1 }
    }

    fn centre(&self, k: usize) -> [f64; 2] {
        let (sin, cos) = (TAU * k as f64 / DISCS).sin_cos();
        [0.5 + OFFSET * cos, 0.5 + OFFSET * sin]
    }

    /// `d_k`, negative in the disc of contact.
    fn beyond(&self, k: usize, x: f64, y: f64) -> f64 {
        let [cx, cy] = self.centre(k);
        (x - cx).powi(2) + (y - cy).powi(2) - self.radius * self.radius
    }

    /// `B`.
    fn bubble(&self, x: f64, y: f64) -> Jet {
        let along_y = y * (1.0 - y);
        if self.free {
            let gradient = [40.0 * along_y, 40.0 * x * (1.0 - 2.0 * y)];
            Jet { value: 40.0 * x * along_y, gradient, laplacian: -80.0 * x }
        } else {
            Jet::bubble(40.0, x, y)
        }
    }

    /// `w_k = (d_k)_+^2 B`.
    fn gap(&self, k: usize, x: f64, y: f64) -> Jet {
        let d = self.beyond(k, x, y);
        if d <= 0.0 {
            return Jet::ZERO;
        }
        let ([cx, cy], bubble) = (self.centre(k), self.bubble(x, y));
        let grad_d = [2.0 * (x - cx), 2.0 * (y - cy)];
        // Lap d^2 = 2 |grad d|^2 + 2 d Lap d, Lap d = 4.
        let [dx, dy] = grad_d;
        let square = Jet {
            value: d * d,
            gradient: grad_d.map(|g| 2.0 * d * g),
            laplacian: 2.0 * (dx * dx + dy * dy) + 8.0 * d,
        };
        Jet::product(square, bubble)
    }

    fn membrane(&self, i: usize, x: f64, y: f64) -> Jet {
        let base =
            if self.floor { Jet::ZERO } else { Jet::combination(0.1, self.bubble(x, y), 0.0, Jet::ZERO) };
        (i..=self.gaps()).rev().fold(base, |u, k| Jet::combination(1.0, u, 1.0, self.gap(k, x, y)))
    }

    fn tension(&self, i: usize, x: f64) -> f64 {
        i as f64 + self.growth * x
    }

    /// By the equation of membrane `i`; `div(mu grad u) = mu Lap u + s d_x u`.
    fn load(&self, i: usize, x: f64, y: f64) -> f64 {
        let u = self.membrane(i, x, y);
        let force = self.tension(i, x) * u.laplacian + self.growth * u.gradient[0];
        let above = if i == 1 { 0.0 } else { self.action(i - 1, x, y) };
        let below = if i > self.gaps() { 0.0 } else { self.action(i, x, y) };
        -force + self.foundation * u.value - below + above
    }
}

impl Layers for Manufactured {
    fn domain(&self) -> Domain {
        Domain::unit_square()
    }

    fn sheets(&self) -> Vec<Sheet> {
        let this = *self;
        let sheet = |i: usize| {
            let tension = Function::from_fn(move |x, _| this.tension(i, x));
            let load = Function::piecewise(move |x, y| this.load(i, x, y), this.interfaces());
            let traction =
                Function::from_fn(move |x, y| this.tension(i, x) * this.membrane(i, x, y).gradient[0]);
            let mut sheet = Sheet::new(Tension::Everywhere(tension), load);
            sheet.foundation = this.foundation;
            sheet.free.extend(this.free.then_some(("right", traction)));
            sheet
        };
        (1..=self.membranes).map(sheet).collect()
    }

    fn floor(&self) -> Option<Function> {
        self.floor.then(|| 0.0.into())
    }

    fn surface(&self, i: usize, x: f64, y: f64) -> Surface {
        let Jet { value, gradient, .. } = self.membrane(i, x, y);
        Surface { value, gradient }
    }

    fn action(&self, k: usize, x: f64, y: f64) -> f64 {
        self.action * (-self.beyond(k, x, y)).max(0.0)
    }

    fn rim(&self, k: usize) -> Option<Interface> {
        Some(Interface::Circle { centre: self.centre(k), radius: self.radius })
    }

    fn interfaces(&self) -> Vec<Interface> {
        (1..=self.gaps()).flat_map(|k| self.rim(k)).collect()
    }
}

#[derive(Debug, Clone, Copy)]
struct Biactive {
    membranes: usize,
    amplitude: f64,
    size: f64,
}

impl Biactive {
    fn membrane(&self, i: usize, x: f64, y: f64) -> Jet {
        let (beyond, size) = ((x - 0.5).max(0.0), self.size * (self.membranes - i) as f64);
        let gap = Jet {
            value: size * beyond.powi(3),
            gradient: [3.0 * size * beyond * beyond, 0.0],
            laplacian: 6.0 * size * beyond,
        };
        Jet::combination(1.0, Jet::sine(self.amplitude, x, y), 1.0, gap)
    }
}

impl Layers for Biactive {
    fn domain(&self) -> Domain {
        Domain::unit_square()
    }

    fn sheets(&self) -> Vec<Sheet> {
        let this = *self;
        let load = |i: usize| Function::from_fn(move |x, y| -(i as f64) * this.membrane(i, x, y).laplacian);
        (1..=self.membranes).map(|i| Sheet::new((i as f64).into(), load(i))).collect()
    }

    fn surface(&self, i: usize, x: f64, y: f64) -> Surface {
        let Jet { value, gradient, .. } = self.membrane(i, x, y);
        Surface { value, gradient }
    }

    fn action(&self, _k: usize, _x: f64, _y: f64) -> f64 {
        0.0
    }

    fn rim(&self, _k: usize) -> Option<Interface> {
        None
    }

    fn interfaces(&self) -> Vec<Interface> {
        vec![Interface::VerticalLine { x: 0.5 }]
    }
}
