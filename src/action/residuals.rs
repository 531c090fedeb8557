//! How far displacements, multipliers and action are from solving the full discrete problem (4.7).

use std::ops::Range;

use super::Action;
use crate::discretization::{Displacement, PairDiscretization};
use crate::mesh::{Mesh, VertexKind};
use crate::numeric::or_infinite;
use crate::parallel::prelude::*;
use crate::parallel::{BLOCK, sums};

/// One check: the largest defect over all vertices, relative to the [`Scales`](crate::discretization::Scales) of the
/// data. A NaN makes it infinite.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Residual {
    /// The defect as it is.
    pub value: f64,
    /// What is left of it when each vertex is allowed the rounding of the terms that cancel there.
    pub beyond_rounding: f64,
}

/// All checks, recomputed from `K`, `F` and `g`, not from the quadratic program that was solved: a mistake in its
/// assembly shows here although every backend agrees with every other.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Residuals {
    /// `mu1 K u1 - F_1 = y` and `F_2 - mu2 K u2 = y`, force per area: the first line of (4.7) for all hat functions of
    /// both membranes, with the multipliers in place of the action.
    pub stationarity: Residual,
    /// `u1 >= u2` inside, `u1 = g_h` and `u2 = 0` on the boundary: the pair is in the cone `K_gh` (3.3). Both are zero at
    /// unused vertices.
    pub primal: Residual,
    /// `y >= 0`, and `lambda_h >= 0` (4.2) as seen by either membrane.
    pub dual_sign: Residual,
    /// `lambda_a (u1 - u2)(a) = 0` (4.8).
    pub complementarity: Residual,
    /// `lambda_1 = lambda_2` (Proposition 12). In a stack, the block balance: where membranes touch each other and nothing else, the
    /// forces on all of them add up to zero.
    pub action_mismatch: Residual,
    /// `y_a = lambda_a int phi_a`, the integrals summed over the triangles anew: multipliers against post-processing.
    pub dual_mismatch: Residual,
    /// `<lambda_h, u1 - u2>_h = 0`: the second line of (4.7) for `chi = 0` and `chi = 2 lambda_h`.
    pub variational_inequality: Residual,
    /// The largest `min(lambda_a, (u1 - u2)(a))`, relative. Not part of the certificate: at the tolerance `t` an
    /// interior-point method leaves `sqrt(t)` here; a polished result leaves rounding.
    pub overlap: f64,
}

impl Residuals {
    /// Recomputes all checks.
    ///
    /// # Panics
    /// When `displacement` is not over the vertices, or `multiplier` or `action` not over the unknowns of `d`.
    pub fn new(
        d: &PairDiscretization,
        displacement: &Displacement,
        multiplier: &[f64],
        action: &[Action],
    ) -> Self {
        let scales = d.scales();
        let [u1, u2] = displacement;
        assert!(
            displacement.iter().all(|u| u.len() == d.mesh().points().len()),
            "displacements are over vertices"
        );
        assert!(
            multiplier.len() == d.interior().len() && action.len() == multiplier.len(),
            "multipliers and actions are over unknowns"
        );
        let (force, length) = (scales.force_density, scales.displacement);
        let integrals = hat_integrals(d.mesh());
        let at_unknown = |(k, &a): (usize, &usize)| {
            let Action { from_membrane: [lambda_1, lambda_2], rounding, lambda, lambda_rounding } = action[k];
            let density = multiplier[k] / d.dual_area()[a];
            let gap = u1[a] - u2[a];
            let of_force = |defect: f64, rounding: f64| Residual::new(defect / force, rounding / force);
            let relative_gap = (gap / length).abs();
            Self {
                stationarity: of_force((lambda_1 - density).abs(), rounding[0])
                    .larger(of_force((lambda_2 - density).abs(), rounding[1])),
                primal: Residual::new(-gap / length, 0.0),
                dual_sign: of_force(-density, 0.0)
                    .larger(of_force(-lambda_1, rounding[0]))
                    .larger(of_force(-lambda_2, rounding[1])),
                complementarity: of_force(lambda.abs() * relative_gap, lambda_rounding * relative_gap),
                action_mismatch: of_force((lambda_1 - lambda_2).abs(), rounding[0] + rounding[1]),
                dual_mismatch: of_force(
                    (multiplier[k] - lambda * integrals[a]).abs() / integrals[a],
                    lambda_rounding,
                ),
                variational_inequality: Residual::default(),
                overlap: Residual::new((lambda / force).min(gap / length), 0.0).value,
            }
        };
        let at_held = |a: usize| {
            let of_length = |defect: f64| Residual::new(defect.abs() / length, 0.0);
            Self { primal: of_length(u1[a] - d.height()[a]).larger(of_length(u2[a])), ..Self::default() }
        };
        let unknowns = d.interior().par_iter().enumerate().with_min_len(BLOCK);
        let held = (0..u1.len()).into_par_iter().filter(|&a| d.mesh().kind()[a] != VertexKind::Interior);
        let largest = unknowns.map(at_unknown).chain(held.map(at_held)).reduce(Self::default, Self::larger);
        let variational_inequality = variational_inequality(d, action, |a| u1[a] - u2[a]);
        Self { variational_inequality, ..largest }
    }

    /// The larger one of each check.
    pub(super) fn larger(self, other: Self) -> Self {
        Self {
            stationarity: self.stationarity.larger(other.stationarity),
            primal: self.primal.larger(other.primal),
            dual_sign: self.dual_sign.larger(other.dual_sign),
            complementarity: self.complementarity.larger(other.complementarity),
            action_mismatch: self.action_mismatch.larger(other.action_mismatch),
            dual_mismatch: self.dual_mismatch.larger(other.dual_mismatch),
            variational_inequality: self.variational_inequality.larger(other.variational_inequality),
            overlap: self.overlap.max(other.overlap),
        }
    }

    /// The largest of the checks beyond rounding: what is compared with the tolerance.
    pub fn beyond_rounding(&self) -> f64 {
        self.named().into_iter().map(|(_, residual)| residual.beyond_rounding).fold(0.0, f64::max)
    }

    /// The checks that make the certificate, with their names.
    pub fn named(&self) -> [(&'static str, Residual); 7] {
        [
            ("stationarity", self.stationarity),
            ("primal", self.primal),
            ("dual_sign", self.dual_sign),
            ("complementarity", self.complementarity),
            ("action_mismatch", self.action_mismatch),
            ("dual_mismatch", self.dual_mismatch),
            ("variational_inequality", self.variational_inequality),
        ]
    }
}

impl Residual {
    /// A defect, and the rounding that is allowed in it.
    pub(super) fn new(defect: f64, rounding: f64) -> Self {
        Self { value: or_infinite(defect), beyond_rounding: or_infinite(defect - rounding) }
    }

    pub(super) fn larger(self, other: Self) -> Self {
        Self {
            value: self.value.max(other.value),
            beyond_rounding: self.beyond_rounding.max(other.beyond_rounding),
        }
    }
}

/// `<lambda_h, u1 - u2>_h` by (4.3), (4.4), relative to the work of the scale force over the scale displacement.
fn variational_inequality(
    d: &PairDiscretization,
    action: &[Action],
    gap: impl Fn(usize) -> f64 + Sync,
) -> Residual {
    if d.interior().is_empty() {
        return Residual::default();
    }
    let scales = d.scales();
    let terms = |k: usize| {
        let a = d.interior()[k];
        let area = d.dual_area()[a];
        [action[k].lambda * area * gap(a), action[k].lambda_rounding * (area * gap(a)).abs(), area]
    };
    let [work, rounding, area] = sums(d.interior().len(), terms);
    let unit = scales.force_density * scales.displacement * area;
    Residual::new(work.abs() / unit, rounding / unit).larger(Residual::default())
}

/// `int phi_a` over vertices, triangle by triangle: what `|D_a|` must be by (4.17).
pub(super) fn hat_integrals(mesh: &Mesh) -> Vec<f64> {
    let over = |triangles: Range<usize>| {
        let mut integrals = vec![0.0; mesh.points().len()];
        for t in triangles {
            let third = mesh.triangle_area(t) / 3.0;
            mesh.triangles()[t].iter().for_each(|&a| integrals[a] += third);
        }
        integrals
    };
    let triangles = mesh.triangles().len();
    let (mut integrals, others) =
        crate::parallel::join(|| over(0..triangles / 2), || over(triangles / 2..triangles));
    integrals.iter_mut().zip(others).for_each(|(integral, other)| *integral += other);
    integrals
}
