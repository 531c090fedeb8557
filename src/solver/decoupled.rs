//! The exact decoupling of (3.4): with `s = mu1 u1 + mu2 u2`, `w = u1 - u2`, `M = mu1 + mu2`, `m = mu1 mu2 / M`,
//!
//! ```text
//! K s = F_1 + F_2                                s = mu1 g on the boundary
//! m K w - y = (mu2 F_1 - mu1 F_2) / M            w = g on the boundary,   w >= 0,  y >= 0,  w'y = 0
//! ```
//!
//! one Poisson problem and one zero-obstacle problem, and back `u1 = (s + mu2 w) / M`, `u2 = (s - mu1 w) / M`.

use super::cholesky::{Cholesky, NotFactored};
use crate::discretization::{Discretization, principal_submatrix};

/// The two halves of the problem on a discretization.
pub(crate) struct Decoupled<'d, 'm> {
    d: &'d Discretization<'m>,
    /// `m`.
    gap_tension: f64,
    /// `(mu2 F_1 - mu1 F_2) / M` over vertices.
    gap_load: Vec<f64>,
}

/// A gap and its multiplier over unknowns.
pub(crate) struct Gap {
    pub(crate) w: Vec<f64>,
    pub(crate) y: Vec<f64>,
    /// The size of the terms that cancel in `y`, for judging its rounding.
    pub(crate) y_terms: Vec<f64>,
}

impl<'d, 'm> Decoupled<'d, 'm> {
    pub(crate) fn new(d: &'d Discretization<'m>) -> Self {
        let [mu1, mu2] = d.tension();
        let total = mu1 + mu2;
        let [f1, f2] = d.load();
        // Fractions of the tensions first: the products of large tensions would overflow.
        let gap_load = f1.iter().zip(f2).map(|(f1, f2)| mu2 / total * f1 - mu1 / total * f2).collect();
        Self { d, gap_tension: mu1 * (mu2 / total), gap_load }
    }

    /// The Poisson half: `s` over unknowns.
    pub(crate) fn solve_sum(&self) -> Result<Vec<f64>, NotFactored> {
        let d = self.d;
        let boundary = |b: usize| d.tension()[0] * d.height()[b];
        let right_side: Vec<f64> = d
            .interior()
            .iter()
            .map(|&a| d.load()[0][a] + d.load()[1][a] - d.stiffness_row(a, boundary))
            .collect();
        Cholesky::new(d.interior_stiffness())?.solve(&right_side)
    }

    /// The obstacle half with the contact set given: `w = 0` where `active`, `y = 0` elsewhere.
    pub(crate) fn solve_gap(&self, active: &[bool]) -> Result<Gap, NotFactored> {
        let d = self.d;
        let free: Vec<usize> = (0..active.len()).filter(|&k| !active[k]).collect();
        let matrix = principal_submatrix(d.interior_stiffness(), &free);
        // m K_NN w_N = f_N - m K_NB g, divided by m
        let right_side: Vec<f64> = free
            .iter()
            .map(|&k| d.interior()[k])
            .map(|a| self.gap_load[a] / self.gap_tension - d.stiffness_row(a, |b| d.height()[b]))
            .collect();
        let mut w = vec![0.0; active.len()];
        for (&k, value) in free.iter().zip(Cholesky::new(&matrix)?.solve(&right_side)?) {
            w[k] = value;
        }
        let on_vertices = d.extend(&w, |a| d.height()[a]);
        let residual = |k: usize| {
            let a = d.interior()[k];
            self.gap_tension * d.stiffness_row(a, |b| on_vertices[b]) - self.gap_load[a]
        };
        let terms = |k: usize| {
            let a = d.interior()[k];
            let row = d.stiffness().outer_view(a).expect("a vertex has a row");
            let size: f64 = row.iter().map(|(b, k)| (k * on_vertices[b]).abs()).sum();
            let [mu1, mu2] = d.tension();
            let load = mu2 / (mu1 + mu2) * d.load()[0][a].abs() + mu1 / (mu1 + mu2) * d.load()[1][a].abs();
            self.gap_tension * size + load
        };
        let y = (0..active.len()).map(|k| if active[k] { residual(k) } else { 0.0 }).collect();
        let y_terms = (0..active.len()).map(|k| if active[k] { terms(k) } else { 0.0 }).collect();
        Ok(Gap { w, y, y_terms })
    }

    /// `[u1, u2]` over vertices from `s` and `w` over unknowns. `w >= 0` gives `u1 >= u2` to the last bit.
    pub(crate) fn recombine(&self, s: &[f64], w: &[f64]) -> [Vec<f64>; 2] {
        let d = self.d;
        let [mu1, mu2] = d.tension();
        let total = mu1 + mu2;
        let u1: Vec<f64> = s.iter().zip(w).map(|(s, w)| s / total + mu2 / total * w).collect();
        let u2: Vec<f64> = s.iter().zip(w).map(|(s, w)| s / total - mu1 / total * w).collect();
        [d.extend(&u1, |a| d.height()[a]), d.extend(&u2, |_| 0.0)]
    }
}
