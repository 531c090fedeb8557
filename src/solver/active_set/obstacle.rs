//! The obstacle half on one level, and the repair of its contact set.

use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::time::Instant;

use sprs::CsMat;

use crate::discretization::Discretization;
use crate::qp::Status;
use crate::solver::cholesky::{Cholesky, NotFactored};

/// A multiplier below zero by less than this fraction of the terms that cancel in it is a zero, rounded.
const MULTIPLIER_ROUNDING: f64 = 256.0 * f64::EPSILON;

/// A gap below zero by less than this fraction of the displacements' scale is a zero, rounded: the error of a linear
/// solve, machine precision times a condition number of up to 1e4.
const GAP_ROUNDING: f64 = 1e-12;

/// A vertex is taken for touching when its multiplier is so much larger than its gap, each in units of the data. A guess
/// that is too small is repaired in fewer steps than one that is too large: all that has passed through is seen at once.
const CAUTION: f64 = 30.0;

/// When to stop although the contact set is not consistent yet.
pub(in crate::solver) struct Limits {
    /// Linear solves for the gap.
    pub(in crate::solver) steps: usize,
    pub(in crate::solver) deadline: Option<Instant>,
}

/// `K w - y = b`, `w >= 0`, `y >= 0`, `w'y = 0`.
pub(in crate::solver) struct Obstacle<'k> {
    k: &'k CsMat<f64>,
    b: Vec<f64>,
    /// The size of the terms that cancel in `b`.
    b_terms: Vec<f64>,
    /// Gaps below this have passed through.
    through: f64,
    cholesky: Cholesky,
}

/// A gap and its multiplier.
pub(in crate::solver) struct Gap {
    pub(in crate::solver) w: Vec<f64>,
    pub(in crate::solver) y: Vec<f64>,
}

impl<'k> Obstacle<'k> {
    /// `scale` is the typical size of `w`.
    pub(in crate::solver) fn new(
        k: &'k CsMat<f64>,
        b: Vec<f64>,
        b_terms: Vec<f64>,
        scale: f64,
    ) -> Result<Self, NotFactored> {
        Ok(Self { k, b, b_terms, through: -GAP_ROUNDING * scale, cholesky: Cholesky::symbolic(k.clone())? })
    }

    /// Repairs a contact set until it is consistent: vertices that pull leave it, vertices that have passed through each other
    /// join it. Returns the result, whether it is consistent, and the number of repairs.
    ///
    /// On meshes where `K` is an M-matrix this ends by itself. Elsewhere, and with rounding at vertices that touch without
    /// pushing, a contact set can come back: then only the last wrong vertex is repaired in a step, which always ends (Murty's
    /// rule for positive definite matrices), until fewer are wrong than ever before (Judice, Pires, Comput. Oper. Res. 21
    /// (1994) 587).
    pub(in crate::solver) fn settle(
        &mut self,
        mut active: Vec<bool>,
        limits: &Limits,
    ) -> Result<(Gap, Status, usize), NotFactored> {
        let (mut fewest, mut single, mut repairs) = (usize::MAX, false, 0);
        let mut seen = HashSet::new();
        loop {
            let gap = self.solve(&active)?;
            let wrong = self.wrong(&active, &gap);
            let status = if wrong.is_empty() {
                Some(Status::Solved)
            } else if repairs + 1 >= limits.steps {
                Some(Status::IterationLimit)
            } else if limits.deadline.is_some_and(|deadline| Instant::now() > deadline) {
                Some(Status::TimeLimit)
            } else {
                None
            };
            if let Some(status) = status {
                return Ok((gap, status, repairs));
            }
            single = wrong.len() >= fewest && (single || !seen.insert(fingerprint(&active)));
            fewest = fewest.min(wrong.len());
            let repaired = if single { &wrong[wrong.len() - 1..] } else { &wrong[..] };
            repaired.iter().for_each(|&i| active[i] = !active[i]);
            repairs += 1;
        }
    }

    /// `w = 0` where `active`, `y = 0` elsewhere. Rows and columns of active vertices are those of the identity, so that the
    /// pattern stays.
    pub(super) fn solve(&mut self, active: &[bool]) -> Result<Gap, NotFactored> {
        let entries = self.k.iter().map(|(&value, (i, j))| match (active[i] || active[j], i == j) {
            (false, _) => value,
            (true, on_diagonal) => f64::from(on_diagonal),
        });
        self.cholesky.refactor(entries)?;
        let right_side: Vec<f64> =
            self.b.iter().zip(active).map(|(&b, &active)| if active { 0.0 } else { b }).collect();
        let w = self.cholesky.solve(&right_side)?;
        let push = |i: usize| if active[i] { self.row(i, |k, j| k * w[j]) - self.b[i] } else { 0.0 };
        let y = (0..w.len()).map(push).collect();
        Ok(Gap { w, y })
    }

    /// The vertices whose sign is wrong beyond rounding.
    pub(super) fn wrong(&self, active: &[bool], gap: &Gap) -> Vec<usize> {
        let terms =
            |i: usize| self.row(i, |k, j| (k * gap.w[j]).abs()) + self.b_terms[i].max(self.b[i].abs());
        let is_wrong = |&i: &usize| {
            if active[i] {
                gap.y[i] < 0.0 && gap.y[i] < -MULTIPLIER_ROUNDING * terms(i)
            } else {
                gap.w[i] < self.through
            }
        };
        (0..active.len()).filter(is_wrong).collect()
    }

    /// `K^-1 b`: the half without obstacle, by the same symbolic factorisation.
    pub(in crate::solver) fn without_obstacle(&mut self, b: &[f64]) -> Result<Vec<f64>, NotFactored> {
        self.cholesky.refactor(self.k.data().iter().copied())?;
        self.cholesky.solve(b)
    }

    fn row(&self, i: usize, term: impl Fn(f64, usize) -> f64) -> f64 {
        self.k.outer_view(i).expect("an unknown has a row").iter().map(|(j, &k)| term(k, j)).sum()
    }
}

/// Tells contact sets apart; two that are taken for one cost single repairs, no more.
fn fingerprint(active: &[bool]) -> u64 {
    let mut hasher = DefaultHasher::new();
    active.hash(&mut hasher);
    hasher.finish()
}

/// The vertices that touch, as displacements and multipliers have it.
pub(in crate::solver) fn guess(
    d: &Discretization,
    [u1, u2]: &[Vec<f64>; 2],
    multiplier: &[f64],
) -> Vec<bool> {
    let scales = d.scales();
    let touches = |(&a, y): (&usize, &f64)| {
        let action = y / (d.dual_area()[a] * scales.force_density);
        action > CAUTION * (u1[a] - u2[a]) / scales.displacement
    };
    d.interior().iter().zip(multiplier).map(touches).collect()
}
