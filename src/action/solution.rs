//! A certified solution.

use crate::parallel::prelude::*;

use super::sums::sums;
use super::{Action, Residuals};
use crate::discretization::Discretization;
use crate::mesh::VertexKind;
use crate::solver::Statistics;

/// Vertices that are worked on together.
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
        action: &[Action],
        residuals: Residuals,
        statistics: Statistics,
    ) -> Self {
        let lambda = nonzero_beyond_rounding(d, action);
        let contact = contact_set(d, &displacement, &lambda);
        let over_cells = |k: usize| {
            let a = d.interior()[k];
            [f64::from(contact[a]), lambda[a]].map(|value| d.dual_area()[a] * value)
        };
        let [contact_area, total_force] = sums(d.interior().len(), over_cells);
        Self {
            energy: energy(d, &displacement),
            contact_area,
            total_force,
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

fn nonzero_beyond_rounding(d: &Discretization, action: &[Action]) -> Vec<f64> {
    let cleaned = |action: &Action| {
        if action.lambda.abs() <= action.lambda_rounding { 0.0 } else { action.lambda }
    };
    d.extend(&action.iter().map(cleaned).collect::<Vec<_>>(), |_| 0.0)
}

/// A vertex is in contact when the gap is zero to rounding or, relative to the data, smaller than the action: for an
/// answer that is not polished, both may be positive.
fn contact_set(d: &Discretization, [u1, u2]: &[Vec<f64>; 2], lambda: &[f64]) -> Vec<bool> {
    let scales = d.scales();
    let touches = |a: usize| {
        let gap = (u1[a] - u2[a]) / scales.displacement;
        d.mesh().kind()[a] == VertexKind::Interior
            && (gap <= TOUCHING || gap < lambda[a] / scales.force_density)
    };
    (0..lambda.len()).into_par_iter().with_min_len(BLOCK).map(touches).collect()
}

fn energy(d: &Discretization, [u1, u2]: &[Vec<f64>; 2]) -> f64 {
    let of = |i: usize, u: &[f64], a: usize| {
        (0.5 * d.tension()[i] * d.stiffness_row(a, |b| u[b]) - d.load()[i][a]) * u[a]
    };
    let at = |a: usize| [of(0, u1, a) + of(1, u2, a)];
    let [energy] = sums(u1.len(), at);
    energy
}
