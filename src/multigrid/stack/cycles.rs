//! Truncated nonsmooth Newton multigrid for a stack, with nested iteration (section 4 of the notes on stacks).
//!
//! A cycle is a correction in which membranes that are pressed together move as one, and those that are pressed against something that does
//! not move stay; then block Gauss-Seidel, at each vertex for all membranes at once. Every part of it lowers the energy: the correction
//! does by its construction, and where displacements have to be brought back into their order, by an exact line search.

use super::chain::Pool;
use super::coarse::CoarseLevels;
use super::conjugate::Conjugate;
use super::level::StackLevel;
use super::levels::StackLevels;
use super::partition::Partition;
use super::settle::{Measure, settle};
use super::sweep::Sweeps;
use crate::multigrid::cholesky::NotFactored;
use crate::multigrid::driver::{self, Cycle};
use crate::multigrid::sweep::Found;
use crate::qp::{Limits, Status};

/// The limit of cycles when none is given.
pub(crate) const MAX_CYCLES: usize = 100;

/// The pace has to lead to the tolerance in as many cycles; five to eight are enough on meshes of ordinary quality. On stretched
/// triangles, where more are needed, algebraic levels or another method are better.
const PACE: usize = 30;

/// Cycles on a coarser level: its error is then well below that of its discretisation.
const COARSE_CYCLES: usize = 2;

/// Sweeps before the correction, and after it.
const SWEEPS: usize = 2;

/// What is asked for.
pub(crate) struct StackGoal {
    /// What makes of the residual at a row of the finest level a fraction of the tolerance.
    pub(crate) weight: Vec<f64>,
    /// Displacements to start from, over the entries of the finest level.
    pub(crate) start: Vec<f64>,
    /// Whether they are a guess of the solution, in place of nested iteration.
    pub(crate) is_guess: bool,
}

/// The last iterate, over the entries of the finest level.
pub(crate) struct StackAnswer {
    /// The displacements, heights included.
    pub(crate) u: Vec<f64>,
    pub(crate) status: Status,
    /// Cycles on each level, from the coarsest.
    pub(crate) cycles: Vec<usize>,
    /// The energies of the iterates on the finest level.
    pub(crate) energies: Vec<f64>,
}

/// Solves, from the coarsest level to the finest.
pub(crate) fn solve(
    levels: &StackLevels,
    goal: StackGoal,
    limits: &Limits,
) -> Result<StackAnswer, NotFactored> {
    let finest = levels.finest();
    let mut coarse = CoarseLevels::new(levels);
    let mut cycles = Vec::new();
    let StackGoal { weight, start, is_guess } = goal;
    let first = if is_guess { finest } else { levels.first() };
    let n = levels.membranes();
    let mut u = (first + 1..=finest).rev().fold(start, |u, l| {
        let transfer = &levels.hierarchy().levels()[l].transfer;
        (0..transfer.coarse_rows())
            .flat_map(|a| (0..n).map(move |i| (a, i)))
            .map(|(a, i)| u[transfer.same_vertex(a) * n + i])
            .collect()
    });
    for l in first..finest {
        let level = levels.problem(l);
        let weight = vec![1.0; level.rows()];
        let measure = Measure { weight: &weight, tolerance: 0.0 };
        let mut on_level = Cycles::new(levels, l, &u, &mut coarse);
        let first = on_level.relax(measure);
        let limits = limits.with_iterations(COARSE_CYCLES);
        let (_, history) = driver::run(&mut Measured(&mut on_level, measure), first, 0.0, PACE, &limits)?;
        cycles.push(history.len() - 1);
        u = prolonged(levels, l, &on_level.u());
    }
    let measure = Measure { weight: &weight, tolerance: 1.0 };
    let mut on_level = Cycles::new(levels, finest, &u, &mut coarse);
    let first = on_level.relax(measure);
    let (status, history) = driver::run(&mut Measured(&mut on_level, measure), first, 1.0, PACE, limits)?;
    cycles.push(history.len() - 1);
    let energies = history.iter().map(|found| found.energy).collect();
    Ok(StackAnswer { u: on_level.u(), status, cycles, energies })
}

/// Displacements on level `l`, on the level above.
fn prolonged(levels: &StackLevels, l: usize, u: &[f64]) -> Vec<f64> {
    let n = levels.membranes();
    let level = levels.problem(l + 1);
    let transfer = &levels.hierarchy().levels()[l + 1].transfer;
    let mut fine = vec![0.0; level.rows() * n];
    for (a, fine) in fine.chunks_exact_mut(n).enumerate() {
        transfer.for_each_parent(a, |b, weight| {
            fine.iter_mut().zip(&u[b * n..]).for_each(|(fine, u)| *fine += weight * u);
        });
    }
    fine
}

/// The cycles whose finest level is this one.
struct Cycles<'c, 'l> {
    l: usize,
    level: &'l StackLevel,
    sweeps: Sweeps<'l>,
    coarse: &'c mut CoarseLevels<'l>,
    partition: Partition,
    changed: Vec<u32>,
    x: Vec<f64>,
    r: Vec<f64>,
    conjugate: Conjugate,
}

impl<'c, 'l> Cycles<'c, 'l> {
    /// From the displacements in their cone that are nearest to these.
    fn new(levels: &'l StackLevels, l: usize, u: &[f64], coarse: &'c mut CoarseLevels<'l>) -> Self {
        let level = levels.problem(l);
        let n = level.membranes();
        let mut x = u.to_vec();
        let mut pool = Pool::new(n);
        x.chunks_exact_mut(n).enumerate().for_each(|(a, x)| level.project(a, x, &mut pool));
        let entries = x.len();
        coarse.restart(l);
        Self {
            l,
            level,
            sweeps: Sweeps::new(level),
            coarse,
            partition: Partition::new(level.rows(), n),
            changed: Vec::new(),
            x,
            r: vec![0.0; entries],
            conjugate: Conjugate::new(entries),
        }
    }

    /// The displacements, heights included.
    fn u(&self) -> Vec<f64> {
        self.x
            .iter()
            .zip(&self.level.height)
            .zip(&self.level.held)
            .map(|((&x, &height), &held)| if held { height } else { x })
            .collect()
    }

    /// Sweeps, and what they have left.
    fn relax(&mut self, measure: Measure) -> Found {
        for _ in 0..SWEEPS {
            self.sweeps.relax(&mut self.x, false);
        }
        let (found, changed) =
            settle(self.level, &self.sweeps, &self.x, &mut self.r, &mut self.partition, measure);
        self.changed = changed;
        found
    }

    /// Adds the correction, as far as it lowers the energy. Returns whether displacements had to be put in order.
    fn correct(&mut self) -> Result<(), NotFactored> {
        let Self { l, level, sweeps, coarse, partition, x, r, conjugate, .. } = self;
        let residual = r.clone();
        conjugate.solve((*l, level), sweeps, coarse, partition, r)?;
        let n = level.membranes();
        let mut pool = Pool::new(n);
        let mut is_cut = false;
        let mut v = vec![0.0; n];
        // From here on, the correction is the step to the nearest displacements in their cone.
        for (a, (x, c)) in x.chunks_exact(n).zip(conjugate.correction.chunks_exact_mut(n)).enumerate() {
            v.iter_mut().zip(x).zip(&*c).for_each(|((v, x), c)| *v = x + c);
            level.project(a, &mut v, &mut pool);
            for ((v, x), c) in v.iter().zip(x).zip(c) {
                is_cut |= *v != x + *c;
                *c = v - x;
            }
        }
        let step = if is_cut { sweeps.best_step(&conjugate.correction, &residual, r) } else { 1.0 };
        for (a, (x, c)) in x.chunks_exact_mut(n).zip(conjugate.correction.chunks_exact(n)).enumerate() {
            x.iter_mut().zip(c).for_each(|(x, c)| *x += step * c);
            level.project(a, x, &mut pool);
        }
        Ok(())
    }
}

/// With the measure of residuals.
struct Measured<'m, 'c, 'l>(&'m mut Cycles<'c, 'l>, Measure<'m>);

impl Cycle for Measured<'_, '_, '_> {
    fn cycle(&mut self, _: f64) -> Result<Found, NotFactored> {
        let Self(cycles, measure) = self;
        cycles.coarse.follow(cycles.l, cycles.level, &cycles.partition, &cycles.changed)?;
        cycles.correct()?;
        for _ in 0..SWEEPS {
            cycles.sweeps.relax(&mut cycles.x, true);
        }
        Ok(cycles.relax(*measure))
    }

    fn has_changed(&self) -> bool {
        !self.0.changed.is_empty()
    }
}
