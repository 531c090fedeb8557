//! From the solution on one mesh to a start on the next.

use crate::action::ContactSolution;
use crate::discretization::{Discretization, Displacements};
use crate::solver::StartingPoint;

/// A solution on its way to a refined mesh: displacements, and the actions in the gaps on the dual cells, over vertices.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fields {
    pub(super) displacement: Displacements,
    pub(super) actions: Vec<Vec<f64>>,
}

impl From<&ContactSolution> for Fields {
    fn from(solution: &ContactSolution) -> Self {
        let actions = solution.gaps().iter().map(|gap| gap.lambda.to_vec()).collect();
        Self { displacement: solution.displacement().to_vec(), actions }
    }
}

impl Fields {
    /// On the refined mesh whose new vertices have these parents.
    pub(super) fn prolonged(mut self, parents: &[[usize; 2]]) -> Self {
        for values in self.displacement.iter_mut().chain(&mut self.actions) {
            prolong(values, parents);
        }
        self
    }

    /// As a point to start from.
    pub(super) fn into_start(self, d: &Discretization) -> StartingPoint {
        let force = |k: usize, a: usize| self.actions[k][a] * d.dual_area()[a];
        let multiplier = match d {
            Discretization::Pair(d) => d.interior().iter().map(|&a| force(0, a)).collect(),
            Discretization::Stack(d) => {
                let gaps = d.gaps();
                let place = |gap: usize| gaps.binary_search(&gap).expect("a row belongs to a gap");
                d.rows().iter().map(|row| force(place(row.gap), row.vertex)).collect()
            }
        };
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
