//! The correction on the finest level: a few steps of conjugate gradients, with a cycle as their preconditioner.

use super::coarse::CoarseLevels;
use super::level::StackLevel;
use super::partition::Partition;
use super::sweep::Sweeps;
use crate::multigrid::cholesky::NotFactored;
use crate::parallel::sums;

/// Steps for a correction: more would solve a linear system whose contact set is not right yet.
const STEPS: usize = 10;

/// A step is the last when the preconditioned residual, squared, has fallen to this fraction.
const ENOUGH: f64 = 1e-3;

/// The vectors.
pub(super) struct Conjugate {
    direction: Vec<f64>,
    product: Vec<f64>,
    preconditioned: Vec<f64>,
    pub(super) correction: Vec<f64>,
}

impl Conjugate {
    pub(super) fn new(entries: usize) -> Self {
        let zeros = || vec![0.0; entries];
        Self { direction: zeros(), product: zeros(), preconditioned: zeros(), correction: zeros() }
    }

    /// Lowers `1/2 c'K c - r'c` among the corrections in which the blocks of the partition move as one. Leaves the residual in `r`.
    pub(super) fn solve(
        &mut self,
        (l, level): (usize, &StackLevel),
        sweeps: &mut Sweeps,
        coarse: &mut CoarseLevels,
        partition: &Partition,
        r: &mut [f64],
    ) -> Result<(), NotFactored> {
        let Self { direction, product, preconditioned, correction } = self;
        correction.fill(0.0);
        let (mut first, mut last) = (0.0, 0.0);
        for step in 0..STEPS {
            precondition((l, level), sweeps, coarse, partition, r, preconditioned, product)?;
            let size = dot(r, preconditioned);
            if step == 0 {
                direction.copy_from_slice(preconditioned);
                first = size;
            } else {
                let along = size / last;
                direction.iter_mut().zip(&*preconditioned).for_each(|(d, z)| *d = z + along * *d);
            }
            if !(size > 0.0) || step > 0 && size <= ENOUGH * first {
                break;
            }
            last = size;
            sweeps.multiply(direction, product);
            let curvature = dot(direction, product);
            if !(curvature > 0.0) {
                break;
            }
            let along = size / curvature;
            correction.iter_mut().zip(&*direction).for_each(|(c, d)| *c += along * d);
            r.iter_mut().zip(&*product).for_each(|(r, p)| *r -= along * p);
        }
        Ok(())
    }
}

/// A symmetric cycle for `K z = r`.
pub(super) fn precondition(
    (l, level): (usize, &StackLevel),
    sweeps: &mut Sweeps,
    coarse: &mut CoarseLevels,
    partition: &Partition,
    r: &[f64],
    z: &mut [f64],
    left: &mut [f64],
) -> Result<(), NotFactored> {
    z.fill(0.0);
    sweeps.relax_blocks(z, r, partition, false);
    sweeps.residuals(z, r, left, vec![(); level.rows().div_ceil(super::sweep::CHUNK)], |(), _, _, _| ());
    coarse.correct(l, partition, left, z)?;
    sweeps.relax_blocks(z, r, partition, true);
    Ok(())
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    let [sum] = sums(x.len(), |i| [x[i] * y[i]]);
    sum
}
