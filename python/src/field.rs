//! Data over the domain: numbers, formulas, callables, arrays over the mesh, views, or one of these for each region.

use std::sync::Arc;

use membrane_contact::mesh::Mesh;
use membrane_contact::problem::{Expression, Field, Function};
use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping, PyString};

use crate::arrays::vector;
use crate::errors::data_error;
use crate::worker::{Line, Raised};

/// What stands among names for all that is not named.
pub(crate) const ELSEWHERE: &str = "elsewhere";

/// The only key of a dictionary that names data of the mesh.
const VIEW: &str = "view";

/// What data are read with.
#[derive(Clone, Copy)]
pub(crate) struct Reader<'a> {
    pub(crate) mesh: &'a Mesh,
    /// Where callables are called.
    pub(crate) line: &'a Line,
}

impl Reader<'_> {
    /// A number, a formula, a callable, an array, a view, or one of these for each region. `key` is named in messages.
    pub(crate) fn field(self, datum: &Bound<'_, PyAny>, key: &str) -> PyResult<Field> {
        let Some(by_name) = names(datum, key)? else { return self.datum(datum, key) };
        let mut parts = Vec::new();
        let mut elsewhere = None;
        for (name, value) in by_name {
            let value = self.datum(&value, &format!("{key}[{name:?}]"))?;
            if name == ELSEWHERE {
                elsewhere = Some(value);
            } else {
                parts.push((name, value));
            }
        }
        Ok(match elsewhere {
            Some(everywhere) if parts.is_empty() => everywhere,
            Some(elsewhere) => Field::by_region(parts).elsewhere(elsewhere),
            None => Field::by_region(parts),
        })
    }

    /// A number, a formula, a callable, an array, or a view.
    pub(crate) fn datum(self, datum: &Bound<'_, PyAny>, key: &str) -> PyResult<Field> {
        if let Some(name) = view(datum, key)? {
            return Ok(Field::view(name));
        }
        if let Some(function) = self.plain(datum, key)? {
            return Ok(function.into());
        }
        let values = vector(datum, key)?;
        let [vertices, triangles] = [self.mesh.points().len(), self.mesh.triangles().len()];
        match values.len() {
            n if n == vertices && n == triangles => Err(data_error(
                datum.py(),
                key,
                format!(
                    "has {n} values, as many as there are vertices and triangles: name them with Mesh.with_view"
                ),
            )),
            n if n == vertices => Ok(Field::PerVertex(values.into())),
            n if n == triangles => Ok(Field::PerTriangle(values.into())),
            n => Err(data_error(
                datum.py(),
                key,
                format!(
                    "has {n} values: give one, or one for each of the {vertices} vertices or {triangles} triangles"
                ),
            )),
        }
    }

    /// A number, a formula, or a callable.
    pub(crate) fn function(self, datum: &Bound<'_, PyAny>, key: &str) -> PyResult<Function> {
        self.plain(datum, key)?.ok_or_else(|| {
            let kind = datum.get_type();
            PyTypeError::new_err(format!(
                "{key} must be a number, a formula, or a callable f(x, y), not {kind}"
            ))
        })
    }

    fn plain(self, datum: &Bound<'_, PyAny>, key: &str) -> PyResult<Option<Function>> {
        if let Ok(formula) = datum.cast::<PyString>() {
            let formula = Expression::parse(formula.to_str()?);
            let formula =
                formula.map_err(|error| data_error(datum.py(), key, format!("is no formula: {error}")))?;
            return Ok(Some(formula.into()));
        }
        if datum.is_callable() {
            return Ok(Some(callable(datum, key, self.line)));
        }
        Ok(number(datum)?.map(Function::Constant))
    }
}

/// A number, of Python or of numpy; a complex one is none, nor is an array of one.
fn number(datum: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    let Some(dtype) = datum.getattr_opt("dtype")? else { return Ok(datum.extract().ok()) };
    let is_real = matches!(dtype.getattr("kind")?.extract()?, 'b' | 'i' | 'u' | 'f');
    let is_one = datum.getattr("ndim")?.extract::<usize>()? == 0;
    Ok(if is_real && is_one { datum.extract().ok() } else { None })
}

/// A value for each name.
type ByName<'py> = Vec<(String, Bound<'py, PyAny>)>;

/// The entries of a dictionary with a value for each name; `None` for anything else.
pub(crate) fn names<'py>(datum: &Bound<'py, PyAny>, key: &str) -> PyResult<Option<ByName<'py>>> {
    let Some(mapping) = mapping(datum) else { return Ok(None) };
    if view(datum, key)?.is_some() {
        return Ok(None);
    }
    let mut entries = Vec::new();
    for entry in mapping.items()? {
        let (name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = entry.extract()?;
        let Ok(name) = name.extract::<String>() else {
            return Err(data_error(
                datum.py(),
                key,
                format!("has the key {}: names are strings", name.repr()?),
            ));
        };
        entries.push((name, value));
    }
    if entries.is_empty() {
        return Err(data_error(datum.py(), key, "is empty: give one value, or one for each name"));
    }
    Ok(Some(entries))
}

/// A dictionary, or what is like one. Anything without keys is not asked what it is: after an interpreter within this one has ended, Python
/// 3.11 cannot answer.
pub(crate) fn mapping<'a, 'py>(datum: &'a Bound<'py, PyAny>) -> Option<&'a Bound<'py, PyMapping>> {
    let has_keys = datum.hasattr("keys").unwrap_or(false);
    has_keys.then(|| datum.cast::<PyMapping>().ok()).flatten()
}

/// The name in `{"view": name}`.
fn view(datum: &Bound<'_, PyAny>, key: &str) -> PyResult<Option<String>> {
    let Ok(mapping) = datum.cast::<PyDict>() else { return Ok(None) };
    if mapping.len() != 1 {
        return Ok(None);
    }
    let Some(name) = mapping.get_item(VIEW)? else { return Ok(None) };
    match name.extract() {
        Ok(name) => Ok(Some(name)),
        Err(_) => Err(data_error(datum.py(), key, "must name a data view of the mesh: {\"view\": name}")),
    }
}

/// A callable `f(x, y)` of arrays.
fn callable(f: &Bound<'_, PyAny>, key: &str, line: &Line) -> Function {
    let f: Arc<Py<PyAny>> = Arc::new(f.clone().unbind());
    let (key, line) = (key.to_owned(), line.clone());
    Function::try_from_fn(move |x, y, values| -> Result<(), Raised> {
        let (f, key, points) = (Arc::clone(&f), key.clone(), [x.to_vec(), y.to_vec()]);
        values.copy_from_slice(&line.call(move |py| call(f.bind(py), &key, points))?);
        Ok(())
    })
}

/// The values of a callable at the points.
fn call(f: &Bound<'_, PyAny>, key: &str, [x, y]: [Vec<f64>; 2]) -> PyResult<Vec<f64>> {
    let py = f.py();
    let points = x.len();
    let answer = f.call1((PyArray1::from_vec(py, x), PyArray1::from_vec(py, y)))?;
    if let Some(number) = number(&answer)? {
        return Ok(vec![number; points]);
    }
    let key = format!("{key}(x, y)");
    let values = vector(&answer, &key)?;
    if values.len() != points {
        return Err(data_error(py, &key, format!("returned {} values for {points} points", values.len())));
    }
    Ok(values)
}
