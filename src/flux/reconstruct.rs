//! The reconstruction of `t_ih` vertex by vertex.

use super::Reconstruction;
use super::fan::{Fan, fans};
use super::field::{Flux, constant_outward, inner_product, through};
use crate::discretization::{Displacement, PairDiscretization};
use crate::fem::gradient;
use crate::mesh::{Mesh, SubTriangulation};

/// Reconstructs fluxes from displacements: what all reconstructions on one mesh share.
#[derive(Debug, Clone)]
pub struct Reconstructor<'a> {
    pub(super) d: &'a PairDiscretization,
    pub(super) sub: &'a SubTriangulation,
    pub(super) load: [Vec<[f64; 3]>; 2],
    fans: Vec<Fan>,
}

impl<'a> Reconstructor<'a> {
    /// Prepares for the mesh of `d`, divided into `sub`; `load` are the integrals `int_K f_i phi_a` of both membranes
    /// that add up to the load vectors of `d` ([`element_loads`](crate::fem::element_loads)). Linear time.
    ///
    /// # Panics
    /// When `sub` or `load` are not of the mesh of `d`.
    pub fn new(d: &'a PairDiscretization, sub: &'a SubTriangulation, load: [Vec<[f64; 3]>; 2]) -> Self {
        let triangles = d.mesh().triangles().len();
        assert_eq!(sub.mesh().triangles().len(), 6 * triangles, "six sub-triangles a triangle");
        assert!(load.iter().all(|load| load.len() == triangles), "loads are over triangles");
        Self { d, sub, load, fans: fans(d.mesh()) }
    }

    /// `[t_1h, t_2h]` for the displacements `[u1, u2]` over vertices.
    ///
    /// They are in `H(div)` for any displacements. The action in their equilibrium is the one that the membrane itself
    /// sees, `-(-1)^i lambda_a = (mu_i K u_i - F_i)_a / |D_a|` (4.5): it closes the balance around `a`. For a solution,
    /// both are `lambda_h` (Proposition 12). Linear time.
    ///
    /// # Panics
    /// When the displacements are not over the vertices.
    pub fn reconstruct(&self, displacement: &Displacement, kind: Reconstruction) -> [Flux<'a>; 2] {
        [0, 1].map(|membrane| self.of_membrane(membrane, &displacement[membrane], kind))
    }

    fn of_membrane(&self, membrane: usize, u: &[f64], kind: Reconstruction) -> Flux<'a> {
        let q = discrete_flux(self.d, membrane, u);
        let of_discrete = |t: usize| constant_outward(self.sub.mesh().corners(t), q[self.sub.triangle_of(t)]);
        let mut outward: Vec<[f64; 3]> = (0..self.sub.mesh().triangles().len()).map(of_discrete).collect();
        for fan in &self.fans {
            let jumps = self.jumps(fan, &q);
            let changes = match kind {
                Reconstruction::Full => self.equilibrated(membrane, fan, &jumps, 1.0),
                Reconstruction::PaperCompatible => self.equilibrated(membrane, fan, &jumps, 0.0),
                Reconstruction::Averaged => averaged(&jumps),
            };
            for (&wedge, change) in fan.wedges.iter().zip(changes) {
                for (half, change) in change.outward().into_iter().enumerate() {
                    (0..3).for_each(|j| outward[2 * wedge + half][j] += change[j]);
                }
            }
        }
        Flux::new(self.sub, outward)
    }

    /// For each wedge `D_a cap K` the flux of `q|_K - q|_K'` counterclockwise through the half edge to the next wedge,
    /// in `K'`; zero for the last one of an open fan.
    fn jumps(&self, fan: &Fan, q: &[[f64; 2]]) -> Vec<f64> {
        let next = |k: usize| if k + 1 < fan.wedges.len() { k + 1 } else { 0 };
        let jump = |k: usize| {
            if !fan.closed && next(k) == 0 {
                return 0.0;
            }
            let [here, there] = [k, next(k)].map(|k| q[fan.wedges[k] / 3]);
            let [a, _, midpoint] = self.sub.mesh().corners(2 * fan.wedges[k] + 1);
            through([here[0] - there[0], here[1] - there[1]], midpoint, a)
        };
        (0..fan.wedges.len()).map(jump).collect()
    }

    /// The changes that balance every wedge; with `across` one, each of its halves, by the flux through the segment to
    /// the barycentre; with `across` zero, that one is kept.
    fn equilibrated(&self, membrane: usize, fan: &Fan, jumps: &[f64], across: f64) -> Vec<Change> {
        let load = |&w: &usize| self.load[membrane][w / 3][w % 3];
        let area = |&w: &usize| self.d.mesh().triangle_area(w / 3) / 3.0;
        let sum = |of_wedge: &dyn Fn(&usize) -> f64| fan.wedges.iter().map(of_wedge).sum::<f64>();
        // -(-1)^i lambda_a: around an interior vertex, the last wedge must lead back to the first.
        let action = if fan.closed { -(sum(&load) + jumps.iter().sum::<f64>()) / sum(&area) } else { 0.0 };
        let mut entering = 0.0;
        let mut changes = Vec::with_capacity(fan.wedges.len());
        for (wedge, jump) in fan.wedges.iter().zip(jumps) {
            let source = load(wedge) + action * area(wedge);
            let leaving = entering + source;
            changes.push(Change { entering, across: across * (entering + 0.5 * source), leaving });
            entering = leaving + jump;
        }
        let circulation = Change { entering: 1.0, across, leaving: 1.0 };
        let alpha = -self.inner(fan, |k| changes[k], |_| circulation)
            / self.inner(fan, |_| circulation, |_| circulation);
        changes.into_iter().map(|change| change.plus(alpha, circulation)).collect()
    }

    /// The `L2` inner product over a fan of the fields with the given fluxes through its segments and none through its
    /// outer edges.
    fn inner(&self, fan: &Fan, s: impl Fn(usize) -> Change, t: impl Fn(usize) -> Change) -> f64 {
        let on_wedge = |(k, wedge): (usize, &usize)| {
            let (s, t) = (s(k).outward(), t(k).outward());
            let on_half =
                |half: usize| inner_product(self.sub.mesh().corners(2 * wedge + half), s[half], t[half]);
            on_half(0) + on_half(1)
        };
        fan.wedges.iter().enumerate().map(on_wedge).sum()
    }
}

/// By how much `t_ih` differs from `-mu_i grad u_ih` on a wedge: fluxes through its first half edge, the segment to the
/// barycentre and the second half edge, all counterclockwise around the vertex.
#[derive(Debug, Clone, Copy)]
struct Change {
    entering: f64,
    across: f64,
    leaving: f64,
}

impl Change {
    /// The outward fluxes of the two halves (vertex, midpoint, barycentre), (vertex, barycentre, midpoint).
    fn outward(self) -> [[f64; 3]; 2] {
        [[0.0, self.across, -self.entering], [0.0, self.leaving, -self.across]]
    }

    /// `self + factor * other`.
    fn plus(self, factor: f64, other: Self) -> Self {
        Self {
            entering: self.entering + factor * other.entering,
            across: self.across + factor * other.across,
            leaving: self.leaving + factor * other.leaving,
        }
    }
}

/// Either side of a half edge gives way by half of the jump.
fn averaged(jumps: &[f64]) -> Vec<Change> {
    let previous = |k: usize| jumps[(k + jumps.len() - 1) % jumps.len()];
    let change = |k: usize| Change { entering: 0.5 * previous(k), across: 0.0, leaving: -0.5 * jumps[k] };
    (0..jumps.len()).map(change).collect()
}

/// `-mu_i grad u_ih` on the triangles, for membrane `i` (0 or 1). Shape: `triangles x 2`; unit: force per length.
///
/// # Panics
/// When `u` is not over the vertices.
pub fn discrete_flux(d: &PairDiscretization, membrane: usize, u: &[f64]) -> Vec<[f64; 2]> {
    assert_eq!(u.len(), d.mesh().points().len(), "displacements are over vertices");
    let mu = d.tension()[membrane];
    (0..d.mesh().triangles().len()).map(|k| flux_on(d.mesh(), k, mu, u)).collect()
}

/// `-mu grad u` on triangle `k` of the P1 function with the values `u`.
pub(super) fn flux_on(mesh: &Mesh, k: usize, mu: f64, u: &[f64]) -> [f64; 2] {
    gradient(mesh.corners(k), mesh.triangles()[k].map(|a| u[a])).map(|slope| -mu * slope)
}
