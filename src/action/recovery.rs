//! Local post-processing (4.5): the action as each membrane sees it.

use crate::discretization::Discretization;

/// Rounding leaves of a difference at most this many units in the last place of the terms that cancel in it: a row of
/// `K` has about seven entries, each the sum of two rounded contributions.
const ROUNDINGS: f64 = 32.0;

/// The action recovered from displacements, over unknowns. Unit: force per area.
#[derive(Debug, Clone)]
pub struct Action {
    /// `[lambda_1, lambda_2]` of (4.5): `(mu1 K u1 - F_1)_a / |D_a|` and `(F_2 - mu2 K u2)_a / |D_a|`.
    pub from_membrane: [Vec<f64>; 2],
    /// What rounding may have left in each of them.
    pub rounding: [Vec<f64>; 2],
    /// `lambda_h = (mu2 lambda_1 + mu1 lambda_2) / (mu1 + mu2)`: the combination that depends on the gap alone, so that
    /// a very stiff membrane does not spoil it. By Proposition 12, all three are the same.
    pub lambda: Vec<f64>,
}

impl Action {
    /// Recovers the action from `displacement` (over vertices): a diagonal solve, fully local.
    pub fn recover(d: &Discretization, displacement: &[Vec<f64>; 2]) -> Self {
        let per_area = |forces: Vec<f64>, factor: f64| -> Vec<f64> {
            d.interior().iter().zip(forces).map(|(&a, force)| factor * force / d.dual_area()[a]).collect()
        };
        let [u1, u2] = displacement;
        let from_membrane = [per_area(d.imbalance(0, u1), 1.0), per_area(d.imbalance(1, u2), -1.0)];
        let ulps = ROUNDINGS * f64::EPSILON;
        let rounding = [0, 1].map(|i| per_area(d.imbalance_terms(i, displacement), ulps));
        let lambda =
            from_membrane[0].iter().zip(&from_membrane[1]).map(|(&l1, &l2)| weighted(d, l1, l2)).collect();
        Self { from_membrane, rounding, lambda }
    }

    /// What rounding may have left in `lambda[k]`.
    pub(crate) fn lambda_rounding(&self, d: &Discretization, k: usize) -> f64 {
        weighted(d, self.rounding[0][k], self.rounding[1][k])
    }
}

/// `(mu2 l1 + mu1 l2) / (mu1 + mu2)`.
fn weighted(d: &Discretization, l1: f64, l2: f64) -> f64 {
    let [mu1, mu2] = d.tension();
    mu2 / (mu1 + mu2) * l1 + mu1 / (mu1 + mu2) * l2
}
