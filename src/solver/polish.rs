//! The polish: from an approximate answer to one that is exact to rounding.
//!
//! An interior-point answer at tolerance `t` has products `y_a w_a ~ t`, but near the free boundary both factors may be
//! `sqrt(t)`: the action is then wrong by percents. The answer still tells which vertices touch. With the contact set
//! guessed, the problem is linear; a wrong guess shows as a negative gap or a negative multiplier and is repaired, as in
//! a primal-dual active set method (Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2002) 865).

use super::Candidate;
use super::decoupled::{Decoupled, Gap};
use crate::discretization::Discretization;

/// Repairs of the contact set. An accurate answer needs none to three; where the membranes touch without pushing, the set
/// moves by one layer of vertices at a time. A repair costs about a hundredth of an interior-point solve.
const MAX_REPAIRS: usize = 100;

/// A vertex is taken for touching when its multiplier is so much larger than its gap, each in units of the data. A guess
/// that is too small is repaired in fewer steps than one that is too large: all that has passed through is seen at once.
const CAUTION: f64 = 30.0;

/// A multiplier below zero by less than this fraction of the terms that cancel in it is a zero, rounded.
const MULTIPLIER_ROUNDING: f64 = 256.0 * f64::EPSILON;

/// A gap below zero by less than this fraction of the displacements' scale is a zero, rounded: the error of a linear
/// solve, machine precision times a condition number of up to 1e4.
const GAP_ROUNDING: f64 = 1e-12;

/// What the polish did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolishReport {
    /// Whether the polished result replaced the solver's.
    pub kept: bool,
    /// How often the contact set was repaired.
    pub repairs: usize,
    /// Whether the last contact set needed no repair.
    pub settled: bool,
    /// The largest relative KKT residual of the solver's answer.
    pub residual_before: f64,
    /// The largest relative KKT residual of the polished one.
    pub residual_after: f64,
}

/// A polished point, not yet compared with the one that it came from.
pub(crate) struct Polished {
    pub(crate) displacement: [Vec<f64>; 2],
    pub(crate) multiplier: Vec<f64>,
    pub(crate) repairs: usize,
    pub(crate) settled: bool,
}

/// Solves for the contact set of `candidate`, repaired until it is consistent. `None` when a linear system cannot be
/// solved.
pub(crate) fn polish(d: &Discretization, candidate: &Candidate) -> Option<Polished> {
    let decoupled = Decoupled::new(d);
    let mut active = guess(d, candidate);
    let mut repairs = 0;
    let (gap, settled) = loop {
        let gap = decoupled.solve_gap(&active).ok()?;
        let repaired = repair(d, &active, &gap);
        if repaired == active {
            break (gap, true);
        }
        if repairs == MAX_REPAIRS {
            break (gap, false);
        }
        active = repaired;
        repairs += 1;
    };
    let w: Vec<f64> = gap.w.iter().map(|w| w.max(0.0)).collect();
    let displacement = decoupled.recombine(&decoupled.solve_sum().ok()?, &w);
    let multiplier = gap.y.iter().map(|y| y.max(0.0)).collect();
    Some(Polished { displacement, multiplier, repairs, settled })
}

fn guess(d: &Discretization, candidate: &Candidate) -> Vec<bool> {
    let scales = d.scales();
    let [u1, u2] = &candidate.displacement;
    d.interior()
        .iter()
        .zip(&candidate.multiplier)
        .map(|(&a, y)| {
            y / (d.dual_area()[a] * scales.force_density) > CAUTION * (u1[a] - u2[a]) / scales.displacement
        })
        .collect()
}

/// Vertices that pull leave the contact set, vertices that have passed through each other join it.
fn repair(d: &Discretization, active: &[bool], gap: &Gap) -> Vec<bool> {
    let through = -GAP_ROUNDING * d.scales().displacement;
    (0..active.len())
        .map(
            |k| {
                if active[k] { gap.y[k] >= -MULTIPLIER_ROUNDING * gap.y_terms[k] } else { gap.w[k] < through }
            },
        )
        .collect()
}
