//! Raviart-Thomas fields of lowest order on `S_h`.

use crate::geometry::{distance_sq, twice_signed_area};
use crate::mesh::SubTriangulation;

/// A field that is `c + d x` on each triangle of `S_h` (4.12), given by its fluxes through the edges.
///
/// It is in `H(div)` when the outward fluxes of any two neighbours through their common edge add up to zero.
#[derive(Debug, Clone)]
pub struct Flux<'s> {
    sub: &'s SubTriangulation,
    outward: Vec<[f64; 3]>,
}

/// A [`Flux`] as plain data for pictures, a value on each triangle of `S_h`.
#[derive(Debug, Clone, PartialEq)]
pub struct FluxCells {
    /// The field at the barycentres, which is its mean. Shape: `sub-triangles x 2`; unit: force per length.
    pub value: Vec<[f64; 2]>,
    /// The divergence. Shape: `sub-triangles`; unit: force per area.
    pub divergence: Vec<f64>,
}

impl<'s> Flux<'s> {
    /// The field with the given outward fluxes (shape and order as [`outward`](Self::outward)).
    ///
    /// # Panics
    /// When their number is not that of the sub-triangles.
    pub(super) fn new(sub: &'s SubTriangulation, outward: Vec<[f64; 3]>) -> Self {
        assert_eq!(outward.len(), sub.mesh().triangles().len(), "fluxes are over sub-triangles");
        Self { sub, outward }
    }

    /// The triangulation `S_h` that it lives on.
    pub fn sub_triangulation(&self) -> &'s SubTriangulation {
        self.sub
    }

    /// The fluxes `int_e t . n` of each sub-triangle through its edges, `n` pointing outward, edge `j` opposite to corner
    /// `j`. Shape: `sub-triangles x 3`; unit: force.
    pub fn outward(&self) -> &[[f64; 3]] {
        &self.outward
    }

    /// The value at `point`, which should lie in sub-triangle `t`. Unit: force per length.
    pub fn at(&self, t: usize, point: [f64; 2]) -> [f64; 2] {
        value(self.sub.mesh().corners(t), self.outward[t], point)
    }

    /// The divergence on sub-triangle `t`, a constant. Unit: force per area.
    pub fn divergence(&self, t: usize) -> f64 {
        self.outward[t].iter().sum::<f64>() / self.sub.mesh().triangle_area(t)
    }

    /// The outward normal components on the edges of sub-triangle `t`, constants. Unit: force per length.
    pub fn normal_trace(&self, t: usize) -> [f64; 3] {
        let corners = self.sub.mesh().corners(t);
        let length = |j: usize| distance_sq(corners[(j + 1) % 3], corners[(j + 2) % 3]).sqrt();
        [0, 1, 2].map(|j| self.outward[t][j] / length(j))
    }

    /// `int_T |t - q|^2` over sub-triangle `T` number `t`, for a constant `q`.
    pub fn distance_sq(&self, t: usize, q: [f64; 2]) -> f64 {
        let corners = self.sub.mesh().corners(t);
        let of_constant = constant_outward(corners, q);
        let difference = [0, 1, 2].map(|j| self.outward[t][j] - of_constant[j]);
        inner_product(corners, difference, difference)
    }

    /// The field as plain data.
    pub fn cells(&self) -> FluxCells {
        let triangles = 0..self.outward.len();
        let barycentre = |t: usize| {
            let [a, b, c] = self.sub.mesh().corners(t);
            [(a[0] + b[0] + c[0]) / 3.0, (a[1] + b[1] + c[1]) / 3.0]
        };
        FluxCells {
            value: triangles.clone().map(|t| self.at(t, barycentre(t))).collect(),
            divergence: triangles.map(|t| self.divergence(t)).collect(),
        }
    }
}

/// `sum_j F_j (x - p_j) / (2 |T|)`, the field on a triangle `T` of corners `p_j` whose outward fluxes are `F_j`.
pub(crate) fn value(corners: [[f64; 2]; 3], outward: [f64; 3], point: [f64; 2]) -> [f64; 2] {
    let scale = 1.0 / twice_signed_area(corners);
    [0, 1].map(|axis| scale * (0..3).map(|j| outward[j] * (point[axis] - corners[j][axis])).sum::<f64>())
}

/// The flux of the constant field `q` through the segment, to the right of its direction.
pub(super) fn through(q: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    q[0] * (to[1] - from[1]) - q[1] * (to[0] - from[0])
}

/// The outward fluxes of the constant field `q`.
pub(crate) fn constant_outward(corners: [[f64; 2]; 3], q: [f64; 2]) -> [f64; 3] {
    [0, 1, 2].map(|j| through(q, corners[(j + 1) % 3], corners[(j + 2) % 3]))
}

/// `int_T s . t` for the fields on a triangle `T` with the outward fluxes `s` and `t`.
pub(crate) fn inner_product(corners: [[f64; 2]; 3], s: [f64; 3], t: [f64; 3]) -> f64 {
    // The rule of the midpoints is exact for quadratic functions.
    let at_midpoint = |j: usize| {
        let [p, q] = [corners[(j + 1) % 3], corners[(j + 2) % 3]];
        let midpoint = [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
        let [s, t] = [s, t].map(|outward| value(corners, outward, midpoint));
        s[0] * t[0] + s[1] * t[1]
    };
    twice_signed_area(corners) / 6.0 * (0..3).map(at_midpoint).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fem::DEGREE_4;
    use crate::mesh::samples::irregular;

    /// Rounding of fields of order one on a mesh of a few cells.
    const ROUNDING: f64 = 1e-13;

    /// The field `c + d x`, the same on all of the domain, from its fluxes: the flux through an edge is its length times
    /// the normal component at the midpoint.
    fn field(sub: &SubTriangulation, c: [f64; 2], d: f64) -> Flux<'_> {
        let outward = |t: usize| {
            let p = sub.mesh().corners(t);
            [0, 1, 2].map(|j| {
                let (from, to) = (p[(j + 1) % 3], p[(j + 2) % 3]);
                through([0, 1].map(|axis| c[axis] + d * 0.5 * (from[axis] + to[axis])), from, to)
            })
        };
        Flux::new(sub, (0..sub.mesh().triangles().len()).map(outward).collect())
    }

    #[test]
    fn values_divergence_and_normal_traces_are_those_of_the_field() {
        let sub = SubTriangulation::new(&irregular(3)).unwrap();
        let (c, d) = ([2.0, -1.0], 3.0);
        let flux = field(&sub, c, d);
        let cells = flux.cells();
        for t in 0..sub.mesh().triangles().len() {
            let p = sub.mesh().corners(t);
            for barycentric in [[0.2, 0.3, 0.5], [1.0, 0.0, 0.0], [1.0 / 3.0; 3]] {
                let x = [0, 1].map(|axis| (0..3).map(|j| barycentric[j] * p[j][axis]).sum::<f64>());
                let found = flux.at(t, x);
                assert!((0..2).all(|axis| (found[axis] - c[axis] - d * x[axis]).abs() < ROUNDING));
                assert!((0..2).all(|axis| (found[axis] - c[axis] - d * x[axis] - 0.1).abs() > ROUNDING));
            }
            assert!((flux.divergence(t) - 2.0 * d).abs() < ROUNDING, "div (c + d x) = 2 d in the plane");
            assert_eq!(cells.divergence[t], flux.divergence(t));
            let barycentre = [0, 1].map(|axis| (p[0][axis] + p[1][axis] + p[2][axis]) / 3.0);
            assert!(
                (0..2).all(|axis| (cells.value[t][axis] - c[axis] - d * barycentre[axis]).abs() < ROUNDING)
            );
            // On the edge from p1 to p2, at p1: the normal component is the same on all of it.
            let length = distance_sq(p[1], p[2]).sqrt();
            let normal = [(p[2][1] - p[1][1]) / length, (p[1][0] - p[2][0]) / length];
            let trace = (0..2).map(|axis| (c[axis] + d * p[1][axis]) * normal[axis]).sum::<f64>();
            assert!((flux.normal_trace(t)[0] - trace).abs() < ROUNDING);
        }
    }

    #[test]
    fn distances_are_integrals_of_squares() {
        let sub = SubTriangulation::new(&irregular(3)).unwrap();
        let (flux, q) = (field(&sub, [2.0, -1.0], 3.0), [0.5, 4.0]);
        for t in 0..sub.mesh().triangles().len() {
            let p = sub.mesh().corners(t);
            let square = |barycentric: &[f64; 3]| {
                let x = [0, 1].map(|axis| (0..3).map(|j| barycentric[j] * p[j][axis]).sum::<f64>());
                distance_sq(flux.at(t, x), q)
            };
            let integral = |weights: &[f64]| {
                let terms = DEGREE_4.points.iter().zip(weights);
                sub.mesh().triangle_area(t) * terms.map(|(b, weight)| weight * square(b)).sum::<f64>()
            };
            let found = flux.distance_sq(t, q);
            assert!((found - integral(DEGREE_4.weights)).abs() < ROUNDING);
            assert!((found - integral(&[1.0 / 6.0; 6])).abs() > ROUNDING, "not by another rule");
        }
    }

    #[test]
    fn a_constant_field_is_at_distance_zero_from_itself_alone() {
        let sub = SubTriangulation::new(&irregular(2)).unwrap();
        let flux = field(&sub, [1.0, 2.0], 0.0);
        assert!(flux.distance_sq(5, [1.0, 2.0]) < ROUNDING * ROUNDING);
        let expected = sub.mesh().triangle_area(5);
        assert!((flux.distance_sq(5, [1.0, 3.0]) - expected).abs() < ROUNDING * expected);
    }
}
