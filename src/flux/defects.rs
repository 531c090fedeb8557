//! The identities of section 4.2, as numbers that should be zero.

use super::field::constant_outward;
use super::reconstruct::discrete_flux;
use super::{Flux, Reconstruction, Reconstructor};
use crate::discretization::Displacement;
use crate::mesh::VertexKind;
use crate::numeric::largest;

/// How far fluxes are from the identities that their reconstruction promises: largest defects over the mesh and both
/// membranes, as forces relative to `mu_i` times the scale of the displacements. Rounding leaves about `1e-15` times what
/// the angles of the mesh cost.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FluxDefects {
    /// Of the normal continuity across the edges of `S_h`: `t_ih` is in `H(div)`.
    pub continuity: f64,
    /// Of `t_ih . n = -mu_i d_n u_ih` (4.13) on the edges of `S_h` inside of a triangle of `T_h`; for the full
    /// reconstruction on those between two vertices' cells.
    pub interior: f64,
    /// Of `int_{D_a} div t_ih = mu_i int grad u_ih . grad phi_a` (4.18), the right side by the stiffness matrix.
    pub balance: f64,
    /// Of `div t_ih = f_a|_K - (-1)^i lambda_a`: on every triangle of `S_h` (full), every `D_a cap K` (paper-compatible),
    /// every `D_a` of an interior vertex (averaged).
    pub equilibrium: f64,
}

impl FluxDefects {
    /// Measures `flux`, reconstructed as `kind` from `displacement`, with the action `lambda`; both over vertices.
    ///
    /// # Panics
    /// When the vectors are not over the vertices or the fluxes are not on the sub-triangles of `reconstructor`.
    pub fn new(
        reconstructor: &Reconstructor,
        displacement: &Displacement,
        lambda: &[f64],
        flux: &[Flux; 2],
        kind: Reconstruction,
    ) -> Self {
        let of_membrane = |membrane: usize| {
            let one = OneMembrane { reconstructor, membrane, flux: &flux[membrane] };
            let force = reconstructor.d.tension()[membrane] * reconstructor.d.scales().displacement;
            Self {
                continuity: largest_size(one.continuity()) / force,
                interior: largest_size(one.interior(&displacement[membrane], kind)) / force,
                balance: largest_size(one.balance(&displacement[membrane])) / force,
                equilibrium: largest_size(one.equilibrium(lambda, kind)) / force,
            }
        };
        let [first, second] = [of_membrane(0), of_membrane(1)];
        Self {
            continuity: first.continuity.max(second.continuity),
            interior: first.interior.max(second.interior),
            balance: first.balance.max(second.balance),
            equilibrium: first.equilibrium.max(second.equilibrium),
        }
    }

    /// The defects with their names.
    pub fn named(&self) -> [(&'static str, f64); 4] {
        [
            ("continuity", self.continuity),
            ("interior", self.interior),
            ("balance", self.balance),
            ("equilibrium", self.equilibrium),
        ]
    }
}

/// The largest absolute value; a NaN counts as infinite.
fn largest_size(defects: impl IntoIterator<Item = f64>) -> f64 {
    largest(defects.into_iter().map(f64::abs))
}

struct OneMembrane<'a> {
    reconstructor: &'a Reconstructor<'a>,
    membrane: usize,
    flux: &'a Flux<'a>,
}

impl OneMembrane<'_> {
    /// What is left of the outward fluxes of neighbours, edge by edge.
    fn continuity(&self) -> Vec<f64> {
        let triangles = self.reconstructor.sub.mesh().triangles();
        let mut sides: Vec<([usize; 2], f64)> = Vec::with_capacity(3 * triangles.len());
        for (corners, outward) in triangles.iter().zip(self.flux.outward()) {
            for j in 0..3 {
                let (p, q) = (corners[(j + 1) % 3], corners[(j + 2) % 3]);
                sides.push(([p.min(q), p.max(q)], outward[j]));
            }
        }
        sides.sort_unstable_by_key(|&(edge, _)| edge);
        let shared = sides.chunk_by(|one, other| one.0 == other.0).filter(|edge| edge.len() == 2);
        shared.map(|edge| edge[0].1 + edge[1].1).collect()
    }

    fn interior(&self, u: &[f64], kind: Reconstruction) -> Vec<f64> {
        let sub = self.reconstructor.sub;
        let q = discrete_flux(self.reconstructor.d, self.membrane, u);
        // The halves of a wedge are (vertex, midpoint, barycentre) and (vertex, barycentre, midpoint).
        let kept = |t: usize| match kind {
            Reconstruction::Full => vec![0],
            Reconstruction::PaperCompatible | Reconstruction::Averaged => vec![0, 1 + t % 2],
        };
        let defects = |t: usize| {
            let discrete = constant_outward(sub.mesh().corners(t), q[sub.triangle_of(t)]);
            kept(t).into_iter().map(move |j| self.flux.outward()[t][j] - discrete[j])
        };
        (0..self.flux.outward().len()).flat_map(defects).collect()
    }

    fn balance(&self, u: &[f64]) -> Vec<f64> {
        let d = self.reconstructor.d;
        let sums = self.sum_over_cells(|t| self.flux.outward()[t].iter().sum());
        let mu = d.tension()[self.membrane];
        d.interior().iter().map(|&a| sums[a] - mu * d.stiffness_row(a, |b| u[b])).collect()
    }

    fn equilibrium(&self, lambda: &[f64], kind: Reconstruction) -> Vec<f64> {
        let Reconstructor { d, sub, load, .. } = self.reconstructor;
        let defect = |t: usize| {
            let (wedge, area) = (t / 2, sub.mesh().triangle_area(t));
            let pushed = [1.0, -1.0][self.membrane] * lambda[sub.vertex_of(t)];
            let source = 0.5 * load[self.membrane][wedge / 3][wedge % 3] + pushed * area;
            self.flux.outward()[t].iter().sum::<f64>() - source
        };
        let each = 0..self.flux.outward().len();
        match kind {
            Reconstruction::Full => each.map(defect).collect(),
            Reconstruction::PaperCompatible => each.step_by(2).map(|t| defect(t) + defect(t + 1)).collect(),
            Reconstruction::Averaged => {
                let sums = self.sum_over_cells(defect);
                let interior = (0..sums.len()).filter(|&a| d.mesh().kind()[a] == VertexKind::Interior);
                interior.map(|a| sums[a]).collect()
            }
        }
    }

    /// Sums over the sub-triangles at each vertex.
    fn sum_over_cells(&self, of_sub_triangle: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut sums = vec![0.0; self.reconstructor.d.mesh().points().len()];
        for t in 0..self.flux.outward().len() {
            sums[self.reconstructor.sub.vertex_of(t)] += of_sub_triangle(t);
        }
        sums
    }
}
