//! Multigrid on the decoupled problem.

#[cfg(test)]
mod tests;

use web_time::Instant;

use super::decoupled::Decoupled;
use super::{
    Candidate, ContactSolver, PreparedSolver, SolverError, SolverOptions, Stalled, StartingPoint, Statistics,
};
use crate::discretization::PairDiscretization;
use crate::multigrid::half::{HalfProblem, MAX_CYCLES, solve};
use crate::multigrid::hierarchy::Hierarchy;
use crate::qp::Status;

const NAME: &str = "multigrid";

/// Both halves may miss the tolerance by as much: their residuals add up in those of the membranes.
const SHARE: f64 = 0.5;

/// The contact problem decoupled; both halves by multigrid, one on each of two threads.
///
/// Truncated nonsmooth Newton multigrid for the gap, plain multigrid for the sum, on the refinements that made the mesh and
/// on algebraic levels below them; on algebraic levels alone where it stalls on those, as on stretched triangles; nested
/// iteration from the coarsest level. The cost of a cycle is linear, and the number
/// of cycles does not depend on the size of the mesh. The energy falls in every cycle. It ends when the contact set stays and
/// the residuals are within the tolerance. Results do not depend on the number of threads.
#[derive(Debug, Clone, Copy, Default)]
pub struct Multigrid;

impl ContactSolver for Multigrid {
    fn name(&self) -> &str {
        NAME
    }

    fn solve(&mut self, d: &PairDiscretization, options: &SolverOptions) -> Result<Candidate, SolverError> {
        PreparedMultigrid::new(d).solve(options)
    }

    fn prepare<'s>(&'s mut self, d: &'s PairDiscretization) -> Box<dyn PreparedSolver + 's> {
        Box::new(PreparedMultigrid::new(d))
    }
}

/// Multigrid for one discretization, whose levels are made once.
pub(super) struct PreparedMultigrid<'d> {
    d: &'d PairDiscretization,
    hierarchy: Option<Hierarchy>,
    /// Levels that are not tried again: those of the refinements, once it has stalled on them.
    stalled: Vec<Stalled>,
}

impl<'d> PreparedMultigrid<'d> {
    pub(super) fn new(d: &'d PairDiscretization) -> Self {
        Self { d, hierarchy: None, stalled: Vec::new() }
    }

    /// Solves on the levels that there are, else on those that are made by `levels`; the time limit counts from `start`.
    fn attempt(
        &mut self,
        levels: fn(&PairDiscretization) -> Hierarchy,
        options: &SolverOptions,
        start: Instant,
    ) -> Result<Candidate, SolverError> {
        let begin = Instant::now();
        let hierarchy = self.hierarchy.get_or_insert_with(|| levels(self.d));
        let setup_seconds = begin.elapsed().as_secs_f64();
        let mut candidate = solve_on(hierarchy, self.d, options, start)?;
        candidate.statistics.setup_seconds = setup_seconds;
        candidate.statistics.solve_seconds = begin.elapsed().as_secs_f64() - setup_seconds;
        Ok(candidate)
    }
}

impl PreparedSolver for PreparedMultigrid<'_> {
    fn solve(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError> {
        options.check()?;
        let start = Instant::now();
        let mut candidate = self.attempt(Hierarchy::new, options, start)?;
        candidate.statistics.stalled.clone_from(&self.stalled);
        let refinements = self.hierarchy.as_ref().map_or(0, Hierarchy::refinements);
        if candidate.statistics.status != Status::Stalled || refinements == 0 {
            return Ok(candidate);
        }
        self.hierarchy = None;
        let mut on_algebraic_levels = self.attempt(Hierarchy::algebraic, options, start)?;
        let method = format!("{NAME} on levels of {refinements} refinements");
        on_algebraic_levels.statistics = on_algebraic_levels.statistics.after(method, candidate.statistics);
        self.stalled.clone_from(&on_algebraic_levels.statistics.stalled);
        Ok(on_algebraic_levels)
    }
}

/// Solves on these levels; the time limit counts from `start`. The seconds in the statistics are left to others.
fn solve_on(
    hierarchy: &Hierarchy,
    d: &PairDiscretization,
    options: &SolverOptions,
    start: Instant,
) -> Result<Candidate, SolverError> {
    let decoupled = Decoupled::new(d);
    let [gap, sum] = halves(hierarchy, &decoupled, d, options);
    let limits = options.limits(MAX_CYCLES, start);
    let (gap, sum) =
        crate::parallel::join(|| solve(hierarchy, gap, &limits), || solve(hierarchy, sum, &limits));
    let (gap, sum) = (gap?, sum?);
    let level_iterations: Vec<usize> = gap.cycles.iter().zip(&sum.cycles).map(|(a, b)| *a.max(b)).collect();
    let (w, (s, y)) = crate::parallel::join(
        || hierarchy.to_vertices(&gap.x),
        || (hierarchy.to_vertices(&sum.x), hierarchy.to_vertices(&gap.y)),
    );
    let status = if gap.status == Status::Solved { sum.status } else { gap.status };
    Ok(Candidate {
        displacement: decoupled.recombine(&s, &w),
        multiplier: d.interior().iter().map(|&a| decoupled.gap_tension() * y[a]).collect(),
        statistics: Statistics {
            iterations: level_iterations.last().copied().unwrap_or(0),
            level_iterations,
            energies: gap.energies,
            ..Statistics::of(NAME, status)
        },
    })
}

/// The gap and the sum.
fn halves(
    hierarchy: &Hierarchy,
    decoupled: &Decoupled,
    d: &PairDiscretization,
    options: &SolverOptions,
) -> [HalfProblem; 2] {
    let force = SHARE * options.tolerance * d.scales().force_density;
    let start = options.warm_start.as_ref().filter(|start| start.fits(d));
    let [mu1, mu2] = d.tension();
    let guess = |combine: &(dyn Fn(&StartingPoint, usize) -> f64 + Sync)| {
        start.map(|start| hierarchy.to_rows(|a| combine(start, a)))
    };
    let gap = HalfProblem {
        load: hierarchy.to_rows(|a| decoupled.gap_load(a)),
        height: hierarchy.to_rows(|a| d.height()[a]),
        lower: 0.0,
        weight: hierarchy.to_rows(|a| decoupled.gap_tension() / (force * d.dual_area()[a])),
        start: guess(&|start, a| start.displacement[0][a] - start.displacement[1][a]),
    };
    let sum = HalfProblem {
        load: hierarchy.to_rows(|a| decoupled.sum_load(a)),
        height: hierarchy.to_rows(|a| decoupled.sum_height(a)),
        lower: f64::NEG_INFINITY,
        weight: hierarchy.to_rows(|a| 1.0 / (force * d.dual_area()[a])),
        start: guess(&|start, a| mu1 * start.displacement[0][a] + mu2 * start.displacement[1][a]),
    };
    [gap, sum]
}
