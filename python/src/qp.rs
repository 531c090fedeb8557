//! The discrete problem as a quadratic program.

use membrane_contact::discretization::Discretization;
use membrane_contact::qp::{QpProblem, qp_of};
use membrane_contact::sprs::CsMat;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::errors::discretization_error;
use crate::field::Reader;
use crate::mesh::Mesh;
use crate::problem::{Arguments, integration_rule};
use crate::worker::Caller;

/// The program ``minimise 1/2 x'Px + q'x + constant subject to Ax >= b``, with multipliers ``y >= 0``: ``P`` (both halves) and ``A`` are
/// ``scipy.sparse.csc_matrix``. ``Solution.x`` and ``Solution.y`` are its solution.
#[pyclass(frozen, get_all, module = "membrane_contact")]
pub(crate) struct Qp {
    #[pyo3(name = "P")]
    p: Py<PyAny>,
    q: Py<PyArray1<f64>>,
    #[pyo3(name = "A")]
    a: Py<PyAny>,
    b: Py<PyArray1<f64>>,
    constant: f64,
}

#[pymethods]
impl Qp {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (rows, variables): (usize, usize) = self.a.bind(py).getattr("shape")?.extract()?;
        Ok(format!("<Qp: {variables} variables, {rows} constraints>"))
    }
}

/// The discrete problem as a quadratic program; needs scipy.
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
///     How data are integrated.
///
/// Returns
/// -------
/// Qp
#[pyfunction]
#[pyo3(signature = (mesh, *, tension=None, load=None, height=None, membranes=None, floor=None, ceiling=None, integration="quadrature"))]
pub(crate) fn qp<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, Mesh>,
    tension: Option<Bound<'py, PyAny>>,
    load: Option<Bound<'py, PyAny>>,
    height: Option<Bound<'py, PyAny>>,
    membranes: Option<Bound<'py, PyAny>>,
    floor: Option<Bound<'py, PyAny>>,
    ceiling: Option<Bound<'py, PyAny>>,
    integration: &str,
) -> PyResult<Qp> {
    let caller = Caller::new()?;
    let mesh = mesh.get().core().clone();
    let arguments = Arguments { tension, load, height, membranes, floor, ceiling };
    let problem = arguments.problem(py, Reader { mesh: &mesh, line: caller.line() })?;
    let rule = integration_rule(py, integration)?;
    let qp = caller.wait_for(py, move || Discretization::by_rule(&problem, mesh, rule).map(|d| qp_of(&d)))?;
    let qp = qp.map_err(|error| discretization_error(py, &error))?;
    let (p, q, a, b) = program(py, &qp)?;
    Ok(Qp { p: p.unbind(), q: q.unbind(), a: a.unbind(), b: b.unbind(), constant: qp.constant() })
}

type Program<'py> =
    (Bound<'py, PyAny>, Bound<'py, PyArray1<f64>>, Bound<'py, PyAny>, Bound<'py, PyArray1<f64>>);

/// `P`, `q`, `A`, `b`, the matrices as `scipy.sparse.csc_matrix`, both halves of `P`.
pub(crate) fn program<'py>(py: Python<'py>, qp: &QpProblem) -> PyResult<Program<'py>> {
    let vector = |values: &[f64]| PyArray1::from_slice(py, values);
    let symmetric = py.import("membrane_contact._interchange")?.getattr("symmetric")?;
    let p = symmetric.call1((matrix(py, qp.p_upper())?,))?;
    Ok((p, vector(qp.q()), matrix(py, qp.a())?, vector(qp.b())))
}

/// As a `scipy.sparse.csc_matrix`.
fn matrix<'py>(py: Python<'py>, matrix: &CsMat<f64>) -> PyResult<Bound<'py, PyAny>> {
    // What scipy and the solvers behind it have.
    let indices = |indices: &[usize]| PyArray1::from_iter(py, indices.iter().map(|&index| index as i32));
    let start = matrix.indptr();
    let parts = PyTuple::new(
        py,
        [
            PyArray1::from_slice(py, matrix.data()).into_any(),
            indices(matrix.indices()).into_any(),
            indices(start.raw_storage()).into_any(),
        ],
    )?;
    py.import("membrane_contact._interchange")?.getattr("sparse")?.call1((parts, matrix.shape()))
}
