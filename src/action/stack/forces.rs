//! The actions in the rows of a stack, from displacements alone.

use std::ops::Range;

use crate::action::recovery::ROUNDINGS;
use crate::discretization::{Segment, StackDiscretization};
use crate::parallel::blocks;
use crate::parallel::prelude::*;

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
    let of_block = |vertices: Range<usize>| {
        let (mut found, mut layers) = (Found::default(), Vec::new());
        for a in vertices {
            for segment in d.segments(a, closed, &mut layers) {
                add_segment(d, u, a, &segment, given, &mut found);
            }
        }
        found
    };
    let blocks: Vec<Found> = blocks(d.dual_area().len()).into_par_iter().map(of_block).collect();
    let rows = closed.len();
    let mut forces = Forces { action: vec![0.0; rows], rounding: vec![0.0; rows], balance: Vec::new() };
    for Found { actions, balance } in blocks {
        for (row, action, rounding) in actions {
            (forces.action[row], forces.rounding[row]) = (action, rounding);
        }
        forces.balance.extend(balance);
    }
    forces
}

/// What is found at some vertices: rows with their actions, and the block balances, each with its rounding.
#[derive(Default)]
struct Found {
    actions: Vec<(usize, f64, f64)>,
    balance: Vec<(usize, f64, f64)>,
}

fn add_segment(
    d: &StackDiscretization,
    u: &[Vec<f64>],
    a: usize,
    segment: &Segment,
    given: Option<&[f64]>,
    forces: &mut Found,
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
    forces.actions.extend(found.into_iter().map(|(row, action)| (row, action + shift, rounding)));
    if segment.above.is_none() && segment.below.is_none() {
        forces.balance.push((a, left, rounding));
    }
}
