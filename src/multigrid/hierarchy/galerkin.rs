//! Galerkin products: the matrix of a coarser level is `P' A P`.

use std::ops::Range;

use super::matrix::{Pattern, Rows, Values, assemble};
use super::transfer::Transfer;
use crate::parallel::blocks;
use crate::parallel::prelude::*;

/// Blocks that share a [`RowSum`].
const BLOCKS: usize = 4;

/// The row of a coarse vertex is gathered here: which columns it has, and their entries.
pub(crate) struct RowSum {
    /// Where a column stands among those of this row, plus one; zero elsewhere.
    place: Vec<u32>,
    pub(crate) column: Vec<u32>,
    pub(crate) value: Vec<f64>,
}

impl RowSum {
    pub(crate) fn new(columns: usize) -> Self {
        Self { place: vec![0; columns], column: Vec::new(), value: Vec::new() }
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, column: usize, value: f64) {
        let place = self.place[column];
        if place == 0 {
            self.column.push(column as u32);
            self.value.push(value);
            self.place[column] = self.column.len() as u32;
        } else {
            self.value[place as usize - 1] += value;
        }
    }

    pub(crate) fn clear(&mut self) {
        for &column in &self.column {
            self.place[column as usize] = 0;
        }
        self.column.clear();
        self.value.clear();
    }

    /// The entry of a column; zero where there is none.
    pub(crate) fn at(&self, column: usize) -> f64 {
        match self.place[column] {
            0 => 0.0,
            place => self.value[place as usize - 1],
        }
    }

    /// `sum_{i,j} P_iA a_ij P_jB` for one `A` and all `B`, over those `i`, `j` that are not `frozen`.
    pub(crate) fn gather(
        &mut self,
        (pattern, values): (&Pattern, &Values),
        transfer: &Transfer,
        a: usize,
        frozen: impl Fn(usize) -> bool,
    ) {
        self.clear();
        for (i, weight) in transfer.children(a) {
            if frozen(i) || values.diagonal[i] == 0.0 {
                continue;
            }
            let value = weight * values.diagonal[i];
            transfer.for_each_parent(i, |b, other| self.add(b, value * other));
            for (&j, value) in pattern.row(i).iter().zip(&values.off_diagonal[pattern.range(i)]) {
                if frozen(j as usize) {
                    continue;
                }
                let value = weight * value;
                transfer.for_each_parent(j as usize, |b, other| self.add(b, value * other));
            }
        }
    }
}

/// `P' A P`, with empty rows for the coarse vertices that are held. Parallel; every sum has one order.
pub(crate) fn galerkin(
    fine: (&Pattern, &Values),
    transfer: &Transfer,
    held: impl Fn(usize) -> bool + Sync,
) -> (Pattern, Values) {
    let coarse_rows = transfer.coarse_rows();
    let of_block = |sum: &mut RowSum, block: Range<usize>| {
        let mut rows = Rows::with_capacity(block.len());
        for a in block {
            let mut diagonal = 0.0;
            if !held(a) {
                sum.gather(fine, transfer, a, |_| false);
                diagonal = sum.at(a);
                for (&column, &value) in sum.column.iter().zip(&sum.value) {
                    if column as usize != a {
                        rows.column.push(column);
                        rows.off_diagonal.push(value);
                    }
                }
            }
            rows.diagonal.push(diagonal);
            rows.ends.push(rows.column.len());
        }
        rows
    };
    // Not a sum for each block: they are as long as all rows.
    let blocks = blocks(coarse_rows).into_par_iter().with_min_len(BLOCKS);
    assemble(blocks.map_init(|| RowSum::new(coarse_rows), of_block).collect())
}
