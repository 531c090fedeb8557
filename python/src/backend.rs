//! A QP solver written in Python behind the core's trait.

use std::sync::Arc;
use std::time::Instant;

use membrane_contact::qp::{BackendError, QpBackend, QpOptions, QpProblem, QpSolution, Status};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::vector;
use crate::qp::program;
use crate::worker::Line;

/// `callable(P, q, A, b, *, tolerance, max_iterations, time_limit) -> (x, y)`, where `P` and `A` are scipy matrices, for the program
/// `minimise 1/2 x'Px + q'x subject to Ax >= b` with `P` symmetric.
pub(crate) struct PythonBackend {
    pub(crate) name: String,
    pub(crate) callable: Arc<Py<PyAny>>,
    pub(crate) line: Line,
}

impl QpBackend for PythonBackend {
    fn name(&self) -> &str {
        &self.name
    }

    fn solve(&mut self, qp: &QpProblem, options: &QpOptions) -> Result<QpSolution, BackendError> {
        let start = Instant::now();
        let (callable, qp, asked) = (Arc::clone(&self.callable), qp.clone(), options.clone());
        let expected = [qp.q().len(), qp.b().len()];
        let answer = self.line.call(move |py| call(callable.bind(py), &qp, &asked));
        let (x, y) = answer.map_err(|raised| self.cannot_run(raised.to_string()))?;
        if [x.len(), y.len()] != expected {
            let [n, m] = expected;
            let reason = format!("it returned {} and {} values in place of {n} and {m}", x.len(), y.len());
            return Err(self.cannot_run(reason));
        }
        Ok(QpSolution {
            x,
            y,
            // What it says of itself would decide nothing.
            status: Status::Unknown,
            iterations: 0,
            setup_seconds: 0.0,
            solve_seconds: start.elapsed().as_secs_f64(),
        })
    }
}

impl PythonBackend {
    fn cannot_run(&self, reason: String) -> BackendError {
        BackendError { backend: self.name.clone(), reason }
    }
}

/// The answer of a callable.
fn call(callable: &Bound<'_, PyAny>, qp: &QpProblem, options: &QpOptions) -> PyResult<(Vec<f64>, Vec<f64>)> {
    let py = callable.py();
    let keywords = PyDict::new(py);
    keywords.set_item("tolerance", options.tolerance)?;
    keywords.set_item("max_iterations", options.max_iterations)?;
    keywords.set_item("time_limit", options.time_limit.map(|limit| limit.seconds()))?;
    let answer = callable.call(program(py, qp)?, Some(&keywords))?;
    let Ok((x, y)) = answer.extract::<(Bound<'_, PyAny>, Bound<'_, PyAny>)>() else {
        return Err(PyTypeError::new_err(format!("a solver must return (x, y), not {}", answer.repr()?)));
    };
    Ok((vector(&x, "x")?, vector(&y, "y")?))
}
