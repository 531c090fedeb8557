//! The linear problem of a given contact set: membranes that touch move as one.

use sprs::CsMat;

use super::actions::{actions, for_segments};
use crate::discretization::{Displacements, StackDiscretization};
use crate::multigrid::cholesky::{Cholesky, NotFactored};

/// No unknown.
const NONE: u32 = u32::MAX;

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
    /// The membranes and vertices whose unknowns are merged, and where those of each merged one end.
    members: Vec<(usize, usize)>,
    ends: Vec<usize>,
}

impl Merged {
    fn new(d: &StackDiscretization, active: &[bool]) -> Self {
        let unknowns = d.unknowns();
        let mut merged = Self {
            number: vec![NONE; unknowns],
            height: vec![0.0; unknowns],
            members: Vec::with_capacity(unknowns),
            ends: Vec::with_capacity(unknowns),
        };
        for_segments(d, active, |a, segment| {
            let rests_on = segment.above.or(segment.below);
            let number = merged.ends.len() as u32;
            for i in segment.layers.clone() {
                let unknown = d.unknown(i, a).expect("segments are free");
                match rests_on {
                    Some(height) => merged.height[unknown] = height,
                    None => merged.number[unknown] = number,
                }
            }
            if rests_on.is_none() {
                merged.members.extend(segment.layers.map(|i| (i, a)));
                merged.ends.push(merged.members.len());
            }
        });
        merged
    }

    /// The members of each merged unknown.
    fn blocks(&self) -> impl Iterator<Item = &[(usize, usize)]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.members[start..end])
    }
}

/// Solves for the displacements where the `active` rows are closed, and for the actions in them.
pub(super) fn solve(d: &StackDiscretization, active: &[bool]) -> Result<Equilibrium, NotFactored> {
    let merged = Merged::new(d, active);
    let (matrix, load) = system(d, &merged);
    let heights = if load.is_empty() { Vec::new() } else { Cholesky::new(matrix)?.solve(&load)? };
    let value = |unknown: usize| match merged.number[unknown] {
        NONE => merged.height[unknown],
        number => heights[number as usize],
    };
    let displacement = d.extend(&(0..d.unknowns()).map(value).collect::<Vec<f64>>());
    let [multiplier, terms] = actions(d, active, &displacement);
    Ok(Equilibrium { displacement, multiplier, terms })
}

/// `Q'K Q` and `Q'(F - K g)`: the rows of all that moves as one are added up.
fn system(d: &StackDiscretization, merged: &Merged) -> (CsMat<f64>, Vec<f64>) {
    let size = merged.ends.len();
    let (mut start, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    let mut load = Vec::with_capacity(size);
    let mut row: Vec<(usize, f64)> = Vec::new();
    // Where each column is among the entries of the row.
    let mut place = vec![NONE; size];
    for members in merged.blocks() {
        row.clear();
        let mut force = 0.0;
        for &(i, a) in members {
            force += d.load(i)[a];
            let on_foundation = std::iter::once((a, d.foundation(i, a))).filter(|entry| entry.1 != 0.0);
            for (b, k) in d.stiffness_row(i, a).chain(on_foundation) {
                let column = match d.unknown(i, b) {
                    None => {
                        force -= k * d.height(i, b).unwrap_or(0.0);
                        continue;
                    }
                    Some(unknown) if merged.number[unknown] == NONE => {
                        force -= k * merged.height[unknown];
                        continue;
                    }
                    Some(unknown) => merged.number[unknown] as usize,
                };
                if place[column] == NONE {
                    place[column] = row.len() as u32;
                    row.push((column, 0.0));
                }
                row[place[column] as usize].1 += k;
            }
        }
        row.iter().for_each(|&(column, _)| place[column] = NONE);
        row.sort_unstable_by_key(|&(column, _)| column);
        columns.extend(row.iter().map(|&(column, _)| column));
        values.extend(row.iter().map(|&(_, value)| value));
        start.push(columns.len());
        load.push(force);
    }
    (CsMat::new((size, size), start, columns, values), load)
}
