//! Load vectors.

use crate::parallel::prelude::*;
use thiserror::Error;

use super::moments::LoadMoments;
use crate::mesh::{Mesh, VertexTriangles};
use crate::problem::Function;
use crate::text::Number;

/// A function has no finite value at a quadrature point.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("is {} at the point ({}, {})", Number(*value), Number(point[0]), Number(point[1]))]
pub struct NotFinite {
    /// Where.
    pub point: [f64; 2],
    /// NaN or an infinity.
    pub value: f64,
}

/// The load vector `F_a = int f phi_a`, by quadrature of degree 4 (for `f phi_a`: exact for `f` of degree 3). Triangles that
/// one of [`Function::jumps`] crosses are cut along it.
///
/// Shape: `vertices` (zero at unused ones). Unit: force. Linear time, in parallel; the result does not depend on the
/// number of threads.
///
/// # Errors
/// [`NotFinite`] when `f` is NaN or infinite at a quadrature point, naming the first in the order of the triangles.
pub fn load(mesh: &Mesh, f: &Function) -> Result<Vec<f64>, NotFinite> {
    let around = VertexTriangles::new(mesh.points().len(), mesh.triangles());
    Ok(LoadMoments::new(mesh, f)?.vector(mesh, &around))
}

/// `int_K f phi_i` for the three corners of each triangle `K`: what [`load`] adds up.
///
/// Shape: `triangles x 3`. Unit: force. Linear time, in parallel.
///
/// # Errors
/// As [`load`].
pub fn element_loads(mesh: &Mesh, f: &Function) -> Result<Vec<[f64; 3]>, NotFinite> {
    let moments = LoadMoments::new(mesh, f)?;
    Ok((0..mesh.triangles().len()).into_par_iter().map(|t| moments.on(mesh, t).integrals).collect())
}

#[cfg(test)]
mod tests;
