//! What the boundary adds to the bound: data between the vertices, and a circle beyond the polygon of the mesh.

use crate::discretization::PairDiscretization;
use crate::estimate::MeasureError;
use crate::flux::WedgeFluxes;
use crate::geometry::distance_sq;
use crate::mesh::{Circle, Mesh, VertexKind};
use crate::problem::{ContactProblem, Domain, EvaluationError, Function, Pair};

/// A boundary vertex lies on the circle up to this fraction of the radius: rounding of its coordinates.
const ON_CIRCLE: f64 = 1e-9;

/// The slope of the height is a difference quotient over this part of an edge: its error is below `1e-8` of the third
/// difference, and rounding below `1e-12`.
const STEP: f64 = 1e-4;

/// The power with which the lift falls along a ray: of a parabola on the edge of an isosceles triangle, the seminorm is the
/// smallest with 3.
const DECAY: f64 = 3.0;

/// The rule of Gauss with three points on `(0, 1)`: points and weights.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// The boundary of the domain against that of the mesh.
///
/// On a disk the membranes are continued from each boundary edge to the circle: constant along its normal, with the values of
/// the data on the circle; and so are the fluxes, their divergence being the load and the action zero. On the edge itself the
/// data are those on the circle at its foot.
pub(super) struct Trace<'a> {
    pair: &'a Pair,
    mesh: &'a Mesh,
    height_h: &'a [f64],
    /// The circle around a disk, if the mesh has all its boundary vertices on it.
    pub(super) circle: Option<Circle>,
}

/// A lift `E` of the data between the vertices.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Lift {
    /// `|E|_{H1(K)}^2`.
    pub(super) seminorm_sq: f64,
    /// `(lt, E)_K`, or more.
    pub(super) action: f64,
}

/// An edge of the boundary, the domain to its left.
struct Edge {
    from: [f64; 2],
    to: [f64; 2],
    length: f64,
    tangent: [f64; 2],
    /// Outward.
    normal: [f64; 2],
    circle: Option<Circle>,
}

impl<'a> Trace<'a> {
    pub(super) fn new(
        problem: &'a ContactProblem,
        domain: Option<&Domain>,
        d: &'a PairDiscretization,
    ) -> Self {
        let has_its_boundary_on = |circle: &Circle| {
            let mut kinds = d.mesh().points().iter().zip(d.mesh().kind());
            kinds.all(|(&point, &kind)| {
                let off = (distance_sq(point, circle.centre).sqrt() - circle.radius).abs();
                kind != VertexKind::Boundary || off <= ON_CIRCLE * circle.radius
            })
        };
        let circle = domain.and_then(Circle::of_domain).filter(has_its_boundary_on);
        let pair = problem.as_pair().expect("a discretization of the pair belongs to one");
        Self { pair, mesh: d.mesh(), height_h: d.height(), circle }
    }

    /// The lift `E` of `g - g_h` from the boundary edges of triangle `k`: on the ray from a point of the edge to an apex, the value
    /// at that point times a power of what is left of the ray. The apex is the opposite corner; of a triangle with several
    /// boundary edges its barycentre, so that the lifts do not meet. The gap stays non-negative: at the part `r` of the ray it is at
    /// least `r g_h`, and the lift takes away at most `r^3 g_h`.
    ///
    /// # Errors
    /// When the height has no value on the edges.
    pub(super) fn lift(&self, k: usize, lambda: &[f64]) -> Result<Lift, MeasureError> {
        let mut sum = Lift::default();
        if self.circle.is_none() && matches!(self.pair.height(), Function::Constant(_)) {
            return Ok(sum);
        }
        let corners = self.mesh.corners(k);
        let several = self.boundary_edges(k).count() > 1;
        let barycentre = [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 3.0);
        // On the dual cells of the corners, at most this.
        let largest_action = self.mesh.triangles()[k].iter().map(|&a| lambda[a]).fold(0.0, f64::max);
        for corner in self.boundary_edges(k) {
            let apex = if several { barycentre } else { corners[(corner + 2) % 3] };
            let (seminorm_sq, positive) =
                self.lift_from_edge(k, corner, apex).map_err(MeasureError::of_height)?;
            sum.seminorm_sq += seminorm_sq;
            sum.action += largest_action * positive;
        }
        Ok(sum)
    }

    /// `|E|_{H1}^2` and `int max(E, 0)`.
    fn lift_from_edge(&self, k: usize, corner: usize, apex: [f64; 2]) -> Result<(f64, f64), EvaluationError> {
        let edge = self.edge(k, corner);
        let [first, last] = [0, 1].map(|j| self.height_h[self.mesh.triangles()[k][(corner + j) % 3]]);
        let from_apex = [edge.from[0] - apex[0], edge.from[1] - apex[1]];
        let distance = dot(from_apex, edge.normal);
        let foot = dot(from_apex, edge.tangent);
        let (mut seminorm_sq, mut positive) = (0.0, 0.0);
        for (_, t, weight) in halves() {
            let value = edge.height(self.pair.height(), t)? - (first + t * (last - first));
            let slope = (edge.height_slope(self.pair.height(), t)? - (last - first)) / edge.length;
            // At the edge; at the part r of the ray from the apex, r^(DECAY - 1) times that.
            let across = (DECAY * value - (foot + t * edge.length) * slope) / distance;
            let weight = weight * edge.length * distance;
            seminorm_sq += weight / (2.0 * DECAY) * (slope * slope + across * across);
            positive += weight / (DECAY + 2.0) * value.max(0.0);
        }
        Ok((seminorm_sq, positive))
    }

    /// `|| mu_i^(1/2) grad u_i + mu_i^(-1/2) sigma_i ||^2` between the boundary edges of triangle `k` and the circle.
    ///
    /// # Errors
    /// When height or load have no value there.
    pub(super) fn beyond_sq(
        &self,
        membrane: usize,
        k: usize,
        fluxes: &WedgeFluxes,
    ) -> Result<f64, MeasureError> {
        let mut sum = 0.0;
        if self.circle.is_none() {
            return Ok(sum);
        }
        let mu = self.pair.tension()[membrane];
        let load = &self.pair.load()[membrane];
        for corner in self.boundary_edges(k) {
            let edge = self.edge(k, corner);
            let outward = fluxes.boundary_outward(membrane, k, corner);
            for (half, t, along) in halves() {
                let trace = outward[half] / (0.5 * edge.length);
                let slope = if membrane == 0 {
                    let slope = edge.height_slope(self.pair.height(), t);
                    slope.map_err(MeasureError::of_height)? / edge.length
                } else {
                    0.0
                };
                let depth = edge.depth(t);
                for (s, weight) in GAUSS {
                    let [x, y] = edge.above(t, 0.5 * s * depth);
                    let f = load.eval(x, y).map_err(|source| MeasureError::of_load(membrane, source))?;
                    let flux = trace + s * depth * f;
                    sum += along * edge.length * depth * weight * (mu * slope * slope + flux * flux / mu);
                }
            }
        }
        Ok(sum)
    }

    /// The corners of triangle `k` from which a boundary edge leads to the next corner.
    fn boundary_edges(&self, k: usize) -> impl Iterator<Item = usize> {
        let triangle = self.mesh.triangles()[k];
        (0..3).filter(move |&corner| {
            let [a, b] = [0, 1].map(|j| triangle[(corner + j) % 3]);
            let is_boundary = |a: usize| self.mesh.kind()[a] == VertexKind::Boundary;
            let shared = |&t: &usize| t != k && self.mesh.triangles()[t].contains(&b);
            is_boundary(a) && is_boundary(b) && self.mesh.around().triangles(a).find(shared).is_none()
        })
    }

    fn edge(&self, k: usize, corner: usize) -> Edge {
        let corners = self.mesh.corners(k);
        let [from, to] = [corners[corner], corners[(corner + 1) % 3]];
        let length = distance_sq(from, to).sqrt();
        let tangent = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
        Edge { from, to, length, tangent, normal: [tangent[1], -tangent[0]], circle: self.circle }
    }
}

impl Edge {
    /// The point at the part `t` of the edge, moved outward by `y`.
    fn above(&self, t: f64, y: f64) -> [f64; 2] {
        [0, 1].map(|axis| self.from[axis] + t * (self.to[axis] - self.from[axis]) + y * self.normal[axis])
    }

    /// From the edge to the circle along the normal; zero on a polygon.
    fn depth(&self, t: f64) -> f64 {
        let Some(Circle { centre, radius }) = self.circle else { return 0.0 };
        let [x, y] = self.above(t, 0.0);
        let from_centre = [x - centre[0], y - centre[1]];
        let along = dot(from_centre, self.tangent);
        ((radius - along) * (radius + along)).max(0.0).sqrt() - dot(from_centre, self.normal)
    }

    /// The data on the boundary of the domain, seen from the edge.
    fn height(&self, g: &Function, t: f64) -> Result<f64, EvaluationError> {
        let [x, y] = self.above(t, self.depth(t));
        g.eval(x, y)
    }

    /// Its derivative for `t`.
    fn height_slope(&self, g: &Function, t: f64) -> Result<f64, EvaluationError> {
        Ok((self.height(g, t + STEP)? - self.height(g, t - STEP)?) / (2.0 * STEP))
    }
}

/// A rule on both halves of an edge: the number of the half, the point `t` of the whole, the weight.
fn halves() -> impl Iterator<Item = (usize, f64, f64)> {
    (0..2).flat_map(|half| {
        GAUSS.into_iter().map(move |(t, weight)| (half, 0.5 * (half as f64 + t), 0.5 * weight))
    })
}

fn dot(u: [f64; 2], v: [f64; 2]) -> f64 {
    u[0] * v[0] + u[1] * v[1]
}
