//! The primal-dual active set method for stacks.

use web_time::Instant;

use super::reduced::{self, Equilibrium};
use crate::discretization::StackDiscretization;
use crate::multigrid::cholesky::NotFactored;
use crate::qp::{Limits, Status};
use crate::solver::repair::{CAUTION, ROUNDING, Repair, SLIGHT, Settled};
use crate::solver::{Candidate, SolverError, SolverOptions, Statistics};

/// The limit of steps when none is given: a cold start needs about as many as there are layers of vertices between the free
/// boundary and where the first guess puts it.
const MAX_STEPS: usize = 2000;

/// From the gaps that a warm start closes, else from open ones (closed where membranes are held by nothing else), the contact set is repaired until it is consistent; in each step, all
/// that touches moves as one. `name` is that of the method.
pub(in crate::solver) fn solve(
    d: &StackDiscretization,
    name: &str,
    options: &SolverOptions,
) -> Result<Candidate, SolverError> {
    options.check()?;
    let start = Instant::now();
    let active = match &options.warm_start {
        Some(start) if start.fits_stack(d) => guess(d, &start.displacement, &start.multiplier),
        _ => d.resting(),
    };
    let found = settle(d, active, &options.limits(MAX_STEPS, start))?;
    Ok(Candidate {
        displacement: found.displacement,
        multiplier: found.multiplier,
        statistics: Statistics {
            iterations: found.repairs + 1,
            solve_seconds: start.elapsed().as_secs_f64(),
            ..Statistics::of(name, found.status)
        },
    })
}

/// Solves for the contact set `active`, over rows, and repairs it until it is consistent; gaps that are slightly closed too far
/// are repaired last.
pub(in crate::solver) fn settle(
    d: &StackDiscretization,
    mut active: Vec<bool>,
    limits: &Limits,
) -> Result<Settled, NotFactored> {
    let mut stages = [SLIGHT * d.scales().displacement, 0.0].into_iter();
    let mut overlooked = stages.next().expect("two stages");
    let (mut repair, mut repairs) = (Repair::default(), 0);
    loop {
        let mut equilibrium = reduced::solve(d, &active)?;
        let mut wrong = wrong(d, &active, &equilibrium, overlooked);
        if wrong.is_empty()
            && let Some(next) = stages.next()
        {
            (overlooked, repair) = (next, Repair::default());
            wrong = self::wrong(d, &active, &equilibrium, overlooked);
        }
        let status = if wrong.is_empty() { Some(Status::Solved) } else { limits.reached(repairs + 1) };
        if let Some(status) = status {
            // What is left below zero is rounding.
            equilibrium.multiplier.iter_mut().for_each(|y| *y = y.max(0.0));
            let Equilibrium { displacement, multiplier, .. } = equilibrium;
            return Ok(Settled { displacement, multiplier, repairs, status });
        }
        repair.apply(&mut active, &wrong);
        repairs += 1;
    }
}

/// The rows whose sign is wrong beyond rounding: they pull, or their layers have passed through each other; or they would be closed
/// between two things that do not move, and are not.
fn wrong(d: &StackDiscretization, active: &[bool], found: &Equilibrium, overlooked: f64) -> Vec<usize> {
    let u = &found.displacement;
    let is_wrong = |&k: &usize| {
        let row = &d.rows()[k];
        let gap = d.gap(u, row);
        if active[k] {
            return found.multiplier[k] < -ROUNDING * found.terms[k]
                || gap > overlooked.max(f64::MIN_POSITIVE);
        }
        // What closing the gap would leave of the rows.
        let is_beyond_rounding = |i: usize| {
            let [_, terms] = d.imbalance(i, row.vertex, &u[i - 1]);
            d.diagonal(i, row.vertex) * gap < -ROUNDING * terms
        };
        gap < -overlooked && gap < 0.0 && row.free_layers().any(is_beyond_rounding)
    };
    (0..active.len()).filter(is_wrong).collect()
}

/// The rows that touch, as displacements and multipliers have it.
pub(in crate::solver) fn guess(d: &StackDiscretization, u: &[Vec<f64>], multiplier: &[f64]) -> Vec<bool> {
    let scales = d.scales();
    let touches = |(row, y): (&crate::discretization::GapRow, &f64)| {
        let action = y / (d.dual_area()[row.vertex] * scales.force_density);
        action > CAUTION * d.gap(u, row) / scales.displacement
    };
    d.rows().iter().zip(multiplier).map(touches).collect()
}
