//! Local post-processing (4.5): the action as each membrane sees it.

use crate::discretization::{Displacement, PairDiscretization};
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;

/// Rounding leaves of a difference at most this many units in the last place of the terms that cancel in it: a row of
/// `K` has about seven entries, each the sum of two rounded contributions.
pub(super) const ROUNDINGS: f64 = 32.0;

/// The action recovered from displacements at one unknown. Unit: force per area.
#[derive(Debug, Clone, Copy)]
pub struct Action {
    /// `[lambda_1, lambda_2]` of (4.5): `(mu1 K u1 - F_1)_a / |D_a|` and `(F_2 - mu2 K u2)_a / |D_a|`.
    pub from_membrane: [f64; 2],
    /// What rounding may have left in each of them.
    pub rounding: [f64; 2],
    /// `lambda_h = (mu2 lambda_1 + mu1 lambda_2) / (mu1 + mu2)`: the combination that depends on the gap alone, so that
    /// a very stiff membrane does not spoil it. By Proposition 12, all three are the same.
    pub lambda: f64,
    /// What rounding may have left in `lambda`.
    pub lambda_rounding: f64,
}

impl Action {
    /// Recovers the action over unknowns from `displacement` (over vertices): a diagonal solve, fully local.
    ///
    /// # Panics
    /// When a displacement is not over the vertices of `d`.
    pub fn recover(d: &PairDiscretization, displacement: &Displacement) -> Vec<Self> {
        let at = |&a: &usize| Self::at(d, a, displacement);
        d.interior().par_iter().with_min_len(BLOCK).map(at).collect()
    }

    fn at(d: &PairDiscretization, a: usize, [u1, u2]: &Displacement) -> Self {
        let balance = d.balance(a, [u1, u2]);
        let per_area = |force: f64| force / d.dual_area()[a];
        let [mu1, mu2] = d.tension();
        let weighted = |[l1, l2]: [f64; 2]| mu2 / (mu1 + mu2) * l1 + mu1 / (mu1 + mu2) * l2;
        let from_membrane = [per_area(balance[0].imbalance), per_area(-balance[1].imbalance)];
        let rounding = balance.map(|balance| per_area(ROUNDINGS * f64::EPSILON * balance.terms));
        Self { from_membrane, rounding, lambda: weighted(from_membrane), lambda_rounding: weighted(rounding) }
    }
}
