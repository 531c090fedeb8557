//! Arrays from and to numpy: read-only views of what our objects keep, never copies; copies of what others give.
#![allow(unsafe_code)]

use numpy::ndarray::{ArrayView, ArrayView1, ArrayView2, Dimension};
use numpy::npyffi::NPY_ARRAY_WRITEABLE;
use numpy::{Element, PyArray, PyArray1, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::True;
use pyo3::types::PyDict;

use crate::errors::data_error;

/// A read-only view of what `slice` finds in a frozen object of ours.
pub(crate) fn view<'py, C, T>(owner: &Bound<'py, C>, slice: impl Fn(&C) -> &[T]) -> Bound<'py, PyArray1<T>>
where
    C: PyClass<Frozen = True> + Sync,
    T: Element,
{
    read_only(owner, ArrayView1::from(slice(owner.get())))
}

/// The same of rows.
pub(crate) fn view_rows<'py, C, T, const N: usize>(
    owner: &Bound<'py, C>,
    rows: impl Fn(&C) -> &[[T; N]],
) -> Bound<'py, PyArray2<T>>
where
    C: PyClass<Frozen = True> + Sync,
    T: Element,
{
    read_only(owner, ArrayView2::from(rows(owner.get())))
}

/// The values, which are in the owner, as an array that keeps it alive.
fn read_only<'py, C, T, D>(owner: &Bound<'py, C>, values: ArrayView<'_, T, D>) -> Bound<'py, PyArray<T, D>>
where
    C: PyClass<Frozen = True> + Sync,
    T: Element,
    D: Dimension,
{
    // SAFETY: The class is frozen, so what it keeps stays where it is and as it is for as long as the object lives, and the array keeps
    // the object alive. Nobody writes to it: it is made read-only before anyone else sees it.
    unsafe {
        let array = PyArray::borrow_from_array(&values, owner.as_any().clone());
        (*array.as_array_ptr()).fields.flags &= !NPY_ARRAY_WRITEABLE;
        array
    }
}

/// Anything that numpy takes for a one-dimensional array of numbers.
pub(crate) fn vector(values: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<f64>> {
    let array = as_array(values, "float64", what)?;
    let array = array.cast_into::<PyArray1<f64>>();
    let array = array.map_err(|_| data_error(values.py(), what, "must be an array of one dimension"))?;
    Ok(array.readonly().as_array().iter().copied().collect())
}

/// Anything that numpy takes for an array of rows of `N` numbers.
pub(crate) fn rows<T: Element + Copy, const N: usize>(
    values: &Bound<'_, PyAny>,
    dtype: &str,
    what: &str,
) -> PyResult<Vec<[T; N]>> {
    let py = values.py();
    let shape = || data_error(py, what, format!("must be an array of the shape (any, {N})"));
    let array = as_array(values, dtype, what)?.cast_into::<PyArray2<T>>().map_err(|_| shape())?;
    if array.shape()[1] != N {
        return Err(shape());
    }
    let array = array.readonly();
    let rows = array.as_array();
    Ok(rows.rows().into_iter().map(|row| std::array::from_fn(|k| row[k])).collect())
}

/// The same of numbers of vertices or triangles.
pub(crate) fn counted<const N: usize>(values: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<[usize; N]>> {
    let rows: Vec<[i64; N]> = rows(values, "int64", what)?;
    if let Some(negative) = rows.iter().flatten().find(|number| **number < 0) {
        return Err(data_error(values.py(), what, format!("has the number {negative}: count from 0")));
    }
    Ok(rows.into_iter().map(|row| row.map(|number| number as usize)).collect())
}

/// `numpy.asarray`, which may not lose anything: no fractions, no imaginary parts.
fn as_array<'py>(values: &Bound<'py, PyAny>, dtype: &str, what: &str) -> PyResult<Bound<'py, PyAny>> {
    let py = values.py();
    let numpy = py.import("numpy")?;
    // What is masked is no number.
    if values.hasattr("mask")? && numpy.getattr("ma")?.call_method1("is_masked", (values,))?.is_truthy()? {
        return Err(data_error(py, what, "has masked values: fill them"));
    }
    let convert = || {
        let array = numpy.call_method1("asarray", (values,))?;
        // An empty list is an array of floats to numpy.
        if array.getattr("size")?.extract::<usize>()? == 0 {
            return array.call_method1("astype", (dtype,));
        }
        let same_kind = PyDict::new(py);
        same_kind.set_item("casting", "same_kind")?;
        array.call_method("astype", (dtype,), Some(&same_kind))
    };
    convert().map_err(|error| {
        data_error(py, what, format!("cannot be read as an array of {dtype}: {}", error.value(py)))
    })
}
