//! The actions in the rows of a stack, from displacements alone.

use crate::action::recovery::ROUNDINGS;
use crate::discretization::{Segment, StackDiscretization};

/// What is recovered from displacements, over rows. Unit: force.
pub(super) struct Forces {
    /// The actions; zero in rows that are not closed.
    pub(super) action: Vec<f64>,
    /// What rounding may have left in each of them.
    pub(super) rounding: Vec<f64>,
    /// What nothing takes up, the rounding in it, and where: the block balance.
    pub(super) balance: Vec<(usize, f64, f64)>,
}

/// The actions in the `closed` rows by cumulative sums along the chains. Between two walls, where a common part of all
/// actions is not determined, `given` says what the uppermost one is; else it is the least one.
pub(super) fn forces(
    d: &StackDiscretization,
    u: &[Vec<f64>],
    closed: &[bool],
    given: Option<&[f64]>,
) -> Forces {
    let rows = closed.len();
    let mut forces = Forces { action: vec![0.0; rows], rounding: vec![0.0; rows], balance: Vec::new() };
    let mut layers = Vec::new();
    for a in 0..d.dual_area().len() {
        for segment in d.segments(a, closed, &mut layers) {
            add_segment(d, u, a, &segment, given, &mut forces);
        }
    }
    forces
}

fn add_segment(
    d: &StackDiscretization,
    u: &[Vec<f64>],
    a: usize,
    segment: &Segment,
    given: Option<&[f64]>,
    forces: &mut Forces,
) {
    let first = segment.layers.start;
    let sides: Vec<[f64; 2]> = segment.layers.clone().map(|i| d.imbalance(i, a, &u[i - 1])).collect();
    let terms: f64 = sides.iter().map(|[_, terms]| terms).sum();
    let rounding = ROUNDINGS * f64::EPSILON * terms;
    let mut found = Vec::new();
    let left = segment
        .actions(|i| sides[i - first][0], |gap, action| found.extend(d.row(gap, a).map(|row| (row, action))));
    // The uppermost comes first.
    let undetermined = segment.above.is_some() && segment.below.is_some();
    let shift = match (given, found.first()) {
        (Some(given), Some(&(row, action))) if undetermined => given[row] - action,
        _ => 0.0,
    };
    for (row, action) in found {
        (forces.action[row], forces.rounding[row]) = (action + shift, rounding);
    }
    if segment.above.is_none() && segment.below.is_none() {
        forces.balance.push((a, left, rounding));
    }
}
