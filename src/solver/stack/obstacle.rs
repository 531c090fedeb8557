//! Multigrid for one membrane over a floor, under a ceiling, or without an obstacle.
//!
//! With `v = u - psi` over a floor `psi`, the problem is that of the gap of a pair,
//!
//! ```text
//! K v - y = F - K psi        v = g - psi where the membrane is fixed,   v >= 0,  y >= 0,  v'y = 0
//! ```
//!
//! likewise with `v = psi - u` under a ceiling; without an obstacle `psi` is zero, and `v` has no bound.

#[cfg(test)]
mod tests;

use std::borrow::Cow;

use web_time::Instant;

use crate::discretization::StackDiscretization;
use crate::multigrid::half::{HalfProblem, HalfSolution, MAX_CYCLES};
use crate::multigrid::membrane::MembraneLevels;
use crate::numeric::largest;
use crate::qp::Status;
use crate::solver::{Candidate, SolverError, SolverOptions, Statistics};

/// The residuals may miss the tolerance by as much: the rest is for the rounding of `psi + v`.
const SHARE: f64 = 0.5;

/// An obstacle is far away where its distance is more than so many times the largest displacement: `psi + v` has fewer digits than
/// `u` there, by as much.
const FAR: f64 = 8.0;

/// How often an obstacle that is far away is moved: each time, a displacement that is known to no digit becomes known to fifteen.
const APPROACHES: usize = 3;

/// Solves on these levels, and again from a nearer obstacle where that is far away.
pub(in crate::solver) fn solve_on(
    levels: &MembraneLevels,
    d: &StackDiscretization,
    name: &str,
    options: &SolverOptions,
    start: Instant,
) -> Result<Candidate, SolverError> {
    let limits = options.limits(MAX_CYCLES, start);
    let mut obstacle = Obstacle::of(d);
    let guess = options.warm_start.as_ref().filter(|guess| guess.fits_stack(d));
    let guess = guess.map(|guess| guess.displacement[0].as_slice());
    let mut found = levels.solve(obstacle.half(levels, options, guess), &limits)?;
    let mut level_iterations = std::mem::take(&mut found.cycles);
    let iterations = level_iterations.last_mut().expect("there is a finest level");
    let mut u = obstacle.displacement(levels, &found);
    for _ in 0..APPROACHES {
        let may_go_on = matches!(found.status, Status::Solved | Status::Stalled);
        let Some(nearer) = obstacle.nearer(&u).filter(|_| may_go_on) else { break };
        obstacle = nearer;
        let left = options.max_iterations.unwrap_or(MAX_CYCLES).saturating_sub(*iterations);
        let half = obstacle.half(levels, options, Some(&u));
        found = levels.solve(half, &limits.with_iterations(left))?;
        *iterations += found.cycles.iter().sum::<usize>();
        u = obstacle.displacement(levels, &found);
    }
    let iterations = *iterations;
    // Nothing touches the obstacle where it is not the real one, or the answer is that of another problem.
    let status = if obstacle.is_touched_where_raised(&u) { Status::Stalled } else { found.status };
    let y = levels.to_vertices(&found.y);
    Ok(Candidate {
        displacement: vec![u],
        multiplier: d.rows().iter().map(|row| y[row.vertex]).collect(),
        statistics: Statistics {
            iterations,
            level_iterations,
            energies: found.energies,
            ..Statistics::of(name, status)
        },
    })
}

/// The obstacle of a membrane: `u = psi + side v`.
struct Obstacle<'d> {
    d: &'d StackDiscretization,
    psi: Cow<'d, [f64]>,
    /// One for a floor, minus one for a ceiling.
    side: f64,
    /// The bound of `v`: minus infinity where there is no obstacle.
    lower: f64,
    /// Where it is nearer than the real one.
    raised: Vec<usize>,
}

impl<'d> Obstacle<'d> {
    fn of(d: &'d StackDiscretization) -> Self {
        let (psi, side, lower) = match d.obstacles() {
            [Some(ceiling), _] => (Cow::Borrowed(ceiling), -1.0, 0.0),
            [None, Some(floor)] => (Cow::Borrowed(floor), 1.0, 0.0),
            [None, None] => (Cow::Owned(vec![0.0; d.dual_area().len()]), 1.0, f64::NEG_INFINITY),
        };
        Self { d, psi, side, lower, raised: Vec::new() }
    }

    /// The problem of `v`; a guess of `u` to start from.
    fn half(&self, levels: &MembraneLevels, options: &SolverOptions, guess: Option<&[f64]>) -> HalfProblem {
        let Self { d, psi, side, lower, .. } = self;
        let force = SHARE * options.tolerance * d.scales().force_density;
        // (F - K psi)_a
        let load = |a: usize| -d.imbalance(1, a, psi)[0];
        HalfProblem {
            load: levels.to_rows(|a| side * load(a)),
            height: levels.to_rows(|a| d.height(1, a).map_or(0.0, |g| side * (g - psi[a]))),
            lower: *lower,
            weight: levels.to_rows(|a| 1.0 / (force * d.dual_area()[a])),
            tolerance: 1.0,
            start: guess.map(|u| levels.to_rows(|a| side * (u[a] - psi[a]))),
        }
    }

    /// `u` over vertices: where `v` is zero, it is `psi` to the last bit.
    fn displacement(&self, levels: &MembraneLevels, found: &HalfSolution) -> Vec<f64> {
        let v = levels.to_vertices(&found.x);
        let u = |a: usize| match self.d.unknown(1, a) {
            Some(_) => self.psi[a] + self.side * v[a],
            None => self.d.height(1, a).unwrap_or(0.0),
        };
        (0..v.len()).map(u).collect()
    }

    /// The obstacle moved to where it is still out of reach of a membrane that is about there; `None` where it is not far away.
    /// With it, the solution is the same as long as it does not touch what was moved; and `u = psi + v` is known to more digits,
    /// because `v` is smaller.
    fn nearer(&self, u: &[f64]) -> Option<Self> {
        let reach = FAR * largest(u.iter().map(|u| u.abs()));
        let is_far = |&a: &usize| self.lower.is_finite() && self.side * (u[a] - self.psi[a]) > reach;
        let far: Vec<usize> = (0..u.len()).filter(is_far).collect();
        if far.is_empty() || reach == 0.0 {
            return None;
        }
        let mut psi = self.psi.to_vec();
        far.iter().for_each(|&a| psi[a] = u[a] - self.side * reach);
        let raised = [self.raised.clone(), far].concat();
        Some(Self { psi: Cow::Owned(psi), raised, ..*self })
    }

    fn is_touched_where_raised(&self, u: &[f64]) -> bool {
        self.raised.iter().any(|&a| u[a] == self.psi[a])
    }
}
