//! The matrices of the coarser levels, truncated: hat functions that reach over vertices in contact are cut off there.
//!
//! With `T` the identity but for zeros at the vertices in contact, the levels have `P' T A T P` in place of `P' A P` (Graeser,
//! Kornhuber, J. Comput. Math. 27 (2009) 1). Only rows near the rim of the contact set differ from what is known, so a change
//! of the set costs as much as it is long.

use crate::multigrid::hierarchy::{Hierarchy, RowSum, Transfer, Values};

/// The truncated matrices below a finest level.
pub(crate) struct Truncation<'h> {
    hierarchy: &'h Hierarchy,
    /// For each level the matrix that holds now.
    values: Vec<Values>,
    sums: Vec<RowSum>,
    marked: Vec<Vec<bool>>,
}

impl<'h> Truncation<'h> {
    /// Without matrices yet: call [`reset`](Self::reset) next.
    pub(crate) fn new(hierarchy: &'h Hierarchy) -> Self {
        let sizes = || hierarchy.levels()[..hierarchy.finest()].iter().map(|level| level.pattern.rows());
        Self {
            hierarchy,
            values: vec![Values::default(); hierarchy.finest()],
            sums: sizes().map(RowSum::new).collect(),
            marked: sizes().map(|rows| vec![false; rows]).collect(),
        }
    }

    /// The matrix of a coarser level.
    pub(crate) fn values(&self, level: usize) -> &Values {
        &self.values[level]
    }

    /// Forgets what was truncated below `finest`.
    pub(crate) fn reset(&mut self, finest: usize) {
        for (values, level) in self.values[..finest].iter_mut().zip(self.hierarchy.levels()) {
            values.clone_from(&level.values);
        }
    }

    /// Follows the contact set of the level `finest`, which has `changed`. Returns whether that has reached level 0.
    pub(crate) fn update(&mut self, finest: usize, frozen: &[bool], changed: &[u32]) -> bool {
        let top = &self.hierarchy.levels()[finest];
        // An entry of the matrix is cut off with its row or its column. Neighbours in contact have no entries left.
        let neighbours = changed.iter().flat_map(|&i| top.pattern.row(i as usize));
        let neighbours = neighbours.filter(|&&j| !frozen[j as usize]);
        let mut rows: Vec<u32> = changed.iter().chain(neighbours).copied().collect();
        for l in (0..finest).rev() {
            let fine = &self.hierarchy.levels()[l + 1];
            rows = parents(&fine.transfer, &rows, &mut self.marked[l]);
            let (below, above) = self.values.split_at_mut(l + 1);
            let level = &self.hierarchy.levels()[l];
            let mut run = 0;
            for &a in rows.iter().filter(|&&a| !level.is_held(a as usize)) {
                if !level.runs.rows(run).contains(&(a as usize)) {
                    run = level.runs.with_row(a as usize);
                }
                below[l].part(run);
                let sum = &mut self.sums[l];
                if l + 1 == finest {
                    sum.gather((&fine.pattern, &fine.values), &fine.transfer, a as usize, |i| frozen[i]);
                } else {
                    sum.gather((&fine.pattern, &above[0]), &fine.transfer, a as usize, |_| false);
                }
                below[l].set_row(&level.pattern, a as usize, |column| sum.at(column));
            }
        }
        !rows.is_empty()
    }
}

/// The rows of the coarser level that depend on these of the finer one, each once and in order.
fn parents(transfer: &Transfer, rows: &[u32], marked: &mut [bool]) -> Vec<u32> {
    let mut parents = Vec::new();
    for &i in rows {
        transfer.for_each_parent(i as usize, |a, _| {
            if !std::mem::replace(&mut marked[a], true) {
                parents.push(a as u32);
            }
        });
    }
    parents.iter().for_each(|&a| marked[a as usize] = false);
    parents.sort_unstable();
    parents
}
