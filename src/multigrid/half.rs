//! One half of the decoupled problem, by truncated nonsmooth Newton multigrid with nested iteration (Graeser, Kornhuber,
//! J. Comput. Math. 27 (2009) 1).
//!
//! A cycle is a linear one on the coarser levels, truncated at the vertices that are pressed into contact, then projected Gauss-Seidel on the
//! finest level. Every part of it lowers the energy (why, is said with the [cycle](super::correction)); where the correction has been
//! cut off at the obstacle and the energy has not fallen, it is damped by an exact line search. Once the contact set stays, the cycles solve the linear system
//! of a step of the active set method.

use super::correction::CoarseLevels;
use super::driver::{self, Cycle, Damped};
use super::sweep::{Bounded, Found, Iterate};
use crate::multigrid::cholesky::NotFactored;
use crate::multigrid::hierarchy::Hierarchy;
use crate::qp::{Limits, Status};

/// The limit of cycles when none is given. Ten are enough on meshes of ordinary quality.
pub(crate) const MAX_CYCLES: usize = 200;

/// Cycles on a coarser level: its error is then well below that of its discretisation.
pub(super) const COARSE_CYCLES: usize = 2;

/// `K x - y = b`, `x >= lower`, `y >= 0`, `y'(x - lower) = 0` at the vertices that are not held. Vectors are over the rows of
/// the finest level.
pub(crate) struct HalfProblem {
    pub(crate) load: Vec<f64>,
    /// `x` at the vertices on the boundary.
    pub(crate) height: Vec<f64>,
    /// Zero for the gap; minus infinity for the sum, which has no obstacle.
    pub(crate) lower: f64,
    /// What makes of a residual a multiple of its unit.
    pub(crate) weight: Vec<f64>,
    /// The largest weighted residual that is as good as none.
    pub(crate) tolerance: f64,
    /// A guess to start from in place of nested iteration.
    pub(crate) start: Option<Vec<f64>>,
}

/// The last iterate, over the rows of the finest level.
pub(crate) struct HalfSolution {
    pub(crate) x: Vec<f64>,
    /// `K x - b` where `x` is at its bound, zero elsewhere.
    pub(crate) y: Vec<f64>,
    pub(crate) status: Status,
    /// Cycles on each level, from the coarsest.
    pub(crate) cycles: Vec<usize>,
    /// The energies of the iterates on the finest level.
    pub(crate) energies: Vec<f64>,
}

/// Solves, from the coarsest level to the finest.
pub(crate) fn solve(
    hierarchy: &Hierarchy,
    problem: HalfProblem,
    limits: &Limits,
) -> Result<HalfSolution, NotFactored> {
    let HalfProblem { load, height, lower, weight, tolerance, start } = problem;
    let (loads, heights) = hierarchy.lifted(load, height);
    let mut coarse = CoarseLevels::new(hierarchy, hierarchy.finest(), lower.is_finite())?;
    let unweighted = vec![1.0; hierarchy.levels()[hierarchy.finest() - 1].pattern.rows()];
    let on_level = |l: usize| {
        let (weight, tolerance) =
            if l == hierarchy.finest() { (&weight, tolerance) } else { (&unweighted, 0.0) };
        Bounded { level: &hierarchy.levels()[l], b: &loads[l], lower, weight, tolerance }
    };
    let mut cycles = Vec::new();
    let x = match start {
        Some(start) => on_level(hierarchy.finest()).feasible(start),
        None => {
            let mut x = vec![0.0; hierarchy.levels()[1].pattern.rows()];
            let coarser = heights.iter().enumerate().take(hierarchy.finest()).skip(1);
            for (l, height) in coarser {
                let limits = limits.with_iterations(COARSE_CYCLES);
                let found = Cycles::new(l, on_level(l), x, &mut coarse)?.run(&limits)?;
                cycles.extend(found.cycles);
                x = prolonged(hierarchy, l, found.x, height, lower);
            }
            x
        }
    };
    let finest = hierarchy.finest();
    let mut found = Cycles::new(finest, on_level(finest), x, &mut coarse)?.run(limits)?;
    cycles.append(&mut found.cycles);
    Ok(HalfSolution { cycles, ..found })
}

/// A function on level `l` with its boundary values, on the level above with zero ones.
fn prolonged(hierarchy: &Hierarchy, l: usize, mut x: Vec<f64>, height: &[f64], lower: f64) -> Vec<f64> {
    let [coarse, fine] = [l, l + 1].map(|l| &hierarchy.levels()[l]);
    for (i, x) in x.iter_mut().enumerate().filter(|&(i, _)| coarse.is_held(i)) {
        *x = height[i];
    }
    let at = |i: usize| if fine.is_held(i) { 0.0 } else { fine.transfer.prolong(i, &x).max(lower) };
    (0..fine.pattern.rows()).map(at).collect()
}

/// The cycles whose finest level is this one.
struct Cycles<'c, 'h> {
    finest: usize,
    bounded: Bounded<'c>,
    coarse: &'c mut CoarseLevels<'h>,
    x: Vec<f64>,
    /// The iterate before.
    last: Vec<f64>,
    frozen: Vec<bool>,
    changed: Vec<u32>,
}

impl<'c, 'h> Cycles<'c, 'h> {
    fn new(
        finest: usize,
        bounded: Bounded<'c>,
        x: Vec<f64>,
        coarse: &'c mut CoarseLevels<'h>,
    ) -> Result<Self, NotFactored> {
        coarse.restart(finest)?;
        let rows = x.len();
        Ok(Self {
            finest,
            bounded,
            coarse,
            x,
            last: vec![0.0; rows],
            frozen: vec![false; rows],
            changed: Vec::new(),
        })
    }

    /// Until the weighted residual is within the tolerance and the contact set stays.
    fn run(mut self, limits: &Limits) -> Result<HalfSolution, NotFactored> {
        let (tolerance, first) = (self.bounded.tolerance, self.relax(false));
        let (status, history) = driver::run(&mut self, first, tolerance, MAX_CYCLES, limits)?;
        let y = self.bounded.multiplier(&self.x);
        let energies = history.iter().map(|found| found.energy).collect();
        Ok(HalfSolution { x: self.x, y, cycles: vec![history.len() - 1], status, energies })
    }
}

impl Damped for Cycles<'_, '_> {
    fn relax(&mut self, is_corrected: bool) -> Found {
        std::mem::swap(&mut self.x, &mut self.last);
        let (correction, functional) = self.coarse.exchange(self.finest);
        let iterate = Iterate {
            x: &mut self.x,
            frozen: &mut self.frozen,
            changed: &mut self.changed,
            coarse: functional,
        };
        self.bounded.correct_and_relax(&self.last, is_corrected.then_some(correction), iterate)
    }

    fn energy_change(&self) -> f64 {
        self.bounded.energy_change(&self.last, &self.x)
    }

    fn damp(&mut self) {
        std::mem::swap(&mut self.x, &mut self.last);
        for i in self.changed.drain(..) {
            self.frozen[i as usize] ^= true;
        }
        let correction = self.coarse.correction(self.finest);
        self.bounded.line_search(&mut self.x, correction, &self.frozen, &mut self.last);
    }
}

impl Cycle for Cycles<'_, '_> {
    fn cycle(&mut self, energy: f64) -> Result<Found, NotFactored> {
        self.coarse.solve(self.finest, &self.frozen, &self.changed)?;
        self.changed.clear();
        Ok(self.correct(energy))
    }

    fn has_changed(&self) -> bool {
        !self.changed.is_empty()
    }
}
