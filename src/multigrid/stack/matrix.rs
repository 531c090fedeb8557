//! The stiffness matrices of all membranes on one level, together.

use crate::multigrid::hierarchy::{Pattern, Values};

/// `K_1, .., K_N`. A vector over them has the entry `a N + i` for membrane `i` (from 0) at row `a`.
pub(super) struct BlockMatrix {
    membranes: usize,
    pattern: Pattern,
    off_diagonal: OffDiagonal,
    /// Zero where no membrane is free.
    pub(super) diagonal: Vec<f64>,
}

/// The entries off the diagonal.
enum OffDiagonal {
    /// Those of one matrix, in the order of the pattern, which all membranes have up to a factor.
    Proportional(Vec<f64>, Vec<f64>),
    /// Those of all membranes, side by side.
    Own(Vec<f64>),
}

impl BlockMatrix {
    /// From the matrices of the `profiles`, on one pattern: membrane `i` has the product of a factor and a profile, and further
    /// entries on the diagonal.
    pub(super) fn new(
        pattern: Pattern,
        profiles: &[Values],
        membranes: &[(f64, usize)],
        on_diagonal: &[f64],
    ) -> Self {
        let n = membranes.len();
        let entries = profiles[0].off_diagonal.len();
        let off_diagonal = match profiles {
            [one] => {
                let factors = membranes.iter().map(|&(factor, _)| factor).collect();
                OffDiagonal::Proportional(one.off_diagonal.clone(), factors)
            }
            _ => {
                let of = |at: usize| {
                    membranes
                        .iter()
                        .map(move |&(factor, profile)| factor * profiles[profile].off_diagonal[at])
                };
                OffDiagonal::Own((0..entries).flat_map(of).collect())
            }
        };
        let of_row = |a: usize| {
            let entry = move |i: usize, (factor, profile): (f64, usize)| match profiles[profile].diagonal[a] {
                0.0 => 0.0,
                k => factor * k + on_diagonal[a * n + i],
            };
            membranes.iter().enumerate().map(move |(i, &membrane)| entry(i, membrane))
        };
        let diagonal = (0..pattern.rows()).flat_map(of_row).collect();
        Self { membranes: n, pattern, off_diagonal, diagonal }
    }

    pub(super) fn membranes(&self) -> usize {
        self.membranes
    }

    pub(super) fn rows(&self) -> usize {
        self.pattern.rows()
    }

    /// The rows that row `a` is coupled to.
    pub(super) fn neighbours(&self, a: usize) -> &[u32] {
        self.pattern.row(a)
    }

    /// The entry number `k` of row `a` for membrane `i`.
    #[inline(always)]
    pub(super) fn entry(&self, a: usize, k: usize, i: usize) -> f64 {
        let at = self.pattern.range(a).start + k;
        match &self.off_diagonal {
            OffDiagonal::Proportional(values, factors) => factors[i] * values[at],
            OffDiagonal::Own(values) => values[at * self.membranes + i],
        }
    }

    /// `sum_b (K_i)_ab x_i(b)` over the columns off the diagonal, for all membranes.
    #[inline(always)]
    pub(super) fn off_diagonal_products(&self, a: usize, x: &[f64], products: &mut [f64]) {
        let n = products.len();
        let range = self.pattern.range(a);
        let columns = self.pattern.row(a);
        products.fill(0.0);
        match &self.off_diagonal {
            OffDiagonal::Proportional(values, factors) => {
                for (&b, &k) in columns.iter().zip(&values[range]) {
                    let x = &x[b as usize * n..][..n];
                    products.iter_mut().zip(x).for_each(|(sum, x)| *sum += k * x);
                }
                products.iter_mut().zip(factors).for_each(|(sum, factor)| *sum *= factor);
            }
            OffDiagonal::Own(values) => {
                let values = values[range.start * n..range.end * n].chunks_exact(n);
                for (&b, k) in columns.iter().zip(values) {
                    let x = &x[b as usize * n..][..n];
                    products.iter_mut().zip(k).zip(x).for_each(|((sum, k), x)| *sum += k * x);
                }
            }
        }
    }
}
