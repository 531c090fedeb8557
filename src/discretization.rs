//! A problem on a mesh: everything that its discrete problem is made of.

mod areas;
mod pair;
mod scales;
mod stack;
mod structure;

use std::sync::Arc;

use thiserror::Error;

#[cfg(test)]
#[cfg(test)]
pub(crate) use pair::principal_submatrix;
pub use pair::{Displacement, PairDiscretization, PairError};
pub use scales::Scales;
pub use stack::{Displacements, GapRow, IntegrationRule, StackDiscretization, StackError};
pub(crate) use stack::{Samples, Segment, at_samples};
pub use structure::Structure;

use crate::mesh::Mesh;
use crate::problem::ContactProblem;

/// A problem on a mesh: the paper's pair, which decouples exactly, or any other stack.
#[derive(Debug, Clone)]
#[allow(
    clippy::large_enum_variant,
    reason = "there is one, or a few, and it is next to nothing beside its vectors"
)]
pub enum Discretization {
    /// The paper's pair (3.4).
    Pair(PairDiscretization),
    /// Any other stack.
    Stack(StackDiscretization),
}

/// A problem cannot be posed on a mesh.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DiscretizationError {
    /// The paper's pair.
    #[error(transparent)]
    Pair(#[from] PairError),
    /// Any other stack.
    #[error(transparent)]
    Stack(#[from] StackError),
}

impl DiscretizationError {
    /// The vertex that the error names.
    pub fn vertex(&self) -> Option<usize> {
        match self {
            Self::Pair(error) => error.vertex(),
            Self::Stack(error) => error.vertex(),
        }
    }
}

impl Discretization {
    /// Assembles the discrete problem: that of the pair where the data are those of [the pair](ContactProblem::as_pair). Linear
    /// time and memory.
    ///
    /// # Errors
    /// [`DiscretizationError`].
    pub fn new(problem: &ContactProblem, mesh: impl Into<Arc<Mesh>>) -> Result<Self, DiscretizationError> {
        Self::by_rule(problem, mesh, IntegrationRule::Quadrature)
    }

    /// Likewise, with the data integrated by another rule.
    ///
    /// # Errors
    /// [`DiscretizationError`].
    pub fn by_rule(
        problem: &ContactProblem,
        mesh: impl Into<Arc<Mesh>>,
        rule: IntegrationRule,
    ) -> Result<Self, DiscretizationError> {
        Ok(match rule {
            IntegrationRule::Quadrature if problem.as_pair().is_some() => {
                Self::Pair(PairDiscretization::new(problem, mesh)?)
            }
            _ => Self::Stack(StackDiscretization::by_rule(problem, mesh, rule)?),
        })
    }

    /// What solvers can make use of.
    pub fn structure(&self) -> Structure<'_> {
        match self {
            Self::Pair(pair) => Structure::Pair(pair),
            Self::Stack(stack) => stack.into(),
        }
    }

    /// The mesh.
    pub fn mesh(&self) -> &Arc<Mesh> {
        match self {
            Self::Pair(pair) => pair.mesh(),
            Self::Stack(stack) => stack.mesh(),
        }
    }

    /// How many membranes there are.
    pub fn membranes(&self) -> usize {
        match self {
            Self::Pair(_) => 2,
            Self::Stack(stack) => stack.membranes(),
        }
    }

    /// How many unknowns there are in all membranes.
    pub fn unknowns(&self) -> usize {
        match self {
            Self::Pair(pair) => 2 * pair.interior().len(),
            Self::Stack(stack) => stack.unknowns(),
        }
    }

    /// The gaps `k` between two layers that there are, in increasing order.
    pub fn gaps(&self) -> Vec<usize> {
        match self {
            Self::Pair(_) => vec![1],
            Self::Stack(stack) => stack.gaps(),
        }
    }

    /// How many rows the constraints have: one for each gap and each vertex where a layer of it is free.
    pub fn rows(&self) -> usize {
        match self {
            Self::Pair(pair) => pair.interior().len(),
            Self::Stack(stack) => stack.rows().len(),
        }
    }

    /// `|D_a| = |Delta_a| / 3`, over vertices; zero at unused ones.
    pub fn dual_area(&self) -> &[f64] {
        match self {
            Self::Pair(pair) => pair.dual_area(),
            Self::Stack(stack) => stack.dual_area(),
        }
    }

    /// The load vector `F_i` of membrane `i` (from 1) over vertices. Unit: force.
    pub fn load(&self, i: usize) -> &[f64] {
        match self {
            Self::Pair(pair) => &pair.load()[i - 1],
            Self::Stack(stack) => stack.load(i),
        }
    }

    /// The sizes that residuals are measured against.
    pub fn scales(&self) -> Scales {
        match self {
            Self::Pair(pair) => pair.scales(),
            Self::Stack(stack) => stack.scales(),
        }
    }

    /// The paper's pair, if it is that.
    pub fn as_pair(&self) -> Option<&PairDiscretization> {
        match self {
            Self::Pair(pair) => Some(pair),
            Self::Stack(_) => None,
        }
    }
}
