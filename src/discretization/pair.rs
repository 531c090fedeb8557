//! The paper's pair on a mesh: everything that the discrete problem (3.4) is made of.

use std::sync::Arc;

use sprs::CsMat;
use thiserror::Error;

use super::areas::dual_areas;
use super::scales::{LARGEST, Scales};
use crate::fem::{LoadMoments, StiffnessMatrix, row_of, stiffness};
use crate::mesh::{Mesh, VertexKind};
use crate::numeric::largest;
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;
use crate::problem::{ContactProblem, EvaluationError, Pair};
use crate::text::Number;

/// `[u1, u2]`, each over vertices.
pub type Displacement = [Vec<f64>; 2];

/// The data of (3.4) on a mesh: `K`, `F_i`, `g_h`, the numbering of the unknowns, `|D_a|`.
///
/// Vectors over *vertices* have an entry for each vertex of the mesh; vectors over *unknowns* have one for each
/// interior vertex, in the order of [`interior`](Self::interior).
#[derive(Debug, Clone)]
pub struct PairDiscretization {
    pub(crate) mesh: Arc<Mesh>,
    pub(crate) tension: [f64; 2],
    pub(crate) stiffness: StiffnessMatrix,
    pub(crate) load: [Vec<f64>; 2],
    pub(crate) moments: [LoadMoments; 2],
    pub(crate) height: Vec<f64>,
    pub(crate) interior: Vec<usize>,
    pub(crate) dual_area: Vec<f64>,
    scales: Scales,
}

/// The forces on one membrane at a vertex.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Balance {
    /// `(mu_i K u_i - F_i)_a`. Unit: force.
    pub(crate) imbalance: f64,
    /// The size of the terms that cancel in it: `mu_i |K| |u_i| + m |K| |u1 - u2| + |F_i|` with `m = mu1 mu2 / (mu1 + mu2)`.
    /// Times the machine precision, it bounds what rounding leaves. The second term is there because one membrane follows
    /// from the other and the gap: where it is nearly flat, the gap's rounding stays in it.
    pub(crate) terms: f64,
}

impl PairDiscretization {
    /// Assembles the discrete problem. Linear time and memory.
    ///
    /// # Errors
    /// [`PairError`] when the problem is not [the pair](ContactProblem::as_pair), a load is not finite at a quadrature point, the height is negative or not finite at a
    /// boundary vertex, or tensions, loads or displacements are so large or small that energies would overflow.
    pub fn new(problem: &ContactProblem, mesh: impl Into<Arc<Mesh>>) -> Result<Self, PairError> {
        let pair = problem.as_pair().ok_or(PairError::NotThePair)?;
        let shared: Arc<Mesh> = mesh.into();
        let mesh = &*shared;
        let moments_of = |i: usize| {
            LoadMoments::new(mesh, &pair.load()[i])
                .map_err(|source| PairError::Load { membrane: i + 1, source })
        };
        let moments = [moments_of(0)?, moments_of(1)?];
        let load = [0, 1].map(|i: usize| moments[i].vector(mesh));
        let height = boundary_height(pair, mesh)?;
        let stiffness = stiffness(mesh);
        let dual_area = dual_areas(mesh);
        let vertices = || 0..mesh.points().len();
        let interior: Vec<usize> = vertices().filter(|&a| mesh.kind()[a] == VertexKind::Interior).collect();
        let scales = Scales::of_pair(mesh, pair.tension(), &load, &height, &dual_area);
        scales.check_range(pair.tension()).map_err(|error| not_seen(&moments, &load).unwrap_or(error))?;
        Ok(Self {
            tension: pair.tension(),
            stiffness,
            load,
            moments,
            height,
            interior,
            dual_area,
            scales,
            mesh: shared,
        })
    }

    /// The mesh.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// `[mu1, mu2]`.
    pub fn tension(&self) -> [f64; 2] {
        self.tension
    }

    /// `K`, the stiffness matrix with unit coefficient on all vertices, rows compressed, symmetric.
    pub fn stiffness(&self) -> &StiffnessMatrix {
        &self.stiffness
    }

    /// `K_II`, its part on the unknowns: positive definite. Made when it is asked for.
    pub fn interior_stiffness(&self) -> CsMat<f64> {
        principal_submatrix(&self.stiffness, &self.interior)
    }

    /// `[F_1, F_2]`, the load vectors over vertices. Unit: force.
    pub fn load(&self) -> &[Vec<f64>; 2] {
        &self.load
    }

    /// `g_h` (3.2) over vertices: `g` at the boundary vertices, zero elsewhere.
    pub fn height(&self) -> &[f64] {
        &self.height
    }

    /// The interior vertices `V_h`: unknown `k` belongs to vertex `interior[k]`.
    pub fn interior(&self) -> &[usize] {
        &self.interior
    }

    /// `|D_a| = |Delta_a| / 3`, the areas of the dual cells over vertices; zero at unused ones.
    pub fn dual_area(&self) -> &[f64] {
        &self.dual_area
    }

    /// The sizes that residuals are measured against.
    pub fn scales(&self) -> Scales {
        self.scales
    }

    /// How much two quadrature rules differ in each load: what the second finds beyond the affine functions that stand for a load
    /// on each triangle, in the norm in which loads enter the bound of the error. Zero for constant and for affine loads;
    /// above the bound, the load has not been seen. Unit: square root of an energy.
    ///
    /// The second rule has at least 65,536 points on the domain, but at most 192 on a triangle: what acts on less than the distance
    /// between them can be missed by both.
    pub fn quadrature_difference(&self) -> [f64; 2] {
        [0, 1].map(|i| self.moments[i].quadrature_difference() / self.tension[i].sqrt())
    }

    /// `mu_i K u_i - F_i` for membrane `i` (0 or 1) at the unknowns, for displacements `u` over vertices. Unit: force.
    pub fn imbalance(&self, i: usize, u: &[f64]) -> Vec<f64> {
        let row = |&a: &usize| self.tension[i] * self.stiffness_row(a, |b| u[b]) - self.load[i][a];
        self.interior.par_iter().with_min_len(BLOCK).map(row).collect()
    }

    /// [`imbalance`](Self::imbalance) of both membranes at the vertex `a`, with the terms that cancel in it.
    pub(crate) fn balance(&self, a: usize, [u1, u2]: [&[f64]; 2]) -> [Balance; 2] {
        let [mu1, mu2] = self.tension;
        let gap_tension = mu1 * (mu2 / (mu1 + mu2));
        let ([mut ku1, mut ku2], [mut terms_1, mut terms_2]) = ([0.0; 2], [0.0; 2]);
        for (b, k) in self.row(a) {
            let (u1, u2) = (u1[b], u2[b]);
            let gap = gap_tension * (u1 - u2).abs();
            ku1 += k * u1;
            ku2 += k * u2;
            terms_1 += k.abs() * (mu1 * u1.abs() + gap);
            terms_2 += k.abs() * (mu2 * u2.abs() + gap);
        }
        let [f1, f2] = [0, 1].map(|i| self.load[i][a]);
        [
            Balance { imbalance: mu1 * ku1 - f1, terms: terms_1 + f1.abs() },
            Balance { imbalance: mu2 * ku2 - f2, terms: terms_2 + f2.abs() },
        ]
    }

    /// `(K v)_a`.
    pub(crate) fn stiffness_row(&self, a: usize, v: impl Fn(usize) -> f64) -> f64 {
        self.row(a).map(|(b, k)| k * v(b)).sum()
    }

    /// `K_aa`.
    pub(crate) fn stiffness_diagonal(&self, a: usize) -> f64 {
        self.row(a).find(|&(b, _)| b == a).map_or(0.0, |(_, k)| k)
    }

    /// The columns and entries of row `a` of `K`.
    fn row(&self, a: usize) -> impl Iterator<Item = (usize, f64)> {
        row_of(&self.stiffness, a)
    }

    /// A function over vertices from its values at the unknowns and on the boundary (zero where unused).
    pub(crate) fn extend(&self, unknowns: &[f64], boundary: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut values: Vec<f64> = (0..self.mesh.points().len())
            .map(|a| if self.mesh.kind()[a] == VertexKind::Boundary { boundary(a) } else { 0.0 })
            .collect();
        for (&a, &value) in self.interior.iter().zip(unknowns) {
            values[a] = value;
        }
        values
    }
}

impl Scales {
    fn of_pair(
        mesh: &Mesh,
        tension: [f64; 2],
        load: &[Vec<f64>; 2],
        height: &[f64],
        dual_area: &[f64],
    ) -> Self {
        let used = |&a: &usize| mesh.kind()[a] != VertexKind::Unused;
        let density = [0, 1].map(|i| {
            let densities = (0..height.len()).filter(used).map(|a| load[i][a].abs() / dual_area[a]);
            // Overflow can leave a NaN.
            largest(densities)
        });
        let heights =
            || (0..height.len()).filter(|&a| mesh.kind()[a] == VertexKind::Boundary).map(|a| height[a]);
        let [lowest, highest] = [heights().fold(f64::INFINITY, f64::min), heights().fold(0.0, f64::max)];
        let (lower, upper) = mesh.bounding_box();
        let width = (upper[0] - lower[0]).min(upper[1] - lower[1]);
        let compliance = width * width / 8.0;

        let deflection = (density[0] / tension[0]).max(density[1] / tension[1]) * compliance;
        let force_density = density[0].max(density[1]).max(tension[0] * (highest - lowest) / compliance);
        // Without any load, and at a constant height, everything is at rest: any scale serves.
        let or_one = |scale: f64| if scale == 0.0 { 1.0 } else { scale };
        Self {
            displacement: or_one(highest + deflection),
            force_density: or_one(force_density),
            dual_area: dual_area.iter().copied().fold(0.0, f64::max),
        }
    }

    fn check_range(&self, tension: [f64; 2]) -> Result<(), PairError> {
        let sizes = [
            ("the tension mu1 is", tension[0]),
            ("the tension mu2 is", tension[1]),
            ("the forces per area have the size", self.force_density),
            ("the displacements have the size", self.displacement),
        ];
        match sizes.into_iter().find(|(_, value)| !(1.0 / LARGEST..=LARGEST).contains(value)) {
            Some((quantity, value)) => Err(PairError::OutOfRange { quantity, value }),
            None => Ok(()),
        }
    }
}

/// A load that varies, of which all that the quadrature has met is next to nothing.
fn not_seen(moments: &[LoadMoments; 2], load: &[Vec<f64>; 2]) -> Option<PairError> {
    let all_small = load.iter().flatten().all(|force| force.abs() < 1.0 / LARGEST);
    let varies =
        |i: &usize| matches!(moments[*i], LoadMoments::Varying { .. }) && !moments[*i].sees_nothing();
    (0..2).filter(|_| all_small).find(varies).map(|i| PairError::NotSeen { membrane: i + 1 })
}

fn boundary_height(pair: &Pair, mesh: &Mesh) -> Result<Vec<f64>, PairError> {
    let is_boundary = |a: &usize| mesh.kind()[*a] == VertexKind::Boundary;
    let boundary: Vec<usize> = (0..mesh.points().len()).filter(is_boundary).collect();
    let [x, y] = [0, 1].map(|axis| boundary.iter().map(|&a| mesh.points()[a][axis]).collect::<Vec<f64>>());
    let mut values = vec![0.0; boundary.len()];
    let refused = |k: usize, value: f64| PairError::Height {
        vertex: boundary[k],
        point: mesh.points()[boundary[k]],
        value,
    };
    pair.height().eval_many(&x, &y, &mut values).map_err(|error| match error {
        EvaluationError::NotFinite { point, value } => {
            let is_there = |k: &usize| [x[*k], y[*k]] == point;
            refused((0..boundary.len()).find(is_there).expect("one of the points"), value)
        }
        source => PairError::HeightFailed { source },
    })?;
    if let Some(k) = values.iter().position(|&value| value < 0.0) {
        return Err(refused(k, values[k]));
    }
    let mut height = vec![0.0; mesh.points().len()];
    boundary.iter().zip(values).for_each(|(&a, value)| height[a] = value);
    Ok(height)
}

/// The rows and columns `chosen` (increasing) of a matrix.
pub(crate) fn principal_submatrix(matrix: &StiffnessMatrix, chosen: &[usize]) -> CsMat<f64> {
    let mut number = vec![usize::MAX; matrix.cols()];
    for (k, &a) in chosen.iter().enumerate() {
        number[a] = k;
    }
    let mut start = Vec::with_capacity(chosen.len() + 1);
    let (mut columns, mut values) = (Vec::new(), Vec::new());
    start.push(0);
    for &a in chosen {
        for (b, value) in row_of(matrix, a).filter(|&(b, _)| number[b] != usize::MAX) {
            columns.push(number[b]);
            values.push(value);
        }
        start.push(columns.len());
    }
    CsMat::new((chosen.len(), chosen.len()), start, columns, values)
}

/// Why a problem cannot be posed on a mesh.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PairError {
    /// Another stack than the paper's pair.
    #[error("the problem is not the paper's pair: take `StackDiscretization`")]
    NotThePair,
    /// A load is not finite.
    #[error("load f{membrane} {source}: it must be finite on the whole domain")]
    Load {
        /// 1 or 2.
        membrane: usize,
        /// Where, or why.
        source: EvaluationError,
    },
    /// The height is negative or not finite at a boundary vertex.
    #[error("height g is {} at the boundary vertex {vertex} ({}, {}): it must be finite and >= 0 on the whole boundary (where a formula is zero up to rounding, write max(0, ...))", Number(*value), Number(point[0]), Number(point[1]))]
    Height {
        /// The vertex, counted from 0.
        vertex: usize,
        /// Its coordinates.
        point: [f64; 2],
        /// The value there.
        value: f64,
    },
    /// The height cannot be evaluated.
    #[error("height g {source}")]
    HeightFailed {
        /// Why.
        source: EvaluationError,
    },
    /// A load is next to nothing at all points of the quadrature.
    #[error("the quadrature sees nothing of load f{membrane}: at its points the load is below {:e}; refine the mesh where the load acts, or choose other units if it is as small everywhere", 1.0 / LARGEST)]
    NotSeen {
        /// 1 or 2.
        membrane: usize,
    },
    /// A size that leads to overflow.
    #[error("{quantity} {value:e}, out of the range from {:e} to {LARGEST:e}: choose other units", 1.0 / LARGEST)]
    OutOfRange {
        /// Whose size.
        quantity: &'static str,
        /// The size.
        value: f64,
    },
}

impl PairError {
    /// The vertex that the error names.
    pub fn vertex(&self) -> Option<usize> {
        match *self {
            Self::Height { vertex, .. } => Some(vertex),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;
