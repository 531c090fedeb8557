//! The problem of a stack on one level of the hierarchy.

use super::chain::Pool;
use super::matrix::BlockMatrix;
use crate::multigrid::hierarchy::Coloring;

/// Minimise `sum_i 1/2 x_i'K_i x_i - b_i'x_i` over displacements in their order, between a floor and a ceiling.
///
/// Vectors over entries have `a N + i` for membrane `i` (from 0) at row `a`; `x` is zero where a membrane is held, at a height that is
/// in `b`.
pub(super) struct StackLevel {
    pub(super) matrix: BlockMatrix,
    pub(super) coloring: Coloring,
    pub(super) load: Vec<f64>,
    /// Of entries.
    pub(super) held: Vec<bool>,
    /// Where they are; zero elsewhere.
    pub(super) height: Vec<f64>,
    /// Floor and ceiling over rows, infinite where there is none.
    pub(super) lower: Vec<f64>,
    pub(super) upper: Vec<f64>,
    /// Which membranes are free at each row.
    pub(super) free: Vec<Free>,
}

/// Which membranes are free at a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Free {
    None,
    Some,
    All,
}

impl StackLevel {
    pub(super) fn membranes(&self) -> usize {
        self.matrix.membranes()
    }

    pub(super) fn rows(&self) -> usize {
        self.matrix.rows()
    }

    /// The entries of row `a`.
    #[inline(always)]
    pub(super) fn entries(&self, a: usize) -> std::ops::Range<usize> {
        let n = self.membranes();
        a * n..(a + 1) * n
    }

    /// The chains of free membranes at row `a`, from `start` to `end`, and what bounds them from below and above: held membranes cut
    /// them.
    #[inline(always)]
    pub(super) fn for_chains(&self, a: usize, mut chain: impl FnMut(usize, usize, [f64; 2])) {
        let n = self.membranes();
        match self.free[a] {
            Free::None => {}
            Free::All => chain(0, n, [self.lower[a], self.upper[a]]),
            Free::Some => {
                let held = |i: usize| self.held[a * n + i];
                let mut start = 0;
                let mut upper = self.upper[a];
                while start < n {
                    if held(start) {
                        upper = self.height[a * n + start];
                        start += 1;
                        continue;
                    }
                    let end = (start..n).find(|&i| held(i)).unwrap_or(n);
                    let lower = if end < n { self.height[a * n + end] } else { self.lower[a] };
                    chain(start, end, [lower, upper]);
                    start = end;
                }
            }
        }
    }

    /// The nearest displacements in their cone at row `a`, in the energy of the diagonals; zero where membranes are held.
    #[inline(always)]
    pub(super) fn project(&self, a: usize, z: &mut [f64], pool: &mut Pool) {
        let d = &self.matrix.diagonal[self.entries(a)];
        if self.free[a] != Free::All {
            for (z, &held) in z.iter_mut().zip(&self.held[self.entries(a)]) {
                *z = if held { 0.0 } else { *z };
            }
        }
        self.for_chains(a, |start, end, bounds| {
            pool.project(&mut z[start..end], &d[start..end], bounds);
        });
    }
}
