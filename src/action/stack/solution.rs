//! A certified solution of a stack.

use super::lines::line_density;
use super::projection::Projection;
use crate::action::{CutOff, Residuals};
use crate::discretization::{Displacements, StackDiscretization};
use crate::parallel::sums;
use crate::solver::Statistics;

/// Displacements, actions and contact sets of a stack: made by [`certify_stack`](super::certify_stack) only.
///
/// Vectors are over the vertices of the mesh, in its order. In each gap, at each vertex where one of its layers is free, one of
/// three things is true, to the last bit: the layers are apart and `lambda = 0`; they touch and press, `lambda > 0`; they touch
/// without a force.
#[derive(Debug, Clone)]
pub struct StackSolution {
    displacement: Displacements,
    gaps: Vec<GapSolution>,
    energy: f64,
    reactions: Vec<f64>,
    imbalance: f64,
    cut_off: CutOff,
    residuals: Residuals,
    statistics: Statistics,
}

/// What happens in one gap.
#[derive(Debug, Clone, PartialEq)]
pub struct GapSolution {
    /// `k`: the gap lies between layers `k` and `k + 1`, counted from the ceiling, layer 0.
    pub number: usize,
    /// `u_k - u_(k+1) >= 0`; at vertices where one of the layers is missing, zero. Unit: length.
    pub gap: Vec<f64>,
    /// The nodal forces `y_a >= 0`, which push layer `k` up and layer `k + 1` down. Unit: force.
    pub force: Vec<f64>,
    /// `lambda_a = y_a / |D_a|`. Unit: force per area. Along lines that carry a force of their own (free edges in contact, jumps of
    /// the ratio of tensions inside a contact zone, kinks of an obstacle) it grows like `1/h`, and the nodal forces count.
    pub lambda: Vec<f64>,
    /// The density of the action along such lines, as far as the data name them: free edges, edges with a line load, and the borders
    /// of regions by which tensions or obstacles are given; zero elsewhere. There, `lambda` has it in itself. Unit: force per length.
    pub line_density: Vec<f64>,
    /// Whether the layers touch, with a force or without; false where both are held.
    pub contact: Vec<bool>,
    /// The area of the dual cells in contact.
    pub contact_area: f64,
    /// The sum of the nodal forces: `int lambda_k`, line actions included.
    pub total_force: f64,
}

impl GapSolution {
    fn new(d: &StackDiscretization, number: usize, projection: &Projection) -> Self {
        let u = &projection.displacement;
        let vertices = d.dual_area().len();
        let height = |layer: usize, a: usize| d.height_of_layer(u, layer, a);
        let gap_at = |a: usize| height(number, a).zip(height(number + 1, a)).map_or(0.0, |(u, v)| u - v);
        let (mut force, mut contact) = (vec![0.0; vertices], vec![false; vertices]);
        for row in d.rows_of(number) {
            let a = d.rows()[row].vertex;
            (force[a], contact[a]) = (projection.action[row], projection.touching[row]);
        }
        let area = d.dual_area();
        let per_area = |(&force, &area): (&f64, &f64)| if force == 0.0 { 0.0 } else { force / area };
        let totals = |a: usize| [if contact[a] { area[a] } else { 0.0 }, force[a]];
        let [contact_area, total_force] = sums(vertices, totals);
        Self {
            number,
            gap: (0..vertices).map(gap_at).collect(),
            lambda: force.iter().zip(area).map(per_area).collect(),
            line_density: line_density(d, number, &force, &contact),
            force,
            contact,
            contact_area,
            total_force,
        }
    }

    /// How many vertices touch.
    pub fn contact_vertices(&self) -> usize {
        self.contact.iter().filter(|&&contact| contact).count()
    }

    /// How many of them are pressed.
    pub fn pressed_vertices(&self) -> usize {
        self.force.iter().filter(|&&force| force > 0.0).count()
    }
}

impl StackSolution {
    pub(super) fn new(
        d: &StackDiscretization,
        projection: Projection,
        residuals: Residuals,
        statistics: Statistics,
    ) -> Self {
        let gaps: Vec<GapSolution> =
            d.gaps().into_iter().map(|number| GapSolution::new(d, number, &projection)).collect();
        let reactions: Vec<f64> = (1..=d.membranes()).map(|i| reaction(d, i, &projection, &gaps)).collect();
        Self {
            energy: energy(d, &projection.displacement),
            imbalance: imbalance(d, &projection.displacement, &gaps, &reactions),
            reactions,
            gaps,
            displacement: projection.displacement,
            cut_off: projection.cut_off,
            residuals,
            statistics,
        }
    }

    /// The displacements of the membranes from the top, fixed values included. Unit: length.
    pub fn displacement(&self) -> &Displacements {
        &self.displacement
    }

    /// The gaps that there are, from the top.
    pub fn gaps(&self) -> &[GapSolution] {
        &self.gaps
    }

    /// Gap `k`, between layers `k` and `k + 1`.
    pub fn gap(&self, k: usize) -> Option<&GapSolution> {
        self.gaps.iter().find(|gap| gap.number == k)
    }

    /// The energy `J(u_h) = sum_i 1/2 u_i'K_i u_i - F_i'u_i`, the foundation and line loads in it.
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// The force with which the supports hold each membrane, upwards. Unit: force.
    pub fn reactions(&self) -> &[f64] {
        &self.reactions
    }

    /// What is left of the sum of all forces on the stack (loads, foundations, supports, obstacles), relative to the sum of their
    /// sizes: rounding, and what the solver has left.
    pub fn imbalance(&self) -> f64 {
        self.imbalance
    }

    /// What was cut off to make the solution exactly complementary.
    pub fn cut_off(&self) -> CutOff {
        self.cut_off
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

fn energy(d: &StackDiscretization, displacement: &Displacements) -> f64 {
    let of = |i: usize, u: &[f64]| -> f64 {
        let [energy] = sums(u.len(), |a| [(0.5 * d.stiffness_times(i, a, u)[0] - d.load(i)[a]) * u[a]]);
        energy
    };
    (1..).zip(displacement).map(|(i, u)| of(i, u)).sum()
}

/// `sum_a (K_i u_i - F_i)_a - (y_i - y_(i-1))_a` over the vertices where membrane `i` is fixed.
fn reaction(d: &StackDiscretization, i: usize, projection: &Projection, gaps: &[GapSolution]) -> f64 {
    let u = &projection.displacement[i - 1];
    let pushed = |number: usize, a: usize| {
        gaps.iter().find(|gap| gap.number == number).map_or(0.0, |gap| gap.force[a])
    };
    let fixed = (0..u.len()).filter(|&a| d.height(i, a).is_some());
    fixed.map(|a| d.imbalance(i, a, u)[0] - (pushed(i, a) - pushed(i - 1, a))).sum()
}

fn imbalance(
    d: &StackDiscretization,
    displacement: &Displacements,
    gaps: &[GapSolution],
    reactions: &[f64],
) -> f64 {
    let mut forces: Vec<f64> = reactions.to_vec();
    for (i, u) in (1..).zip(displacement) {
        forces.push(d.load(i).iter().sum());
        forces.push(-(0..u.len()).map(|a| d.foundation(i, a) * u[a]).sum::<f64>());
    }
    // The ceiling pushes down, the floor up; what membranes do to each other cancels.
    let last = d.membranes();
    for gap in gaps {
        forces.extend(match gap.number {
            0 => Some(-gap.total_force),
            k if k == last => Some(gap.total_force),
            _ => None,
        });
    }
    let size: f64 = forces.iter().map(|force| force.abs()).sum();
    if size == 0.0 { 0.0 } else { forces.iter().sum::<f64>().abs() / size }
}
