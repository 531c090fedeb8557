//! Multigrid.

#[cfg(test)]
mod tests;

use std::borrow::Cow;

use web_time::Instant;

use super::{Candidate, ContactSolver, PreparedSolver, SolverError, SolverOptions, Stalled, pair, stack};
use crate::discretization::{Discretization, PairDiscretization, StackDiscretization, Structure};
use crate::fem::StiffnessMatrix;
use crate::multigrid::hierarchy::{Genealogy, inside};
use crate::multigrid::membrane::MembraneLevels;
use crate::multigrid::stack::StackLevels;
use crate::qp::Status;

const NAME: &str = "multigrid";

/// The pair decoupled, both halves by multigrid at once; one membrane with at most one obstacle; or any other stack, all membranes at
/// once.
///
/// Truncated nonsmooth Newton multigrid for the gap, plain multigrid for the sum, on the refinements that made the mesh and
/// on algebraic levels below them; on algebraic levels alone where it stalls on those, as on stretched triangles; nested
/// iteration from the coarsest level. Inside the triangles of a coarse mesh that has been refined uniformly, levels are lattices of which
/// nothing is stored. The cost of a cycle is linear, and the number
/// of cycles does not depend on the size of the mesh. The energy falls in every cycle. It ends when the contact set stays and
/// the residuals are within the tolerance. Results do not depend on the number of threads.
///
/// In a stack, membranes that are pressed together move as one in the corrections, which are a few steps of conjugate gradients with
/// a cycle as their preconditioner.
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
enum Levels<'d> {
    /// Of one matrix.
    One(MembraneLevels<'d>),
    /// Of all membranes together.
    Coupled(StackLevels),
}

impl<'d> Levels<'d> {
    /// Those that follow the refinements that made the mesh, as far as they go, or algebraic ones.
    fn new(structure: Structure<'d>, coarsening: Coarsening) -> Self {
        let mesh = structure.mesh();
        let one = |k: Cow<'d, StiffnessMatrix>, is_free: &[bool]| match coarsening {
            Coarsening::Refinements => MembraneLevels::new(mesh, k, is_free),
            Coarsening::Algebraic => MembraneLevels::algebraic(&k, is_free),
        };
        match structure {
            Structure::Pair(d) => Self::One(one(Cow::Borrowed(d.stiffness()), &inside(mesh))),
            Structure::Obstacle(d) => {
                let is_free: Vec<bool> =
                    (0..mesh.points().len()).map(|a| d.unknown(1, a).is_some()).collect();
                Self::One(one(Cow::Owned(d.matrix(1)), &is_free))
            }
            Structure::Coupled(d) => {
                let genealogy = match coarsening {
                    Coarsening::Refinements => Genealogy::of(mesh),
                    Coarsening::Algebraic => Genealogy::unknown(mesh.points().len()),
                };
                Self::Coupled(StackLevels::new(d, &genealogy))
            }
        }
    }

    /// How many of them follow the refinements that made the mesh.
    fn refinements(&self) -> usize {
        match self {
            Self::One(levels) => levels.refinements(),
            Self::Coupled(levels) => levels.hierarchy().refinements(),
        }
    }
}

/// How levels are made.
#[derive(Debug, Clone, Copy)]
enum Coarsening {
    Refinements,
    Algebraic,
}

/// Multigrid for one discretization, whose levels are made once.
pub(super) struct PreparedMultigrid<'d> {
    structure: Structure<'d>,
    levels: Option<Levels<'d>>,
    /// Levels that are not tried again: those of the refinements, once it has stalled on them.
    stalled: Vec<Stalled>,
}

impl<'d> PreparedMultigrid<'d> {
    pub(super) fn new(structure: Structure<'d>) -> Self {
        Self { structure, levels: None, stalled: Vec::new() }
    }

    /// Solves on the levels that there are, else on those that are made like this; the time limit counts from `start`.
    fn attempt(
        &mut self,
        coarsening: Coarsening,
        options: &SolverOptions,
        start: Instant,
    ) -> Result<Candidate, SolverError> {
        let begin = Instant::now();
        let levels = match &mut self.levels {
            Some(levels) => levels,
            none => none.insert(Levels::new(self.structure, coarsening)),
        };
        let setup_seconds = begin.elapsed().as_secs_f64();
        let mut candidate = match (levels, self.structure) {
            (Levels::One(levels), Structure::Pair(d)) => {
                pair::multigrid::solve_on(levels, d, NAME, options, start)
            }
            (Levels::One(levels), Structure::Obstacle(d) | Structure::Coupled(d)) => {
                stack::obstacle::solve_on(levels, d, NAME, options, start)
            }
            (Levels::Coupled(levels), Structure::Obstacle(d) | Structure::Coupled(d)) => {
                stack::coupled::solve_on(levels, d, NAME, options, start)
            }
            (Levels::Coupled(_), Structure::Pair(_)) => unreachable!("the levels are those of the structure"),
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
        let mut candidate = self.attempt(Coarsening::Refinements, options, start)?;
        candidate.statistics.stalled.clone_from(&self.stalled);
        let refinements = self.levels.as_ref().map_or(0, Levels::refinements);
        if candidate.statistics.status != Status::Stalled || refinements == 0 {
            return Ok(candidate);
        }
        // On stretched triangles coarser meshes are no good: their neighbours along the long sides are hardly coupled.
        self.levels = None;
        let mut on_algebraic_levels = self.attempt(Coarsening::Algebraic, options, start)?;
        let method = format!("{NAME} on levels of {refinements} refinements");
        on_algebraic_levels.statistics = on_algebraic_levels.statistics.after(method, candidate.statistics);
        self.stalled.clone_from(&on_algebraic_levels.statistics.stalled);
        Ok(on_algebraic_levels)
    }
}
