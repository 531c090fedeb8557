//! The norm of `H^-1` by a Riesz lift.

use super::MeasureError;
use super::spaces::Spaces;
use crate::discretization::PairDiscretization;
use crate::fem::CutRule;
use crate::geometry::twice_signed_area;
use crate::mesh::{Mesh, SubTriangulation};
use crate::parallel::prelude::*;
use crate::parallel::{blocks_of, join};

/// Triangles that are integrated together: enough for all threads, few enough to need no memory.
const BATCH: usize = 1 << 16;

/// `||rho||_{-1} = sqrt((rho, z))` with `-Lap z = rho`, `z in H1_0`, where `z` is a P1 function on `S_h` refined.
///
/// On `T_h` itself the lift would be blind to all that is orthogonal to its hat functions: where `lambda` jumps, a quarter
/// to a third of the figure. On each triangle of `S_h` the piecewise constant `lambda_h` has one value, so `rho` is as
/// smooth there as the exact `lambda`, and is integrated with subdivision where that is not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DualNorm {
    /// The figure on `S_h` refined once.
    pub value: f64,
    /// The figure on `S_h`.
    pub coarser: f64,
    /// The norm on `S_h` of what the last subdivision at curves and corner changes in `rho`: by the triangle inequality
    /// a bound of what it changes in the figure.
    pub quadrature: f64,
}

impl DualNorm {
    /// What one refinement of the lift's mesh adds, `value - coarser`: an estimate of what is still missing.
    ///
    /// The spaces are nested, so the figures grow towards the norm, and the missing part of their squares is
    /// `|z - z_h|_1^2`. The estimate is on the safe side when each refinement halves that part at least; it falls by 4 on
    /// convex domains, by `2^(4/3)` at the corner of an L-shape.
    pub fn estimate(&self) -> f64 {
        self.value - self.coarser
    }
}

/// The norm of `rho(t, point)`, where `t` is the triangle of `S_h` that contains the point, with the lift on `S_h` refined
/// `refinements >= 1` times and once less.
pub(super) fn dual_norm(
    d: &PairDiscretization,
    sub: &SubTriangulation,
    rule: &CutRule,
    refinements: usize,
    rho: impl Fn(usize, [f64; 2]) -> f64 + Sync,
) -> Result<DualNorm, MeasureError> {
    let (spaces, mesh) = Spaces::new(d, sub, refinements)?;
    let parts = mesh.triangles().len() / sub.mesh().triangles().len();
    let [deep, change] = functionals(&mesh, rule, |t, point| rho(t / parts, point));
    // By far the largest mesh of all: its memory is for the lifts.
    drop(mesh);
    let [deep, change] = [deep, change].map(|functional| spaces.functional(&functional));
    let on_coarser = |functional| spaces.dual_norm(&spaces.restrict(functional));
    let (value, on_coarser) = join(|| spaces.dual_norm(&deep), || [on_coarser(&deep), on_coarser(&change)]);
    let [coarser, quadrature] = on_coarser;
    Ok(DualNorm { value: value?, coarser: coarser?, quadrature: quadrature? })
}

/// `int rho phi_a` over vertices, and what the last subdivision of the rule changes in it.
fn functionals(mesh: &Mesh, rule: &CutRule, rho: impl Fn(usize, [f64; 2]) -> f64 + Sync) -> [Vec<f64>; 2] {
    let shallower = rule.shallower();
    let on_triangle = |t: usize| {
        let corners = mesh.corners(t);
        let deep = against_hats(corners, rule, |point| rho(t, point));
        if rule.is_plain(corners) {
            return [deep, [0.0; 3]];
        }
        let shallow = against_hats(corners, &shallower, |point| rho(t, point));
        [deep, [0, 1, 2].map(|i| deep[i] - shallow[i])]
    };
    let mut sums = [vec![0.0; mesh.points().len()], vec![0.0; mesh.points().len()]];
    for batch in blocks_of(BATCH, mesh.triangles().len()) {
        let integrals: Vec<_> = batch.clone().into_par_iter().map(on_triangle).collect();
        for (corners, integrals) in mesh.triangles()[batch].iter().zip(integrals) {
            for (sum, integral) in sums.iter_mut().zip(integrals) {
                (0..3).for_each(|i| sum[corners[i]] += integral[i]);
            }
        }
    }
    sums
}

/// `int f phi_i` over a triangle, for the hat functions of its corners.
fn against_hats(corners: [[f64; 2]; 3], rule: &CutRule, f: impl Fn([f64; 2]) -> f64) -> [f64; 3] {
    let [a, b, c] = corners;
    let scale = 1.0 / twice_signed_area(corners);
    let mut integrals = [0.0; 3];
    rule.visit(corners, &mut |point, weight| {
        let value = scale * weight * f(point);
        integrals[0] += value * twice_signed_area([point, b, c]);
        integrals[1] += value * twice_signed_area([a, point, c]);
        integrals[2] += value * twice_signed_area([a, b, point]);
    });
    integrals
}

#[cfg(test)]
mod tests;
