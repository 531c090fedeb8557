//! Norms of functionals on a level, by conjugate gradients with a cycle as their preconditioner.

use super::cholesky::NotFactored;
use super::correction::CoarseLevels;
use super::hierarchy::{Hierarchy, Level};

/// An iteration that adds no more than this fraction to the squared norm is the last: a cycle leaves a tenth or less of the error,
/// so what is missing then is smaller still.
const TOLERANCE: f64 = 1e-12;

/// Far beyond the dozen iterations of ordinary meshes: triangles that are nearly flat need hundreds.
pub(crate) const MAX_ITERATIONS: usize = 500;

/// Why there is no norm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NoNorm {
    /// The coarsest level cannot be factored.
    NotFactored,
    /// [`MAX_ITERATIONS`] are not enough.
    NotConverged,
}

impl From<NotFactored> for NoNorm {
    fn from(_: NotFactored) -> Self {
        Self::NotFactored
    }
}

/// `sup (rho, v) / (v'A v)^(1/2)` over the functions of a level that vanish at held vertices, for a functional given by its values
/// at the hat functions.
///
/// With `A z = rho` it is `sqrt(rho' z)`, which the iteration gathers term by term: `z` itself is not needed. A cycle is not
/// symmetric, so a direction is made orthogonal to the one before it by itself, not by the short recurrence.
pub(crate) fn dual_norm(hierarchy: &Hierarchy, l: usize, rho: &[f64]) -> Result<f64, NoNorm> {
    let level = &hierarchy.levels()[l];
    let mut cycles = CoarseLevels::new(hierarchy, l + 1, false)?;
    let mut residual: Vec<f64> =
        rho.iter().enumerate().map(|(i, &rho)| if level.is_held(i) { 0.0 } else { rho }).collect();
    let mut direction: Vec<f64> = vec![0.0; rho.len()];
    let mut product = direction.clone();
    let mut curvature = 1.0;
    let mut norm_sq: f64 = 0.0;
    for _ in 0..MAX_ITERATIONS {
        let correction = cycles.v_cycle(l, &residual)?;
        let along = dot(correction, &product) / curvature;
        for (d, c) in direction.iter_mut().zip(correction) {
            *d = c - along * *d;
        }
        multiply(level, &direction, &mut product);
        curvature = dot(&direction, &product);
        let slope = dot(&residual, &direction);
        if slope == 0.0 {
            return Ok(norm_sq.sqrt());
        }
        let gain = slope * slope / curvature;
        norm_sq += gain;
        if gain <= TOLERANCE * norm_sq {
            return Ok(norm_sq.sqrt());
        }
        for (r, p) in residual.iter_mut().zip(&product) {
            *r -= slope / curvature * p;
        }
    }
    Err(NoNorm::NotConverged)
}

/// `A x` at the vertices that are not held, for an `x` that is zero at the others.
fn multiply(level: &Level, x: &[f64], product: &mut [f64]) {
    let Level { pattern, values, .. } = level;
    for (i, product) in product.iter_mut().enumerate().filter(|&(i, _)| !level.is_held(i)) {
        *product = values.diagonal[i] * x[i] + values.off_diagonal_product(pattern, i, x);
    }
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
