//! The matrices of the coarser levels, truncated: hat functions that reach over vertices in contact are cut off there.
//!
//! With `T` the identity but for zeros at the vertices in contact, the levels have `P' T A T P` in place of `P' A P` (Graeser,
//! Kornhuber, J. Comput. Math. 27 (2009) 1). Only rows near the rim of the contact set differ from what is known, so a change
//! of the set costs as much as it is long.

use crate::multigrid::hierarchy::{Hierarchy, RowSum, Transfer, Values};

/// An entry that differs by less than this fraction of the whole diagonal does so by the order of a sum.
const UNCHANGED: f64 = 1e-12;

/// The truncated matrices below a finest level.
pub(crate) struct Truncation<'h> {
    hierarchy: &'h Hierarchy,
    /// For each level the matrix that holds now.
    values: Vec<Values>,
    sums: Vec<RowSum>,
    marked: Vec<Vec<bool>>,
}

impl<'h> Truncation<'h> {
    /// Of the levels `0..levels`, without matrices yet: call [`reset`](Self::reset) next.
    pub(crate) fn new(hierarchy: &'h Hierarchy, levels: usize) -> Self {
        let sizes = || hierarchy.levels()[..levels].iter().map(|level| level.pattern.rows());
        Self {
            hierarchy,
            values: vec![Values::default(); levels],
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
        let rows: Vec<u32> = changed.iter().chain(neighbours).copied().collect();
        self.follow(finest, rows, Some(frozen))
    }

    /// The matrix of the finest of these levels has these entries now: of the diagonal, and off it in the order of the pattern. Returns
    /// whether that has reached level 0.
    pub(crate) fn replace(&mut self, diagonal: &[f64], off_diagonal: &[f64]) -> bool {
        let finest = self.values.len() - 1;
        let level = &self.hierarchy.levels()[finest];
        let values = &mut self.values[finest];
        let mut rows = Vec::new();
        for i in (0..level.pattern.rows()).filter(|&i| !level.is_held(i)) {
            let range = level.pattern.range(i);
            let same = |a: f64, b: f64| (a - b).abs() <= UNCHANGED * level.values.diagonal[i];
            let off = values.off_diagonal[range.clone()].iter().zip(&off_diagonal[range.clone()]);
            if same(values.diagonal[i], diagonal[i]) && off.into_iter().all(|(&a, &b)| same(a, b)) {
                continue;
            }
            values.part(level.runs.with_row(i));
            let mut entries = off_diagonal[range].iter();
            values.set_row(&level.pattern, i, |column| {
                if column == i { diagonal[i] } else { *entries.next().expect("a row has as many entries") }
            });
            rows.push(i as u32);
        }
        self.follow(finest, rows, None)
    }

    /// Makes the matrices below the level `finest` follow these of its rows: those of its whole matrix where they are not `frozen`, else those
    /// that hold now. Returns whether that has reached level 0.
    fn follow(&mut self, finest: usize, mut rows: Vec<u32>, frozen: Option<&[bool]>) -> bool {
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
                match frozen.filter(|_| l + 1 == finest) {
                    Some(frozen) => {
                        sum.gather((&fine.pattern, &fine.values), &fine.transfer, a as usize, |i| frozen[i]);
                    }
                    None => sum.gather((&fine.pattern, &above[0]), &fine.transfer, a as usize, |_| false),
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
