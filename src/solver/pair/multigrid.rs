//! Multigrid on the decoupled pair.

use web_time::Instant;

use super::decoupled::Decoupled;
use crate::discretization::PairDiscretization;
use crate::multigrid::half::{HalfProblem, MAX_CYCLES};
use crate::multigrid::membrane::MembraneLevels;
use crate::qp::Status;
use crate::solver::{Candidate, SolverError, SolverOptions, StartingPoint, Statistics};

/// Both halves may miss the tolerance by as much: their residuals add up in those of the membranes.
const SHARE: f64 = 0.5;

/// Solves on these levels; the time limit counts from `start`. The seconds in the statistics are left to others.
pub(in crate::solver) fn solve_on(
    levels: &MembraneLevels,
    d: &PairDiscretization,
    name: &str,
    options: &SolverOptions,
    start: Instant,
) -> Result<Candidate, SolverError> {
    let decoupled = Decoupled::new(d);
    let [gap, sum] = halves(levels, &decoupled, d, options);
    let limits = options.limits(MAX_CYCLES, start);
    let (gap, sum) = crate::parallel::join(|| levels.solve(gap, &limits), || levels.solve(sum, &limits));
    let (gap, sum) = (gap?, sum?);
    let level_iterations: Vec<usize> = gap.cycles.iter().zip(&sum.cycles).map(|(a, b)| *a.max(b)).collect();
    let (w, (s, y)) = crate::parallel::join(
        || levels.to_vertices(&gap.x),
        || (levels.to_vertices(&sum.x), levels.to_vertices(&gap.y)),
    );
    let status = if gap.status == Status::Solved { sum.status } else { gap.status };
    Ok(Candidate {
        displacement: decoupled.recombine(&s, &w).into(),
        multiplier: d.interior().iter().map(|&a| decoupled.gap_tension() * y[a]).collect(),
        statistics: Statistics {
            iterations: level_iterations.last().copied().unwrap_or(0),
            level_iterations,
            energies: gap.energies,
            ..Statistics::of(name, status)
        },
    })
}

/// The gap and the sum.
fn halves(
    levels: &MembraneLevels,
    decoupled: &Decoupled,
    d: &PairDiscretization,
    options: &SolverOptions,
) -> [HalfProblem; 2] {
    let force = SHARE * options.tolerance * d.scales().force_density;
    let start = options.warm_start.as_ref().filter(|start| start.fits_pair(d));
    let [mu1, mu2] = d.tension();
    let guess = |combine: &(dyn Fn(&StartingPoint, usize) -> f64 + Sync)| {
        start.map(|start| levels.to_rows(|a| combine(start, a)))
    };
    let gap = HalfProblem {
        load: levels.to_rows(|a| decoupled.gap_load(a)),
        height: levels.to_rows(|a| d.height()[a]),
        lower: 0.0,
        weight: levels.to_rows(|a| decoupled.gap_tension() / (force * d.dual_area()[a])),
        tolerance: 1.0,
        start: guess(&|start, a| start.displacement[0][a] - start.displacement[1][a]),
    };
    let sum = HalfProblem {
        load: levels.to_rows(|a| decoupled.sum_load(a)),
        height: levels.to_rows(|a| decoupled.sum_height(a)),
        lower: f64::NEG_INFINITY,
        weight: levels.to_rows(|a| 1.0 / (force * d.dual_area()[a])),
        tolerance: 1.0,
        start: guess(&|start, a| mu1 * start.displacement[0][a] + mu2 * start.displacement[1][a]),
    };
    [gap, sum]
}
