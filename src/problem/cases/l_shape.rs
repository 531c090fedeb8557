//! The singularity of a re-entrant corner: cases F (in the gap, with contact) and G (free of contact).

use std::f64::consts::{FRAC_PI_4, TAU};
use std::sync::Arc;

use super::decoupled::{Companion, Decoupled};
use super::description::Description;
use super::jet::Jet;
use super::parameter::{MU1, MU2, Parameter};
use crate::geometry::Interface;
use crate::problem::Domain;

/// The gap of case F is purely singular up to this radius ...
const PLATEAU: f64 = 0.25;
/// ... vanishes from this one on ...
const SUPPORT: f64 = 0.75;
/// ... and the action starts here: biactive in between.
const CONTACT: f64 = 1.25;

pub(super) static L_SHAPE: Description<dyn Decoupled> = Description {
    name: "l-shape",
    title: "L-shape, corner singularity in the gap, contact beyond a biactive ring",
    letter: "F",
    formulas: &[
        "Omega = (-2,2)^2 without [0,2]x[-2,0], g = 0, s = 0, theta in [0, 3 pi/2]",
        "w      = r^(2/3) gamma(r) sin(2 theta/3), t = 2 (r - 1/4),",
        "gamma  = 1 for r < 1/4, 0 for r > 3/4, else -6 t^5 + 15 t^4 - 10 t^3 + 1",
        "lambda = m for r > 5/4, else 0",
        "F      = -m sin(2 theta/3) (r^(2/3) gamma'' + (7/3) r^(-1/3) gamma')",
        "         - lambda",
        "f1     = F, f2 = -F",
        "Source: S. Bartels, C. Carstensen, Numer. Math. 99 (2004) 225",
    ],
    parameters: &[MU1, MU2],
    build: |values| Ok(Arc::new(LShape { action: values.reduced_tension() })),
};

pub(super) static L_SHAPE_FREE: Description<dyn Decoupled> = Description {
    name: "l-shape-free",
    title: "L-shape, corner singularity in both membranes, nowhere in contact",
    letter: "G",
    formulas: &[
        "Omega = (-1,1)^2 without [0,1]x[-1,0], theta in [0, 3 pi/2]",
        "w      = g, lambda = 0",
        "u2     = (1 - x^2) (1 - y^2) r^(2/3) sin(2 theta/3)",
    ],
    parameters: &[MU1, MU2, Parameter::positive("g", 0.5, "gap, the same everywhere")],
    build: |values| Ok(Arc::new(LShapeFree { gap: values.get("g") })),
};

/// Polar coordinates around the corner; the angle jumps in the middle of the missing quadrant, so that it is
/// continuous across both edges of the corner.
fn polar(x: f64, y: f64) -> (f64, f64) {
    let angle = y.atan2(x);
    (x.hypot(y), if angle < -FRAC_PI_4 { angle + TAU } else { angle })
}

/// `r^(2/3) sin(2 theta/3)`, harmonic, zero on both edges of the corner.
fn singular(r: f64, theta: f64) -> Jet {
    let root = r.cbrt();
    let (sin, cos) = (theta / 3.0).sin_cos();
    // At the corner itself, 0 * infinity would make the gradient NaN.
    let gradient = if r > 0.0 { [-sin, cos].map(|d| 2.0 * d / (3.0 * root)) } else { [0.0, f64::INFINITY] };
    Jet { value: root * root * (2.0 * theta / 3.0).sin(), gradient, laplacian: 0.0 }
}

#[derive(Debug)]
struct LShape {
    /// `m`, so that the scaled problem has the load -1 in the contact zone.
    action: f64,
}

impl Decoupled for LShape {
    fn domain(&self) -> Domain {
        Domain::LShape { half_width: 2.0 }
    }

    fn interfaces(&self) -> Vec<Interface> {
        [PLATEAU, SUPPORT, CONTACT].map(|radius| Interface::Circle { centre: [0.0, 0.0], radius }).to_vec()
    }

    fn gap(&self, x: f64, y: f64) -> Jet {
        let (r, theta) = polar(x, y);
        if r >= SUPPORT {
            return Jet::ZERO;
        }
        let sigma = singular(r, theta);
        if r <= PLATEAU {
            return sigma;
        }
        let t = (r - PLATEAU) / (SUPPORT - PLATEAU);
        let gamma = 1.0 - t.powi(3) * (10.0 + t * (6.0 * t - 15.0));
        let d_gamma = -60.0 * (t * (1.0 - t)).powi(2);
        let dd_gamma = -240.0 * t * (1.0 - t) * (1.0 - 2.0 * t);
        let towards = sigma.value * d_gamma / r;
        Jet {
            value: gamma * sigma.value,
            gradient: [gamma * sigma.gradient[0] + towards * x, gamma * sigma.gradient[1] + towards * y],
            laplacian: sigma.value * (dd_gamma + 7.0 / 3.0 * d_gamma / r),
        }
    }

    fn companion(&self, _x: f64, _y: f64) -> Companion {
        Companion::Sum(Jet::ZERO)
    }

    fn lambda(&self, x: f64, y: f64) -> f64 {
        if x.hypot(y) > CONTACT { self.action } else { 0.0 }
    }

    fn height(&self, _x: f64, _y: f64) -> f64 {
        0.0
    }
}

#[derive(Debug)]
struct LShapeFree {
    gap: f64,
}

impl Decoupled for LShapeFree {
    fn domain(&self) -> Domain {
        Domain::LShape { half_width: 1.0 }
    }

    fn interfaces(&self) -> Vec<Interface> {
        Vec::new()
    }

    fn gap(&self, _x: f64, _y: f64) -> Jet {
        Jet::constant(self.gap)
    }

    /// `u2 = phi sigma` with `Lap u2 = sigma Lap phi + 2 grad phi . grad sigma`. Multiplied out, the second
    /// term is `-(8/3) (sigma - x y r^(2/3) cos(4 theta/3))`, which is bounded although `grad sigma` is not.
    fn companion(&self, x: f64, y: f64) -> Companion {
        let (r, theta) = polar(x, y);
        let sigma = singular(r, theta);
        let (along_x, along_y) = (1.0 - x * x, 1.0 - y * y);
        let phi = along_x * along_y;
        let mixed = sigma.value - x * y * r.cbrt().powi(2) * (4.0 * theta / 3.0).cos();
        Companion::Lower(Jet {
            value: phi * sigma.value,
            gradient: [
                phi * sigma.gradient[0] - 2.0 * x * along_y * sigma.value,
                phi * sigma.gradient[1] - 2.0 * y * along_x * sigma.value,
            ],
            laplacian: -2.0 * (along_x + along_y) * sigma.value - 8.0 / 3.0 * mixed,
        })
    }

    fn lambda(&self, _x: f64, _y: f64) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_singular_function_is_continuous_across_both_edges_and_inside() {
        let jumps = |polar: fn(f64, f64) -> (f64, f64), [x, y]: [f64; 2], [dx, dy]: [f64; 2]| {
            let [ahead, behind] = [1e-9, -1e-9].map(|step| {
                let (r, theta) = polar(x + step * dx, y + step * dy);
                singular(r, theta).value
            });
            (ahead - behind).abs() > 1e-6
        };
        let raw = |x: f64, y: f64| (x.hypot(y), y.atan2(x));
        let raw_positive = |x: f64, y: f64| (x.hypot(y), y.atan2(x).rem_euclid(TAU));
        let (first_edge, last_edge, inside) = ([0.5, 0.0], [0.0, -0.5], [-0.5, 0.0]);
        let (across_x, across_y) = ([1.0, 0.0], [0.0, 1.0]);
        assert!(!jumps(polar, first_edge, across_y) && jumps(raw_positive, first_edge, across_y));
        assert!(!jumps(polar, inside, across_y) && jumps(raw, inside, across_y));
        assert!(!jumps(polar, last_edge, across_x));
    }
}
