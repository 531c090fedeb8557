//! The bound triangle by triangle.

use super::trace::Trace;
use crate::discretization::{Displacement, PairDiscretization};
use crate::estimate::MeasureError;
use crate::fem::gradient;
use crate::flux::WedgeFluxes;
use crate::geometry::poincare;
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;

/// `int_{D_a cap K} phi_a = 22 |K| / 108`, and of the hat functions of the other two corners `7 |K| / 108` each.
const OWN: f64 = 22.0 / 108.0;
const OTHER: f64 = 7.0 / 108.0;

/// What the bound is made from.
pub(super) struct Cells<'a> {
    pub(super) d: &'a PairDiscretization,
    pub(super) displacement: &'a Displacement,
    /// `lt` over vertices.
    pub(super) lambda: &'a [f64],
    pub(super) fluxes: WedgeFluxes<'a>,
    pub(super) trace: &'a Trace<'a>,
}

/// Sums over triangles.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    /// `(a_{K,i} + b_{K,i})^2` of each membrane, and what lies beyond the mesh.
    pub(super) indicators_sq: [f64; 2],
    /// `a_{K,i} b_{K,i}`.
    pub(super) products: f64,
    /// `b_{K,i}^2` of each membrane.
    pub(super) changes_sq: [f64; 2],
    /// `(lt, wh)` from vertices next to those that touch, and from those themselves.
    pub(super) contact: f64,
    pub(super) overlap: f64,
    pub(super) flux_sq: f64,
    pub(super) oscillation_sq: f64,
    /// Of the change that makes the gap non-negative.
    pub(super) feasible_sq: f64,
    /// Of the lift of `g - g_h`, and of what lies beyond the mesh.
    pub(super) boundary_sq: f64,
    /// `|||u_h|||^2`.
    pub(super) energy_sq: f64,
}

impl Sums {
    fn plus(self, other: Self) -> Self {
        let sum = |one: [f64; 2], other: [f64; 2]| [one[0] + other[0], one[1] + other[1]];
        Self {
            indicators_sq: sum(self.indicators_sq, other.indicators_sq),
            products: self.products + other.products,
            changes_sq: sum(self.changes_sq, other.changes_sq),
            contact: self.contact + other.contact,
            overlap: self.overlap + other.overlap,
            flux_sq: self.flux_sq + other.flux_sq,
            oscillation_sq: self.oscillation_sq + other.oscillation_sq,
            feasible_sq: self.feasible_sq + other.feasible_sq,
            boundary_sq: self.boundary_sq + other.boundary_sq,
            energy_sq: self.energy_sq + other.energy_sq,
        }
    }

    /// What a triangle adds to the square of the bound.
    fn indicator_sq(&self) -> f64 {
        self.indicators_sq[0] + self.indicators_sq[1] + 2.0 * (self.products + self.contact + self.overlap)
    }
}

impl Cells<'_> {
    /// The sides of a rectangle around the domain: that of the circle where the bound reaches up to it, else that of the mesh.
    pub(super) fn sides(&self) -> [f64; 2] {
        let (lower, upper) = self.d.mesh().bounding_box();
        match self.trace.circle {
            Some(circle) => [2.0 * circle.radius; 2],
            None => [upper[0] - lower[0], upper[1] - lower[1]],
        }
    }

    /// The sums over all triangles, added in an order that does not depend on the number of threads, and the squared
    /// indicators.
    ///
    /// # Errors
    /// When the data have no value on the boundary: the first in the order of the triangles.
    pub(super) fn sum(&self) -> Result<(Sums, Vec<f64>), MeasureError> {
        let mut indicators = vec![0.0; self.d.mesh().triangles().len()];
        let on_block = |(block, indicators): (usize, &mut [f64])| {
            let mut sums = Sums::default();
            for (k, indicator) in indicators.iter_mut().enumerate() {
                let on_triangle = self.on_triangle(block * BLOCK + k)?;
                *indicator = on_triangle.indicator_sq();
                sums = sums.plus(on_triangle);
            }
            Ok(sums)
        };
        let blocks: Vec<Result<Sums, MeasureError>> =
            indicators.par_chunks_mut(BLOCK).enumerate().map(on_block).collect();
        let mut sums = Sums::default();
        for block in blocks {
            sums = sums.plus(block?);
        }
        Ok((sums, indicators))
    }

    fn on_triangle(&self, k: usize) -> Result<Sums, MeasureError> {
        let (flux_sq, oscillation) = (self.fluxes.distance_sq(k), self.oscillation(k));
        let energy = self.fluxes.energy(k, self.d.tension());
        let (feasible_sq, lift) = (self.feasible_sq(k), self.trace.lift(k, self.lambda)?);
        let (contact, overlap) = self.contact(k);
        let mut sums = Sums { contact: contact + lift.action, overlap, ..Sums::default() };
        for (i, mu) in self.d.tension().into_iter().enumerate() {
            let lift_sq = if i == 0 { mu * lift.seminorm_sq } else { 0.0 };
            let beyond_sq = self.trace.beyond_sq(i, k, &self.fluxes)?;
            let flux_sq = flux_sq[i] / mu;
            let oscillation_sq = oscillation[i].powi(2) / mu;
            let a = flux_sq.sqrt() + oscillation_sq.sqrt();
            let b = feasible_sq[i].sqrt() + lift_sq.sqrt();
            sums.indicators_sq[i] = (a + b).powi(2) + beyond_sq;
            sums.products += a * b;
            sums.changes_sq[i] = b * b;
            sums.flux_sq += flux_sq;
            sums.oscillation_sq += oscillation_sq;
            sums.feasible_sq += feasible_sq[i];
            sums.boundary_sq += lift_sq + beyond_sq;
            sums.energy_sq += energy[i];
        }
        Ok(sums)
    }

    /// `h_K / pi ||r_i - rho_i||_K`, where on the wedge at `a` the residual is `f_i` less its share `f_a|_K`: at most
    /// `||f_i - p||_K`, with the affine `p` that has the same shares, and `||p - f_a||_K`, which is
    /// `(5/3 sum_a |K|/3 (f_a - f_K)^2)^(1/2)`.
    fn oscillation(&self, k: usize) -> [f64; 2] {
        let (diameter, area) = (self.d.mesh().diameter_sq(k).sqrt(), self.d.mesh().triangle_area(k));
        [0, 1].map(|i: usize| poincare(diameter) * self.d.moments[i].on(self.d.mesh(), k).oscillation(area))
    }

    /// `mu_i |c_i|_{H1(K)}^2` for the changes `c_1 = (mu2 / M) w^-` and `c_2 = -(mu1 / M) w^-` that make the gap non-negative.
    fn feasible_sq(&self, k: usize) -> [f64; 2] {
        let overlap = |a: usize| (self.displacement[1][a] - self.displacement[0][a]).max(0.0);
        if self.d.mesh().triangles()[k].iter().all(|&a| overlap(a) == 0.0) {
            return [0.0; 2];
        }
        let [mu1, mu2] = self.d.tension();
        let shares = [mu2 / (mu1 + mu2), mu1 / (mu1 + mu2)];
        let square = self.seminorm_sq(k, overlap);
        [mu1 * shares[0] * shares[0] * square, mu2 * shares[1] * shares[1] * square]
    }

    /// `(lt, max(wh, 0))_K`: from the gap at the other corners, and at the vertex of the action itself.
    fn contact(&self, k: usize) -> (f64, f64) {
        let corners = self.d.mesh().triangles()[k];
        let gap = corners.map(|a| (self.displacement[0][a] - self.displacement[1][a]).max(0.0));
        let lambda = corners.map(|a| self.lambda[a]);
        let area = self.d.mesh().triangle_area(k);
        let others = |j: usize| gap[(j + 1) % 3] + gap[(j + 2) % 3];
        let contact = (0..3).map(|j| OTHER * lambda[j] * others(j)).sum::<f64>();
        let overlap = (0..3).map(|j| OWN * lambda[j] * gap[j]).sum::<f64>();
        (area * contact, area * overlap)
    }

    /// `|v|_{H1(K)}^2` of a P1 function.
    fn seminorm_sq(&self, k: usize, v: impl Fn(usize) -> f64) -> f64 {
        let [x, y] = gradient(self.d.mesh().corners(k), self.d.mesh().triangles()[k].map(v));
        self.d.mesh().triangle_area(k) * (x * x + y * y)
    }
}
