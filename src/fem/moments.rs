//! A load triangle by triangle: what load vectors and error bounds need of it.

use std::ops::Range;

use super::CutRule;
use super::dual_norm::dual_norm;
use super::quadrature::DEGREE_4;
use super::second_rule::SecondRule;
use crate::geometry::{poincare, twice_signed_area};
use crate::mesh::{Mesh, corner_of};
use crate::parallel::prelude::*;
use crate::parallel::{BLOCK, blocks_of};
use crate::problem::{EvaluationError, Function};

/// Triangles whose quadrature points are evaluated together.
pub(super) const BATCH: usize = 512;

/// Subdivisions of a triangle that a jump of the load crosses: the jump is where it is, up to a sixteenth of the mesh size
/// squared.
const JUMP_DEPTH: usize = 4;

/// The moments of a load on all triangles, by the quadrature of [`load`](super::load()).
#[derive(Debug, Clone)]
pub(crate) enum LoadMoments {
    /// The same value everywhere: nothing needs to be kept.
    Constant(f64),
    /// One that is known at the points of the quadrature.
    Varying {
        /// Over triangles.
        moments: Vec<ElementMoments>,
        /// What a second rule finds beyond them, see [`LoadMoments::quadrature_difference`].
        difference: f64,
    },
}

impl LoadMoments {
    /// Linear time, in parallel; the result does not depend on the number of threads.
    ///
    /// # Errors
    /// As [`load`](super::load()).
    pub(crate) fn new(mesh: &Mesh, f: &Function) -> Result<Self, EvaluationError> {
        if let Function::Constant(value) = *f
            && value.is_finite()
        {
            return Ok(Self::Constant(value));
        }
        let triangles = mesh.triangles().len();
        let blocks = || blocks_of(BATCH, triangles).into_par_iter();
        let area_of = |block: Range<usize>| block.map(|t| mesh.triangle_area(t)).sum();
        let areas: Vec<f64> = blocks().map(area_of).collect();
        let second_rule = SecondRule::new(areas.iter().sum());
        // Collected before errors are looked for, so that the first in the order of the triangles is named.
        let blocks: Vec<_> = blocks().map(|block| on_block(mesh, block, f, &second_rule)).collect();
        Ok(SeenLoad::of_batches(blocks.into_iter().collect::<Result<_, _>>()?).into_moments(mesh))
    }

    /// Of a load that is given by parts: the triangles of each, and what is seen of it there. Together they are all triangles.
    pub(crate) fn of_parts(mesh: &Mesh, parts: impl IntoIterator<Item = (Vec<usize>, SeenLoad)>) -> Self {
        let nothing = ElementMoments { integrals: [0.0; 3], deviation: 0.0 };
        let triangles = mesh.triangles().len();
        let mut all =
            SeenLoad { moments: vec![nothing; triangles], means: vec![0.0; triangles], excess_sq: 0.0 };
        for (triangles, part) in parts {
            for ((t, moments), mean) in triangles.into_iter().zip(part.moments).zip(part.means) {
                (all.moments[t], all.means[t]) = (moments, mean);
            }
            all.excess_sq += part.excess_sq;
        }
        all.into_moments(mesh)
    }

    /// What a second quadrature rule, at other points, finds of the load `f` beyond the affine functions `p` that stand for it, in the
    /// norm in which a load enters the bound of the error, but for the tension:
    ///
    /// ```text
    /// ( sum_K (h_K / pi)^2 max(0, ||f - p - m_K||_K^2 - ||f - p||_K^2) )^(1/2) + || m ||_{H^-1}
    /// ```
    ///
    /// The means `m_K` of `f - p` are zero by the first rule; so is the rest, where both rules find the same. Unit: force.
    pub(crate) fn quadrature_difference(&self) -> f64 {
        match self {
            Self::Constant(_) => 0.0,
            Self::Varying { difference, .. } => *difference,
        }
    }

    /// Whether the load varies, but is zero at all points of the quadrature.
    pub(crate) fn sees_nothing(&self) -> bool {
        match self {
            Self::Constant(_) => false,
            Self::Varying { moments, .. } => moments
                .iter()
                .all(|on_triangle| on_triangle.integrals == [0.0; 3] && on_triangle.deviation == 0.0),
        }
    }

    /// Those on triangle `t`.
    pub(crate) fn on(&self, mesh: &Mesh, t: usize) -> ElementMoments {
        match self {
            Self::Constant(value) => {
                ElementMoments { integrals: [value * mesh.triangle_area(t) / 3.0; 3], deviation: 0.0 }
            }
            Self::Varying { moments, .. } => moments[t],
        }
    }

    /// `int_K f phi_i` for corner `i` of triangle `t`, whose area is known.
    pub(crate) fn share(&self, t: usize, i: usize, area: f64) -> f64 {
        match self {
            Self::Constant(value) => value * area / 3.0,
            Self::Varying { moments, .. } => moments[t].integrals[i],
        }
    }

    /// The load vector: the sums of the integrals around the vertices.
    pub(crate) fn vector(&self, mesh: &Mesh) -> Vec<f64> {
        let on_element =
            |t: usize, a: usize| self.share(t, corner_of(mesh.triangles()[t], a), mesh.triangle_area(t));
        let at = |a: usize| mesh.around().triangles(a).map(|t| on_element(t, a)).sum();
        (0..mesh.points().len()).into_par_iter().with_min_len(BLOCK).map(at).collect()
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
        let own = Self { integrals, deviation: 0.0 };
        Self { deviation: (area * own.rest(area, samples).square).sqrt(), ..own }
    }

    /// `||f - f_a||_K` or more, where `f_a` on the wedge of each corner is its share `(3 / |K|) int_K f phi_a`: that is
    /// `||f - p||_K` and `||p - f_a||_K = (5/3 sum_a |K|/3 (f_a - f_K)^2)^(1/2)`.
    pub(crate) fn oscillation(&self, area: f64) -> f64 {
        let mean = self.integrals.iter().sum::<f64>() / area;
        let shares_sq: f64 = self.integrals.iter().map(|f| (3.0 * f / area - mean).powi(2)).sum();
        self.deviation + (5.0 / 9.0 * area * shares_sq).sqrt()
    }

    /// The values of `p` at the corners: `int_K p phi_i = |K| / 12 (3 mean + p_i)`.
    fn affine(&self, area: f64) -> [f64; 3] {
        let mean = self.integrals.iter().sum::<f64>() / area;
        self.integrals.map(|integral| 12.0 * integral / area - 3.0 * mean)
    }

    /// The means of `f - p` and of its square.
    fn rest(&self, area: f64, samples: &Samples) -> Rest {
        let [p, q, r] = self.affine(area);
        let (mut mean, mut square) = (0.0, 0.0);
        for ((value, weight), [a, b, c]) in samples.values.iter().zip(samples.weights).zip(samples.points) {
            let rest = value - (a * p + b * q + c * r);
            mean += weight * rest;
            square += weight * rest * rest;
        }
        Rest { mean, square }
    }

    /// What the samples of another rule find beyond these moments.
    fn beyond(&self, area: f64, samples: &Samples) -> Beyond {
        let Rest { mean, square } = self.rest(area, samples);
        let excess_sq = area * (square - mean * mean) - self.deviation * self.deviation;
        Beyond { mean, excess_sq: excess_sq.max(0.0) }
    }
}

/// Means over a triangle.
struct Rest {
    mean: f64,
    square: f64,
}

/// What a second rule finds of `f - p` on a triangle.
#[derive(Debug, Clone, Copy)]
struct Beyond {
    /// Its mean.
    mean: f64,
    /// The square of its norm without the mean, as far as that is more than what the first rule finds.
    excess_sq: f64,
}

/// A function at the points of a rule on a triangle.
#[derive(Clone, Copy)]
struct Samples<'a> {
    values: &'a [f64],
    /// Their sum is one.
    weights: &'a [f64],
    /// Barycentric coordinates.
    points: &'a [[f64; 3]],
}

impl<'a> Samples<'a> {
    /// Takes the values at the points of a rule off the front of `values`.
    fn next(values: &mut &'a [f64], weights: &'a [f64], points: &'a [[f64; 3]]) -> Self {
        let (own, rest) = values.split_at(points.len());
        *values = rest;
        Self { values: own, weights, points }
    }

    /// `int_T f phi_i` for the three corners.
    fn integrals(&self, area: f64) -> [f64; 3] {
        let mut integrals = [0.0; 3];
        for ((value, weight), point) in self.values.iter().zip(self.weights).zip(self.points) {
            (0..3).for_each(|i| integrals[i] += weight * value * point[i]);
        }
        integrals.map(|integral| area * integral)
    }
}

/// What the two rules find of a load on some triangles.
pub(crate) struct SeenLoad {
    pub(crate) moments: Vec<ElementMoments>,
    /// What the second rule finds: the means of `f - p`, and the sum of `(h_K / pi)^2` times the rest.
    means: Vec<f64>,
    excess_sq: f64,
}

impl SeenLoad {
    fn with_capacity(triangles: usize) -> Self {
        Self { moments: Vec::with_capacity(triangles), means: Vec::with_capacity(triangles), excess_sq: 0.0 }
    }

    /// Of a load that is affine on each triangle and has these integrals against the hat functions.
    pub(crate) fn affine(integrals: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let moments: Vec<_> =
            integrals.into_iter().map(|integrals| ElementMoments { integrals, deviation: 0.0 }).collect();
        Self { means: vec![0.0; moments.len()], moments, excess_sq: 0.0 }
    }

    /// Of batches of [`BATCH`] triangles, but for the last.
    fn of_batches(batches: Vec<Self>) -> Self {
        let triangles = batches.iter().map(|batch| batch.means.len()).sum::<usize>();
        let each = || (0..triangles).into_par_iter().with_min_len(BLOCK);
        Self {
            moments: each().map(|t| batches[t / BATCH].moments[t % BATCH]).collect(),
            means: each().map(|t| batches[t / BATCH].means[t % BATCH]).collect(),
            excess_sq: batches.iter().map(|batch| batch.excess_sq).sum(),
        }
    }

    /// Of all triangles.
    fn into_moments(self, mesh: &Mesh) -> LoadMoments {
        let difference = self.excess_sq.sqrt() + dual_norm(mesh, &self.means);
        LoadMoments::Varying { moments: self.moments, difference }
    }
}

/// The moments on the given triangles; `f` is not evaluated anywhere else.
///
/// # Errors
/// As [`load`](super::load()).
pub(crate) fn moments_on(
    mesh: &Mesh,
    triangles: &[usize],
    f: &Function,
) -> Result<SeenLoad, EvaluationError> {
    let second_rule = SecondRule::new(triangles.iter().map(|&t| mesh.triangle_area(t)).sum());
    let of_block = |block: Range<usize>| on_block(mesh, triangles[block].iter().copied(), f, &second_rule);
    let blocks: Vec<_> = blocks_of(BATCH, triangles.len()).into_par_iter().map(of_block).collect();
    Ok(SeenLoad::of_batches(blocks.into_iter().collect::<Result<_, _>>()?))
}

/// The moments on one block of triangles.
fn on_block(
    mesh: &Mesh,
    triangles: impl Iterator<Item = usize> + Clone,
    f: &Function,
    second_rule: &SecondRule,
) -> Result<SeenLoad, EvaluationError> {
    let (mut first, mut second) = (Values::default(), Values::default());
    for t in triangles.clone() {
        first.add_points(mesh.corners(t), DEGREE_4.points);
        second.add_points(mesh.corners(t), &second_rule.on(mesh.triangle_area(t)).points);
    }
    first.evaluate(f)?;
    second.evaluate(f)?;
    let (mut first, mut second) = (first.values.as_slice(), second.values.as_slice());
    let cut = CutRule::new(f.jumps().to_vec(), None, JUMP_DEPTH);
    let shallower = cut.shallower();
    let mut along_jumps = CutSamples::default();
    let mut on_triangle = |t: usize| {
        let (corners, area) = (mesh.corners(t), mesh.triangle_area(t));
        let rule = second_rule.on(area);
        let plain = Samples::next(&mut first, DEGREE_4.weights, DEGREE_4.points);
        let other = Samples::next(&mut second, &rule.weights, &rule.points);
        if cut.is_plain(corners) {
            let moments = ElementMoments::new(area, &plain);
            return Ok((moments, moments.beyond(area, &other)));
        }
        let moments = ElementMoments::new(area, &along_jumps.of(corners, f, &cut)?);
        Ok((moments, moments.beyond(area, &along_jumps.of(corners, f, &shallower)?)))
    };
    let mut found = SeenLoad::with_capacity(BATCH);
    for t in triangles {
        let (moments, Beyond { mean, excess_sq }) = on_triangle(t)?;
        found.moments.push(moments);
        found.means.push(mean);
        found.excess_sq += poincare(mesh.diameter_sq(t).sqrt()).powi(2) * excess_sq;
    }
    Ok(found)
}

/// A function at many points.
#[derive(Default)]
struct Values {
    x: Vec<f64>,
    y: Vec<f64>,
    values: Vec<f64>,
}

impl Values {
    /// Adds points that are given by their barycentric coordinates.
    fn add_points(&mut self, corners: [[f64; 2]; 3], points: &[[f64; 3]]) {
        for barycentric in points {
            let at = |axis: usize| (0..3).map(|i| barycentric[i] * corners[i][axis]).sum::<f64>();
            self.x.push(at(0));
            self.y.push(at(1));
        }
    }

    fn evaluate(&mut self, f: &Function) -> Result<(), EvaluationError> {
        self.values.clear();
        self.values.resize(self.x.len(), 0.0);
        f.eval_many(&self.x, &self.y, &mut self.values)
    }

    fn clear(&mut self) {
        self.x.clear();
        self.y.clear();
    }
}

/// Memory for the points on a triangle in which a function jumps.
#[derive(Default)]
struct CutSamples {
    at: Values,
    weights: Vec<f64>,
    points: Vec<[f64; 3]>,
}

impl CutSamples {
    fn of(
        &mut self,
        corners: [[f64; 2]; 3],
        f: &Function,
        cut: &CutRule,
    ) -> Result<Samples<'_>, EvaluationError> {
        let Self { at, weights, points } = self;
        at.clear();
        weights.clear();
        points.clear();
        let area = 0.5 * twice_signed_area(corners);
        cut.visit(corners, &mut |point, weight| {
            at.x.push(point[0]);
            at.y.push(point[1]);
            weights.push(weight / area);
            points.push(hats(corners, point));
        });
        at.evaluate(f)?;
        Ok(Samples { values: &at.values, weights, points })
    }
}

/// The hat functions of the corners at a point.
fn hats(corners: [[f64; 2]; 3], point: [f64; 2]) -> [f64; 3] {
    let twice_area = twice_signed_area(corners);
    [0, 1, 2].map(|i| twice_signed_area([point, corners[(i + 1) % 3], corners[(i + 2) % 3]]) / twice_area)
}

#[cfg(test)]
mod tests;
