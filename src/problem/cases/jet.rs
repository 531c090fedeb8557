//! A smooth function at a point, with the derivatives that the equations need.

use std::f64::consts::PI;

/// Value, gradient and Laplacian of a function at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jet {
    pub(super) value: f64,
    pub(super) gradient: [f64; 2],
    pub(super) laplacian: f64,
}

impl Jet {
    /// The function 0.
    pub(super) const ZERO: Self = Self::constant(0.0);

    /// A constant function.
    pub(super) const fn constant(value: f64) -> Self {
        Self { value, gradient: [0.0, 0.0], laplacian: 0.0 }
    }

    /// `a p + b q`.
    pub(super) fn combination(a: f64, p: Self, b: f64, q: Self) -> Self {
        Self {
            value: a * p.value + b * q.value,
            gradient: [0, 1].map(|k| a * p.gradient[k] + b * q.gradient[k]),
            laplacian: a * p.laplacian + b * q.laplacian,
        }
    }

    /// `p q`.
    pub(super) fn product(p: Self, q: Self) -> Self {
        let [px, py] = p.gradient;
        let [qx, qy] = q.gradient;
        Self {
            value: p.value * q.value,
            gradient: [p.value * qx + q.value * px, p.value * qy + q.value * py],
            laplacian: p.value * q.laplacian + 2.0 * (px * qx + py * qy) + q.value * p.laplacian,
        }
    }

    /// `c sin(pi x) sin(pi y)`, zero on the boundary of the unit square.
    pub(super) fn sine(c: f64, x: f64, y: f64) -> Self {
        let ((sin_x, cos_x), (sin_y, cos_y)) = ((PI * x).sin_cos(), (PI * y).sin_cos());
        let value = c * sin_x * sin_y;
        Self {
            value,
            gradient: [c * PI * cos_x * sin_y, c * PI * sin_x * cos_y],
            laplacian: -2.0 * PI * PI * value,
        }
    }

    /// `c x (1 - x) y (1 - y)`, zero on the boundary of the unit square.
    pub(super) fn bubble(c: f64, x: f64, y: f64) -> Self {
        let (along_x, along_y) = (x * (1.0 - x), y * (1.0 - y));
        Self {
            value: c * along_x * along_y,
            gradient: [c * (1.0 - 2.0 * x) * along_y, c * along_x * (1.0 - 2.0 * y)],
            laplacian: -2.0 * c * (along_x + along_y),
        }
    }
}
