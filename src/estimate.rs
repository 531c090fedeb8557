//! Errors of solutions: bounds, guaranteed up to the quadrature of the loads, and norms against an exact solution.

mod bound;
mod contact_bounds;
mod lift;
mod norms;
mod residual;
mod rim;
mod spaces;
mod stack;
mod stack_norms;
#[cfg(test)]
mod tests;

pub use bound::{BoundParts, DataWarning, ErrorBound, ErrorBounds};
pub use contact_bounds::ContactBounds;
pub use lift::DualNorm;
pub use norms::{ContactAreas, ErrorNorms, energy_error};
pub use residual::residual_indicators;
pub use rim::RimError;
pub use stack::NoBound;
pub use stack_norms::{GapError, StackNorms};

use thiserror::Error;

use crate::discretization::PairDiscretization;
use crate::mesh::MeshError;
use crate::problem::EvaluationError;

/// The error of a solution cannot be measured.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MeasureError {
    /// Solution and discretization do not belong together.
    #[error(
        "the solution has {values} values, the mesh {vertices} vertices: give the discretization that was solved"
    )]
    OtherMesh {
        /// Entries of the solution's vectors.
        values: usize,
        /// Vertices of the mesh.
        vertices: usize,
    },
    /// The triangles are too small to be divided.
    #[error("the triangles cannot be divided for the lift of the action: {0}")]
    SubTriangulation(#[from] MeshError),
    /// The stiffness matrix cannot be factored.
    #[error(
        "the lift of the action cannot be factored: memory is short, or the mesh has triangles that are too thin"
    )]
    NotFactored,
    /// The iteration for the lift does not converge.
    #[error(
        "the lift of the action has not converged in {iterations} iterations: the mesh has triangles that are too thin"
    )]
    NotConverged {
        /// The limit.
        iterations: usize,
    },
    /// The height has no value between the vertices of the boundary.
    #[error("height g {source}: it must be finite on the whole boundary")]
    Height {
        /// Where, or why.
        source: EvaluationError,
    },
    /// A load has no value between the mesh and the circle of the disk that it stands for.
    #[error("load f{membrane} {source}: it must be finite on the whole domain")]
    Load {
        /// 1 or 2.
        membrane: usize,
        /// Where, or why.
        source: EvaluationError,
    },
    /// The exact solution or the discrete one is not finite somewhere.
    #[error(
        "the error against the exact solution is not finite: the displacements or the solution's parameters are too large"
    )]
    NotFinite,
}

impl MeasureError {
    fn of_height(source: EvaluationError) -> Self {
        Self::Height { source }
    }

    /// Of membrane 0 or 1.
    fn of_load(membrane: usize, source: EvaluationError) -> Self {
        Self::Load { membrane: membrane + 1, source }
    }

    /// Refuses vectors that are not over the vertices of `d`.
    fn check<V: AsRef<[f64]>>(
        d: &PairDiscretization,
        vectors: impl IntoIterator<Item = V>,
    ) -> Result<(), Self> {
        let vertices = d.mesh().points().len();
        let mut lengths = vectors.into_iter().map(|values| values.as_ref().len());
        match lengths.find(|&values| values != vertices) {
            Some(values) => Err(Self::OtherMesh { values, vertices }),
            None => Ok(()),
        }
    }
}
