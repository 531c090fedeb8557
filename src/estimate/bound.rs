//! A bound of the energy error, guaranteed up to the quadrature of the loads, from the full flux reconstruction.
//!
//! Let `lt >= 0` be an action and `sigma_i` fluxes in `H(div)`, their residuals `r_i = f_i - (-1)^i lt - div sigma_i` cut into
//! a part of zero mean on every triangle and a rest `rho_i`. Let `u^` be a pair in the cone that has the trace of the data. Then
//!
//! ```text
//! |||u - u_h|||^2 <= sum_i ( || a_i + b_i || + alpha_i )^2 + 2 sum_i ( (a_i, b_i) + alpha_i || b_i || ) + 2 (lt, w^)
//!
//! a_{K,i} = || mu_i^(1/2) grad u_ih + mu_i^(-1/2) sigma_i ||_K + h_K / (pi mu_i^(1/2)) || r_i - rho_i ||_K
//! b_{K,i} = mu_i^(1/2) |u^_i - u_ih|_{H1(K)}         alpha_i = C_F mu_i^(-1/2) || rho_i ||
//! ```
//!
//! with the norms of sequences over triangles, the constant of Poincare on convex triangles `h_K / pi` (Payne, Weinberger) and
//! that of Friedrichs on a rectangle `a x b` around the domain, `C_F = 1 / (pi (1/a^2 + 1/b^2)^(1/2))`; the proof is in
//! `docs/theory.md`. Nothing in it is unknown.
//!
//! `u^` differs from `u_h` by `w -> max(w, 0)` at the vertices, for a pair of a solver that is not in the cone, and by a lift of
//! `g - g_h` in the triangles at the boundary.

mod cells;
mod trace;
mod warning;

use std::sync::OnceLock;

use cells::{Cells, Sums};
use trace::Trace;
pub use warning::DataWarning;

use super::MeasureError;
use crate::action::{Action, PairSolution, extend_to_boundary};
use crate::discretization::{Displacement, PairDiscretization};
use crate::flux::WedgeFluxes;
use crate::geometry::friedrichs;
use crate::parallel::sums;
use crate::problem::{ContactProblem, Domain};

/// A bound of the energy error `|||u - u_h||| = (sum_i mu_i |u_i - u_ih|_{H1}^2)^(1/2)`.
///
/// It is guaranteed up to the quadrature of the loads and of the height: loads that are polynomials of degree 3 are integrated exactly, and of
/// others the residual is known as well as the quadrature knows them. How well that is, a second rule says at other points
/// ([`ErrorBound::warnings`]); what both do not meet, nobody sees.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorBound {
    /// The bound. Unit: square root of an energy.
    pub total: f64,
    /// `|||u_h|||`.
    pub energy_norm: f64,
    /// Where it comes from.
    pub parts: BoundParts,
    /// The actions `lt` of the bound, one for each gap from the top, on the dual cells: `lambda_h` where the layers touch, less what acts
    /// along lines; and on the cells where both are held, where `lambda_h` is zero, that of the neighbours if they touch all around: for
    /// a pair, `total_force_extended` is its integral. Shape: `gaps x vertices`; unit: force per area.
    pub actions: Vec<Vec<f64>>,
    /// The squared indicators `sum_i (a_{K,i} + b_{K,i})^2 + 2 a_{K,i} b_{K,i} + 2 (lt, w^)_K`: with `alpha_i = 0`, their sum is the
    /// square of the bound. Shape: `triangles`.
    pub indicators: Vec<f64>,
    /// By how much the bound would grow at most, about, by what a second quadrature rule finds of each load; see
    /// [`PairDiscretization::quadrature_difference`]. Unit: square root of an energy.
    pub quadrature_difference: Vec<f64>,
    /// The loads of which the quadrature may know too little for the bound to hold.
    pub warnings: Vec<DataWarning>,
}

/// What a bound consists of, each part as a norm of its own; the bound is at most the sum of the parts, with `boundary` and
/// `algebraic` counted twice.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct BoundParts {
    /// The distance of the reconstructed fluxes from `-mu_i grad u_ih`: the discretisation error.
    pub flux: f64,
    /// What the mesh does not resolve of the loads.
    pub oscillation: f64,
    /// `(2 (lambda_h, w_h))^(1/2)` from triangles that are partly in contact.
    pub contact: f64,
    /// From `g - g_h`, and from what lies between a circle and the polygon of the mesh; of a stack, from obstacles between the
    /// vertices.
    pub boundary: f64,
    /// What the solver left: solving more tightly makes this part smaller and no other.
    pub algebraic: f64,
}

impl BoundParts {
    /// All that a finer mesh makes smaller, a tighter tolerance does not.
    pub fn discretization(&self) -> f64 {
        self.flux.hypot(self.contact) + self.oscillation + self.boundary
    }
}

impl ErrorBound {
    /// Bounds the error of any displacements `[u1, u2]` over vertices that have the boundary values `g_h` and 0 of `d`, the
    /// discretization of `problem`; they need not solve it. Linear time.
    ///
    /// `domain` tells what the mesh stands for: with a disk, on whose circle the mesh has its boundary vertices, the membranes
    /// are continued to the circle, and the bound is one on the disk. In every other case the polygon that the mesh covers
    /// counts as the domain.
    ///
    /// # Errors
    /// [`MeasureError::OtherMesh`] when the displacements are not over the vertices, [`MeasureError::Height`] and
    /// [`MeasureError::Load`] when the data have no value at a point of the boundary.
    pub fn new(
        problem: &ContactProblem,
        domain: Option<&Domain>,
        d: &PairDiscretization,
        displacement: &Displacement,
    ) -> Result<Self, MeasureError> {
        ErrorBounds::new(problem, domain, d).of_displacement(displacement)
    }

    fn from_sums(
        d: &PairDiscretization,
        sums: &Sums,
        friedrichs: f64,
        rest_sq: [f64; 2],
        action: Vec<f64>,
        indicators: Vec<f64>,
    ) -> Self {
        let rest = [0, 1].map(|i| friedrichs * (rest_sq[i] / d.tension()[i]).sqrt());
        let of_membrane = |i: usize| {
            let changes = 2.0 * rest[i] * sums.changes_sq[i].sqrt();
            (sums.indicators_sq[i].sqrt() + rest[i]).powi(2) + changes
        };
        let others = sums.products + sums.contact + sums.overlap;
        let total = (of_membrane(0) + of_membrane(1) + 2.0 * others).sqrt();
        Self {
            total,
            quadrature_difference: d.quadrature_difference().to_vec(),
            warnings: DataWarning::all(d, total),
            energy_norm: sums.energy_sq.sqrt(),
            parts: BoundParts {
                flux: sums.flux_sq.sqrt(),
                oscillation: sums.oscillation_sq.sqrt(),
                contact: (2.0 * sums.contact).sqrt(),
                boundary: sums.boundary_sq.sqrt(),
                algebraic: rest[0].hypot(rest[1]) + (2.0 * sums.overlap).sqrt() + sums.feasible_sq.sqrt(),
            },
            actions: vec![action],
            indicators,
        }
    }

    /// A bound of the error relative to the energy norm of the exact solution, which is
    /// `|||u_h|||` less the bound at least; `None` when the bound is not smaller than that. Zero where there is no error, also
    /// of membranes at rest.
    pub fn relative(&self) -> Option<f64> {
        if self.total == 0.0 {
            return Some(0.0);
        }
        let least = self.energy_norm - self.total;
        (least > 0.0).then(|| self.total / least)
    }
}

/// The bounds of several errors on one discretization: what depends on the data alone is found once, with the first of them.
pub struct ErrorBounds<'a> {
    problem: &'a ContactProblem,
    domain: Option<&'a Domain>,
    d: &'a PairDiscretization,
    trace: OnceLock<Trace<'a>>,
}

impl<'a> ErrorBounds<'a> {
    /// For pairs on `d`, the discretization of `problem`; `domain` as in [`ErrorBound::new`].
    pub fn new(problem: &'a ContactProblem, domain: Option<&'a Domain>, d: &'a PairDiscretization) -> Self {
        Self { problem, domain, d, trace: OnceLock::new() }
    }

    /// [`ErrorBound::new`].
    ///
    /// # Errors
    /// Likewise.
    pub fn of_displacement(&self, displacement: &Displacement) -> Result<ErrorBound, MeasureError> {
        MeasureError::check(self.d, displacement)?;
        let seen = Action::recover(self.d, displacement);
        let action = likely_action(self.d, displacement, &seen);
        self.with_action(displacement, action)
    }

    /// Bounds the error of a certified solution, with its own action: what was cut off of the action that the displacements
    /// have by (4.5) is in the algebraic part.
    ///
    /// # Errors
    /// [`MeasureError::OtherMesh`] when it is the solution on another mesh, and those of [`ErrorBound::new`].
    pub fn of_solution(&self, solution: &PairSolution) -> Result<ErrorBound, MeasureError> {
        MeasureError::check(self.d, solution.displacement())?;
        self.with_action(solution.displacement(), solution.lambda().to_vec())
    }

    /// With any `action >= 0` over vertices, zero on the boundary, where it is still to be continued to.
    fn with_action(
        &self,
        displacement: &Displacement,
        mut action: Vec<f64>,
    ) -> Result<ErrorBound, MeasureError> {
        let d = self.d;
        let trace = self.trace.get_or_init(|| Trace::new(self.problem, self.domain, d));
        let rest_sq = rest_sq(d, displacement, &action);
        extend_to_boundary(d, displacement, &mut action);
        let fluxes = WedgeFluxes::new(d, displacement, &action);
        let cells = Cells { d, displacement, lambda: &action, fluxes, trace };
        let (sums, indicators) = cells.sum()?;
        let friedrichs = friedrichs(cells.sides());
        drop(cells);
        Ok(ErrorBound::from_sums(d, &sums, friedrichs, rest_sq, action, indicators))
    }
}

/// The recovered action where the membranes seem to touch, cut off at zero: over vertices.
fn likely_action(d: &PairDiscretization, [u1, u2]: &Displacement, seen: &[Action]) -> Vec<f64> {
    let scales = d.scales();
    let at = |(&a, action): (&usize, &Action)| {
        // Where there is a gap, an action would cost its product with the gap; rounding of a large gap is none.
        let is_action = action.lambda > action.lambda_rounding;
        let touches = (u1[a] - u2[a]) / scales.displacement < action.lambda / scales.force_density;
        if is_action && touches { action.lambda } else { 0.0 }
    };
    let actions: Vec<f64> = d.interior().iter().zip(seen).map(at).collect();
    d.extend(&actions, |_| 0.0)
}

/// `||rho_i||^2`, where `rho_i` is on `D_a` the action that membrane `i` sees, less that of the bound.
fn rest_sq(d: &PairDiscretization, displacement: &Displacement, action: &[f64]) -> [f64; 2] {
    let [u1, u2] = displacement;
    sums(d.interior().len(), |k| {
        let a = d.interior()[k];
        let [one, two] = d.balance(a, [u1, u2]);
        let left = [one.imbalance, -two.imbalance].map(|force| force / d.dual_area()[a] - action[a]);
        left.map(|left| d.dual_area()[a] * left * left)
    })
}

#[cfg(test)]
mod tests;
