//! Data sampled inside triangles, as bounds of errors need them.

use std::ops::Range;

use super::error::StackError;
use super::fields::{IntegrationRule, OnTriangles, pieces};
use crate::mesh::{Mesh, ViewPlace};
use crate::parallel::blocks_of;
use crate::parallel::prelude::*;
use crate::problem::{Field, Function};

/// A field at seven points of a triangle: the corners, the midpoints of the edges from each corner to the next, the barycentre.
pub(crate) type Samples = [f64; 7];

/// Their barycentric coordinates.
const SAMPLES: [[f64; 3]; 7] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.5],
    [0.5, 0.0, 0.5],
    [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
];

/// An affine function at the points, from its values at the corners.
pub(crate) fn at_samples(corners: [f64; 3]) -> Samples {
    SAMPLES.map(|point| (0..3).map(|j| point[j] * corners[j]).sum::<f64>())
}

/// Whether a field has one value on each triangle.
pub(super) fn is_constant_on_triangles(mesh: &Mesh, field: &Field) -> bool {
    match field {
        Field::Everywhere(function) => matches!(function, Function::Constant(_)),
        Field::PerVertex(_) => false,
        Field::PerTriangle(_) => true,
        Field::View(name) => {
            let view = mesh.views().get(name).and_then(Result::ok);
            view.is_some_and(|view| view.place() == ViewPlace::Triangles)
        }
        Field::ByRegion { parts, elsewhere } => {
            let mut fields = parts.iter().map(|(_, field)| field).chain(elsewhere.as_deref());
            fields.all(|field| is_constant_on_triangles(mesh, field))
        }
    }
}

/// Triangles whose points are evaluated together.
const BATCH: usize = 512;

/// A field at the points of each triangle, as the triangle itself sees it. Shape: `triangles x 7`.
pub(super) fn samples(mesh: &Mesh, field: &Field, datum: &str) -> Result<Vec<Samples>, StackError> {
    let mut samples = vec![[0.0; 7]; mesh.triangles().len()];
    for piece in pieces(mesh, field, datum)? {
        let found = match piece.field {
            Field::Everywhere(function) if !matches!(function, Function::Constant(_)) => {
                of_function(mesh, function, &piece.triangles, datum)?
            }
            _ => match piece.on_triangles(mesh, datum, IntegrationRule::Quadrature)? {
                OnTriangles::Values(values) => values.into_iter().map(|value| [value; 7]).collect(),
                OnTriangles::Seen(_) => piece.at_corners(mesh, datum)?.into_iter().map(at_samples).collect(),
            },
        };
        piece.triangles.into_iter().zip(found).for_each(|(t, found)| samples[t] = found);
    }
    Ok(samples)
}

fn of_function(
    mesh: &Mesh,
    function: &Function,
    triangles: &[usize],
    datum: &str,
) -> Result<Vec<Samples>, StackError> {
    let on_block = |block: Range<usize>| {
        let at = |axis: usize| -> Vec<f64> {
            let corners = triangles[block.clone()].iter().map(|&t| mesh.corners(t));
            corners.flat_map(|corners| at_samples(corners.map(|corner| corner[axis]))).collect()
        };
        let (x, y) = (at(0), at(1));
        let mut values = vec![0.0; x.len()];
        function.eval_many(&x, &y, &mut values).map(|()| values.as_chunks().0.to_vec())
    };
    // Collected before errors are looked for, so that the first in the order of the triangles is named.
    let found: Vec<_> = blocks_of(BATCH, triangles.len()).into_par_iter().map(on_block).collect();
    let found: Result<Vec<Vec<Samples>>, _> = found.into_iter().collect();
    found
        .map(|blocks| blocks.concat())
        .map_err(|source| StackError::Evaluation { datum: datum.into(), source })
}
