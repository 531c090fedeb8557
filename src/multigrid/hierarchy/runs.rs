//! Runs of rows that have one stencil.
//!
//! On uniformly refined meshes most rows of a colour have the entries of the row before, with each column moved on by one. Their
//! products with a vector need no indices and one set of values: they are sums of a few slices.

use std::ops::Range;

use super::coloring::Coloring;
use super::matrix::{Pattern, Values};
use crate::parallel::prelude::*;

/// The most rows of a run: their products stay in the nearest cache, and rows that change spoil no more than these.
pub(crate) const LONGEST: usize = 32;

/// Fewer rows are worked on one by one.
const SHORTEST: usize = 8;

/// The rows of each window and colour in runs. Whether the rows of a run share a stencil is known to the [`Values`].
#[derive(Debug, Clone, Default)]
pub(crate) struct Runs {
    /// The first row of each; at the end the number of rows.
    start: Vec<u32>,
    /// The first run of each window and colour; at the end the number of runs.
    first: Vec<u32>,
    colors: usize,
}

impl Runs {
    /// Finds the runs of a matrix; and whether the rows of each share a stencil, where entries may differ by a fraction
    /// `tolerance` of the diagonal.
    pub(crate) fn new(
        coloring: &Coloring,
        pattern: &Pattern,
        values: &Values,
        tolerance: f64,
    ) -> (Self, Vec<bool>) {
        let colors = coloring.colors();
        let of_color =
            |at: usize| runs(coloring.rows(at / colors, at % colors), (pattern, values), tolerance);
        let by_color: Vec<Vec<(u32, bool)>> =
            (0..coloring.windows() * colors).into_par_iter().map(of_color).collect();
        let count = by_color.iter().map(Vec::len).sum();
        let (mut start, mut shared) = (Vec::with_capacity(count + 1), Vec::with_capacity(count));
        let mut first = vec![0];
        for (row, one_stencil) in by_color.iter().flatten().copied() {
            start.push(row);
            shared.push(one_stencil);
        }
        let mut runs = 0;
        for of_color in &by_color {
            runs += of_color.len() as u32;
            first.push(runs);
        }
        start.push(pattern.rows() as u32);
        (Self { start, first, colors }, shared)
    }

    /// The runs of a colour in a window.
    #[inline(always)]
    pub(crate) fn of(&self, window: usize, color: usize) -> Range<usize> {
        let at = window * self.colors + color;
        self.first[at] as usize..self.first[at + 1] as usize
    }

    /// The rows of a run.
    #[inline(always)]
    pub(crate) fn rows(&self, run: usize) -> Range<usize> {
        self.start[run] as usize..self.start[run + 1] as usize
    }

    /// The run of a row.
    pub(crate) fn with_row(&self, i: usize) -> usize {
        self.start.partition_point(|&start| start as usize <= i) - 1
    }
}

/// Cuts rows into runs: where each starts, and whether its rows share a stencil.
fn runs(rows: Range<usize>, matrix: (&Pattern, &Values), tolerance: f64) -> Vec<(u32, bool)> {
    let mut runs: Vec<(u32, bool)> = Vec::new();
    let mut from = rows.start;
    while from < rows.end {
        let longest = rows.end.min(from + LONGEST);
        let to = (from + 1..longest).find(|&i| !has_stencil(i, from, matrix, tolerance)).unwrap_or(longest);
        if to - from >= SHORTEST {
            runs.push((from as u32, true));
        } else {
            // Few rows join those before them.
            match runs.last() {
                Some(&(start, false)) if to - start as usize <= LONGEST => {}
                _ => runs.push((from as u32, false)),
            }
        }
        from = to;
    }
    runs
}

/// Whether the row `i` has the entries of the row `first`, each as many columns further on as it is itself.
fn has_stencil(i: usize, first: usize, (pattern, values): (&Pattern, &Values), tolerance: f64) -> bool {
    let [columns, shifted] = [first, i].map(|i| pattern.row(i));
    let [entries, others] = [first, i].map(|i| &values.off_diagonal[pattern.range(i)]);
    let diagonal = values.diagonal[first];
    let same = |a: f64, b: f64| (a - b).abs() <= tolerance * diagonal;
    columns.len() == shifted.len()
        && same(diagonal, values.diagonal[i])
        && columns.iter().zip(shifted).all(|(j, k)| *k as usize == *j as usize + (i - first))
        && entries.iter().zip(others).all(|(&a, &b)| same(a, b))
}

impl Values {
    /// [`off_diagonal_product`](Self::off_diagonal_product) of the rows of a run.
    #[inline(always)]
    pub(crate) fn off_diagonal_products<'p>(
        &self,
        (pattern, runs): (&Pattern, &Runs),
        run: usize,
        x: &[f64],
        products: &'p mut [f64; LONGEST],
    ) -> &'p [f64] {
        let rows = runs.rows(run);
        let products = &mut products[..rows.len()];
        if self.shared[run] {
            self.stencil_products(pattern, rows.start, x, products);
        } else {
            for (product, i) in products.iter_mut().zip(rows) {
                *product = self.off_diagonal_product(pattern, i, x);
            }
        }
        products
    }
}
