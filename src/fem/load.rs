//! Load vectors.

use rayon::prelude::*;
use thiserror::Error;

use super::CutRule;
use super::quadrature::{DEGREE_4, TriangleRule};
use crate::mesh::{Mesh, VertexTriangles, twice_signed_area};
use crate::problem::Function;

/// Triangles whose quadrature points are evaluated together.
const BLOCK: usize = 512;

/// Subdivisions of a triangle that a jump of the load crosses: the jump is where it is, up to a sixteenth of the mesh size
/// squared.
const JUMP_DEPTH: usize = 4;

/// A function has no finite value at a quadrature point.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("is {value} at the point ({}, {})", point[0], point[1])]
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
    load_around(mesh, &VertexTriangles::new(mesh.points().len(), mesh.triangles()), f)
}

/// [`load`], with the triangles around the vertices at hand.
pub(crate) fn load_around(
    mesh: &Mesh,
    around: &VertexTriangles,
    f: &Function,
) -> Result<Vec<f64>, NotFinite> {
    let integrals = element_loads(mesh, f)?;
    let on_element = |t: usize, a: usize| {
        let corner = mesh.triangles()[t].iter().position(|&b| b == a);
        integrals[t][corner.expect("a is a corner of the triangles around it")]
    };
    let at = |a: usize| around.of(a).iter().map(|&t| on_element(t, a)).sum();
    Ok((0..mesh.points().len()).into_par_iter().map(at).collect())
}

/// `int_K f phi_i` for the three corners of each triangle `K`: what [`load`] adds up.
///
/// Shape: `triangles x 3`. Unit: force. Linear time, in parallel.
///
/// # Errors
/// As [`load`].
pub fn element_loads(mesh: &Mesh, f: &Function) -> Result<Vec<[f64; 3]>, NotFinite> {
    let blocks = mesh.triangles().len().div_ceil(BLOCK);
    // Collected before errors are looked for, so that the first in the order of the triangles is named.
    let blocks: Vec<_> =
        (0..blocks).into_par_iter().map(|block| block_loads(mesh, block, f, &DEGREE_4)).collect();
    Ok(blocks.into_iter().collect::<Result<Vec<_>, _>>()?.concat())
}

/// [`element_loads`] for one block of triangles.
fn block_loads(
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
    let cut = CutRule::new(f.jumps().to_vec(), None, JUMP_DEPTH);
    Ok(triangles
        .zip(values.chunks_exact(points))
        .map(|(t, values)| {
            if cut.is_plain(mesh.corners(t)) {
                [0, 1, 2].map(|corner| integral(t, values, corner))
            } else {
                cut_load(mesh.corners(t), f, &cut)
            }
        })
        .collect())
}

/// `int_T f phi_i` for the three corners of a triangle in which `f` jumps.
fn cut_load(corners: [[f64; 2]; 3], f: &Function, cut: &CutRule) -> [f64; 3] {
    let twice_area = twice_signed_area(corners);
    let mut integrals = [0.0; 3];
    cut.visit(corners, &mut |point, weight| {
        let value = weight * f.eval(point[0], point[1]);
        for (i, integral) in integrals.iter_mut().enumerate() {
            let hat = twice_signed_area([point, corners[(i + 1) % 3], corners[(i + 2) % 3]]) / twice_area;
            *integral += value * hat;
        }
    });
    integrals
}

#[cfg(test)]
mod tests;
