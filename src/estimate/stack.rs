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

mod cells;
mod rest;
#[cfg(test)]
mod tests;

use thiserror::Error;

use super::{BoundParts, ErrorBound, LoadWarning};
use crate::action::{StackSolution, extend_to_held};
use crate::discretization::{IntegrationRule, StackDiscretization, StackError};
use crate::mesh::{VertexKind, VertexTriangles};
use cells::{Cells, Sums};

/// Why there is no bound of the error.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum NoBound {
    /// The values at vertices say nothing of what the data are between them.
    #[error("the data are integrated by their values at vertices: use the quadrature")]
    VertexRule,
    /// The residual would have no mean of zero.
    #[error(
        "the foundation of membrane {membrane} varies inside triangles: give one value per region or triangle"
    )]
    VaryingFoundation {
        /// From 1.
        membrane: usize,
    },
    /// Parts of the domain that meet in a single vertex cannot be balanced one by one.
    #[error(
        "parts of the mesh meet in the single vertex {vertex}, around which membrane {membrane} has no flux: join or part them"
    )]
    MeetInAVertex {
        /// The vertex.
        vertex: usize,
        /// From 1.
        membrane: usize,
    },
    /// A datum has no value inside a triangle.
    #[error(transparent)]
    Data(#[from] StackError),
    /// Solution and discretization do not belong together.
    #[error("the solution belongs to another discretization: give the one that was solved")]
    OtherMesh,
}

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
        for (k, membrane) in d.problem().membranes().iter().enumerate() {
            if !membrane.foundation.is_constant_on_triangles() {
                return Err(NoBound::VaryingFoundation { membrane: k + 1 });
            }
        }
        Self::with_actions(d, displacement, Actions::new(d, solution))
    }

    /// With any actions that are not negative: the nearer to what the displacement sees, the better.
    fn with_actions(
        d: &StackDiscretization,
        displacement: &[Vec<f64>],
        actions: Actions,
    ) -> Result<Self, NoBound> {
        let around = VertexTriangles::new(d.mesh().points().len(), d.mesh().triangles());
        let cells = Cells::new(d, displacement, &actions, &around)?;
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
            warnings: LoadWarning::of_stack(d, total),
        }
    }
}

/// The actions of the bound: those of the solution, continued to where both layers are held, and parted into what acts on areas and
/// what acts along lines.
pub(super) struct Actions {
    gaps: Vec<GapAction>,
}

struct GapAction {
    number: usize,
    /// `lt` on the dual cells, over vertices. Unit: force per area.
    lambda: Vec<f64>,
    /// The edges that carry an action along a line, the lower end of each first, and its densities on the halves at both ends.
    lines: Vec<([usize; 2], [f64; 2])>,
}

impl Actions {
    fn new(d: &StackDiscretization, solution: &StackSolution) -> Self {
        let gaps = solution.gaps().iter().map(|gap| {
            let (k, area) = (gap.number, d.dual_area());
            let mut lambda = gap.lambda.clone();
            let of_edge = |edge: [usize; 2]| (edge, edge.map(|a| gap.line_density[a]));
            let touches = |edge: &[usize; 2]| edge.iter().all(|&a| gap.contact[a]);
            let lines: Vec<_> = d
                .lines(k)
                .into_iter()
                .filter(touches)
                .map(of_edge)
                .filter(|(_, density)| *density != [0.0; 2])
                .collect();
            for &(ends, density) in &lines {
                let half = 0.5 * d.edge_length(ends);
                for (a, density) in ends.into_iter().zip(density) {
                    // Rounding of a difference may leave less than nothing.
                    lambda[a] = (lambda[a] - density * half / area[a]).max(0.0);
                }
            }
            let is_held = |a: usize| d.mesh().kind()[a] != VertexKind::Unused && d.row(k, a).is_none();
            extend_to_held(d.mesh(), is_held, |a| gap.gap[a] > 0.0, &mut lambda);
            GapAction { number: k, lambda, lines }
        });
        Self { gaps: gaps.collect() }
    }

    fn gap(&self, k: usize) -> Option<&GapAction> {
        self.gaps.iter().find(|gap| gap.number == k)
    }

    /// `lt_i - lt_(i-1)` over vertices.
    fn on_membrane(&self, i: usize, vertices: usize) -> Vec<f64> {
        let mut action = vec![0.0; vertices];
        for (k, sign) in [(i, 1.0), (i - 1, -1.0)] {
            let lambda = self.gap(k).map_or(&[][..], |gap| &gap.lambda);
            action.iter_mut().zip(lambda).for_each(|(action, lambda)| *action += sign * lambda);
        }
        action
    }

    /// All edges that carry an action along a line on membrane `i`, with the sign of what it does to the membrane.
    fn lines_on(&self, i: usize) -> impl Iterator<Item = ([usize; 2], [f64; 2])> {
        [(i, 1.0), (i - 1, -1.0)].into_iter().flat_map(move |(k, sign)| {
            let lines = self.gap(k).map_or(&[][..], |gap| &gap.lines);
            lines.iter().map(move |&(ends, density)| (ends, density.map(|density| sign * density)))
        })
    }
}
