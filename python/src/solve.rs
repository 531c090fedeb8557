//! `solve`: from a mesh and data to a certified solution with its bound.

use std::sync::Arc;

use membrane_contact::action::{ContactSolution, certify};
use membrane_contact::discretization::Discretization;
use membrane_contact::estimate::{ErrorBound, NoBound};
use membrane_contact::problem::{ContactProblem, Domain};
use membrane_contact::qp::{Clarabel, TimeLimit};
use membrane_contact::solver::{ActiveSet, Auto, ContactSolver, Multigrid, QpSolver, SolverOptions};
use membrane_contact::study::{AccuracyError, Bounded, Tolerance, solve_bounded};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::backend::PythonBackend;
use crate::errors::{accuracy_error, data_error, discretization_error, value_error};
use crate::field::Reader;
use crate::mesh::Mesh;
use crate::problem::{Arguments, integration_rule};
use crate::solution::Solution;
use crate::worker::{Caller, Line};

/// The solvers that have names.
const SOLVERS: [&str; 4] = ["auto", "multigrid", "active-set", "clarabel"];

/// Solves, certifies, and bounds the error.
///
/// Parameters
/// ----------
/// mesh : Mesh
/// tension : tuple of Field
///     Of a pair: the tensions of the upper and the lower membrane, force per length, positive.
/// load : tuple of Field
///     Of a pair: the loads, force per area, positive upwards. Default 0.
/// height : Datum
///     Of a pair: where the upper membrane is held on the boundary; the lower one is at 0. Default 0.
/// membranes : list of Membrane
///     In place of these: any number of membranes from the top.
/// floor, ceiling : Field
///     What no membrane is below, or above.
/// integration : {"quadrature", "vertices"}
///     How data are integrated; the second is for published values that rest on it.
/// solver : {"auto", "multigrid", "active-set", "clarabel"} or callable
///     Or a solver of quadratic programs, ``f(P, q, A, b, *, tolerance, max_iterations, time_limit) -> (x, y)``, for `qp` in units in which
///     its data have size 1. What it says of itself decides nothing. See `qpsolvers_backend`.
/// tolerance : float or "auto"
///     The largest residual, relative to the data; ``"auto"``: until what the solver leaves is a small part of the bound. Default 1e-8.
/// max_iterations : int
/// time_limit : float
///     Seconds.
/// polish : bool
///     Whether to make the answer of a QP solver exact by solving for its contact set.
/// warm_start : Solution
///     Of a similar problem on the same mesh.
/// bound : bool
///     Whether to bound the error, which takes about as long as a solve.
///
/// Returns
/// -------
/// Solution
///
/// Raises
/// ------
/// DataError
///     The data are wrong, or do not fit the mesh.
/// CertificationError
///     The solver has found no solution.
/// BackendError
///     A QP solver cannot run.
///
/// Notes
/// -----
/// Exceptions of Python code pass through. Ctrl-C is raised at once; what runs then ends by itself.
#[pyfunction]
#[pyo3(signature = (
    mesh, *, tension=None, load=None, height=None, membranes=None, floor=None, ceiling=None, integration="quadrature",
    solver=None, tolerance=None, max_iterations=None, time_limit=None, polish=true, warm_start=None, bound=true,
))]
pub(crate) fn solve<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, Mesh>,
    tension: Option<Bound<'py, PyAny>>,
    load: Option<Bound<'py, PyAny>>,
    height: Option<Bound<'py, PyAny>>,
    membranes: Option<Bound<'py, PyAny>>,
    floor: Option<Bound<'py, PyAny>>,
    ceiling: Option<Bound<'py, PyAny>>,
    integration: &str,
    solver: Option<Bound<'py, PyAny>>,
    tolerance: Option<Bound<'py, PyAny>>,
    max_iterations: Option<usize>,
    time_limit: Option<f64>,
    polish: bool,
    warm_start: Option<Bound<'py, Solution>>,
    bound: bool,
) -> PyResult<Solution> {
    let caller = Caller::new()?;
    let core = mesh.get().core().clone();
    let arguments = Arguments { tension, load, height, membranes, floor, ceiling };
    let problem = arguments.problem(py, Reader { mesh: &core, line: caller.line() })?;
    let rule = integration_rule(py, integration)?;
    let tolerance = tolerance_of(tolerance.as_ref())?;
    if max_iterations == Some(0) {
        return Err(data_error(py, "max_iterations", "must be positive"));
    }
    let warm_start = warm_start.map(|start| start.get().starting_point());
    let options = SolverOptions {
        tolerance: tolerance.or_default(),
        max_iterations,
        time_limit: time_limit.map(TimeLimit::from_seconds).transpose().map_err(value_error)?,
        interrupt: Some(caller.line().interrupt()),
        polish,
        warm_start,
    };
    let mut solver = solver_of(solver.as_ref(), caller.line())?;
    let problem = Arc::new(problem);
    let posed = Arc::clone(&problem);
    let d = caller.wait_for(py, move || Discretization::by_rule(&posed, core, rule))?;
    let d = d.map_err(|error| discretization_error(py, &error))?;
    if options.warm_start.as_ref().is_some_and(|start| !start.fits(&d)) {
        let problem = "is no solution on this mesh with these membranes, supports and obstacles";
        return Err(data_error(py, "warm_start", problem));
    }
    let domain = mesh.get().domain().cloned();
    let work = move || {
        let found = accurate(&problem, domain.as_ref(), &d, &mut *solver, &options, tolerance, bound);
        (d, found)
    };
    let (d, found) = caller.wait_for(py, work)?;
    let found = found.map_err(|error| accuracy_error(py, &error))?;
    Ok(Solution::new(mesh.clone().unbind(), Arc::new(d), found.solution, found.bound, found.tolerance))
}

/// A number, or `"auto"`.
pub(crate) fn tolerance_of(tolerance: Option<&Bound<'_, PyAny>>) -> PyResult<Tolerance> {
    let Some(tolerance) = tolerance else { return Ok(Tolerance::Fixed(SolverOptions::default().tolerance)) };
    if tolerance.extract::<&str>().is_ok_and(|text| text == "auto") {
        return Ok(Tolerance::Auto);
    }
    let number = tolerance.extract();
    let number = number.map_err(|_| PyTypeError::new_err("tolerance must be a number or \"auto\""))?;
    Ok(Tolerance::Fixed(number))
}

/// The solver that was asked for.
pub(crate) fn solver_of(given: Option<&Bound<'_, PyAny>>, line: &Line) -> PyResult<Box<dyn ContactSolver>> {
    let Some(given) = given else { return Ok(Box::new(Auto)) };
    if given.is_callable() {
        let name = given.getattr("__name__").and_then(|name| name.extract());
        let name = name.unwrap_or_else(|_| "python".to_owned());
        let callable = Arc::new(given.clone().unbind());
        return Ok(Box::new(QpSolver::new(PythonBackend { name, callable, line: line.clone() })));
    }
    let known = SOLVERS.join(", ");
    let Ok(name) = given.extract::<String>() else {
        return Err(PyTypeError::new_err(format!("solver must be one of {known}, or a callable")));
    };
    Ok(match name.as_str() {
        "auto" => Box::new(Auto),
        "multigrid" => Box::new(Multigrid),
        "active-set" => Box::new(ActiveSet),
        "clarabel" => Box::new(QpSolver::new(Clarabel)),
        other => {
            let problem = format!("is {other:?}: it may be {known}, or a callable");
            return Err(data_error(given.py(), "solver", problem));
        }
    })
}

/// A certified solution, and its bound if that was asked for.
struct Found {
    solution: ContactSolution,
    bound: Option<Result<ErrorBound, NoBound>>,
    tolerance: f64,
}

fn accurate(
    problem: &ContactProblem,
    domain: Option<&Domain>,
    d: &Discretization,
    solver: &mut dyn ContactSolver,
    options: &SolverOptions,
    tolerance: Tolerance,
    bound: bool,
) -> Result<Found, AccuracyError> {
    match tolerance {
        Tolerance::Fixed(tolerance) if !bound => {
            let candidate = solver.solve(d, options)?;
            let solution = certify(d, candidate, tolerance);
            let solution = solution.map_err(|rejected| AccuracyError::Rejected(rejected, tolerance))?;
            Ok(Found { solution, bound: None, tolerance })
        }
        _ => {
            let Bounded { solution, bound, tolerance, .. } =
                solve_bounded(problem, domain, d, solver, options, tolerance)?;
            Ok(Found { solution, bound: Some(bound), tolerance })
        }
    }
}
