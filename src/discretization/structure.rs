//! What solvers can make use of.

use std::sync::Arc;

use super::pair::PairDiscretization;
use super::stack::StackDiscretization;
use crate::mesh::Mesh;

/// What solvers can make use of.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum Structure<'d> {
    /// The paper's pair: a linear problem for a mean of the membranes, and an obstacle problem for the gap.
    Pair(&'d PairDiscretization),
    /// One membrane with at most one obstacle: the obstacle problem.
    Obstacle(&'d StackDiscretization),
    /// Membranes and obstacles that know of each other.
    Coupled(&'d StackDiscretization),
}

impl<'d> From<&'d StackDiscretization> for Structure<'d> {
    fn from(d: &'d StackDiscretization) -> Self {
        if d.is_obstacle_problem() { Self::Obstacle(d) } else { Self::Coupled(d) }
    }
}

impl<'d> Structure<'d> {
    /// The mesh.
    pub fn mesh(self) -> &'d Arc<Mesh> {
        match self {
            Self::Pair(d) => d.mesh(),
            Self::Obstacle(d) | Self::Coupled(d) => d.mesh(),
        }
    }
}
