//! A load triangle by triangle: what load vectors and error bounds need of it.

use rayon::prelude::*;

use super::CutRule;
use super::load::NotFinite;
use super::quadrature::DEGREE_4;
use crate::geometry::twice_signed_area;
use crate::mesh::{Mesh, VertexTriangles, corner_of};
use crate::problem::Function;

/// Triangles whose quadrature points are evaluated together.
pub(super) const BLOCK: usize = 512;

/// Subdivisions of a triangle that a jump of the load crosses: the jump is where it is, up to a sixteenth of the mesh size
/// squared.
const JUMP_DEPTH: usize = 4;

/// The moments of a load on all triangles, by the quadrature of [`load`](super::load()).
#[derive(Debug, Clone)]
pub(crate) enum LoadMoments {
    /// The same value everywhere: nothing needs to be kept.
    Constant(f64),
    /// Over triangles.
    Varying(Vec<ElementMoments>),
}

impl LoadMoments {
    /// Linear time, in parallel; the result does not depend on the number of threads.
    ///
    /// # Errors
    /// As [`load`](super::load()).
    pub(crate) fn new(mesh: &Mesh, f: &Function) -> Result<Self, NotFinite> {
        match *f {
            Function::Constant(value) if value.is_finite() => Ok(Self::Constant(value)),
            _ => {
                let blocks = 0..mesh.triangles().len().div_ceil(BLOCK);
                // Collected before errors are looked for, so that the first in the order of the triangles is named.
                let blocks: Vec<_> = blocks.into_par_iter().map(|block| on_block(mesh, block, f)).collect();
                Ok(Self::Varying(blocks.into_iter().collect::<Result<Vec<_>, _>>()?.concat()))
            }
        }
    }

    /// Those on triangle `t`.
    pub(crate) fn on(&self, mesh: &Mesh, t: usize) -> ElementMoments {
        match self {
            Self::Constant(value) => {
                ElementMoments { integrals: [value * mesh.triangle_area(t) / 3.0; 3], deviation: 0.0 }
            }
            Self::Varying(moments) => moments[t],
        }
    }

    /// The load vector: the sums of the integrals around the vertices.
    pub(crate) fn vector(&self, mesh: &Mesh, around: &VertexTriangles) -> Vec<f64> {
        let on_element = |t: usize, a: usize| self.on(mesh, t).integrals[corner_of(mesh.triangles()[t], a)];
        let at = |a: usize| around.of(a).iter().map(|&t| on_element(t, a)).sum();
        (0..mesh.points().len()).into_par_iter().map(at).collect()
    }
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
    fn new(area: f64, samples: &Samples) -> Self {
        let integrals = samples.integrals(area);
        let mean = integrals.iter().sum::<f64>() / area;
        // `int_K p phi_i = |K| / 12 (3 mean + p_i)`.
        let [p, q, r] = integrals.map(|integral| 12.0 * integral / area - 3.0 * mean);
        let Samples { values, weights, points } = samples;
        let mut square = 0.0;
        for ((value, weight), [a, b, c]) in values.iter().zip(*weights).zip(*points) {
            square += weight * (value - (a * p + b * q + c * r)).powi(2);
        }
        Self { integrals, deviation: (area * square).sqrt() }
    }
}

/// A function at the points of a rule on a triangle.
struct Samples<'a> {
    values: &'a [f64],
    /// Their sum is one.
    weights: &'a [f64],
    /// Barycentric coordinates.
    points: &'a [[f64; 3]],
}

impl Samples<'_> {
    /// `int_T f phi_i` for the three corners.
    fn integrals(&self, area: f64) -> [f64; 3] {
        let mut integrals = [0.0; 3];
        for ((value, weight), point) in self.values.iter().zip(self.weights).zip(self.points) {
            (0..3).for_each(|i| integrals[i] += weight * value * point[i]);
        }
        integrals.map(|integral| area * integral)
    }
}

/// The moments on one block of triangles.
fn on_block(mesh: &Mesh, block: usize, f: &Function) -> Result<Vec<ElementMoments>, NotFinite> {
    let rule = DEGREE_4;
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
    let mut along_jumps = CutSamples::default();
    let on_triangle = |(t, values): (usize, &[f64])| {
        let (corners, area) = (mesh.corners(t), mesh.triangle_area(t));
        let samples = if cut.is_plain(corners) {
            Samples { values, weights: rule.weights, points: rule.points }
        } else {
            along_jumps.of(corners, f, &cut)
        };
        ElementMoments::new(area, &samples)
    };
    Ok(triangles.zip(values.chunks_exact(points)).map(on_triangle).collect())
}

/// Memory for the points on a triangle in which a function jumps.
#[derive(Default)]
struct CutSamples {
    values: Vec<f64>,
    weights: Vec<f64>,
    points: Vec<[f64; 3]>,
}

impl CutSamples {
    fn of(&mut self, corners: [[f64; 2]; 3], f: &Function, cut: &CutRule) -> Samples<'_> {
        let Self { values, weights, points } = self;
        values.clear();
        weights.clear();
        points.clear();
        let area = 0.5 * twice_signed_area(corners);
        cut.visit(corners, &mut |point, weight| {
            values.push(f.eval(point[0], point[1]));
            weights.push(weight / area);
            points.push(hats(corners, point));
        });
        Samples { values, weights, points }
    }
}

/// The hat functions of the corners at a point.
fn hats(corners: [[f64; 2]; 3], point: [f64; 2]) -> [f64; 3] {
    let twice_area = twice_signed_area(corners);
    [0, 1, 2].map(|i| twice_signed_area([point, corners[(i + 1) % 3], corners[(i + 2) % 3]]) / twice_area)
}
