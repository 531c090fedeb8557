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
    over_blocks(mesh, f, |_, integrals, _| integrals)
}

/// A load on one triangle `K`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ElementMoments {
    /// `int_K f phi_i` for the three corners. Unit: force.
    pub(crate) integrals: [f64; 3],
    /// `||f - p||_K`, where the affine function `p` has the same integrals. Unit: force per length.
    pub(crate) deviation: f64,
}

impl ElementMoments {
    fn of_constant(value: f64, area: f64) -> Self {
        Self { integrals: [value * area / 3.0; 3], deviation: 0.0 }
    }

    fn new(area: f64, integrals: [f64; 3], samples: &Samples) -> Self {
        let mean = integrals.iter().sum::<f64>() / area;
        // `int_K p phi_i = |K| / 12 (3 mean + p_i)`.
        let at_corners = integrals.map(|integral| 12.0 * integral / area - 3.0 * mean);
        let mut square = 0.0;
        samples(&mut |Sample { value, weight, barycentric }| {
            let affine = (0..3).map(|i| barycentric[i] * at_corners[i]).sum::<f64>();
            square += weight * (value - affine).powi(2);
        });
        Self { integrals, deviation: square.sqrt() }
    }
}

/// The moments of `f` on the triangles, by the quadrature of [`load`]: what error bounds need of it. Linear time, in parallel.
///
/// # Errors
/// As [`load`].
pub(crate) fn element_moments(mesh: &Mesh, f: &Function) -> Result<Vec<ElementMoments>, NotFinite> {
    if let Function::Constant(value) = *f {
        let of_triangle = |t| ElementMoments::of_constant(value, mesh.triangle_area(t));
        return Ok((0..mesh.triangles().len()).into_par_iter().map(of_triangle).collect());
    }
    over_blocks(mesh, f, ElementMoments::new)
}

/// A point of the rule.
struct Sample {
    value: f64,
    weight: f64,
    barycentric: [f64; 3],
}

/// Calls its argument for the points of the rule on a triangle.
type Samples<'a> = dyn Fn(&mut dyn FnMut(Sample)) + 'a;

/// `of(area, integrals, samples)` for each triangle: the integrals of `f` against the hat functions, and `f` at the points of
/// the rule.
fn over_blocks<T: Clone + Send>(
    mesh: &Mesh,
    f: &Function,
    of: impl Fn(f64, [f64; 3], &Samples) -> T + Sync,
) -> Result<Vec<T>, NotFinite> {
    let blocks = mesh.triangles().len().div_ceil(BLOCK);
    // Collected before errors are looked for, so that the first in the order of the triangles is named.
    let blocks: Vec<_> =
        (0..blocks).into_par_iter().map(|block| on_block(mesh, block, f, &DEGREE_4, &of)).collect();
    Ok(blocks.into_iter().collect::<Result<Vec<_>, _>>()?.concat())
}

/// [`over_blocks`] for one block of triangles.
fn on_block<T>(
    mesh: &Mesh,
    block: usize,
    f: &Function,
    rule: &TriangleRule,
    of: impl Fn(f64, [f64; 3], &Samples) -> T,
) -> Result<Vec<T>, NotFinite> {
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
    let cut = CutRule::new(f.jumps().to_vec(), None, JUMP_DEPTH);
    let on_triangle = |(t, values): (usize, &[f64])| {
        let (corners, area) = (mesh.corners(t), mesh.triangle_area(t));
        if cut.is_plain(corners) {
            let terms = || values.iter().zip(rule.weights).zip(rule.points);
            let integral =
                |corner: usize| area * terms().map(|((f, weight), b)| weight * f * b[corner]).sum::<f64>();
            of(area, [0, 1, 2].map(integral), &|sample| {
                terms().for_each(|((&value, weight), &barycentric)| {
                    sample(Sample { value, weight: area * weight, barycentric });
                });
            })
        } else {
            of(area, cut_load(corners, f, &cut), &|sample| {
                cut.visit(corners, &mut |point, weight| {
                    let value = f.eval(point[0], point[1]);
                    sample(Sample { value, weight, barycentric: hats(corners, point) });
                });
            })
        }
    };
    Ok(triangles.zip(values.chunks_exact(points)).map(on_triangle).collect())
}

/// `int_T f phi_i` for the three corners of a triangle in which `f` jumps.
fn cut_load(corners: [[f64; 2]; 3], f: &Function, cut: &CutRule) -> [f64; 3] {
    let mut integrals = [0.0; 3];
    cut.visit(corners, &mut |point, weight| {
        let value = weight * f.eval(point[0], point[1]);
        integrals.iter_mut().zip(hats(corners, point)).for_each(|(integral, hat)| *integral += value * hat);
    });
    integrals
}

/// The hat functions of the corners at a point.
fn hats(corners: [[f64; 2]; 3], point: [f64; 2]) -> [f64; 3] {
    let twice_area = twice_signed_area(corners);
    [0, 1, 2].map(|i| twice_signed_area([point, corners[(i + 1) % 3], corners[(i + 2) % 3]]) / twice_area)
}

#[cfg(test)]
mod tests;
