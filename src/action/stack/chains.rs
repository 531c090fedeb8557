//! The layers at each vertex, with their rows, and the actions between them.

use crate::action::recovery::ROUNDINGS;
use crate::discretization::{Layer, Segment, StackDiscretization, segments};

/// The rows at each vertex.
pub(super) struct Chains<'d> {
    pub(super) d: &'d StackDiscretization,
    /// The row of gap `k` at vertex `a`, at `a (N + 1) + k`.
    row_at: Vec<Option<u32>>,
}

/// What is recovered from displacements, over rows. Unit: force.
pub(super) struct Forces {
    /// The actions; zero in rows that are not closed.
    pub(super) action: Vec<f64>,
    /// What rounding may have left in each of them.
    pub(super) rounding: Vec<f64>,
    /// What nothing takes up, the rounding in it, and where: the block balance.
    pub(super) balance: Vec<(usize, f64, f64)>,
}

impl<'d> Chains<'d> {
    pub(super) fn new(d: &'d StackDiscretization) -> Self {
        let gaps = d.membranes() + 1;
        let mut row_at = vec![None; gaps * d.dual_area().len()];
        for (k, row) in d.rows().iter().enumerate() {
            row_at[row.vertex * gaps + row.gap] = Some(k as u32);
        }
        Self { d, row_at }
    }

    /// The row of gap `k` at vertex `a`.
    pub(super) fn row(&self, k: usize, a: usize) -> Option<usize> {
        self.row_at[a * (self.d.membranes() + 1) + k].map(|row| row as usize)
    }

    /// The segments at vertex `a`, where the `closed` rows touch.
    pub(super) fn segments(&self, a: usize, closed: &[bool], layers: &mut Vec<Layer>) -> Vec<Segment> {
        self.d.layers_at(a, layers);
        segments(layers, |gap| self.row(gap, a).is_some_and(|row| closed[row]))
    }

    /// The actions in the `closed` rows by cumulative sums along the chains. Between two walls, where a common part of all
    /// actions is not determined, `given` says what the uppermost one is; else it is the least one.
    pub(super) fn forces(&self, u: &[Vec<f64>], closed: &[bool], given: Option<&[f64]>) -> Forces {
        let rows = closed.len();
        let mut forces = Forces { action: vec![0.0; rows], rounding: vec![0.0; rows], balance: Vec::new() };
        let mut layers = Vec::new();
        for a in 0..self.d.dual_area().len() {
            for segment in self.segments(a, closed, &mut layers) {
                self.add_segment(u, a, &segment, given, &mut forces);
            }
        }
        forces
    }

    fn add_segment(
        &self,
        u: &[Vec<f64>],
        a: usize,
        segment: &Segment,
        given: Option<&[f64]>,
        forces: &mut Forces,
    ) {
        let first = segment.layers.start;
        let sides: Vec<[f64; 2]> =
            segment.layers.clone().map(|i| self.d.imbalance(i, a, &u[i - 1])).collect();
        let terms: f64 = sides.iter().map(|[_, terms]| terms).sum();
        let rounding = ROUNDINGS * f64::EPSILON * terms;
        let mut found = Vec::new();
        let left = segment.actions(
            |i| sides[i - first][0],
            |gap, action| found.extend(self.row(gap, a).map(|row| (row, action))),
        );
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
}
