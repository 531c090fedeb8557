//! The obstacle half on one level, and the repair of its contact set.

use sprs::CsMat;

use crate::discretization::PairDiscretization;
use crate::multigrid::cholesky::{Cholesky, NotFactored};
use crate::qp::{Limits, Status};
use crate::solver::repair::{CAUTION, ROUNDING, Repair, SLIGHT};

/// `K w - y = b`, `w >= 0`, `y >= 0`, `w'y = 0`.
pub(in crate::solver::pair) struct Obstacle {
    k: CsMat<f64>,
    b: Vec<f64>,
    /// The size of the terms that cancel in `b`.
    b_terms: Vec<f64>,
    /// What is overlooked of a gap below zero at first.
    slight: f64,
    cholesky: Cholesky,
}

/// A gap and its multiplier.
pub(in crate::solver::pair) struct Gap {
    pub(in crate::solver::pair) w: Vec<f64>,
    pub(in crate::solver::pair) y: Vec<f64>,
}

impl Obstacle {
    /// `scale` is the typical size of `w`.
    pub(in crate::solver::pair) fn new(
        k: CsMat<f64>,
        b: Vec<f64>,
        b_terms: Vec<f64>,
        scale: f64,
    ) -> Result<Self, NotFactored> {
        let cholesky = Cholesky::symbolic(k.clone())?;
        Ok(Self { k, b, b_terms, slight: SLIGHT * scale, cholesky })
    }

    /// Repairs a contact set until it is consistent: vertices that pull leave it, vertices that have passed through each other
    /// join it, those that have so by little last. Returns the result, whether it is consistent, and the number of repairs.
    pub(in crate::solver::pair) fn settle(
        &mut self,
        active: Vec<bool>,
        limits: &Limits,
    ) -> Result<(Gap, Status, usize), NotFactored> {
        self.settle_in_stages(&[self.slight, 0.0], active, limits)
    }

    /// Likewise, but slight gaps below zero are left as they are.
    pub(super) fn settle_roughly(
        &mut self,
        active: Vec<bool>,
        limits: &Limits,
    ) -> Result<(Gap, Status, usize), NotFactored> {
        self.settle_in_stages(&[self.slight], active, limits)
    }

    /// Repairs for each of the gaps `overlooked` in turn.
    fn settle_in_stages(
        &mut self,
        overlooked: &[f64],
        mut active: Vec<bool>,
        limits: &Limits,
    ) -> Result<(Gap, Status, usize), NotFactored> {
        let (mut stage, mut repair, mut repairs) = (0, Repair::default(), 0);
        loop {
            let gap = self.solve(&active)?;
            let mut wrong = self.wrong(&active, &gap, overlooked[stage]);
            while wrong.is_empty() && stage + 1 < overlooked.len() {
                (stage, repair) = (stage + 1, Repair::default());
                wrong = self.wrong(&active, &gap, overlooked[stage]);
            }
            if wrong.is_empty() {
                return Ok((gap, Status::Solved, repairs));
            }
            if let Some(status) = limits.reached(repairs + 1) {
                return Ok((gap, status, repairs));
            }
            repair.apply(&mut active, &wrong);
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

    /// The vertices whose sign is wrong beyond rounding, without gaps that are below zero by less than `overlooked`.
    pub(super) fn wrong(&self, active: &[bool], gap: &Gap, overlooked: f64) -> Vec<usize> {
        let terms =
            |i: usize| self.row(i, |k, j| (k * gap.w[j]).abs()) + self.b_terms[i].max(self.b[i].abs());
        let defect = |i: usize| match (active[i], gap.w[i] < -overlooked) {
            (true, _) => gap.y[i],
            // What cutting the gap off would leave of the row.
            (false, true) => self.row(i, |k, j| if j == i { k * gap.w[i] } else { 0.0 }),
            (false, false) => 0.0,
        };
        let is_wrong = |&i: &usize| {
            let defect = defect(i);
            defect < 0.0 && defect < -ROUNDING * terms(i)
        };
        (0..active.len()).filter(is_wrong).collect()
    }

    /// `K^-1 b`: the half without obstacle, by the same symbolic factorisation.
    pub(in crate::solver::pair) fn without_obstacle(&mut self, b: &[f64]) -> Result<Vec<f64>, NotFactored> {
        self.cholesky.refactor(self.k.data().iter().copied())?;
        self.cholesky.solve(b)
    }

    fn row(&self, i: usize, term: impl Fn(f64, usize) -> f64) -> f64 {
        self.k.outer_view(i).expect("an unknown has a row").iter().map(|(j, &k)| term(k, j)).sum()
    }
}

/// The vertices that touch, as displacements and multipliers have it.
pub(in crate::solver) fn guess(d: &PairDiscretization, u: &[Vec<f64>], multiplier: &[f64]) -> Vec<bool> {
    let scales = d.scales();
    let touches = |(&a, y): (&usize, &f64)| {
        let action = y / (d.dual_area()[a] * scales.force_density);
        action > CAUTION * (u[0][a] - u[1][a]) / scales.displacement
    };
    d.interior().iter().zip(multiplier).map(touches).collect()
}
