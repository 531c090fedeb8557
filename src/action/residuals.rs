//! How far displacements, multipliers and action are from solving the full discrete problem (4.7).

use rayon::prelude::*;

use super::Action;
use crate::discretization::Discretization;
use crate::mesh::VertexKind;

/// Vertices that are worked on together.
const BLOCK: usize = 4096;

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
    /// `lambda_1 = lambda_2` (Proposition 12).
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
    /// When `displacement` is not over the vertices or `multiplier` not over the unknowns of `d`.
    pub fn new(
        d: &Discretization,
        displacement: &[Vec<f64>; 2],
        multiplier: &[f64],
        action: &Action,
    ) -> Self {
        let scales = d.scales();
        let [u1, u2] = displacement;
        assert!(
            displacement.iter().all(|u| u.len() == d.mesh().points().len()),
            "displacements are over vertices"
        );
        assert_eq!(multiplier.len(), d.interior().len(), "multipliers are over unknowns");
        let (force, length) = (scales.force_density, scales.displacement);
        let unknowns = || d.interior().par_iter().with_min_len(BLOCK).copied().enumerate();
        let density = |k: usize, a: usize| multiplier[k] / d.dual_area()[a];
        let gap = |a: usize| u1[a] - u2[a];
        let [lambda_1, lambda_2] = &action.from_membrane;
        let [rounding_1, rounding_2] = &action.rounding;

        let stationarity = unknowns().flat_map_iter(|(k, a)| {
            [(lambda_1, rounding_1), (lambda_2, rounding_2)]
                .map(|(lambda, rounding)| ((lambda[k] - density(k, a)).abs() / force, rounding[k] / force))
        });
        let held = (0..u1.len()).into_par_iter().filter(|&a| d.mesh().kind()[a] != VertexKind::Interior);
        let trace = held.flat_map_iter(|a| [(u1[a] - d.height()[a]).abs(), u2[a].abs()]);
        let primal = unknowns().map(|(_, a)| -gap(a)).chain(trace).map(|defect| (defect / length, 0.0));
        let dual_sign = unknowns().flat_map_iter(|(k, a)| {
            [(density(k, a), 0.0), (lambda_1[k], rounding_1[k]), (lambda_2[k], rounding_2[k])]
                .map(|(lambda, rounding)| (-lambda / force, rounding / force))
        });
        let complementarity = unknowns().map(|(k, a)| {
            let gap = (gap(a) / length).abs();
            (action.lambda[k].abs() / force * gap, action.lambda_rounding(d, k) / force * gap)
        });
        let action_mismatch = unknowns().map(|(k, _)| {
            ((lambda_1[k] - lambda_2[k]).abs() / force, (rounding_1[k] + rounding_2[k]) / force)
        });
        let integrals = hat_integrals(d);
        let dual_mismatch = unknowns().map(|(k, a)| {
            let defect = (multiplier[k] - action.lambda[k] * integrals[a]).abs() / integrals[a];
            (defect / force, action.lambda_rounding(d, k) / force)
        });
        Self {
            stationarity: Residual::largest(stationarity),
            primal: Residual::largest(primal),
            dual_sign: Residual::largest(dual_sign),
            complementarity: Residual::largest(complementarity),
            action_mismatch: Residual::largest(action_mismatch),
            dual_mismatch: Residual::largest(dual_mismatch),
            variational_inequality: variational_inequality(d, action, gap),
            overlap: Residual::largest(
                unknowns().map(|(k, a)| ((action.lambda[k] / force).min(gap(a) / length), 0.0)),
            )
            .value,
        }
    }

    /// The largest of the checks beyond rounding: what is held against the tolerance.
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
    /// The largest of `(defect, rounding allowed there)`.
    fn largest(defects: impl ParallelIterator<Item = (f64, f64)>) -> Self {
        let or_infinite = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
        let larger = |a: Self, b: Self| Self {
            value: a.value.max(b.value),
            beyond_rounding: a.beyond_rounding.max(b.beyond_rounding),
        };
        let of_one = |(defect, rounding)| Self {
            value: or_infinite(defect),
            beyond_rounding: or_infinite(defect - rounding),
        };
        defects.map(of_one).reduce(Self::default, larger)
    }
}

/// `<lambda_h, u1 - u2>_h` by (4.3), (4.4), relative to the work of the scale force over the scale displacement.
fn variational_inequality(d: &Discretization, action: &Action, gap: impl Fn(usize) -> f64) -> Residual {
    let scales = d.scales();
    let (mut work, mut rounding, mut area) = (0.0, 0.0, 0.0);
    for (k, &a) in d.interior().iter().enumerate() {
        let weight = d.dual_area()[a] * gap(a);
        work += action.lambda[k] * weight;
        rounding += action.lambda_rounding(d, k) * weight.abs();
        area += d.dual_area()[a];
    }
    if d.interior().is_empty() {
        return Residual::default();
    }
    let unit = scales.force_density * scales.displacement * area;
    Residual::largest(rayon::iter::once((work.abs() / unit, rounding / unit)))
}

/// `int phi_a` over vertices, triangle by triangle: what `|D_a|` must be by (4.17).
fn hat_integrals(d: &Discretization) -> Vec<f64> {
    let mut integrals = vec![0.0; d.mesh().points().len()];
    for (t, corners) in d.mesh().triangles().iter().enumerate() {
        for &a in corners {
            integrals[a] += d.mesh().triangle_area(t) / 3.0;
        }
    }
    integrals
}
