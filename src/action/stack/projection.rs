//! From a candidate within the tolerance to displacements in their cone and actions in theirs, complementary to the last bit.

use super::forces::forces;
use crate::action::CutOff;
use crate::action::recovery::ROUNDINGS;
use crate::discretization::{Displacements, Segment, StackDiscretization};
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;

/// See [`action::projection`](crate::action::CutOff): of the gap and the multiplier of a row, the smaller one, relative to the
/// data, becomes zero. Membranes that touch move to their mean, weighted by the diagonals of their `K_i`, or to what they rest
/// on.
pub(super) struct Projection {
    pub(super) displacement: Displacements,
    /// The force in each row: `lambda |D_a|`.
    pub(super) action: Vec<f64>,
    /// Whether the layers of each row touch.
    pub(super) touching: Vec<bool>,
    pub(super) cut_off: CutOff,
}

impl Projection {
    pub(super) fn new(d: &StackDiscretization, mut displacement: Displacements, multiplier: &[f64]) -> Self {
        let scales = d.scales();
        let mut moved = take_known_heights(d, &mut displacement);
        let rows = (0..multiplier.len()).into_par_iter().with_min_len(BLOCK);
        let mut touching: Vec<bool> =
            rows.map(|row| touches(d, &displacement, row, multiplier[row])).collect();
        for a in 0..d.dual_area().len() {
            moved = close_gaps(d, a, &mut touching, &mut displacement).max(moved);
        }
        let forces = forces(d, &displacement, &touching, None);
        let densities = |row: usize, force: f64| force.abs() / d.dual_area()[d.rows()[row].vertex];
        let mut dropped: f64 = 0.0;
        let mut action = forces.action;
        for (row, force) in action.iter_mut().enumerate() {
            if *force <= forces.rounding[row] {
                dropped = dropped.max(densities(row, *force));
                *force = 0.0;
            }
        }
        let unbalanced = forces.balance.iter().map(|&(a, left, _)| left.abs() / d.dual_area()[a]);
        let dropped = unbalanced.fold(dropped, f64::max);
        let cut_off = CutOff { gap: moved / scales.displacement, action: dropped / scales.force_density };
        Self { displacement, action, touching, cut_off }
    }
}

/// Heights where the membranes are fixed, zero at unused vertices: the largest change.
fn take_known_heights(d: &StackDiscretization, displacement: &mut Displacements) -> f64 {
    let mut changed: f64 = 0.0;
    for (i, u) in (1..).zip(displacement) {
        for a in (0..u.len()).filter(|&a| d.unknown(i, a).is_none()) {
            let height = d.height(i, a).unwrap_or(0.0);
            changed = changed.max((u[a] - height).abs());
            u[a] = height;
        }
    }
    changed
}

/// The least diagonal entry of the free sides of a row, and the terms that cancel in theirs.
fn stiffness_of(d: &StackDiscretization, u: &[Vec<f64>], row: usize) -> [f64; 2] {
    let row = &d.rows()[row];
    row.free_layers().fold([f64::INFINITY, 0.0], |[least, terms], i| {
        let [_, of_membrane] = d.imbalance(i, row.vertex, &u[i - 1]);
        [least.min(d.diagonal(i, row.vertex)), terms + of_membrane]
    })
}

fn touches(d: &StackDiscretization, u: &[Vec<f64>], row: usize, multiplier: f64) -> bool {
    let gap = d.gap(u, &d.rows()[row]);
    let scales = d.scales();
    let area = d.dual_area()[d.rows()[row].vertex];
    let is_below = || gap / scales.displacement < multiplier / (area * scales.force_density);
    let is_rounding = || {
        let [stiffness, terms] = stiffness_of(d, u, row);
        stiffness * gap <= ROUNDINGS * f64::EPSILON * terms
    };
    gap <= 0.0 || is_below() || is_rounding()
}

/// Moves all that touches at a vertex together, and what passes through a neighbour by that too; the largest change.
fn close_gaps(
    d: &StackDiscretization,
    a: usize,
    touching: &mut [bool],
    displacement: &mut Displacements,
) -> f64 {
    let mut layers = Vec::new();
    let mut moved: f64 = 0.0;
    let rows = || (0..=d.membranes()).filter_map(|gap| d.row(gap, a));
    if !rows().any(|row| touching[row]) {
        return moved;
    }
    let rows: Vec<usize> = rows().collect();
    // Each pass but the last closes one more gap.
    for _ in 0..=rows.len() {
        for segment in d.segments(a, touching, &mut layers) {
            let height = common_height(d, a, &segment, displacement);
            for i in segment.layers {
                moved = moved.max((displacement[i - 1][a] - height).abs());
                displacement[i - 1][a] = height;
            }
        }
        let gaps: Vec<(usize, f64)> =
            rows.iter().map(|&row| (row, d.gap(displacement, &d.rows()[row]))).collect();
        // Between two walls that are apart, only one is touched.
        gaps.iter().filter(|(_, gap)| *gap > 0.0).for_each(|&(row, _)| touching[row] = false);
        let passed: Vec<usize> =
            gaps.into_iter().filter(|&(row, gap)| gap <= 0.0 && !touching[row]).map(|(row, _)| row).collect();
        if passed.is_empty() {
            break;
        }
        passed.into_iter().for_each(|row| touching[row] = true);
    }
    moved
}

/// Of membranes that are together already, where they are.
fn common_height(d: &StackDiscretization, a: usize, segment: &Segment, u: &Displacements) -> f64 {
    if let Some(height) = segment.above.or(segment.below) {
        return height;
    }
    let first = u[segment.layers.start - 1][a];
    if segment.layers.clone().all(|i| u[i - 1][a] == first) {
        return first;
    }
    let weighted = segment.layers.clone().map(|i| (d.diagonal(i, a), u[i - 1][a]));
    let [sum, weights] =
        weighted.fold([0.0; 2], |[sum, weights], (weight, u)| [sum + weight * u, weights + weight]);
    sum / weights
}
