//! From the solution on one mesh to a start on the next.

use crate::action::PairSolution;
use crate::discretization::{Displacement, PairDiscretization};
use crate::solver::StartingPoint;

/// A solution on its way to a refined mesh: displacements, and the action on the dual cells, over vertices.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fields {
    pub(super) displacement: Displacement,
    pub(super) lambda: Vec<f64>,
}

impl From<&PairSolution> for Fields {
    fn from(solution: &PairSolution) -> Self {
        Self { displacement: solution.displacement().clone(), lambda: solution.lambda().to_vec() }
    }
}

impl Fields {
    /// On the refined mesh whose new vertices have these parents.
    pub(super) fn prolonged(mut self, parents: &[[usize; 2]]) -> Self {
        for values in self.displacement.iter_mut().chain([&mut self.lambda]) {
            prolong(values, parents);
        }
        self
    }

    /// As a point to start from.
    pub(super) fn into_start(self, d: &PairDiscretization) -> StartingPoint {
        let multiplier = d.interior().iter().map(|&a| self.lambda[a] * d.dual_area()[a]).collect();
        StartingPoint { displacement: self.displacement, multiplier }
    }
}

/// A P1 function on the refined mesh: the mean of the ends at the midpoint of an edge.
fn prolong(values: &mut Vec<f64>, parents: &[[usize; 2]]) {
    values.reserve(parents.len());
    for &[a, b] in parents {
        values.push(0.5 * (values[a] + values[b]));
    }
}
