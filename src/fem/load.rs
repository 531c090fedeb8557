//! Load vectors.

use super::moments::LoadMoments;
use crate::mesh::Mesh;
use crate::parallel::prelude::*;
use crate::problem::{EvaluationError, Function};

/// The load vector `F_a = int f phi_a`, by quadrature of degree 4 (for `f phi_a`: exact for `f` of degree 3). Triangles that
/// one of [`Function::jumps`] crosses are cut along it.
///
/// Shape: `vertices` (zero at unused ones). Unit: force. Linear time, in parallel; the result does not depend on the
/// number of threads.
///
/// # Errors
/// [`EvaluationError`] when `f` fails, or is NaN or infinite at a quadrature point, naming the first in the order of the
/// triangles.
pub fn load(mesh: &Mesh, f: &Function) -> Result<Vec<f64>, EvaluationError> {
    Ok(LoadMoments::new(mesh, f)?.vector(mesh))
}

/// `int_K f phi_i` for the three corners of each triangle `K`: what [`load`] adds up.
///
/// Shape: `triangles x 3`. Unit: force. Linear time, in parallel.
///
/// # Errors
/// As [`load`].
pub fn element_loads(mesh: &Mesh, f: &Function) -> Result<Vec<[f64; 3]>, EvaluationError> {
    let moments = LoadMoments::new(mesh, f)?;
    Ok((0..mesh.triangles().len()).into_par_iter().map(|t| moments.on(mesh, t).integrals).collect())
}

#[cfg(test)]
mod tests;
