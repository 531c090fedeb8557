//! Sweeps over all membranes of a level, colour by colour.

use super::chain::Pool;
use super::level::StackLevel;
use super::partition::Partition;
use crate::parallel::prelude::*;
use crate::parallel::sums;

/// Rows whose sweeps are worth a thread of their own.
pub(super) const CHUNK: usize = 4096;

/// Sweeps over one level: its windows in groups, one for a thread at a time.
///
/// Rows of a colour are not coupled, so the new values of all are found from the old ones, all at once, and then take their place.
pub(super) struct Sweeps<'l> {
    level: &'l StackLevel,
    /// The windows of each group, and its rows.
    groups: Vec<Group>,
    next: Vec<f64>,
}

struct Group {
    windows: std::ops::Range<usize>,
    rows: std::ops::Range<usize>,
}

impl<'l> Sweeps<'l> {
    pub(super) fn new(level: &'l StackLevel) -> Self {
        let coloring = &level.coloring;
        let mut groups: Vec<Group> = Vec::new();
        for window in 0..coloring.windows() {
            let rows = coloring.window(window);
            match groups.last_mut() {
                Some(last) if last.rows.len() < CHUNK => {
                    last.windows.end = window + 1;
                    last.rows.end = rows.end;
                }
                _ => groups.push(Group { windows: window..window + 1, rows }),
            }
        }
        Self { level, groups, next: vec![0.0; level.rows() * level.membranes()] }
    }

    /// The values of each row become `solve(row, products, values)`, from the products with the entries off the diagonal.
    pub(super) fn sweep(
        &mut self,
        x: &mut [f64],
        backwards: bool,
        solve: impl Fn(usize, &[f64], &mut [f64], &mut Pool) + Sync,
    ) {
        let Self { level, groups, next } = self;
        let n = level.membranes();
        let colors = level.coloring.colors();
        for step in 0..colors {
            let color = if backwards { colors - 1 - step } else { step };
            let x_now = &*x;
            let of_group = |(group, next): (&Group, &mut [f64])| {
                let (mut pool, mut products) = (Pool::new(n), vec![0.0; n]);
                for a in group.windows.clone().flat_map(|window| level.coloring.rows(window, color)) {
                    level.matrix.off_diagonal_products(a, x_now, &mut products);
                    let at = (a - group.rows.start) * n;
                    solve(a, &products, &mut next[at..at + n], &mut pool);
                }
            };
            cut(next, groups, n).into_par_iter().for_each(of_group);
            let next = &*next;
            let take = |(group, x): (&Group, &mut [f64])| {
                for rows in group.windows.clone().map(|window| level.coloring.rows(window, color)) {
                    let of_group = (rows.start - group.rows.start) * n..(rows.end - group.rows.start) * n;
                    x[of_group].copy_from_slice(&next[rows.start * n..rows.end * n]);
                }
            };
            cut(x, groups, n).into_par_iter().for_each(take);
        }
    }

    /// Projected Gauss-Seidel: the displacements of each row become those of least energy.
    pub(super) fn relax(&mut self, x: &mut [f64], backwards: bool) {
        let level = self.level;
        self.sweep(x, backwards, |a, products, z, pool| {
            let entries = level.entries(a);
            let (b, d) = (&level.load[entries.clone()], &level.matrix.diagonal[entries]);
            for (((z, b), d), product) in z.iter_mut().zip(b).zip(d).zip(products) {
                *z = (b - product) / d;
            }
            level.project(a, z, pool);
        });
    }

    /// Gauss-Seidel for `K c = r`, as far as the blocks move.
    pub(super) fn relax_blocks(&mut self, c: &mut [f64], r: &[f64], partition: &Partition, backwards: bool) {
        let level = self.level;
        self.sweep(c, backwards, |a, products, c, _| {
            let entries = level.entries(a);
            let (r, d) = (&r[entries.clone()], &level.matrix.diagonal[entries]);
            let lens = partition.lens(a);
            let mut i = 0;
            while i < c.len() {
                match lens[i] as usize {
                    0 => {
                        c[i] = 0.0;
                        i += 1;
                    }
                    1 => {
                        c[i] = (r[i] - products[i]) / d[i];
                        i += 1;
                    }
                    len => {
                        let members = i..i + len;
                        let force: f64 = members.clone().map(|i| r[i] - products[i]).sum();
                        let stiffness: f64 = d[members.clone()].iter().sum();
                        c[members].fill(force / stiffness);
                        i += len;
                    }
                }
            }
        });
    }

    /// `K x`.
    pub(super) fn multiply(&self, x: &[f64], product: &mut [f64]) {
        let level = self.level;
        let n = level.membranes();
        let parts = product.par_chunks_mut(CHUNK * n).enumerate();
        parts.for_each(|(k, product)| {
            for (a, product) in (k * CHUNK..).zip(product.chunks_exact_mut(n)) {
                level.matrix.off_diagonal_products(a, x, product);
                let entries = level.entries(a);
                let (x, d) = (&x[entries.clone()], &level.matrix.diagonal[entries]);
                product.iter_mut().zip(x).zip(d).for_each(|((product, x), d)| *product += d * x);
            }
        });
    }

    /// How much of a step `d` lowers the energy most, all of it at most, where the residual is `r`; `K d` is left in `product`.
    pub(super) fn best_step(&self, d: &[f64], r: &[f64], product: &mut [f64]) -> f64 {
        self.multiply(d, product);
        let [slope, curvature] = sums(d.len(), |i| [r[i] * d[i], product[i] * d[i]]);
        if curvature > 0.0 { (slope / curvature).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// The residual `r = b - K x`; each of the `chunks` of [`CHUNK`] rows is shown those of its rows, as `at(chunk, row, x, r)`.
    pub(super) fn residuals<T: Send>(
        &self,
        x: &[f64],
        b: &[f64],
        r: &mut [f64],
        mut chunks: Vec<T>,
        at: impl Fn(&mut T, usize, &[f64], &[f64]) + Sync,
    ) -> Vec<T> {
        let level = self.level;
        let n = level.membranes();
        let parts: Vec<(usize, (&mut [f64], &mut T))> =
            r.chunks_mut(CHUNK * n).zip(chunks.iter_mut()).enumerate().collect();
        parts.into_par_iter().for_each(|(k, (r, found))| {
            for (a, r) in (k * CHUNK..).zip(r.chunks_exact_mut(n)) {
                level.matrix.off_diagonal_products(a, x, r);
                let entries = level.entries(a);
                let (x, b, d) = (&x[entries.clone()], &b[entries.clone()], &level.matrix.diagonal[entries]);
                for (((r, x), b), d) in r.iter_mut().zip(x).zip(b).zip(d) {
                    *r = if *d == 0.0 { 0.0 } else { b - d * x - *r };
                }
                at(found, a, x, r);
            }
        });
        chunks
    }
}

/// What the groups have of a vector over entries.
fn cut<'a>(mut vector: &'a mut [f64], groups: &'a [Group], n: usize) -> Vec<(&'a Group, &'a mut [f64])> {
    let part = |group: &'a Group| {
        let own = vector.split_off_mut(..group.rows.len() * n).expect("groups are parts of the whole");
        (group, own)
    };
    groups.iter().map(part).collect()
}
