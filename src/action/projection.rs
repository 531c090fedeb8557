//! From a candidate within the tolerance to a pair and an action in their cones, complementary to the last bit.

use super::Action;
use crate::discretization::{Displacement, PairDiscretization};
use crate::mesh::VertexKind;
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;

/// A pair in `K_gh` (3.3) and an action in `Lambda_h` (4.2) with `lambda_a (u1 - u2)(a) = 0` (4.8), all exactly.
///
/// At each interior vertex the candidate says whether the membranes touch: they do where the gap is zero, where closing it
/// would change the action by less than its rounding, and where it is smaller than the multiplier, both relative to the data.
/// There the gap is closed and `mu1 u1 + mu2 u2` kept; the action is (4.5) of these displacements, without what rounding
/// explains and cut off at zero. Everywhere else there is a gap, and the action is zero. On the boundary the pair has its
/// data.
///
/// **Why this needs no tolerance of its own.** Of gap and multiplier the smaller one, in units of the data, becomes zero.
/// Where both are positive, the square of what is cut off is at most their product, which `complementarity` bounds;
/// a gap below zero is in `primal`, a multiplier below zero in `dual_sign`, and the noise of an action where the multiplier
/// is zero in `stationarity`, all measured on the candidate. So no bad candidate becomes a good one. Multigrid, the
/// active set method and every polished answer have one of the two equal to zero at each vertex already: their displacements
/// stay as they are, bit by bit, and what is cut off of the action is within the tolerance. An interior-point answer
/// at the tolerance `t` has both of the size `sqrt(t)` at the free boundary; residuals of the projected pair would then be
/// of that size over the square of the mesh size, although its energy is wrong by `t` only. That is no reason to reject
/// the answer, but one to polish it: [`CutOff`] tells what was cut off, and the bound of the error is one of what is
/// handed out.
pub(super) struct Projection {
    pub(super) displacement: Displacement,
    /// Over vertices.
    pub(super) lambda: Vec<f64>,
    /// Over vertices.
    pub(super) contact: Vec<bool>,
    pub(super) cut_off: CutOff,
    /// What was projected, unless it was complementary already.
    pub(super) before: Option<Before>,
}

/// Displacements and multipliers per dual area, over vertices, as they were certified.
#[derive(Debug, Clone)]
pub(super) struct Before {
    pub(super) displacement: Displacement,
    pub(super) lambda: Vec<f64>,
}

/// What a candidate has lost on its way to a solution, relative to the [`Scales`](crate::discretization::Scales) of the data.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct CutOff {
    /// The largest gap that was closed, overlap that was removed, or error of a boundary value. Zero for an answer with an
    /// exact contact set.
    pub gap: f64,
    /// The largest action, of either sign, that was set to zero.
    pub action: f64,
}

impl Projection {
    /// Of a candidate whose vectors fit `d`, and the action recovered from its displacements.
    pub(super) fn new(
        d: &PairDiscretization,
        mut displacement: Displacement,
        multiplier: &[f64],
        mut action: Vec<Action>,
    ) -> Self {
        let touching = touching(d, &displacement, multiplier, &action);
        let before = Before::new(d, &displacement, multiplier);
        let moved = take_data_of_boundary(d, &mut displacement);
        let moved = close_gaps(d, &touching, &mut displacement).max(moved);
        if moved > 0.0 {
            action = Action::recover(d, &displacement);
        }
        let mut contact = vec![false; d.mesh().points().len()];
        let mut lambda = vec![0.0; contact.len()];
        let mut cut_off: f64 = 0.0;
        for ((&a, touches), action) in d.interior().iter().zip(touching).zip(action) {
            contact[a] = touches;
            let Action { lambda: recovered, lambda_rounding, .. } = action;
            if touches && recovered > lambda_rounding {
                lambda[a] = recovered;
            } else {
                cut_off = cut_off.max(recovered.abs());
            }
        }
        let scales = d.scales();
        let cut_off = CutOff { gap: moved / scales.displacement, action: cut_off / scales.force_density };
        Self { displacement, lambda, contact, cut_off, before }
    }
}

impl Before {
    fn new(d: &PairDiscretization, displacement: &Displacement, multiplier: &[f64]) -> Option<Self> {
        let [u1, u2] = displacement;
        let held =
            |a: usize| d.mesh().kind()[a] == VertexKind::Interior || (u1[a], u2[a]) == (d.height()[a], 0.0);
        let is_complementary = |(&a, &y): (&usize, &f64)| u1[a] == u2[a] || (u1[a] > u2[a] && y == 0.0);
        if d.interior().par_iter().zip(multiplier).with_min_len(BLOCK).all(is_complementary)
            && (0..u1.len()).into_par_iter().with_min_len(BLOCK).all(held)
        {
            return None;
        }
        let densities: Vec<f64> =
            d.interior().iter().zip(multiplier).map(|(&a, y)| y / d.dual_area()[a]).collect();
        Some(Self { displacement: displacement.clone(), lambda: d.extend(&densities, |_| 0.0) })
    }
}

/// Whether the membranes touch, over unknowns.
fn touching(
    d: &PairDiscretization,
    [u1, u2]: &Displacement,
    multiplier: &[f64],
    action: &[Action],
) -> Vec<bool> {
    let scales = d.scales();
    let [mu1, mu2] = d.tension();
    let gap_tension = mu1 * (mu2 / (mu1 + mu2));
    let touches = |(k, &a): (usize, &usize)| {
        let gap = u1[a] - u2[a];
        let area = d.dual_area()[a];
        let is_below = || gap / scales.displacement < multiplier[k] / (area * scales.force_density);
        let is_rounding = || gap_tension * d.stiffness_diagonal(a) * gap <= action[k].lambda_rounding * area;
        gap <= 0.0 || is_below() || is_rounding()
    };
    d.interior().par_iter().enumerate().with_min_len(BLOCK).map(touches).collect()
}

/// `u1 = g_h` and `u2 = 0` at the boundary vertices, zero at unused ones: the largest change of the gap.
fn take_data_of_boundary(d: &PairDiscretization, [u1, u2]: &mut Displacement) -> f64 {
    let mut changed: f64 = 0.0;
    let kinds = d.mesh().kind().iter().enumerate();
    for (a, _) in kinds.filter(|&(_, &kind)| kind != VertexKind::Interior) {
        changed = changed.max((u1[a] - d.height()[a]).abs()).max(u2[a].abs());
        (u1[a], u2[a]) = (d.height()[a], 0.0);
    }
    changed
}

/// Makes `u1 = u2` where they touch and keeps `mu1 u1 + mu2 u2`: the largest gap or overlap that there was.
fn close_gaps(d: &PairDiscretization, touching: &[bool], [u1, u2]: &mut Displacement) -> f64 {
    let [mu1, mu2] = d.tension();
    let share = [mu1 / (mu1 + mu2), mu2 / (mu1 + mu2)];
    let mut closed: f64 = 0.0;
    for (&a, &touches) in d.interior().iter().zip(touching) {
        if touches && u1[a] != u2[a] {
            closed = closed.max((u1[a] - u2[a]).abs());
            let together = share[0] * u1[a] + share[1] * u2[a];
            (u1[a], u2[a]) = (together, together);
        }
    }
    closed
}
