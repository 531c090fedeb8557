//! Our errors as Python's.

use std::fmt::Display;

use membrane_contact::action::Rejected;
use membrane_contact::discretization::DiscretizationError;
use membrane_contact::problem::ProblemError;
use membrane_contact::{mesh, solver, study};
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

create_exception!(membrane_contact, ContactError, PyRuntimeError, "What a solver can fail with.");
create_exception!(
    membrane_contact,
    CertificationError,
    ContactError,
    "The result is not a solution. `residuals`: dict, by how much, or None where there is no result; `status`: what the solver says."
);
create_exception!(membrane_contact, BackendError, ContactError, "A QP solver cannot run on the problem.");
create_exception!(
    membrane_contact,
    MeshError,
    PyValueError,
    "Points and triangles are not a triangulation. `triangle`: int or None, the first that is wrong; `vertices`: those named."
);
create_exception!(
    membrane_contact,
    DataError,
    PyValueError,
    "A datum is wrong. `key`: str or None, which; `vertex`: int or None, where."
);

/// A datum `key` is wrong.
pub(crate) fn data_error(py: Python<'_>, key: &str, problem: impl Display) -> PyErr {
    data_error_at(py, format!("{key} {problem}"), Some(key), None)
}

/// The data make no problem.
pub(crate) fn problem_error(py: Python<'_>, error: &ProblemError) -> PyErr {
    data_error_at(py, error.to_string(), None, None)
}

/// The data do not go together, or not with the mesh.
pub(crate) fn discretization_error(py: Python<'_>, error: &DiscretizationError) -> PyErr {
    data_error_at(py, error.to_string(), None, error.vertex())
}

fn data_error_at(py: Python<'_>, message: String, key: Option<&str>, vertex: Option<usize>) -> PyErr {
    with_attributes(py, DataError::new_err(message), |raised| {
        raised.setattr("key", key)?;
        raised.setattr("vertex", vertex)
    })
}

/// Bad input of any other kind.
pub(crate) fn value_error(error: impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

pub(crate) fn mesh_error(py: Python<'_>, error: &mesh::MeshError) -> PyErr {
    with_attributes(py, MeshError::new_err(error.to_string()), |raised| {
        raised.setattr("triangle", error.triangle())?;
        raised.setattr("vertices", error.vertices())
    })
}

/// What numpy would take for a vertex counted from the end.
pub(crate) fn negative_vertex(py: Python<'_>, triangle: usize, vertex: i64) -> PyErr {
    let problem = format!("triangle {triangle} has the vertex {vertex}: count from 0");
    with_attributes(py, MeshError::new_err(problem), |raised| {
        raised.setattr("triangle", triangle)?;
        raised.setattr("vertices", [vertex])
    })
}

/// A solver cannot run.
pub(crate) fn solver_error(error: &solver::SolverError) -> PyErr {
    match error {
        solver::SolverError::Tolerance(_) => value_error(error),
        solver::SolverError::Backend(error) => BackendError::new_err(error.to_string()),
        error => ContactError::new_err(error.to_string()),
    }
}

/// What a solver has found is no solution.
pub(crate) fn rejected(py: Python<'_>, rejected: &Rejected) -> PyErr {
    let error = CertificationError::new_err(format!("{rejected}; {}", rejected.remedy()));
    with_attributes(py, error, |raised| {
        raised.setattr("status", rejected.statistics.status.as_str())?;
        let Some(residuals) = rejected.residuals else { return raised.setattr("residuals", py.None()) };
        let by_name = PyDict::new(py);
        for (name, residual) in residuals.named() {
            by_name.set_item(name, residual.beyond_rounding)?;
        }
        raised.setattr("residuals", by_name)
    })
}

/// There is no certified solution with a bound.
pub(crate) fn accuracy_error(py: Python<'_>, error: &study::AccuracyError) -> PyErr {
    match error {
        study::AccuracyError::Solver(error) => solver_error(error),
        study::AccuracyError::Rejected(error, _) => rejected(py, error),
        error => ContactError::new_err(error.to_string()),
    }
}

/// A level of a study fails.
pub(crate) fn study_error(py: Python<'_>, error: &study::StudyError) -> PyErr {
    match error {
        study::StudyError::Mesh(error) => mesh_error(py, error),
        study::StudyError::Discretization(error) => discretization_error(py, error),
        study::StudyError::Solver(error) => solver_error(error),
        study::StudyError::Rejected { rejected: of_level, .. } => rejected(py, of_level),
        error => ContactError::new_err(error.to_string()),
    }
}

fn with_attributes(
    py: Python<'_>,
    error: PyErr,
    set: impl FnOnce(&Bound<'_, PyAny>) -> PyResult<()>,
) -> PyErr {
    match set(error.value(py)) {
        Ok(()) => error,
        Err(other) => other,
    }
}
