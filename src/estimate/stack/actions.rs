//! The actions that the bound rests on.

use crate::action::{StackSolution, extend_to_held};
use crate::discretization::StackDiscretization;
use crate::mesh::VertexKind;

/// The actions of the bound: those of the solution, continued to where both layers are held, and parted into what acts on areas and
/// what acts along lines.
pub(super) struct Actions {
    pub(super) gaps: Vec<GapAction>,
}

/// The action in one gap.
pub(super) struct GapAction {
    pub(super) number: usize,
    /// `lt` on the dual cells, over vertices. Unit: force per area.
    pub(super) lambda: Vec<f64>,
    /// The edges that carry an action along a line, the lower end of each first, and its densities on the halves at both ends.
    pub(super) lines: Vec<([usize; 2], [f64; 2])>,
}

impl Actions {
    pub(super) fn new(d: &StackDiscretization, solution: &StackSolution) -> Self {
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
    pub(super) fn on_membrane(&self, i: usize, vertices: usize) -> Vec<f64> {
        let mut action = vec![0.0; vertices];
        for (k, sign) in [(i, 1.0), (i - 1, -1.0)] {
            let lambda = self.gap(k).map_or(&[][..], |gap| &gap.lambda);
            action.iter_mut().zip(lambda).for_each(|(action, lambda)| *action += sign * lambda);
        }
        action
    }

    /// All edges that carry an action along a line on membrane `i`, with the sign of what it does to the membrane.
    pub(super) fn lines_on(&self, i: usize) -> impl Iterator<Item = ([usize; 2], [f64; 2])> {
        [(i, 1.0), (i - 1, -1.0)].into_iter().flat_map(move |(k, sign)| {
            let lines = self.gap(k).map_or(&[][..], |gap| &gap.lines);
            lines.iter().map(move |&(ends, density)| (ends, density.map(|density| sign * density)))
        })
    }
}
