//! Errors on a sequence of refined meshes.

use thiserror::Error;
use web_time::Instant;

use super::LevelErrors;
use super::accuracy::{AccuracyError, Tolerance, solve_bounded};
use super::prolongation::Fields;
use crate::action::{PairSolution, Rejected, Rim};
use crate::discretization::{Discretization, DiscretizationError, PairDiscretization};
use crate::estimate::{DataWarning, ErrorBound, ErrorNorms, MeasureError, NoBound, RimError};
use crate::mesh::{MeshError, MeshFamily};
use crate::problem::{ContactProblem, ExactSolution, ProblemError};
use crate::qp::TimeLimit;
use crate::solver::{ContactSolver, SolverError, SolverOptions};

/// Solves a case with a known solution on finer and finer meshes, each solve started from the one before.
pub struct ConvergenceStudy {
    exact: ExactSolution,
    problem: ContactProblem,
    family: MeshFamily,
    solver: Box<dyn ContactSolver>,
    options: SolverOptions,
    tolerance: Tolerance,
    level: usize,
    last: Option<Fields>,
    /// The vertices of the last mesh that was solved on, and the loads of which its bound may know too little.
    warnings: Option<(usize, Vec<DataWarning>)>,
}

/// A level of a study fails.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StudyError {
    /// The data make no problem.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// The mesh cannot be refined further.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The problem cannot be posed.
    #[error(transparent)]
    Discretization(#[from] DiscretizationError),
    /// There is no bound of the error, which the study rests on.
    #[error("there is no bound of the error: {0}")]
    NoBound(NoBound),
    /// The solver cannot run.
    #[error(transparent)]
    Solver(#[from] SolverError),
    /// Its result is not certified.
    #[error("level {level}: {rejected}")]
    Rejected {
        /// The level.
        level: usize,
        /// Why.
        rejected: Box<Rejected>,
    },
    /// The errors cannot be measured.
    #[error(transparent)]
    Measure(#[from] MeasureError),
}

impl StudyError {
    pub(super) fn at(level: usize, error: AccuracyError) -> Self {
        match error {
            AccuracyError::Solver(error) => Self::Solver(error),
            AccuracyError::Rejected(rejected, _) => Self::Rejected { level, rejected },
            AccuracyError::Measure(error) => Self::Measure(error),
        }
    }
}

impl ConvergenceStudy {
    /// A study that starts on the current mesh of `family`.
    ///
    /// # Errors
    /// When the data of the case make no problem.
    pub fn new(
        exact: ExactSolution,
        family: MeshFamily,
        solver: Box<dyn ContactSolver>,
        options: SolverOptions,
        tolerance: Tolerance,
    ) -> Result<Self, StudyError> {
        let problem = exact.problem()?;
        Ok(Self { exact, problem, family, solver, options, tolerance, level: 0, last: None, warnings: None })
    }

    /// Vertices of the current mesh: that of the last level, before the first one that of the coming level.
    pub fn vertices(&self) -> usize {
        self.family.mesh().points().len()
    }

    /// Limits the time of each solve from now on, seconds.
    pub fn set_time_limit(&mut self, time_limit: Option<TimeLimit>) {
        self.options.time_limit = time_limit;
    }

    /// Solves on the next mesh and measures the errors.
    ///
    /// # Errors
    /// [`StudyError`].
    pub fn next_level(&mut self) -> Result<LevelErrors, StudyError> {
        self.on_next_mesh(|exact, d, solution, bound, level| {
            let start = Instant::now();
            let norms = ErrorNorms::new(d, solution, exact)?;
            let quality = d.mesh().quality();
            let rim = exact.rim().map(|curve| {
                let rim = Rim::new(d.mesh(), &solution.gap(), solution.contact());
                RimError::new(d.mesh(), &rim, &curve)
            });
            let [first, second] = norms.h1;
            Ok(LevelErrors {
                level,
                vertices: d.mesh().points().len(),
                triangles: d.mesh().triangles().len(),
                h: quality.h_max,
                h_min: quality.h_min,
                h1: first.hypot(second),
                l2: norms.l2[0].hypot(norms.l2[1]),
                energy: norms.energy,
                bound: Some(bound.total),
                nodal: norms.nodal_max[0].max(norms.nodal_max[1]),
                lambda_l2: norms.lambda_l2,
                lambda_dual: Some(norms.lambda_dual.value),
                lambda_dual_estimate: Some(norms.lambda_dual.estimate()),
                contact_area: norms.contact.error(),
                quadrature: norms.quadrature,
                iterations: solution.statistics().iterations,
                solve_seconds: 0.0,
                norm_seconds: start.elapsed().as_secs_f64(),
                rim_distance: rim.and_then(|rim| rim.hausdorff),
                jaccard: rim.map(|rim| rim.jaccard),
            })
        })
        .map(|(errors, solve_seconds)| LevelErrors { solve_seconds, ..errors })
    }

    /// Solves on the next mesh without measuring: for a level whose errors are known, to start the one after it from.
    ///
    /// # Errors
    /// [`StudyError`].
    pub fn skip_level(&mut self) -> Result<(), StudyError> {
        self.on_next_mesh(|_, _, _, _, _| Ok(())).map(|_| ())
    }

    /// The loads of which the quadrature may know too little on `level` for its bound to hold, where that is the last level or one
    /// that an earlier study has measured: then the problem is assembled there, and not solved.
    ///
    /// # Errors
    /// [`StudyError`] when there is no such mesh.
    pub fn into_warnings(mut self, level: &LevelErrors) -> Result<Vec<DataWarning>, StudyError> {
        if let Some((_, warnings)) = self.warnings.take_if(|(vertices, _)| *vertices == level.vertices) {
            return Ok(warnings);
        }
        while self.vertices() < level.vertices {
            self.family.refine()?;
        }
        let d = PairDiscretization::new(&self.problem, self.family.mesh().clone())
            .map_err(DiscretizationError::from)?;
        Ok(level.bound.map_or_else(Vec::new, |bound| DataWarning::all(&d, bound)))
    }

    /// Refines (but for the first level), solves from the last level's solution, certifies, and hands the solution to
    /// `measure`; returns its result and the seconds up to there.
    fn on_next_mesh<T>(
        &mut self,
        measure: impl FnOnce(
            &ExactSolution,
            &PairDiscretization,
            &PairSolution,
            &ErrorBound,
            usize,
        ) -> Result<T, StudyError>,
    ) -> Result<(T, f64), StudyError> {
        let start = Instant::now();
        let level = self.level;
        let prolonged = match self.last.take() {
            None => None,
            Some(last) => Some(last.prolonged(&self.family.refine()?)),
        };
        let d = Discretization::new(&self.problem, self.family.mesh().clone())?;
        let warm_start = prolonged.map(|fields| fields.into_start(&d));
        let options = SolverOptions { warm_start, ..self.options.clone() };
        let domain = self.exact.domain();
        let bounded =
            solve_bounded(&self.problem, Some(&domain), &d, &mut *self.solver, &options, self.tolerance)
                .map_err(|error| StudyError::at(level, error))?;
        let seconds = start.elapsed().as_secs_f64();
        let bound = bounded.bound.map_err(StudyError::NoBound)?;
        let pair = d.as_pair().zip(bounded.solution.as_pair());
        let (pair, solution) = pair.expect("the exact solutions are those of pairs");
        let measured = measure(&self.exact, pair, solution, &bound, level)?;
        self.last = Some(Fields::from(&bounded.solution));
        self.warnings = Some((self.vertices(), bound.warnings));
        self.level += 1;
        Ok((measured, seconds))
    }
}
