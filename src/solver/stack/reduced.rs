//! The linear problem of a given contact set: membranes that touch move as one.

use sprs::CsMat;

use crate::discretization::{Displacements, Layer, Segment, StackDiscretization, segments};
use crate::multigrid::cholesky::{Cholesky, NotFactored};

/// No row, or no unknown.
const NONE: u32 = u32::MAX;

/// A stack with the rows of each vertex at hand.
pub(super) struct Reduced<'d> {
    d: &'d StackDiscretization,
    /// The row of gap `k` at vertex `a`, at `a (N + 1) + k`.
    row_at: Vec<u32>,
}

/// The displacements of a contact set, the actions in its rows, and the size of the terms that cancel in these.
pub(super) struct Equilibrium {
    pub(super) displacement: Displacements,
    pub(super) multiplier: Vec<f64>,
    pub(super) terms: Vec<f64>,
}

/// Where the unknowns go when those that touch become one.
struct Merged {
    /// The merged unknown of each unknown.
    number: Vec<u32>,
    /// The height of those that rest on something.
    height: Vec<f64>,
    /// The unknowns of each merged one.
    members: Vec<Vec<(usize, usize)>>,
}

impl<'d> Reduced<'d> {
    pub(super) fn new(d: &'d StackDiscretization) -> Self {
        let gaps = d.membranes() + 1;
        let mut row_at = vec![NONE; gaps * d.dual_area().len()];
        for (k, row) in d.rows().iter().enumerate() {
            row_at[row.vertex * gaps + row.gap] = k as u32;
        }
        Self { d, row_at }
    }

    /// The row of gap `k` at vertex `a`.
    fn row(&self, k: usize, a: usize) -> Option<usize> {
        let row = self.row_at[a * (self.d.membranes() + 1) + k];
        (row != NONE).then_some(row as usize)
    }

    /// Calls `visit` with the segments at each vertex.
    fn for_segments(&self, active: &[bool], mut visit: impl FnMut(usize, &[Layer], Segment)) {
        let mut layers = Vec::new();
        for a in 0..self.d.dual_area().len() {
            self.d.layers_at(a, &mut layers);
            let touches = |gap: usize| self.row(gap, a).is_some_and(|row| active[row]);
            for segment in segments(&layers, touches) {
                visit(a, &layers, segment);
            }
        }
    }

    fn merged(&self, active: &[bool]) -> Merged {
        let unknowns = self.d.unknowns();
        let mut merged =
            Merged { number: vec![NONE; unknowns], height: vec![0.0; unknowns], members: Vec::new() };
        self.for_segments(active, |a, layers, segment| {
            let rests_on = segment.above.or(segment.below);
            let number = merged.members.len() as u32;
            for layer in segment.layers.clone() {
                let Layer::Unknown(unknown) = layers[layer] else { unreachable!("segments are free") };
                match rests_on {
                    Some(height) => merged.height[unknown] = height,
                    None => merged.number[unknown] = number,
                }
            }
            if rests_on.is_none() {
                merged.members.push(segment.layers.map(|layer| (layer, a)).collect());
            }
        });
        merged
    }

    /// Solves for the displacements where the `active` rows are closed, and for the actions in them.
    pub(super) fn solve(&self, active: &[bool]) -> Result<Equilibrium, NotFactored> {
        let merged = self.merged(active);
        let (matrix, load) = self.system(&merged);
        let heights = if load.is_empty() { Vec::new() } else { Cholesky::new(matrix)?.solve(&load)? };
        let value = |unknown: usize| match merged.number[unknown] {
            NONE => merged.height[unknown],
            number => heights[number as usize],
        };
        let displacement = self.d.extend(&(0..self.d.unknowns()).map(value).collect::<Vec<f64>>());
        let mut multiplier = vec![0.0; active.len()];
        let mut terms = vec![0.0; active.len()];
        self.for_segments(active, |a, _, segment| {
            let sides: Vec<[f64; 2]> =
                segment.layers.clone().map(|i| self.d.imbalance(i, a, &displacement[i - 1])).collect();
            let first = segment.layers.start;
            let of_segment = sides.iter().map(|[_, terms]| terms).sum::<f64>();
            segment.actions(
                |i| sides[i - first][0],
                |k, action| {
                    if let Some(row) = self.row(k, a) {
                        (multiplier[row], terms[row]) = (action, of_segment);
                    }
                },
            );
        });
        Ok(Equilibrium { displacement, multiplier, terms })
    }

    /// `Q'K Q` and `Q'(F - K g)`: the rows of all that moves as one are added up.
    fn system(&self, merged: &Merged) -> (CsMat<f64>, Vec<f64>) {
        let size = merged.members.len();
        let (mut start, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        let mut load = Vec::with_capacity(size);
        // Where each column is among the entries of the present row.
        let mut place = vec![NONE; size];
        for members in &merged.members {
            let begin = columns.len();
            let mut force = 0.0;
            for &(i, a) in members {
                force += self.d.load(i)[a];
                let on_foundation =
                    std::iter::once((a, self.d.foundation(i, a))).filter(|entry| entry.1 != 0.0);
                for (b, k) in self.d.stiffness_row(i, a).chain(on_foundation) {
                    let column = match self.d.unknown(i, b) {
                        None => {
                            force -= k * self.d.height(i, b).unwrap_or(0.0);
                            continue;
                        }
                        Some(unknown) if merged.number[unknown] == NONE => {
                            force -= k * merged.height[unknown];
                            continue;
                        }
                        Some(unknown) => merged.number[unknown] as usize,
                    };
                    if place[column] == NONE {
                        place[column] = columns.len() as u32;
                        columns.push(column);
                        values.push(0.0);
                    }
                    values[place[column] as usize] += k;
                }
            }
            columns[begin..].iter().for_each(|&column| place[column] = NONE);
            let mut row: Vec<(usize, f64)> =
                columns[begin..].iter().copied().zip(values[begin..].iter().copied()).collect();
            row.sort_unstable_by_key(|&(column, _)| column);
            for (k, (column, value)) in row.into_iter().enumerate() {
                (columns[begin + k], values[begin + k]) = (column, value);
            }
            start.push(columns.len());
            load.push(force);
        }
        (CsMat::new((size, size), start, columns, values), load)
    }
}
