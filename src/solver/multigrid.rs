//! Multigrid.

#[cfg(test)]
mod tests;

use web_time::Instant;

use super::{Candidate, ContactSolver, PreparedSolver, SolverError, SolverOptions, Stalled, pair, stack};
use crate::discretization::{Discretization, PairDiscretization, StackDiscretization, Structure};
use crate::mesh::Mesh;
use crate::multigrid::hierarchy::{Genealogy, Hierarchy};
use crate::qp::Status;

const NAME: &str = "multigrid";

/// The pair decoupled, both halves by multigrid, one on each of two threads; or one membrane with at most one obstacle.
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

    fn solve_pair(
        &mut self,
        d: &PairDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError> {
        PreparedMultigrid::new(Structure::Pair(d)).solve(options)
    }

    fn solve_stack(
        &mut self,
        d: &StackDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError> {
        PreparedMultigrid::new(d.into()).solve(options)
    }

    fn prepare<'s>(&'s mut self, d: &'s Discretization) -> Box<dyn PreparedSolver + 's> {
        Box::new(PreparedMultigrid::new(d.structure()))
    }
}

/// The levels of what it solves.
fn levels(structure: Structure, genealogy: &Genealogy) -> Result<Hierarchy, SolverError> {
    match structure {
        Structure::Pair(d) => Ok(Hierarchy::of_pair(d, genealogy)),
        Structure::Obstacle(d) => {
            let is_free: Vec<bool> =
                (0..d.mesh().points().len()).map(|a| d.unknown(1, a).is_some()).collect();
            Ok(Hierarchy::over(&d.matrix(1), &is_free, genealogy))
        }
        Structure::Coupled(_) => Err(SolverError::Coupled),
    }
}

/// Multigrid for one discretization, whose levels are made once.
pub(super) struct PreparedMultigrid<'d> {
    structure: Structure<'d>,
    hierarchy: Option<Hierarchy>,
    /// Levels that are not tried again: those of the refinements, once it has stalled on them.
    stalled: Vec<Stalled>,
}

impl<'d> PreparedMultigrid<'d> {
    pub(super) fn new(structure: Structure<'d>) -> Self {
        Self { structure, hierarchy: None, stalled: Vec::new() }
    }

    /// Solves on the levels that there are, else on those that are made by this genealogy; the time limit counts from `start`.
    fn attempt(
        &mut self,
        genealogy: impl FnOnce(&Mesh) -> Genealogy,
        options: &SolverOptions,
        start: Instant,
    ) -> Result<Candidate, SolverError> {
        let begin = Instant::now();
        let hierarchy = match &mut self.hierarchy {
            Some(hierarchy) => hierarchy,
            none => none.insert(levels(self.structure, &genealogy(self.structure.mesh()))?),
        };
        let setup_seconds = begin.elapsed().as_secs_f64();
        let mut candidate = match self.structure {
            Structure::Pair(d) => pair::multigrid::solve_on(hierarchy, d, NAME, options, start),
            Structure::Obstacle(d) | Structure::Coupled(d) => {
                stack::multigrid::solve_on(hierarchy, d, NAME, options, start)
            }
        }?;
        candidate.statistics.setup_seconds = setup_seconds;
        candidate.statistics.solve_seconds = begin.elapsed().as_secs_f64() - setup_seconds;
        Ok(candidate)
    }
}

impl PreparedSolver for PreparedMultigrid<'_> {
    fn solve(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError> {
        options.check()?;
        let start = Instant::now();
        let mut candidate = self.attempt(Genealogy::of, options, start)?;
        candidate.statistics.stalled.clone_from(&self.stalled);
        let refinements = self.hierarchy.as_ref().map_or(0, Hierarchy::refinements);
        if candidate.statistics.status != Status::Stalled || refinements == 0 {
            return Ok(candidate);
        }
        // On stretched triangles coarser meshes are no good: their neighbours along the long sides are hardly coupled.
        self.hierarchy = None;
        let unknown = |mesh: &Mesh| Genealogy::unknown(mesh.points().len());
        let mut on_algebraic_levels = self.attempt(unknown, options, start)?;
        let method = format!("{NAME} on levels of {refinements} refinements");
        on_algebraic_levels.statistics = on_algebraic_levels.statistics.after(method, candidate.statistics);
        self.stalled.clone_from(&on_algebraic_levels.statistics.stalled);
        Ok(on_algebraic_levels)
    }
}
