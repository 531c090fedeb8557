//! The primal-dual active set method on the obstacle half (Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2002) 865).

mod nested;
mod obstacle;
#[cfg(test)]
mod tests;

use web_time::Instant;

use obstacle::Obstacle;
pub(in crate::solver) use obstacle::guess;

use super::decoupled::Decoupled;
use crate::discretization::PairDiscretization;
use crate::multigrid::cholesky::NotFactored;
use crate::qp::Limits;
use crate::solver::repair::Settled;
use crate::solver::{Candidate, SolverError, SolverOptions, Statistics};

/// The limit of steps when none is given. A cold start needs about as many as there are layers of vertices between the
/// free boundary and where the first guess puts it.
const MAX_STEPS: usize = 2000;

/// See [`ActiveSet`](crate::solver::ActiveSet); `name` is that of the method.
pub(in crate::solver) fn solve(
    d: &PairDiscretization,
    name: &str,
    options: &SolverOptions,
) -> Result<Candidate, SolverError> {
    options.check()?;
    let start = Instant::now();
    let limits = options.limits(MAX_STEPS, start);
    let (active, mut level_iterations) = match &options.warm_start {
        Some(start) if start.fits_pair(d) => (guess(d, &start.displacement, &start.multiplier), Vec::new()),
        _ => nested::guess_from_coarser_levels(d, &limits)?,
    };
    let setup_seconds = start.elapsed().as_secs_f64();
    let found = settle(d, active, &limits)?;
    level_iterations.push(found.repairs + 1);
    Ok(Candidate {
        displacement: found.displacement,
        multiplier: found.multiplier,
        statistics: Statistics {
            iterations: found.repairs + 1,
            level_iterations,
            setup_seconds,
            solve_seconds: start.elapsed().as_secs_f64() - setup_seconds,
            ..Statistics::of(name, found.status)
        },
    })
}

/// Solves for the contact set `active`, and repairs it until it is consistent.
pub(in crate::solver) fn settle(
    d: &PairDiscretization,
    active: Vec<bool>,
    limits: &Limits,
) -> Result<Settled, NotFactored> {
    let decoupled = Decoupled::new(d);
    let mut half = gap_half(d, &decoupled)?;
    let sum_load = lifted(d, |a| decoupled.sum_load(a), |b| decoupled.sum_height(b));
    let (gap, status, repairs) = half.settle(active, limits)?;
    let s = half.without_obstacle(&sum_load)?;
    let over_vertices = |unknowns: &[f64]| d.extend(unknowns, |_| 0.0);
    let w: Vec<f64> = gap.w.iter().map(|w| w.max(0.0)).collect();
    Ok(Settled {
        displacement: decoupled.recombine(&over_vertices(&s), &over_vertices(&w)).into(),
        multiplier: gap.y.iter().map(|y| decoupled.gap_tension() * y.max(0.0)).collect(),
        repairs,
        status,
    })
}

/// The obstacle half on the unknowns of the discretization.
fn gap_half(d: &PairDiscretization, decoupled: &Decoupled) -> Result<Obstacle, NotFactored> {
    let load = lifted(d, |a| decoupled.gap_load(a), |b| d.height()[b]);
    let terms = d.interior().iter().map(|&a| decoupled.gap_load_terms(a)).collect();
    Obstacle::new(d.interior_stiffness(), load, terms, d.scales().displacement)
}

/// `b - K_IB g` for a `height` that is zero inside.
fn lifted(d: &PairDiscretization, load: impl Fn(usize) -> f64, height: impl Fn(usize) -> f64) -> Vec<f64> {
    d.interior().iter().map(|&a| load(a) - d.stiffness_row(a, &height)).collect()
}
