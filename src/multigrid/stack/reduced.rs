//! The matrices of coarser levels: rows are the blocks that move.

use super::partition::Partition;
use crate::multigrid::hierarchy::row_product;
use crate::parallel::prelude::*;

/// Parts that share the memory in which rows are made.
const PARTS: usize = 4;

/// Rows of a level that are kept together.
const ROWS: usize = 1024;

/// A symmetric matrix over the entries of a level; the rows of entries that are no blocks are empty.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Reduced {
    /// The entries of [`ROWS`] rows of the level each.
    parts: Vec<Part>,
    /// Of how many rows of the level, and entries at each.
    rows: usize,
    membranes: usize,
}

/// Compressed rows.
#[derive(Debug, Clone, Default, PartialEq)]
struct Part {
    start: Vec<u32>,
    column: Vec<u32>,
    value: Vec<f64>,
    diagonal: Vec<f64>,
    /// Zero where the diagonal is.
    inverse: Vec<f64>,
}

/// One row in the making: its columns with their entries, and the entry on the diagonal.
pub(super) trait RowMaker {
    fn make(&mut self, a: usize, entry: usize, push: impl FnMut(u32, f64)) -> f64;
}

impl Reduced {
    /// With empty rows.
    pub(super) fn new(rows: usize, membranes: usize) -> Self {
        let empty = |rows: usize| {
            let zeros = vec![0.0; rows * membranes];
            Part {
                start: vec![0; zeros.len() + 1],
                diagonal: zeros.clone(),
                inverse: zeros,
                ..Part::default()
            }
        };
        let parts = (0..rows).step_by(ROWS).map(|first| empty(ROWS.min(rows - first))).collect();
        Self { parts, rows, membranes }
    }

    /// Makes the rows of the `dirty` ones of the level anew, which come in order.
    pub(super) fn renew<M: RowMaker>(&mut self, dirty: &[u32], maker: impl Fn() -> M + Sync + Send) {
        let n = self.membranes;
        // The parts with rows to be made, each with these.
        let mut parts = Vec::new();
        let mut left = dirty;
        for (k, part) in self.parts.iter_mut().enumerate() {
            let own;
            (own, left) = left.split_at(left.partition_point(|&a| (a as usize) < (k + 1) * ROWS));
            if !own.is_empty() {
                parts.push((k * ROWS, part, own));
            }
        }
        let work = parts.into_par_iter().with_min_len(PARTS);
        work.map_init(maker, |maker, (first, part, dirty)| part.renew(first, n, dirty, maker)).count();
    }

    pub(super) fn entries(&self) -> usize {
        self.rows * self.membranes
    }

    /// The part of an entry at a row of the level, and its row there.
    #[inline(always)]
    fn find(&self, a: usize, entry: usize) -> (&Part, usize) {
        let part = a / ROWS;
        (&self.parts[part], entry - part * ROWS * self.membranes)
    }

    /// The entry on the diagonal.
    pub(super) fn diagonal(&self, a: usize, entry: usize) -> f64 {
        let (part, row) = self.find(a, entry);
        part.diagonal[row]
    }

    /// The entries off the diagonal.
    #[inline(always)]
    pub(super) fn row(&self, a: usize, entry: usize) -> impl Iterator<Item = (usize, f64)> {
        let (part, row) = self.find(a, entry);
        let range = part.range(row);
        part.column[range.clone()].iter().zip(&part.value[range]).map(|(&j, &value)| (j as usize, value))
    }

    /// The parts, each with its first entry.
    fn parts(&self) -> impl DoubleEndedIterator<Item = (usize, &Part)> {
        self.parts.iter().enumerate().map(|(k, part)| (k * ROWS * self.membranes, part))
    }

    /// A Gauss-Seidel sweep from zero.
    pub(super) fn relax_from_zero(&self, b: &[f64], x: &mut [f64]) {
        x.fill(0.0);
        for (first, part) in self.parts() {
            (0..part.inverse.len()).for_each(|i| part.relax(first, i, b, x));
        }
    }

    /// A sweep in the other order.
    pub(super) fn relax_backwards(&self, b: &[f64], x: &mut [f64]) {
        for (first, part) in self.parts().rev() {
            (0..part.inverse.len()).rev().for_each(|i| part.relax(first, i, b, x));
        }
    }

    /// `b - A x` at the rows that are not empty: `at(entry, r)`.
    pub(super) fn for_residuals(&self, b: &[f64], x: &[f64], mut at: impl FnMut(usize, f64)) {
        for (first, part) in self.parts() {
            for i in (0..part.inverse.len()).filter(|&i| part.inverse[i] != 0.0) {
                at(first + i, b[first + i] - part.diagonal[i] * x[first + i] - part.product(i, x));
            }
        }
    }
}

impl Part {
    #[inline(always)]
    fn range(&self, i: usize) -> std::ops::Range<usize> {
        self.start[i] as usize..self.start[i + 1] as usize
    }

    /// The product of row `i` off the diagonal.
    #[inline(always)]
    fn product(&self, i: usize, x: &[f64]) -> f64 {
        let range = self.range(i);
        row_product(&self.column[range.clone()], &self.value[range], x)
    }

    /// Gauss-Seidel for row `i`, of a part that begins at the entry `first`; an empty row is left as it is.
    #[inline(always)]
    fn relax(&self, first: usize, i: usize, b: &[f64], x: &mut [f64]) {
        if self.inverse[i] != 0.0 {
            x[first + i] = (b[first + i] - self.product(i, x)) * self.inverse[i];
        }
    }

    /// Makes the rows of the `dirty` ones of the level anew; `first` is the one with which it begins.
    fn renew(&mut self, first: usize, n: usize, dirty: &[u32], maker: &mut impl RowMaker) {
        let rows = self.diagonal.len();
        let mut new = Self {
            start: Vec::with_capacity(rows + 1),
            diagonal: Vec::with_capacity(rows),
            ..Self::default()
        };
        new.column.reserve(self.column.len());
        new.value.reserve(self.column.len());
        new.start.push(0);
        let mut dirty = dirty.iter().map(|&a| a as usize - first).peekable();
        for a in 0..rows / n {
            let is_dirty = dirty.next_if_eq(&a).is_some();
            for i in a * n..(a + 1) * n {
                let diagonal = if is_dirty {
                    let Self { column, value, .. } = &mut new;
                    maker.make(first + a, first * n + i, |j, entry| {
                        column.push(j);
                        value.push(entry);
                    })
                } else {
                    new.column.extend_from_slice(&self.column[self.range(i)]);
                    new.value.extend_from_slice(&self.value[self.range(i)]);
                    self.diagonal[i]
                };
                new.diagonal.push(diagonal);
                new.start.push(new.column.len() as u32);
            }
        }
        new.inverse = new.diagonal.iter().map(|&d| if d == 0.0 { 0.0 } else { d.recip() }).collect();
        *self = new;
    }
}

/// Matrices whose rows are the blocks of a partition.
pub(super) trait BlockRows: Sync {
    /// The entries `(row of the level, block, value)` of the row of a block, that of the diagonal too.
    fn for_entries(
        &self,
        a: usize,
        block: usize,
        partition: &Partition,
        entry: impl FnMut(usize, usize, f64),
    );
}

impl BlockRows for Reduced {
    #[inline(always)]
    fn for_entries(
        &self,
        a: usize,
        block: usize,
        partition: &Partition,
        mut entry: impl FnMut(usize, usize, f64),
    ) {
        entry(a, block, self.diagonal(a, block));
        for (column, value) in self.row(a, block) {
            entry(partition.vertex(column), column, value);
        }
    }
}

impl BlockRows for super::matrix::BlockMatrix {
    #[inline(always)]
    fn for_entries(
        &self,
        a: usize,
        block: usize,
        partition: &Partition,
        mut entry: impl FnMut(usize, usize, f64),
    ) {
        let n = self.membranes();
        let members = block - a * n..block - a * n + partition.len(block);
        entry(a, block, members.clone().map(|i| self.diagonal[a * n + i]).sum());
        for (k, &b) in self.neighbours(a).iter().enumerate() {
            for i in members.clone() {
                let column = partition.block(b as usize, i);
                if partition.len(column) != 0 {
                    entry(b as usize, column, self.entry(a, k, i));
                }
            }
        }
    }
}
