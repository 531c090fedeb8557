//! Solutions as Python sees them.

use std::sync::{Arc, OnceLock};

use membrane_contact::action::ContactSolution;
use membrane_contact::discretization::Discretization;
use membrane_contact::estimate::{ErrorBound, NoBound};
use membrane_contact::qp::Answer;
use membrane_contact::solver::StartingPoint;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::view;
use crate::mesh::Mesh;

/// A certified solution, as `solve` returns it. Arrays are over the vertices of the mesh, and read-only views.
#[pyclass(frozen, module = "membrane_contact")]
pub(crate) struct Solution {
    mesh: Py<Mesh>,
    d: Arc<Discretization>,
    solution: ContactSolution,
    bound: Option<Result<ErrorBound, NoBound>>,
    tolerance: f64,
    /// Of a pair, made when it is asked for.
    gap: OnceLock<Vec<f64>>,
}

impl Solution {
    pub(crate) fn new(
        mesh: Py<Mesh>,
        d: Arc<Discretization>,
        solution: ContactSolution,
        bound: Option<Result<ErrorBound, NoBound>>,
        tolerance: f64,
    ) -> Self {
        Self { mesh, d, solution, bound, tolerance, gap: OnceLock::new() }
    }

    /// The gaps over vertices, one for each gap that there is.
    fn gap_values(&self, index: usize) -> &[f64] {
        match &self.solution {
            ContactSolution::Pair(solution) => self.gap.get_or_init(|| solution.gap()),
            ContactSolution::Stack(solution) => &solution.gaps()[index].gap,
        }
    }

    fn gap_count(&self) -> usize {
        self.solution.gaps().len()
    }

    /// The index of the only gap.
    fn only_gap(&self, attribute: &str) -> PyResult<usize> {
        match self.gap_count() {
            1 => Ok(0),
            0 => Err(PyAttributeError::new_err(format!("{attribute}: there is no gap"))),
            n => Err(PyAttributeError::new_err(format!(
                "{attribute}: there are {n} gaps, write gaps[k].{attribute}"
            ))),
        }
    }

    fn action_values(&self, index: usize) -> &[f64] {
        self.solution.gaps()[index].lambda
    }

    fn contact_flags(&self, index: usize) -> &[bool] {
        self.solution.gaps()[index].contact
    }

    fn error_bound_or_reason(&self) -> Result<&ErrorBound, String> {
        match &self.bound {
            Some(Ok(bound)) => Ok(bound),
            Some(Err(reason)) => Err(reason.to_string()),
            None => Err("it was not asked for: solve(..., bound=True)".into()),
        }
    }

    /// The ceiling or the floor.
    fn obstacle(&self, index: usize) -> Option<&[f64]> {
        match &*self.d {
            Discretization::Pair(_) => None,
            Discretization::Stack(d) => d.obstacles()[index],
        }
    }

    /// A guess for the same discrete problem, or for another one on the same mesh.
    pub(crate) fn starting_point(&self) -> StartingPoint {
        let area = match &*self.d {
            Discretization::Pair(d) => d.dual_area(),
            Discretization::Stack(d) => d.dual_area(),
        };
        let multiplier = match (&*self.d, &self.solution) {
            (Discretization::Pair(d), ContactSolution::Pair(solution)) => {
                d.interior().iter().map(|&a| solution.lambda()[a] * area[a]).collect()
            }
            (Discretization::Stack(d), ContactSolution::Stack(solution)) => {
                let force = |row: &membrane_contact::discretization::GapRow| {
                    solution.gap(row.gap).map_or(0.0, |gap| gap.force[row.vertex])
                };
                d.rows().iter().map(force).collect()
            }
            _ => unreachable!("the solution is one of its discretization"),
        };
        StartingPoint { displacement: self.solution.displacement().to_vec(), multiplier }
    }
}

/// Calls a function of the package's Python part with the solution.
fn python<'py>(
    slf: &Bound<'py, Solution>,
    function: &str,
    further: impl FnOnce(&Bound<'py, PyDict>) -> PyResult<()>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = slf.py();
    let keywords = PyDict::new(py);
    further(&keywords)?;
    py.import("membrane_contact._views")?.getattr(function)?.call((slf,), Some(&keywords))
}

#[pymethods]
impl Solution {
    /// The mesh that it is over.
    #[getter]
    fn mesh(&self, py: Python<'_>) -> Py<Mesh> {
        self.mesh.clone_ref(py)
    }

    /// The displacements of the membranes from the top, values on the boundary included. Unit: length.
    #[getter]
    fn u<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let membranes = 0..slf.get().solution.displacement().len();
        PyTuple::new(slf.py(), membranes.map(|i| view(slf, |of| &of.solution.displacement()[i])))
    }

    /// The displacement of the upper, or only, membrane. Unit: length.
    #[getter]
    fn u1<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<f64>> {
        view(slf, |of| &of.solution.displacement()[0])
    }

    /// The displacement of the second membrane. Unit: length.
    #[getter]
    fn u2<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        if slf.get().solution.displacement().len() < 2 {
            return Err(PyAttributeError::new_err("u2: there is one membrane"));
        }
        Ok(view(slf, |of| &of.solution.displacement()[1]))
    }

    /// Whether it is one of the paper's pair.
    #[getter]
    fn is_pair(&self) -> bool {
        self.solution.as_pair().is_some()
    }

    /// What no membrane is above, over vertices; None without one. Unit: length.
    #[getter]
    fn ceiling<'py>(slf: &Bound<'py, Self>) -> Option<Bound<'py, PyArray1<f64>>> {
        slf.get().obstacle(0)?;
        Some(view(slf, |of| of.obstacle(0).unwrap_or_default()))
    }

    /// What no membrane is below, over vertices; None without one. Unit: length.
    #[getter]
    fn floor<'py>(slf: &Bound<'py, Self>) -> Option<Bound<'py, PyArray1<f64>>> {
        slf.get().obstacle(1)?;
        Some(view(slf, |of| of.obstacle(1).unwrap_or_default()))
    }

    /// What happens in each gap, from the top.
    #[getter]
    fn gaps<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let gaps = (0..slf.get().gap_count()).map(|index| Gap { solution: slf.clone().unbind(), index });
        let gaps: Vec<_> = gaps.map(|gap| Bound::new(slf.py(), gap)).collect::<PyResult<_>>()?;
        PyTuple::new(slf.py(), gaps)
    }

    /// The gap of the only gap. Unit: length.
    #[getter]
    fn gap<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let index = slf.get().only_gap("gap")?;
        Ok(view(slf, |of| of.gap_values(index)))
    }

    /// The action in the only gap. Unit: force per area.
    #[getter]
    fn action<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let index = slf.get().only_gap("action")?;
        Ok(view(slf, |of| of.action_values(index)))
    }

    /// Whether the layers of the only gap touch.
    #[getter]
    fn contact<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let index = slf.get().only_gap("contact")?;
        Ok(view(slf, |of| of.contact_flags(index)))
    }

    /// The energy of the displacements.
    #[getter]
    fn energy(&self) -> f64 {
        self.solution.energy()
    }

    /// The area of the dual cells in contact, of all gaps together.
    #[getter]
    fn contact_area(&self) -> f64 {
        self.solution.contact_area()
    }

    /// The force of all actions together.
    #[getter]
    fn total_force(&self) -> f64 {
        self.solution.total_force()
    }

    /// The largest residual of the certificate beyond rounding, relative to the data.
    #[getter]
    fn residual(&self) -> f64 {
        self.solution.residuals().beyond_rounding()
    }

    /// The residuals of the certificate by name, relative to the data.
    #[getter]
    fn residuals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let by_name = PyDict::new(py);
        for (name, residual) in self.solution.residuals().named() {
            by_name.set_item(name, residual.value)?;
        }
        Ok(by_name)
    }

    /// The tolerance within which it is certified.
    #[getter]
    fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// A bound of the error in the energy norm, guaranteed up to the quadrature of the loads; None where `no_error_bound` says why.
    #[getter]
    fn error_bound(&self) -> Option<f64> {
        self.error_bound_or_reason().ok().map(|bound| bound.total)
    }

    /// The bound over the energy norm of the exact solution; None without a bound, or where it is too large to know that.
    #[getter]
    fn relative_error_bound(&self) -> Option<f64> {
        self.error_bound_or_reason().ok()?.relative()
    }

    /// Why there is no bound of the error; None where there is one.
    #[getter]
    fn no_error_bound(&self) -> Option<String> {
        self.error_bound_or_reason().err()
    }

    /// What the bound consists of, by name; None without a bound.
    #[getter]
    fn error_parts<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Ok(bound) = self.error_bound_or_reason() else { return Ok(None) };
        let parts = PyDict::new(py);
        let all = bound.parts;
        for (name, part) in [
            ("flux", all.flux),
            ("oscillation", all.oscillation),
            ("contact", all.contact),
            ("boundary", all.boundary),
            ("algebraic", all.algebraic),
        ] {
            parts.set_item(name, part)?;
        }
        Ok(Some(parts))
    }

    /// The energy norm of the displacements, which the bound can be compared with; None without a bound.
    #[getter]
    fn energy_norm(&self) -> Option<f64> {
        self.error_bound_or_reason().ok().map(|bound| bound.energy_norm)
    }

    /// The squared indicators of the error on triangles, whose sum is about the square of the bound; None without a bound.
    #[getter]
    fn indicators<'py>(slf: &Bound<'py, Self>) -> Option<Bound<'py, PyArray1<f64>>> {
        slf.get().error_bound_or_reason().ok()?;
        Some(view(slf, |of| of.error_bound_or_reason().map_or(&[][..], |bound| &bound.indicators)))
    }

    /// The loads of which the quadrature may know too little for the bound to hold.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        let bound = self.error_bound_or_reason();
        bound.map_or_else(|_| Vec::new(), |bound| bound.warnings.iter().map(ToString::to_string).collect())
    }

    /// The solver that found it.
    #[getter]
    fn solver(&self) -> &str {
        &self.solution.statistics().solver
    }

    /// Why the solver stopped, in its own view.
    #[getter]
    fn status(&self) -> &'static str {
        self.solution.statistics().status.as_str()
    }

    /// Which solver was chosen and why, when that was left open.
    #[getter]
    fn choice(&self) -> Option<&str> {
        self.solution.statistics().choice.as_deref()
    }

    /// Iterations of the solver.
    #[getter]
    fn iterations(&self) -> usize {
        self.solution.statistics().iterations
    }

    /// Seconds of set-up and solve.
    #[getter]
    fn seconds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let statistics = self.solution.statistics();
        let seconds = PyDict::new(py);
        seconds.set_item("setup", statistics.setup_seconds)?;
        seconds.set_item("solve", statistics.solve_seconds)?;
        Ok(seconds)
    }

    /// The point of the quadratic program that it is, see `qp`.
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.answer().x)
    }

    /// The multipliers of the quadratic program, see `qp`. Unit: force.
    #[getter]
    fn y<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.answer().y)
    }

    /// It never changes.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    /// As a ``meshio.Mesh`` with the arrays of ``solution.vtu``.
    fn to_meshio<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        python(slf, "to_meshio", |_| Ok(()))
    }

    /// As a ``pyvista.UnstructuredGrid`` with the arrays of ``solution.vtu``.
    fn to_pyvista<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        python(slf, "to_pyvista", |_| Ok(()))
    }

    /// Draws a field with matplotlib.
    ///
    /// Parameters
    /// ----------
    /// field : str
    ///     ``u1`` ..., ``gap``, ``action`` or ``contact``; of several gaps with the number, as in ``gap_1``. Default: the only gap, else ``u1``.
    /// ax : matplotlib.axes.Axes, optional
    ///
    /// Returns
    /// -------
    /// matplotlib.axes.Axes
    #[pyo3(signature = (field=None, ax=None))]
    fn plot<'py>(
        slf: &Bound<'py, Self>,
        field: Option<&str>,
        ax: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        python(slf, "plot", |keywords| {
            keywords.set_item("field", field)?;
            keywords.set_item("ax", ax)
        })
    }

    /// A table for notebooks.
    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        python(slf, "html", |_| Ok(()))
    }

    fn __repr__(&self) -> String {
        let statistics = self.solution.statistics();
        let bound = match self.error_bound_or_reason() {
            Ok(bound) => format!("error at most {:.3e} in the energy norm", bound.total),
            Err(_) => "error not bounded".into(),
        };
        format!(
            "<Solution: {} vertices, contact area {:.6}, force {:.6}; certified, residual {:.1e}; {bound}; {} in {} iterations>",
            self.solution.displacement()[0].len(),
            self.solution.contact_area(),
            self.solution.total_force(),
            self.residual(),
            statistics.solver,
            statistics.iterations,
        )
    }
}

impl Solution {
    /// The solution as an answer to the quadratic program.
    fn answer(&self) -> Answer {
        let StartingPoint { displacement, multiplier } = self.starting_point();
        let x = match &*self.d {
            Discretization::Pair(d) => {
                displacement.iter().flat_map(|u| d.interior().iter().map(|&a| u[a])).collect()
            }
            Discretization::Stack(d) => {
                let mut x = vec![0.0; d.unknowns()];
                for (i, u) in displacement.iter().enumerate() {
                    for (a, &value) in u.iter().enumerate() {
                        if let Some(k) = d.unknown(i + 1, a) {
                            x[k] = value;
                        }
                    }
                }
                x
            }
        };
        Answer { x, y: multiplier }
    }
}

/// What happens in one gap of a solution, between layers ``number`` and ``number + 1`` from the top; the ceiling is layer 0.
#[pyclass(frozen, module = "membrane_contact")]
pub(crate) struct Gap {
    solution: Py<Solution>,
    index: usize,
}

impl Gap {
    fn view<'py, T: numpy::Element>(
        &self,
        py: Python<'py>,
        values: impl Fn(&Solution) -> &[T],
    ) -> Bound<'py, PyArray1<T>> {
        view(self.solution.bind(py), values)
    }

    fn of_stack<'a>(&self, solution: &'a Solution) -> Option<&'a membrane_contact::action::GapSolution> {
        solution.solution.as_stack().map(|stack| &stack.gaps()[self.index])
    }
}

#[pymethods]
impl Gap {
    /// The number of the gap.
    #[getter]
    fn number(&self) -> usize {
        self.of_stack(self.solution.get()).map_or(1, |gap| gap.number)
    }

    /// The distance of the layers, not negative. Unit: length.
    #[getter]
    fn gap<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.view(py, |of| of.gap_values(self.index))
    }

    /// The action, not negative, zero where the layers are apart. Unit: force per area.
    #[getter]
    fn action<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.view(py, |of| of.action_values(self.index))
    }

    /// Whether the layers touch, with a force or without.
    #[getter]
    fn contact<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        self.view(py, |of| of.contact_flags(self.index))
    }

    /// The action times the dual area at each vertex: right also where the action has a density along a line. Unit: force.
    #[getter]
    fn force<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let solution = self.solution.get();
        match self.of_stack(solution) {
            Some(_) => self.view(py, |of| self.of_stack(of).map_or(&[][..], |gap| &gap.force)),
            None => {
                let Discretization::Pair(d) = &*solution.d else {
                    unreachable!("the solution is one of its discretization")
                };
                let lambda = solution.action_values(0).iter();
                let force = lambda.zip(d.dual_area()).map(|(lambda, area)| lambda * area);
                let force = PyArray1::from_iter(py, force);
                force.readwrite().make_nonwriteable();
                force
            }
        }
    }

    /// The density of the action along lines that the data name and that carry a force of their own. Unit: force per length.
    #[getter]
    fn line_density<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        match self.of_stack(self.solution.get()) {
            Some(_) => self.view(py, |of| self.of_stack(of).map_or(&[][..], |gap| &gap.line_density)),
            None => PyArray1::zeros(py, self.solution.get().gap_values(0).len(), false),
        }
    }

    /// The area of the dual cells in contact.
    #[getter]
    fn contact_area(&self) -> f64 {
        self.solution.get().solution.gaps()[self.index].contact_area
    }

    /// The force of the action.
    #[getter]
    fn total_force(&self) -> f64 {
        self.solution.get().solution.gaps()[self.index].total_force
    }

    fn __repr__(&self) -> String {
        let gap = &self.solution.get().solution.gaps()[self.index];
        format!("<Gap {}: contact area {:.6}, force {:.6}>", gap.number, gap.contact_area, gap.total_force)
    }
}
