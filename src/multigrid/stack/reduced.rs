//! The matrices of coarser levels: rows are the blocks that move.

use super::partition::Partition;
use crate::multigrid::hierarchy::Rows;

/// A symmetric matrix over the entries of a level, in compressed rows; the rows of entries that are no blocks are empty.
#[derive(Debug, Clone, Default)]
pub(super) struct Reduced {
    pub(super) start: Vec<u32>,
    pub(super) column: Vec<u32>,
    pub(super) value: Vec<f64>,
    pub(super) diagonal: Vec<f64>,
    /// Zero where the diagonal is.
    inverse: Vec<f64>,
}

impl Reduced {
    /// Puts blocks of consecutive rows together.
    pub(super) fn assemble(blocks: Vec<Rows>) -> Self {
        let entries = blocks.iter().map(|block| block.column.len()).sum();
        let rows = blocks.iter().map(|block| block.diagonal.len()).sum();
        let mut matrix = Self {
            start: Vec::with_capacity(rows + 1),
            column: Vec::with_capacity(entries),
            value: Vec::with_capacity(entries),
            diagonal: Vec::with_capacity(rows),
            inverse: Vec::new(),
        };
        matrix.start.push(0);
        for block in blocks {
            let offset = matrix.column.len();
            matrix.start.extend(block.ends.iter().map(|end| (offset + end) as u32));
            matrix.column.extend(block.column);
            matrix.value.extend(block.off_diagonal);
            matrix.diagonal.extend(block.diagonal);
        }
        let reciprocal = |&d: &f64| if d == 0.0 { 0.0 } else { d.recip() };
        matrix.inverse = matrix.diagonal.iter().map(reciprocal).collect();
        matrix
    }

    pub(super) fn rows(&self) -> usize {
        self.diagonal.len()
    }

    /// The entries of a row off the diagonal.
    #[inline(always)]
    pub(super) fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.start[i] as usize..self.start[i + 1] as usize;
        self.column[range.clone()].iter().zip(&self.value[range]).map(|(&j, &value)| (j as usize, value))
    }

    #[inline(always)]
    fn off_diagonal_product(&self, i: usize, x: &[f64]) -> f64 {
        let range = self.start[i] as usize..self.start[i + 1] as usize;
        let (mut columns, mut values) = (&self.column[range.clone()], &self.value[range]);
        let mut sum = 0.0;
        while let (Some(([j, k, l, m], columns_left)), Some(([a, b, c, d], values_left))) =
            (columns.split_first_chunk::<4>(), values.split_first_chunk::<4>())
        {
            let x = |j: &u32| x[*j as usize];
            sum += (a * x(j) + b * x(k)) + (c * x(l) + d * x(m));
            (columns, values) = (columns_left, values_left);
        }
        for (&j, &a) in columns.iter().zip(values) {
            sum += a * x[j as usize];
        }
        sum
    }

    /// A Gauss-Seidel sweep from zero.
    pub(super) fn relax_from_zero(&self, b: &[f64], x: &mut [f64]) {
        x.fill(0.0);
        self.relax(b, x);
    }

    /// A Gauss-Seidel sweep.
    fn relax(&self, b: &[f64], x: &mut [f64]) {
        for i in (0..self.rows()).filter(|&i| self.inverse[i] != 0.0) {
            x[i] = (b[i] - self.off_diagonal_product(i, x)) * self.inverse[i];
        }
    }

    /// A sweep in the other order.
    pub(super) fn relax_backwards(&self, b: &[f64], x: &mut [f64]) {
        for i in (0..self.rows()).rev().filter(|&i| self.inverse[i] != 0.0) {
            x[i] = (b[i] - self.off_diagonal_product(i, x)) * self.inverse[i];
        }
    }

    /// `b - A x` at the rows that are not empty: `at(row, r)`.
    pub(super) fn for_residuals(&self, b: &[f64], x: &[f64], mut at: impl FnMut(usize, f64)) {
        for i in (0..self.rows()).filter(|&i| self.inverse[i] != 0.0) {
            at(i, b[i] - self.diagonal[i] * x[i] - self.off_diagonal_product(i, x));
        }
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
        entry(a, block, self.diagonal[block]);
        for (column, value) in self.row(block) {
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
