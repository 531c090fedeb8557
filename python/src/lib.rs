//! The Python package: a thin rim around the core, by its public interface only. No mathematics is here.

mod adapt;
mod arrays;
mod backend;
mod errors;
mod field;
mod mesh;
mod problem;
mod program;
mod qp;
mod solution;
mod solve;
mod worker;

use pyo3::prelude::*;

#[pymodule(gil_used = false)]
mod _core {
    #[pymodule_export]
    use crate::adapt::adapt;
    #[pymodule_export]
    use crate::errors::{BackendError, CertificationError, ContactError, DataError, MeshError};
    #[pymodule_export]
    use crate::mesh::Mesh;
    #[pymodule_export]
    use crate::program::run;
    #[pymodule_export]
    use crate::qp::{Qp, qp};
    #[pymodule_export]
    use crate::solution::{Gap, Solution};
    #[pymodule_export]
    use crate::solve::solve;

    use super::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
