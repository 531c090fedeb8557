//! A certified solution.

use super::projection::{Before, Projection};
use super::{CutOff, Residuals, extend_to_boundary};
use crate::discretization::{Displacement, PairDiscretization};
use crate::parallel::sums;
use crate::solver::Statistics;

/// Displacements, action and contact set of (3.4), (4.5): made by [`certify_pair`](super::certify_pair) only.
///
/// Vectors are over the vertices of the mesh, in its order. At each interior vertex one of three things is true, to the last
/// bit: the membranes are apart, `u1 > u2` and `lambda_a = 0`; they touch and press, `u1 = u2` and `lambda_a > 0`; they touch
/// without a force, `u1 = u2` and `lambda_a = 0`. *Contact* is where they touch, *pressed* where there is a force.
#[derive(Debug, Clone)]
pub struct PairSolution {
    displacement: Displacement,
    lambda: Vec<f64>,
    contact: Vec<bool>,
    energy: f64,
    inside: Totals,
    extended: Totals,
    cut_off: CutOff,
    before: Option<Before>,
    residuals: Residuals,
    statistics: Statistics,
}

/// Sums over dual cells.
#[derive(Debug, Clone, Copy)]
struct Totals {
    area: f64,
    force: f64,
}

impl Totals {
    /// Over the cells of all vertices that touch.
    fn new(d: &PairDiscretization, contact: &[bool], lambda: &[f64]) -> Self {
        let over_cells = |a: usize| [f64::from(contact[a]), lambda[a]].map(|value| d.dual_area()[a] * value);
        let [area, force] = sums(contact.len(), over_cells);
        Self { area, force }
    }

    /// Likewise, with the cells of the boundary to which the contact is continued.
    fn extended(
        self,
        d: &PairDiscretization,
        displacement: &Displacement,
        contact: &[bool],
        lambda: &[f64],
    ) -> Self {
        let mut lambda = lambda.to_vec();
        let at_boundary = extend_to_boundary(d, displacement, &mut lambda);
        if !at_boundary.contains(&true) {
            return self;
        }
        let contact: Vec<bool> =
            contact.iter().zip(at_boundary).map(|(contact, edge)| contact | edge).collect();
        Self::new(d, &contact, &lambda)
    }
}

impl PairSolution {
    pub(super) fn new(
        d: &PairDiscretization,
        projection: Projection,
        residuals: Residuals,
        statistics: Statistics,
    ) -> Self {
        let Projection { displacement, lambda, contact, cut_off, before } = projection;
        let inside = Totals::new(d, &contact, &lambda);
        Self {
            energy: energy(d, &displacement),
            inside,
            extended: inside.extended(d, &displacement, &contact, &lambda),
            displacement,
            lambda,
            contact,
            cut_off,
            before,
            residuals,
            statistics,
        }
    }

    /// `[u1, u2]`, boundary values included. Unit: length.
    pub fn displacement(&self) -> &Displacement {
        &self.displacement
    }

    /// The gap `u1 - u2`: not negative, and zero exactly where the membranes touch. Unit: length.
    pub fn gap(&self) -> Vec<f64> {
        let [u1, u2] = &self.displacement;
        u1.iter().zip(u2).map(|(u1, u2)| u1 - u2).collect()
    }

    /// `lambda_a`, the values of `lambda_h` on the dual cells `D_a`; zero on the boundary, where it has none. Unit: force
    /// per area. Not negative, and positive only where the membranes touch; values that are no more than the rounding of what
    /// cancels in them are zero.
    pub fn lambda(&self) -> &[f64] {
        &self.lambda
    }

    /// Whether the membranes touch at a vertex, with a force or without; false on the boundary, where they are held.
    pub fn contact(&self) -> &[bool] {
        &self.contact
    }

    /// The energy `J(u_h) = sum_i mu_i/2 |u_i|_1^2 - (f_i, u_i)` of (2.9).
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// The area of the dual cells of the vertices in contact: the paper's, whose cells belong to the interior vertices.
    pub fn contact_area(&self) -> f64 {
        self.inside.area
    }

    /// `int lambda_h`, the force with which the membranes push: the paper's, with `lambda_h = 0` on the cells of the boundary.
    pub fn total_force(&self) -> f64 {
        self.inside.force
    }

    /// The contact area with the dual cells of those boundary vertices around which the membranes touch in all triangles:
    /// what is in contact where it reaches the edge.
    pub fn contact_area_extended(&self) -> f64 {
        self.extended.area
    }

    /// The integral of the action continued to these cells, on each by the mean of its neighbours: the action of the bound of
    /// the error. Where contact reaches the edge, [`total_force`](Self::total_force) misses the cells along it, and this does
    /// not.
    pub fn total_force_extended(&self) -> f64 {
        self.extended.force
    }

    /// The displacements and the action, over vertices, whose residuals were certified: the solution's own but for an answer
    /// that had both a gap and a multiplier somewhere. Certified again, they give this solution again.
    pub fn certified(&self) -> (&Displacement, &[f64]) {
        match &self.before {
            Some(before) => (&before.displacement, &before.lambda),
            None => (&self.displacement, &self.lambda),
        }
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

fn energy(d: &PairDiscretization, [u1, u2]: &Displacement) -> f64 {
    let of = |i: usize, u: &[f64], a: usize| {
        (0.5 * d.tension()[i] * d.stiffness_row(a, |b| u[b]) - d.load()[i][a]) * u[a]
    };
    let at = |a: usize| [of(0, u1, a) + of(1, u2, a)];
    let [energy] = sums(u1.len(), at);
    energy
}
