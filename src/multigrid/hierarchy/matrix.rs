//! Symmetric matrices in compact rows.

use super::ordering::inverse;
use crate::fem::{StiffnessMatrix, row_of};
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;

/// Where the off-diagonal entries of a matrix stand: compressed rows with 32-bit indices.
#[derive(Debug, Clone, Default)]
pub(crate) struct Pattern {
    start: Vec<u32>,
    column: Vec<u32>,
}

/// The entries of a matrix: of the diagonal, and off it in the order of the pattern.
#[derive(Debug, Clone, Default)]
pub(crate) struct Values {
    pub(crate) off_diagonal: Vec<f64>,
    pub(crate) diagonal: Vec<f64>,
    /// The reciprocals of the diagonal; zero for the empty rows of vertices that are held.
    pub(crate) inverse: Vec<f64>,
    /// Whether the rows of each run share a stencil.
    pub(crate) shared: Vec<bool>,
    /// Whether rows of each run have been replaced: they may be coupled to others of their colour.
    pub(crate) replaced: Vec<bool>,
}

/// Consecutive rows of a matrix.
#[derive(Debug)]
pub(crate) struct Rows {
    /// Where each row ends among the entries.
    pub(crate) ends: Vec<usize>,
    pub(crate) column: Vec<u32>,
    pub(crate) off_diagonal: Vec<f64>,
    pub(crate) diagonal: Vec<f64>,
}

impl Pattern {
    /// The entries of row `i`, as a range.
    #[inline(always)]
    pub(crate) fn range(&self, i: usize) -> std::ops::Range<usize> {
        self.start[i] as usize..self.start[i + 1] as usize
    }

    /// The columns of row `i`.
    #[inline(always)]
    pub(crate) fn row(&self, i: usize) -> &[u32] {
        &self.column[self.range(i)]
    }

    pub(crate) fn rows(&self) -> usize {
        self.start.len() - 1
    }

    /// The largest distance of a row and a column.
    pub(crate) fn bandwidth(&self) -> usize {
        let reach = |i: usize| self.row(i).iter().map(|&j| i.abs_diff(j as usize)).max().unwrap_or(0);
        (0..self.rows()).into_par_iter().with_min_len(BLOCK).map(reach).max().unwrap_or(0)
    }
}

/// `sum_j a_j x_j` over the columns of a row.
#[inline(always)]
pub(crate) fn row_product(mut columns: &[u32], mut values: &[f64], x: &[f64]) -> f64 {
    let mut sum = 0.0;
    // Four at once: most rows have four or six entries, and a loop costs more than they do.
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

impl Values {
    /// `sum_j a_ij x_j` over the columns off the diagonal.
    #[inline(always)]
    pub(crate) fn off_diagonal_product(&self, pattern: &Pattern, i: usize, x: &[f64]) -> f64 {
        let range = pattern.range(i);
        row_product(&pattern.column[range.clone()], &self.off_diagonal[range], x)
    }

    /// For rows that have the entries of the `first` one, each in the next column.
    #[inline(always)]
    pub(super) fn stencil_products(&self, pattern: &Pattern, first: usize, x: &[f64], products: &mut [f64]) {
        let range = pattern.range(first);
        let (mut columns, mut values) = (&pattern.column[range.clone()], &self.off_diagonal[range]);
        let rows = products.len();
        let x = |j: &u32| &x[*j as usize..][..rows];
        products.fill(0.0);
        while let (Some(([j, k, l, m], columns_left)), Some(([a, b, c, d], values_left))) =
            (columns.split_first_chunk::<4>(), values.split_first_chunk::<4>())
        {
            let (p, q, r, s) = (x(j), x(k), x(l), x(m));
            for (i, sum) in products.iter_mut().enumerate() {
                *sum += (a * p[i] + b * q[i]) + (c * r[i] + d * s[i]);
            }
            (columns, values) = (columns_left, values_left);
        }
        for (j, a) in columns.iter().zip(values) {
            for (sum, x) in products.iter_mut().zip(x(j)) {
                *sum += a * x;
            }
        }
    }

    /// Rows of a run are replaced: they have no common stencil any more, and may be coupled to others of their colour.
    pub(crate) fn part(&mut self, run: usize) {
        self.shared[run] = false;
        self.replaced[run] = true;
    }

    /// Whether a row of a run may be coupled to others of its colour.
    #[inline(always)]
    pub(crate) fn is_replaced(&self, run: usize) -> bool {
        self.replaced[run]
    }

    /// Replaces the entries of the row `i`, whose columns stay.
    pub(crate) fn set_row(&mut self, pattern: &Pattern, i: usize, mut entry: impl FnMut(usize) -> f64) {
        for (&j, value) in pattern.row(i).iter().zip(&mut self.off_diagonal[pattern.range(i)]) {
            *value = entry(j as usize);
        }
        self.diagonal[i] = entry(i);
        self.inverse[i] = reciprocal(self.diagonal[i]);
    }
}

impl Rows {
    /// Room for so many rows of a triangulation, whose vertices have six neighbours on average.
    pub(crate) fn with_capacity(rows: usize) -> Self {
        Self {
            ends: Vec::with_capacity(rows),
            column: Vec::with_capacity(6 * rows),
            off_diagonal: Vec::with_capacity(6 * rows),
            diagonal: Vec::with_capacity(rows),
        }
    }
}

/// Puts blocks of consecutive rows together, all of them at once.
pub(crate) fn assemble(blocks: Vec<Rows>) -> (Pattern, Values) {
    let count = |of: fn(&Rows) -> usize| blocks.iter().map(of).sum::<usize>();
    let (rows, entries) = (count(|block| block.ends.len()), count(|block| block.column.len()));
    let mut pattern = Pattern { start: vec![0; rows + 1], column: vec![0; entries] };
    let mut values = Values {
        off_diagonal: vec![0.0; entries],
        diagonal: vec![0.0; rows],
        inverse: vec![0.0; rows],
        shared: Vec::new(),
        replaced: Vec::new(),
    };
    let (mut start, mut column) = (&mut pattern.start[1..], &mut pattern.column[..]);
    let mut off_diagonal = &mut values.off_diagonal[..];
    let (mut diagonal, mut inverse) = (&mut values.diagonal[..], &mut values.inverse[..]);
    let mut offset = 0;
    crate::parallel::scope(|scope| {
        for block in blocks {
            let (rows, entries) = (block.ends.len(), block.column.len());
            let start = split_off(&mut start, rows);
            let column = split_off(&mut column, entries);
            let off_diagonal = split_off(&mut off_diagonal, entries);
            let diagonal = split_off(&mut diagonal, rows);
            let inverse = split_off(&mut inverse, rows);
            scope.spawn(move |_| {
                start.iter_mut().zip(&block.ends).for_each(|(start, end)| *start = (offset + end) as u32);
                column.copy_from_slice(&block.column);
                off_diagonal.copy_from_slice(&block.off_diagonal);
                diagonal.copy_from_slice(&block.diagonal);
                inverse.iter_mut().zip(&block.diagonal).for_each(|(inverse, &a)| *inverse = reciprocal(a));
            });
            offset += entries;
        }
    });
    (pattern, values)
}

/// The first elements of a slice, which keeps the others.
fn split_off<'a, T>(slice: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    slice.split_off_mut(..count).expect("blocks are parts of the whole")
}

fn reciprocal(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.recip() }
}

/// The rows and columns of a matrix in another order: row `order[i]` becomes row `i`, column `j` becomes `position[j]`.
pub(crate) fn reordered(
    (pattern, values): (&Pattern, &Values),
    order: &[u32],
    position: &[u32],
) -> (Pattern, Values) {
    let block = |block: &[u32]| {
        let mut rows = Rows::with_capacity(BLOCK);
        for &old in block {
            let range = pattern.range(old as usize);
            rows.column.extend(pattern.column[range.clone()].iter().map(|&j| position[j as usize]));
            rows.off_diagonal.extend_from_slice(&values.off_diagonal[range]);
            rows.diagonal.push(values.diagonal[old as usize]);
            rows.ends.push(rows.column.len());
        }
        rows
    };
    assemble(order.par_chunks(BLOCK).map(block).collect())
}

/// `K` with empty rows for vertices that are not `free`, the vertices in this order.
pub(crate) fn compact_stiffness(k: &StiffnessMatrix, free: &[bool], order: &[u32]) -> (Pattern, Values) {
    let position = inverse(order);
    let block = |block: &[u32]| {
        let mut rows = Rows::with_capacity(BLOCK);
        for &a in block {
            let a = a as usize;
            let mut diagonal = 0.0;
            if free[a] {
                for (b, value) in row_of(k, a) {
                    if b == a {
                        diagonal = value;
                    } else {
                        rows.column.push(position[b]);
                        rows.off_diagonal.push(value);
                    }
                }
            }
            rows.diagonal.push(diagonal);
            rows.ends.push(rows.column.len());
        }
        rows
    };
    assemble(order.par_chunks(BLOCK).map(block).collect())
}
