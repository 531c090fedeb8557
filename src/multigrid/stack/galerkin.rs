//! Galerkin products: the matrices of the coarser levels, truncated by what moves as one.

use super::partition::Partition;
use super::reduced::{BlockRows, Reduced, RowMaker};
use crate::multigrid::hierarchy::{RowSum, Transfer};

/// `P'A P`, where a block of the finer level takes the mean of what the scalar prolongation gives to its members.
pub(super) struct Galerkin<'a, M> {
    pub(super) matrix: &'a M,
    pub(super) fine: &'a Partition,
    pub(super) transfer: &'a Transfer,
    pub(super) coarse: &'a Partition,
}

impl<M: BlockRows> Galerkin<'_, M> {
    /// Makes these rows of the coarser level anew.
    pub(super) fn renew(&self, reduced: &mut Reduced, dirty: &[u32]) {
        let entries = self.transfer.coarse_rows() * self.coarse.membranes();
        reduced.renew(dirty, || Gathering { galerkin: self, sum: RowSum::new(entries) });
    }
}

struct Gathering<'a, M> {
    galerkin: &'a Galerkin<'a, M>,
    sum: RowSum,
}

impl<M: BlockRows> RowMaker for Gathering<'_, M> {
    fn make(&mut self, a: usize, entry: usize, mut push: impl FnMut(u32, f64)) -> f64 {
        let Self { galerkin: Galerkin { matrix, fine, transfer, coarse }, sum } = self;
        if coarse.len(entry) == 0 {
            return 0.0;
        }
        sum.clear();
        let n = coarse.membranes();
        let (member, members) = (entry - a * n, coarse.len(entry) as f64);
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
        for (&column, &value) in sum.column.iter().zip(&sum.value) {
            if column as usize != entry && value != 0.0 {
                push(column, value);
            }
        }
        sum.at(entry)
    }
}
