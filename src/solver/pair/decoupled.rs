//! The exact decoupling of (3.4): with `s = mu1 u1 + mu2 u2`, `w = u1 - u2`, `M = mu1 + mu2`, `m = mu1 mu2 / M`,
//!
//! ```text
//! K s = F_1 + F_2                                s = mu1 g on the boundary
//! m K w - y = (mu2 F_1 - mu1 F_2) / M            w = g on the boundary,   w >= 0,  y >= 0,  w'y = 0
//! ```
//!
//! one Poisson problem and one zero-obstacle problem, and back `u1 = (s + mu2 w) / M`, `u2 = (s - mu1 w) / M`.

use crate::discretization::{Displacement, PairDiscretization};
use crate::mesh::VertexKind;
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;

/// The data of the two halves on a discretization, each with the matrix `K`: the gap's divided by `m`.
pub(crate) struct Decoupled<'d> {
    d: &'d PairDiscretization,
    /// `mu1 / M`, `mu2 / M`: fractions, because products of large tensions would overflow.
    share: [f64; 2],
}

impl<'d> Decoupled<'d> {
    pub(crate) fn new(d: &'d PairDiscretization) -> Self {
        let [mu1, mu2] = d.tension();
        Self { d, share: [mu1 / (mu1 + mu2), mu2 / (mu1 + mu2)] }
    }

    /// `m`.
    pub(crate) fn gap_tension(&self) -> f64 {
        self.d.tension()[0] * self.share[1]
    }

    /// `(F_1 + F_2)_a`.
    pub(crate) fn sum_load(&self, a: usize) -> f64 {
        self.d.load()[0][a] + self.d.load()[1][a]
    }

    /// `s` at the boundary vertex `a`.
    pub(crate) fn sum_height(&self, a: usize) -> f64 {
        self.d.tension()[0] * self.d.height()[a]
    }

    /// `(mu2 F_1 - mu1 F_2)_a / (M m)`.
    pub(crate) fn gap_load(&self, a: usize) -> f64 {
        let [f1, f2] = self.d.load();
        (self.share[1] * f1[a] - self.share[0] * f2[a]) / self.gap_tension()
    }

    /// The size of the terms that cancel in [`gap_load`](Self::gap_load).
    pub(crate) fn gap_load_terms(&self, a: usize) -> f64 {
        let [f1, f2] = self.d.load();
        (self.share[1] * f1[a].abs() + self.share[0] * f2[a].abs()) / self.gap_tension()
    }

    /// `[u1, u2]` over vertices from `s` and `w` at the interior ones. `w >= 0` gives `u1 >= u2` to the last bit.
    pub(crate) fn recombine(&self, s: &[f64], w: &[f64]) -> Displacement {
        let [mu1, mu2] = self.d.tension();
        let total = mu1 + mu2;
        let kind = self.d.mesh().kind();
        let over_vertices =
            |inside: &(dyn Fn(usize) -> f64 + Sync), boundary: &(dyn Fn(usize) -> f64 + Sync)| -> Vec<f64> {
                let value = |a: usize| match kind[a] {
                    VertexKind::Interior => inside(a),
                    VertexKind::Boundary => boundary(a),
                    VertexKind::Unused => 0.0,
                };
                (0..kind.len()).into_par_iter().with_min_len(BLOCK).map(value).collect()
            };
        let u1 = over_vertices(&|a| s[a] / total + self.share[1] * w[a], &|a| self.d.height()[a]);
        let u2 = over_vertices(&|a| s[a] / total - self.share[0] * w[a], &|_| 0.0);
        [u1, u2]
    }
}
