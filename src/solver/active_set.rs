//! The primal-dual active set method on the obstacle half (Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2002) 865).

use std::time::{Duration, Instant};

use super::cholesky::NotFactored;
use super::decoupled::{Decoupled, Gap};
use super::{Candidate, ContactSolver, SolverError, SolverOptions, Statistics};
use crate::discretization::Discretization;
use crate::qp::Status;

/// The limit of steps when none is given. A cold start needs about as many as there are layers of vertices between the
/// free boundary and where the first guess puts it; far more than that is a cycle.
const MAX_STEPS: usize = 2000;

/// A multiplier below zero by less than this fraction of the terms that cancel in it is a zero, rounded.
const MULTIPLIER_ROUNDING: f64 = 256.0 * f64::EPSILON;

/// A gap below zero by less than this fraction of the displacements' scale is a zero, rounded: the error of a linear
/// solve, machine precision times a condition number of up to 1e4.
const GAP_ROUNDING: f64 = 1e-12;

/// A vertex is taken for touching when its multiplier is so much larger than its gap, each in units of the data. A guess
/// that is too small is repaired in fewer steps than one that is too large: all that has passed through is seen at once.
const CAUTION: f64 = 30.0;

/// The contact problem decoupled, and its contact set found by repair of a guess: that of the warm start, or none.
///
/// Works on any mesh. It ends with the exact contact set, so displacements and action are right to rounding. Every step
/// factors a matrix anew; a warm start saves most of them.
#[derive(Debug, Clone, Copy, Default)]
pub struct ActiveSet;

impl ContactSolver for ActiveSet {
    fn name(&self) -> &str {
        "active-set"
    }

    fn solve(&mut self, d: &Discretization, options: &SolverOptions) -> Result<Candidate, SolverError> {
        options.check()?;
        let start = Instant::now();
        let guess = match &options.warm_start {
            Some(start) if start.fits(d) => guess(d, &start.displacement, &start.multiplier),
            _ => vec![false; d.interior().len()],
        };
        let deadline = options.time_limit.map(|seconds| start + Duration::from_secs_f64(seconds));
        let limits = Limits { steps: options.max_iterations.unwrap_or(MAX_STEPS), deadline };
        let found = settle(d, guess, &limits).map_err(|NotFactored| SolverError::NotFactored)?;
        Ok(Candidate {
            displacement: found.displacement,
            multiplier: found.multiplier,
            statistics: Statistics {
                solver: self.name().into(),
                status: found.status,
                iterations: found.repairs + 1,
                setup_seconds: 0.0,
                solve_seconds: start.elapsed().as_secs_f64(),
                polish: None,
            },
        })
    }
}

/// When to stop although the contact set is not consistent yet.
pub(super) struct Limits {
    /// Linear solves for the gap.
    pub(super) steps: usize,
    pub(super) deadline: Option<Instant>,
}

/// Displacements over vertices and multipliers over unknowns for the last contact set.
pub(super) struct Settled {
    pub(super) displacement: [Vec<f64>; 2],
    pub(super) multiplier: Vec<f64>,
    /// How often the contact set was repaired.
    pub(super) repairs: usize,
    /// Solved when the last contact set needed no repair.
    pub(super) status: Status,
}

/// Solves for the contact set `active`, and repairs it until it is consistent.
pub(super) fn settle(
    d: &Discretization,
    mut active: Vec<bool>,
    limits: &Limits,
) -> Result<Settled, NotFactored> {
    let decoupled = Decoupled::new(d);
    let mut repairs = 0;
    let (gap, status) = loop {
        let gap = decoupled.solve_gap(&active)?;
        let repaired = repair(d, &active, &gap);
        if repaired == active {
            break (gap, Status::Solved);
        }
        if repairs + 1 >= limits.steps {
            break (gap, Status::IterationLimit);
        }
        if limits.deadline.is_some_and(|deadline| Instant::now() > deadline) {
            break (gap, Status::TimeLimit);
        }
        active = repaired;
        repairs += 1;
    };
    let w: Vec<f64> = gap.w.iter().map(|w| w.max(0.0)).collect();
    let displacement = decoupled.recombine(&decoupled.solve_sum()?, &w);
    let multiplier = gap.y.iter().map(|y| y.max(0.0)).collect();
    Ok(Settled { displacement, multiplier, repairs, status })
}

/// The vertices that touch, as displacements and multipliers have it.
pub(super) fn guess(d: &Discretization, [u1, u2]: &[Vec<f64>; 2], multiplier: &[f64]) -> Vec<bool> {
    let scales = d.scales();
    let touches = |(&a, y): (&usize, &f64)| {
        let action = y / (d.dual_area()[a] * scales.force_density);
        action > CAUTION * (u1[a] - u2[a]) / scales.displacement
    };
    d.interior().iter().zip(multiplier).map(touches).collect()
}

/// Vertices that pull leave the contact set, vertices that have passed through each other join it.
fn repair(d: &Discretization, active: &[bool], gap: &Gap) -> Vec<bool> {
    let through = -GAP_ROUNDING * d.scales().displacement;
    let pushes = |k: usize| gap.y[k] >= -MULTIPLIER_ROUNDING * gap.y_terms[k];
    (0..active.len()).map(|k| if active[k] { pushes(k) } else { gap.w[k] < through }).collect()
}
