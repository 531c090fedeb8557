//! Multigrid on the decoupled problem.

#[cfg(test)]
mod tests;

use std::time::Instant;

use super::decoupled::Decoupled;
use super::{Candidate, ContactSolver, SolverError, SolverOptions, StartingPoint, Statistics};
use crate::discretization::Discretization;
use crate::multigrid::half::{HalfProblem, Limits, MAX_CYCLES, solve};
use crate::multigrid::hierarchy::Hierarchy;
use crate::qp::Status;

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
        "multigrid"
    }

    fn solve(&mut self, d: &Discretization, options: &SolverOptions) -> Result<Candidate, SolverError> {
        options.check()?;
        let start = Instant::now();
        let candidate = self.solve_on(Hierarchy::new, d, options, start)?;
        let has_stalled = candidate.statistics.status == Status::Stalled;
        if has_stalled && !d.mesh().ancestry().is_empty() {
            return self.solve_on(Hierarchy::algebraic, d, options, start);
        }
        Ok(candidate)
    }
}

impl Multigrid {
    /// Solves on the levels that are made like this; the time limit counts from `start`.
    fn solve_on(
        &self,
        levels: fn(&Discretization) -> Hierarchy,
        d: &Discretization,
        options: &SolverOptions,
        start: Instant,
    ) -> Result<Candidate, SolverError> {
        let hierarchy = levels(d);
        let setup_seconds = start.elapsed().as_secs_f64();
        let decoupled = Decoupled::new(d);
        let [gap, sum] = halves(&hierarchy, &decoupled, d, options);
        let limits = Limits {
            cycles: options.max_iterations.unwrap_or(MAX_CYCLES),
            deadline: options.deadline(start),
        };
        let (gap, sum) =
            crate::parallel::join(|| solve(&hierarchy, gap, &limits), || solve(&hierarchy, sum, &limits));
        let (gap, sum) = (gap?, sum?);
        let level_iterations: Vec<usize> =
            gap.cycles.iter().zip(&sum.cycles).map(|(a, b)| *a.max(b)).collect();
        let (w, (s, y)) = crate::parallel::join(
            || hierarchy.to_vertices(&gap.x),
            || (hierarchy.to_vertices(&sum.x), hierarchy.to_vertices(&gap.y)),
        );
        Ok(Candidate {
            displacement: decoupled.recombine(&s, &w),
            multiplier: d.interior().iter().map(|&a| decoupled.gap_tension() * y[a]).collect(),
            statistics: Statistics {
                status: if gap.status == Status::Solved { sum.status } else { gap.status },
                iterations: level_iterations.last().copied().unwrap_or(0),
                level_iterations,
                energies: gap.energies,
                setup_seconds,
                solve_seconds: start.elapsed().as_secs_f64() - setup_seconds,
                ..Statistics::of(self.name())
            },
        })
    }
}

/// The gap and the sum.
fn halves(
    hierarchy: &Hierarchy,
    decoupled: &Decoupled,
    d: &Discretization,
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
