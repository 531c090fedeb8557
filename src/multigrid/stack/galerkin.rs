//! Galerkin products: the matrices of the coarser levels, truncated by what moves as one.

use std::ops::Range;

use super::partition::Partition;
use super::reduced::{BlockRows, Reduced};
use crate::multigrid::hierarchy::{RowSum, Rows, Transfer};
use crate::parallel::blocks_of;
use crate::parallel::prelude::*;

/// Coarse rows that are made together.
const BLOCK: usize = 1024;

/// Blocks that share a [`RowSum`].
const BLOCKS: usize = 4;

/// `P'A P`, where a block of the finer level takes the mean of what the scalar prolongation gives to its members.
pub(super) fn galerkin(
    fine: (&impl BlockRows, &Partition),
    transfer: &Transfer,
    coarse: &Partition,
) -> Reduced {
    let n = coarse.membranes();
    let coarse_rows = transfer.coarse_rows();
    let of_block = |sum: &mut RowSum, block: Range<usize>| {
        let mut rows = Rows::with_capacity(block.len() * n);
        for a in block {
            for at in a * n..(a + 1) * n {
                let mut diagonal = 0.0;
                if coarse.len(at) != 0 {
                    gather(sum, fine, transfer, coarse, (a, at));
                    diagonal = sum.at(at);
                    for (&column, &value) in sum.column.iter().zip(&sum.value) {
                        if column as usize != at && value != 0.0 {
                            rows.column.push(column);
                            rows.off_diagonal.push(value);
                        }
                    }
                }
                rows.diagonal.push(diagonal);
                rows.ends.push(rows.column.len());
            }
        }
        rows
    };
    let blocks = blocks_of(BLOCK, coarse_rows).into_par_iter().with_min_len(BLOCKS);
    Reduced::assemble(blocks.map_init(|| RowSum::new(coarse_rows * n), of_block).collect())
}

/// The row of the coarse block `at`, which is at row `a`.
#[inline(always)]
fn gather(
    sum: &mut RowSum,
    (matrix, fine): (&impl BlockRows, &Partition),
    transfer: &Transfer,
    coarse: &Partition,
    (a, at): (usize, usize),
) {
    sum.clear();
    let n = coarse.membranes();
    let (member, members) = (at - a * n, coarse.len(at) as f64);
    for (i, weight) in transfer.children(a) {
        let block = fine.block(i, member);
        if fine.len(block) == 0 {
            continue;
        }
        let weight = weight * members / fine.len(block) as f64;
        matrix.for_entries(i, block, fine, |j, column, value| {
            let first = column - j * n;
            let len = fine.len(column);
            let value = weight * value / len as f64;
            transfer.for_each_parent(j, |b, other| {
                for p in first..first + len {
                    let entry = coarse.block(b, p);
                    if coarse.len(entry) != 0 {
                        sum.add(entry, value * other);
                    }
                }
            });
        });
    }
}
