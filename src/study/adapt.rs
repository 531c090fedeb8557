//! Meshes that are refined where the error is.

use std::sync::Arc;

use web_time::Instant;

use super::accuracy::{Bounded, Tolerance, solve_bounded};
use super::prolongation::Fields;
use super::{StudyError, mark};
use crate::action::{ContactSolution, certify};
use crate::discretization::{Discretization, Displacements};
use crate::estimate::{ContactBounds, ErrorBound, energy_error, residual_indicators};
use crate::mesh::{Bisection, Mesh};
use crate::problem::{ContactProblem, Domain, ExactSolution};
use crate::qp::TimeLimit;
use crate::solver::{Candidate, ContactSolver, SolverOptions, StartingPoint, Statistics};

/// The fraction of the squared error in the triangles that are marked.
const FRACTION: f64 = 0.5;

/// Refinements of a study that can go on from a checkpoint, so that those of a hostile one take a time proportional to its
/// length. Runs have less than a hundred.
const MAX_REFINEMENTS: usize = 1000;

/// Solves on meshes that are bisected where the indicators of the error bound are largest.
///
/// Each level starts from the solution of the one before; the bisections are the hierarchy of the multigrid solver.
pub struct AdaptiveStudy {
    problem: ContactProblem,
    domain: Option<Domain>,
    exact: Option<ExactSolution>,
    bisection: Bisection,
    solver: Box<dyn ContactSolver>,
    options: SolverOptions,
    tolerance: Tolerance,
    marked: Vec<Vec<usize>>,
    /// The current mesh's discretization and solution.
    last: Option<(Arc<Discretization>, Bounded)>,
}

/// One level: a mesh and the error on it. Written as a row of `adapt.csv`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct AdaptiveLevel {
    /// The number of the level, from 0.
    pub level: usize,
    /// Vertices of the mesh.
    pub vertices: usize,
    /// Triangles of the mesh.
    pub triangles: usize,
    /// The longest edge.
    pub h: f64,
    /// The shortest edge.
    pub h_min: f64,
    /// The smallest angle, degrees.
    pub min_angle: f64,
    /// The bound of the energy error, guaranteed up to the quadrature of the loads.
    pub bound: f64,
    /// The bound relative to the exact solution's energy norm; empty when the bound is too large to know that.
    pub relative_bound: Option<f64>,
    /// The parts of the bound, see [`BoundParts`](crate::estimate::BoundParts).
    pub flux: f64,
    /// Likewise.
    pub oscillation: f64,
    /// Likewise.
    pub contact: f64,
    /// Likewise.
    pub boundary: f64,
    /// Likewise.
    pub algebraic: f64,
    /// The residual estimator with the action of the bound, see [`residual_indicators`]; of a pair only.
    pub residual_estimator: Option<f64>,
    /// `|||u_h|||`.
    pub energy_norm: f64,
    /// The energy error; empty where no exact solution is known.
    pub energy_error: Option<f64>,
    /// The tolerance within which the solution is certified.
    pub tolerance: f64,
    /// Iterations of the solver.
    pub iterations: usize,
    /// Seconds for mesh, assembly and solution.
    pub solve_seconds: f64,
    /// Seconds for the bound.
    pub bound_seconds: f64,
}

impl AdaptiveLevel {
    /// The bound over the energy error, where that is known.
    pub fn effectivity(&self) -> Option<f64> {
        self.energy_error.map(|error| self.bound / error)
    }
}

/// What a study goes on from: the marked triangles of all refinements so far, and the solution on the last mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Checkpoint {
    /// Of each refinement the triangles that were marked.
    pub marked: Vec<Vec<usize>>,
    /// Over vertices, one for each membrane from the top, as they were certified.
    pub displacement: Displacements,
    /// The actions in the gaps, over vertices, likewise.
    pub actions: Vec<Vec<f64>>,
    /// The tolerance within which they are certified.
    pub tolerance: f64,
    /// How they were found.
    pub statistics: Statistics,
}

impl AdaptiveStudy {
    /// A study that starts on `mesh`. `domain` is what the mesh stands for (see [`ErrorBound::new`]); with the exact solution,
    /// true errors are measured as well.
    pub fn new(
        problem: ContactProblem,
        domain: Option<Domain>,
        exact: Option<ExactSolution>,
        mesh: impl Into<Arc<Mesh>>,
        solver: Box<dyn ContactSolver>,
        options: SolverOptions,
        tolerance: Tolerance,
    ) -> Self {
        let bisection = match &domain {
            Some(domain) => Bisection::of_domain(mesh, domain),
            None => Bisection::new(mesh),
        };
        Self { problem, domain, exact, bisection, solver, options, tolerance, marked: Vec::new(), last: None }
    }

    /// The current mesh.
    pub fn mesh(&self) -> &Arc<Mesh> {
        self.bisection.mesh()
    }

    /// Limits the time of each solve from now on, seconds.
    pub fn set_time_limit(&mut self, time_limit: Option<TimeLimit>) {
        self.options.time_limit = time_limit;
    }

    /// The problem.
    pub fn problem(&self) -> &ContactProblem {
        &self.problem
    }

    /// The solution on the current mesh and its bound, once there is one.
    pub fn solution(&self) -> Option<(&ContactSolution, &ErrorBound)> {
        self.last.as_ref().and_then(|(_, last)| Some((&last.solution, last.bound.as_ref().ok()?)))
    }

    /// The discretization that it solves.
    pub fn discretization(&self) -> Option<&Arc<Discretization>> {
        self.last.as_ref().map(|(d, _)| d)
    }

    /// Refines where the error of the last level is (but for the first level), solves and bounds the error.
    ///
    /// # Errors
    /// [`StudyError`]; when the mesh cannot be refined further, the last level stays, and it is lost for every other reason.
    pub fn next_level(&mut self) -> Result<AdaptiveLevel, StudyError> {
        let start = Instant::now();
        let prolonged = match &self.last {
            None => None,
            Some((_, last)) => {
                let bound = last.bound.as_ref().expect("a level without a bound is an error");
                let marked = mark(&bound.indicators, FRACTION);
                let parents = self.bisection.refine(&marked)?;
                self.marked.push(marked);
                Some(Fields::from(&last.solution).prolonged(&parents))
            }
        };
        self.last = None;
        let level = self.marked.len();
        let d = Discretization::new(&self.problem, self.bisection.mesh().clone())?;
        let warm_start = prolonged.map(|fields| fields.into_start(&d));
        let options = SolverOptions { warm_start, ..self.options.clone() };
        let domain = self.domain.as_ref();
        let bounded = solve_bounded(&self.problem, domain, &d, &mut *self.solver, &options, self.tolerance)
            .map_err(|error| StudyError::at(level, error))?;
        let seconds = start.elapsed().as_secs_f64();
        let row = self.row(&d, &bounded, seconds)?;
        self.last = Some((Arc::new(d), bounded));
        Ok(row)
    }

    fn row(
        &self,
        d: &Discretization,
        bounded: &Bounded,
        solve_seconds: f64,
    ) -> Result<AdaptiveLevel, StudyError> {
        let Bounded { solution, bound, tolerance, bound_seconds } = bounded;
        let bound = bound.as_ref().map_err(|reason| StudyError::NoBound(reason.clone()))?;
        let (mut residual_estimator, mut error) = (None, None);
        if let (Some(d), Some(solution)) = (d.as_pair(), solution.as_pair()) {
            let displacement = solution.displacement();
            let residuals = residual_indicators(d, displacement, &bound.actions[0])?;
            residual_estimator = Some(residuals.iter().sum::<f64>().sqrt());
            error = self.exact.as_ref().map(|exact| energy_error(d, displacement, exact)).transpose()?;
        }
        let quality = d.mesh().quality();
        let parts = bound.parts;
        Ok(AdaptiveLevel {
            level: self.marked.len(),
            vertices: d.mesh().points().len(),
            triangles: d.mesh().triangles().len(),
            h: quality.h_max,
            h_min: quality.h_min,
            min_angle: quality.min_angle,
            bound: bound.total,
            relative_bound: bound.relative(),
            flux: parts.flux,
            oscillation: parts.oscillation,
            contact: parts.contact,
            boundary: parts.boundary,
            algebraic: parts.algebraic,
            residual_estimator,
            energy_norm: bound.energy_norm,
            energy_error: error,
            tolerance: *tolerance,
            iterations: solution.statistics().iterations,
            solve_seconds: solve_seconds - bound_seconds,
            bound_seconds: *bound_seconds,
        })
    }

    /// What a later run goes on from; `None` before the first level.
    pub fn checkpoint(&self) -> Option<Checkpoint> {
        self.last.as_ref().map(|(_, last)| {
            let (displacement, actions) = last.solution.certified();
            Checkpoint {
                marked: self.marked.clone(),
                displacement: displacement.to_vec(),
                actions: actions.into_iter().map(<[f64]>::to_vec).collect(),
                tolerance: last.tolerance,
                statistics: last.solution.statistics().clone(),
            }
        })
    }

    /// Goes on from a checkpoint: bisects the first mesh again and has the solution certified again, within a
    /// tolerance that the study accepts. Returns whether it is one of this study; if not, the study is as it was.
    ///
    /// # Errors
    /// [`StudyError`] when the problem cannot be posed on the mesh.
    pub fn resume(&mut self, checkpoint: Checkpoint) -> Result<bool, StudyError> {
        let Checkpoint { marked, displacement, actions, tolerance, statistics } = checkpoint;
        let vertices = displacement.first().map_or(0, Vec::len);
        let is_whole = displacement.iter().chain(&actions).all(|values| values.len() == vertices);
        if !is_whole || !(tolerance <= self.tolerance.loosest()) || marked.len() > MAX_REFINEMENTS {
            return Ok(false);
        }
        let mut bisection = self.bisection.clone();
        for marked in &marked {
            // Each refinement has made vertices, and the solution has a value at each: so a hostile checkpoint makes no
            // mesh that is larger than itself.
            let mesh = bisection.mesh();
            let is_there = |&t: &usize| t < mesh.triangles().len();
            let may_grow = !marked.is_empty() && mesh.points().len() < vertices;
            if !may_grow || !marked.iter().all(is_there) || bisection.refine(marked).is_err() {
                return Ok(false);
            }
        }
        if bisection.mesh().points().len() != vertices {
            return Ok(false);
        }
        let d = Discretization::new(&self.problem, bisection.mesh().clone())?;
        if displacement.len() != d.membranes() || actions.len() != d.gaps().len() {
            return Ok(false);
        }
        let StartingPoint { displacement, multiplier } = Fields { displacement, actions }.into_start(&d);
        let Ok(solution) = certify(&d, Candidate { displacement, multiplier, statistics }, tolerance) else {
            return Ok(false);
        };
        let bounds = ContactBounds::new(&self.problem, self.domain.as_ref(), &d);
        let bounded = Bounded::new(&bounds, solution, tolerance)?;
        if bounded.bound.is_err() {
            return Ok(false);
        }
        self.last = Some((Arc::new(d), bounded));
        self.marked = marked;
        self.bisection = bisection;
        Ok(true)
    }
}
