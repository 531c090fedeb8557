//! A certified solution.

use rayon::prelude::*;

use super::{Action, Residuals};
use crate::discretization::Discretization;
use crate::solver::Statistics;

/// Terms that are added up together.
const BLOCK: usize = 4096;

/// Membranes closer than this fraction of the displacements' scale touch: the rounding of the displacements.
const TOUCHING: f64 = 1e-12;

/// Displacements, action and contact set of (3.4), (4.5): made by [`certify`](super::certify) only.
///
/// Vectors are over the vertices of the mesh, in its order.
#[derive(Debug, Clone)]
pub struct ContactSolution {
    displacement: [Vec<f64>; 2],
    lambda: Vec<f64>,
    contact: Vec<bool>,
    energy: f64,
    contact_area: f64,
    total_force: f64,
    residuals: Residuals,
    statistics: Statistics,
}

impl ContactSolution {
    pub(super) fn new(
        d: &Discretization,
        displacement: [Vec<f64>; 2],
        action: &Action,
        residuals: Residuals,
        statistics: Statistics,
    ) -> Self {
        let lambda = nonzero_beyond_rounding(d, action);
        let contact = contact_set(d, &displacement, &lambda);
        let sum_cells = |value: &(dyn Fn(usize) -> f64 + Sync)| {
            sum(d.interior().len(), |k| d.dual_area()[d.interior()[k]] * value(d.interior()[k]))
        };
        Self {
            energy: energy(d, &displacement),
            contact_area: sum_cells(&|a| f64::from(contact[a])),
            total_force: sum_cells(&|a| lambda[a]),
            displacement,
            lambda,
            contact,
            residuals,
            statistics,
        }
    }

    /// `[u1, u2]`, boundary values included. Unit: length.
    pub fn displacement(&self) -> &[Vec<f64>; 2] {
        &self.displacement
    }

    /// The gap `u1 - u2`. Unit: length.
    pub fn gap(&self) -> Vec<f64> {
        let [u1, u2] = &self.displacement;
        u1.iter().zip(u2).map(|(u1, u2)| u1 - u2).collect()
    }

    /// `lambda_a`, the values of `lambda_h` on the dual cells `D_a`; zero on the boundary, where it has none. Unit: force
    /// per area. Values that are no more than the rounding of what cancels in them are zero.
    pub fn lambda(&self) -> &[f64] {
        &self.lambda
    }

    /// Whether the membranes touch at a vertex; false on the boundary, where they are held.
    pub fn contact(&self) -> &[bool] {
        &self.contact
    }

    /// The energy `J(u_h) = sum_i mu_i/2 |u_i|_1^2 - (f_i, u_i)` of (2.9).
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// The area of the dual cells of the vertices in contact.
    pub fn contact_area(&self) -> f64 {
        self.contact_area
    }

    /// `int lambda_h`, the force with which the membranes push.
    pub fn total_force(&self) -> f64 {
        self.total_force
    }

    /// The residuals that were certified.
    pub fn residuals(&self) -> &Residuals {
        &self.residuals
    }

    /// How the solution was found.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }
}

fn nonzero_beyond_rounding(d: &Discretization, action: &Action) -> Vec<f64> {
    let cleaned = |k: usize| {
        let lambda = action.lambda[k];
        if lambda.abs() <= action.lambda_rounding(d, k) { 0.0 } else { lambda }
    };
    let over_unknowns = (0..d.interior().len()).into_par_iter().with_min_len(BLOCK).map(cleaned);
    d.extend(&over_unknowns.collect::<Vec<_>>(), |_| 0.0)
}

/// A vertex is in contact when the gap is zero to rounding or, relative to the data, smaller than the action: for an
/// answer that is not polished, both may be positive.
fn contact_set(d: &Discretization, [u1, u2]: &[Vec<f64>; 2], lambda: &[f64]) -> Vec<bool> {
    let scales = d.scales();
    let mut contact = vec![false; lambda.len()];
    for &a in d.interior() {
        let gap = (u1[a] - u2[a]) / scales.displacement;
        contact[a] = gap <= TOUCHING || gap < lambda[a] / scales.force_density;
    }
    contact
}

fn energy(d: &Discretization, displacement: &[Vec<f64>; 2]) -> f64 {
    (0..2)
        .map(|i| {
            let u = &displacement[i];
            let at = |a: usize| (0.5 * d.tension()[i] * d.stiffness_row(a, |b| u[b]) - d.load()[i][a]) * u[a];
            sum(u.len(), at)
        })
        .sum()
}

/// `term(0) + ... + term(count - 1)`, in parallel, in an order that does not depend on the number of threads.
fn sum(count: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    let of_block = |block: usize| (block * BLOCK..((block + 1) * BLOCK).min(count)).map(&term).sum::<f64>();
    let blocks: Vec<f64> = (0..count.div_ceil(BLOCK)).into_par_iter().map(of_block).collect();
    // From zero: `sum` makes a negative zero of nothing.
    blocks.into_iter().fold(0.0, |sum, block| sum + block)
}
