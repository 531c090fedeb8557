//! Load vectors.

use rayon::prelude::*;
use thiserror::Error;

use super::quadrature::{DEGREE_4, TriangleRule};
use crate::mesh::{Mesh, VertexTriangles};
use crate::problem::Function;

/// Triangles whose quadrature points are evaluated together.
const BLOCK: usize = 512;

/// A function has no finite value at a quadrature point.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("is {value} at the point ({}, {})", point[0], point[1])]
pub struct NotFinite {
    /// Where.
    pub point: [f64; 2],
    /// NaN or an infinity.
    pub value: f64,
}

/// The load vector `F_a = int f phi_a`, by quadrature of degree 4 (for `f phi_a`: exact for `f` of degree 3).
///
/// Shape: `vertices` (zero at unused ones). Unit: force. Linear time, in parallel; the result does not depend on the
/// number of threads.
///
/// # Errors
/// [`NotFinite`] when `f` is NaN or infinite at a quadrature point, naming the first in the order of the triangles.
pub fn load(mesh: &Mesh, f: &Function) -> Result<Vec<f64>, NotFinite> {
    load_around(mesh, &VertexTriangles::new(mesh.points().len(), mesh.triangles()), f)
}

/// [`load`], with the triangles around the vertices at hand.
pub(crate) fn load_around(
    mesh: &Mesh,
    around: &VertexTriangles,
    f: &Function,
) -> Result<Vec<f64>, NotFinite> {
    let blocks = mesh.triangles().len().div_ceil(BLOCK);
    // Collected before errors are looked for, so that the first in the order of the triangles is named.
    let blocks: Vec<_> =
        (0..blocks).into_par_iter().map(|block| element_loads(mesh, block, f, &DEGREE_4)).collect();
    let blocks = blocks.into_iter().collect::<Result<Vec<_>, _>>()?;
    let on_element = |t: usize, a: usize| {
        let corner = mesh.triangles()[t].iter().position(|&b| b == a);
        blocks[t / BLOCK][t % BLOCK][corner.expect("a is a corner of the triangles around it")]
    };
    let at = |a: usize| around.of(a).iter().map(|&t| on_element(t, a)).sum();
    Ok((0..mesh.points().len()).into_par_iter().map(at).collect())
}

/// `int_T f phi_i` for the three corners of each triangle of a block.
fn element_loads(
    mesh: &Mesh,
    block: usize,
    f: &Function,
    rule: &TriangleRule,
) -> Result<Vec<[f64; 3]>, NotFinite> {
    let triangles = block * BLOCK..((block + 1) * BLOCK).min(mesh.triangles().len());
    let points = rule.points.len();
    let (mut x, mut y) = (Vec::with_capacity(points * BLOCK), Vec::with_capacity(points * BLOCK));
    for t in triangles.clone() {
        let corners = mesh.corners(t);
        for barycentric in rule.points {
            let at = |axis: usize| (0..3).map(|i| barycentric[i] * corners[i][axis]).sum::<f64>();
            x.push(at(0));
            y.push(at(1));
        }
    }
    let mut values = vec![0.0; x.len()];
    f.eval_many(&x, &y, &mut values);
    if let Some(k) = values.iter().position(|value| !value.is_finite()) {
        return Err(NotFinite { point: [x[k], y[k]], value: values[k] });
    }
    let integral = |t: usize, values: &[f64], corner: usize| {
        let terms = values.iter().zip(rule.weights).zip(rule.points);
        mesh.triangle_area(t) * terms.map(|((f, weight), b)| weight * f * b[corner]).sum::<f64>()
    };
    Ok(triangles
        .zip(values.chunks_exact(points))
        .map(|(t, values)| [0, 1, 2].map(|corner| integral(t, values, corner)))
        .collect())
}

#[cfg(test)]
mod tests;
