//! The program `membranes`.

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the program on these arguments, of which the first is its own name, and returns the exit code.
#[pyfunction]
pub(crate) fn run(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| membrane_contact::cli::run(arguments))
}
