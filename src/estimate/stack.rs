//! A bound of the energy error of a stack, guaranteed up to the quadrature of its data.
//!
//! Let `lt_k >= 0` be actions in the gaps, with densities along lines where the discrete action has some; let `sigma_i` be fluxes that
//! balance them with the loads, and `ut` a stack in the cone. On a triangle `K`, with `r_i = f_i + lt_i - lt_(i-1) - c_i u_i - div
//! sigma_i`, which has the mean zero there,
//!
//! ```text
//! |||u - ut||| <= (eta + alpha) / 2 + ((eta + alpha)^2 / 4 + C)^(1/2)
//!
//! eta^2 = sum_i sum_K ( || mu_i^(1/2) grad ut_i + mu_i^(-1/2) sigma_i ||_K + m_K || r_i ||_K + || c_i^(1/2) (ut_i - u_ih) ||_K )^2
//! m_K = min( h_K / (pi mu_i^(1/2)), c_i^(-1/2) )          C = sum_k (lt_k, wt_k)
//! ```
//!
//! and `alpha` for what the solver has left, carried to where the membrane is held by fluxes along the triangles ([`rest`]). `ut` is
//! `u_h` but where an obstacle lies between it and the vertices: there it is the obstacle, and `|||ut - u_h|||` is added.
//!
//! Data that vary inside a triangle are known at its corners, the midpoints of its edges and its barycentre, and are affine between
//! these points: obstacles, and the inverse of a tension. The domain is the polygon that the mesh covers, and heights are those of the
//! vertices, affine between them.

mod actions;
mod cells;
mod error;
mod rest;
#[cfg(test)]
mod tests;

use super::{BoundParts, DataWarning, ErrorBound};
use crate::action::StackSolution;
use crate::discretization::{IntegrationRule, StackDiscretization};
use actions::Actions;
use cells::{Cells, Sums};
pub use error::NoBound;

impl ErrorBound {
    /// Bounds the error of a certified solution of a stack, `(sum_i ||mu_i^(1/2) grad (u_i - u_ih)||^2 + ||c_i^(1/2) (u_i -
    /// u_ih)||^2)^(1/2)`. Linear time.
    ///
    /// # Errors
    /// [`NoBound`].
    pub fn of_stack(d: &StackDiscretization, solution: &StackSolution) -> Result<Self, NoBound> {
        let displacement = solution.displacement();
        let fits = |u: &Vec<f64>| u.len() == d.mesh().points().len();
        if displacement.len() != d.membranes() || !displacement.iter().all(fits) {
            return Err(NoBound::OtherMesh);
        }
        if d.rule() != IntegrationRule::Quadrature {
            return Err(NoBound::VertexRule);
        }
        if !d.is_held() {
            return Err(NoBound::Pressed);
        }
        if let Some(membrane) = (1..=d.membranes()).find(|&i| !d.has_even_foundation(i)) {
            return Err(NoBound::VaryingFoundation { membrane });
        }
        Self::with_actions(d, displacement, Actions::new(d, solution))
    }

    /// With any actions that are not negative: the nearer to what the displacement sees, the better.
    fn with_actions(
        d: &StackDiscretization,
        displacement: &[Vec<f64>],
        actions: Actions,
    ) -> Result<Self, NoBound> {
        let cells = Cells::new(d, displacement, &actions)?;
        let (sums, indicators) = cells.sum();
        let alpha_sq: f64 = cells
            .layers()
            .map(|(i, layer)| rest::norm_sq(d, i, &layer.least_tension, &layer.flux.rest))
            .sum();
        drop(cells);
        Ok(Self::from_stack(d, &sums, alpha_sq.sqrt(), actions, indicators))
    }

    fn from_stack(
        d: &StackDiscretization,
        sums: &Sums,
        alpha: f64,
        actions: Actions,
        indicators: Vec<f64>,
    ) -> Self {
        let half = 0.5 * (sums.eta_sq.sqrt() + alpha);
        let moved = sums.moved_sq.sqrt();
        let total = half + (half * half + sums.contact).sqrt() + moved;
        Self {
            total,
            energy_norm: sums.energy_sq.sqrt(),
            parts: BoundParts {
                flux: sums.flux_sq.sqrt(),
                oscillation: sums.oscillation_sq.sqrt(),
                contact: (2.0 * sums.contact).sqrt(),
                boundary: moved,
                algebraic: alpha,
            },
            actions: actions.gaps.into_iter().map(|gap| gap.lambda).collect(),
            indicators,
            quadrature_difference: d.quadrature_difference(),
            warnings: DataWarning::of_stack(d, total),
        }
    }
}
