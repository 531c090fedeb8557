//! `adapt`: meshes that are refined where the error is.

use std::ffi::CString;
use std::sync::Arc;

use membrane_contact::mesh::{self, MeshError};
use membrane_contact::qp::TimeLimit;
use membrane_contact::solver::SolverOptions;
use membrane_contact::study::{AdaptiveLevel, AdaptiveStudy, StudyError};
use pyo3::exceptions::PyRuntimeWarning;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{data_error, study_error, value_error};
use crate::field::Reader;
use crate::mesh::Mesh;
use crate::problem::Arguments;
use crate::solution::Solution;
use crate::solve::{solver_of, tolerance_of};
use crate::worker::Caller;

/// How much larger the next mesh is taken to be while only one is known.
const GROWTH: f64 = 2.0;

/// Refines where the error is until its bound is small enough.
///
/// Parameters
/// ----------
/// mesh : Mesh
///     Where it starts: bisected where the indicators of the bound are largest.
/// tension, load, height, membranes, floor, ceiling, solver, polish, time_limit
///     As for `solve`; the limit of time is that of each solve. Arrays over the mesh do not follow it: give functions or views.
/// relative_error : float
///     The bound of the error over the energy norm of the exact solution to reach.
/// max_vertices : int
///     The largest mesh.
/// tolerance : float or "auto"
///     How accurately each level is solved. Default ``"auto"``.
/// callback : callable
///     Called after each level with a dictionary: ``level``, ``vertices``, ``bound``, ``relative_bound`` (None where it is not known yet),
///     ``energy_norm``, ``iterations``, ``seconds``.
///
/// Returns
/// -------
/// Solution
///     The last one; where the accuracy was not reached, a ``RuntimeWarning`` says so.
///
/// Raises
/// ------
/// As `solve`.
#[pyfunction]
#[pyo3(signature = (
    mesh, *, tension=None, load=None, height=None, membranes=None, floor=None, ceiling=None, relative_error=0.01,
    max_vertices=1_000_000, solver=None, tolerance=None, polish=true, time_limit=None, callback=None,
))]
pub(crate) fn adapt<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, Mesh>,
    tension: Option<Bound<'py, PyAny>>,
    load: Option<Bound<'py, PyAny>>,
    height: Option<Bound<'py, PyAny>>,
    membranes: Option<Bound<'py, PyAny>>,
    floor: Option<Bound<'py, PyAny>>,
    ceiling: Option<Bound<'py, PyAny>>,
    relative_error: f64,
    max_vertices: usize,
    solver: Option<Bound<'py, PyAny>>,
    tolerance: Option<Bound<'py, PyAny>>,
    polish: bool,
    time_limit: Option<f64>,
    callback: Option<Bound<'py, PyAny>>,
) -> PyResult<Solution> {
    if !(relative_error > 0.0) {
        return Err(data_error(py, "relative_error", "must be positive"));
    }
    let caller = Caller::new()?;
    let (core, domain) = (mesh.get().core().clone(), mesh.get().domain().cloned());
    if core.points().len() > max_vertices {
        let problem = format!("is {max_vertices}, and the first mesh has {} already", core.points().len());
        return Err(data_error(py, "max_vertices", problem));
    }
    let arguments = Arguments { tension, load, height, membranes, floor, ceiling };
    let problem = arguments.problem(py, Reader { mesh: &core, line: caller.line() })?;
    let tolerance = match &tolerance {
        None => membrane_contact::study::Tolerance::Auto,
        given => tolerance_of(given.as_ref())?,
    };
    let options = SolverOptions {
        time_limit: time_limit.map(TimeLimit::from_seconds).transpose().map_err(value_error)?,
        interrupt: Some(caller.line().interrupt()),
        polish,
        ..SolverOptions::default()
    };
    let solver = solver_of(solver.as_ref(), caller.line())?;
    let mut study = AdaptiveStudy::new(problem, domain.clone(), None, core, solver, options, tolerance);
    let mut before: Option<AdaptiveLevel> = None;
    let mut certified_within = 0.0;
    let short = loop {
        let work = move || {
            let level = study.next_level();
            (study, level)
        };
        let (back, level) = caller.wait_for(py, work)?;
        study = back;
        let level = match level {
            Ok(level) => level,
            Err(StudyError::Mesh(MeshError::TooSmall { .. })) => {
                break Some("triangles would become too small");
            }
            Err(error) => return Err(study_error(py, &error)),
        };
        certified_within = level.tolerance;
        if let Some(callback) = &callback {
            callback.call1((row(py, &level)?,))?;
        }
        if level.relative_bound.is_some_and(|bound| bound <= relative_error) {
            break None;
        }
        let growth = before.map_or(GROWTH, |before| level.vertices as f64 / before.vertices as f64);
        if growth * level.vertices as f64 > max_vertices as f64 {
            break Some("the next mesh would have more than max_vertices");
        }
        before = Some(level);
    };
    let (found, bound) = study.solution().expect("a level has been solved");
    if let Some(why) = short {
        let reached = bound.relative().map_or("unknown".into(), |bound| format!("{:.2} %", 100.0 * bound));
        let warning = format!("adapt: stopped at a relative error of at most {reached}: {why}");
        let warning = CString::new(warning).expect("it has no zero byte");
        PyErr::warn(py, &py.get_type::<PyRuntimeWarning>(), &warning, 1)?;
    }
    let (found, bound) = (found.clone(), bound.clone());
    let d = Arc::clone(study.discretization().expect("a level has been solved"));
    let mesh = Py::new(py, Mesh::over(mesh::Mesh::clone(study.mesh()), domain))?;
    Ok(Solution::new(mesh, d, found, Some(Ok(bound)), certified_within))
}

/// What the callback is told of a level.
fn row<'py>(py: Python<'py>, level: &AdaptiveLevel) -> PyResult<Bound<'py, PyDict>> {
    let row = PyDict::new(py);
    row.set_item("level", level.level)?;
    row.set_item("vertices", level.vertices)?;
    row.set_item("bound", level.bound)?;
    row.set_item("relative_bound", level.relative_bound)?;
    row.set_item("energy_norm", level.energy_norm)?;
    row.set_item("iterations", level.iterations)?;
    row.set_item("seconds", level.solve_seconds + level.bound_seconds)?;
    Ok(row)
}
