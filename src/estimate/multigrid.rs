//! Conjugate gradients with a multigrid preconditioner, for the Riesz lift.

use sprs::CsMat;

use super::MeasureError;
use crate::discretization::Discretization;
use crate::fem::stiffness;
use crate::mesh::{Mesh, Refinement, SubTriangulation, VertexKind};
use crate::multigrid::cholesky::Cholesky;

/// An iteration that adds no more than this fraction to the squared norm is the last: a V-cycle leaves a tenth or less
/// of the error, so what is missing then is smaller still.
const TOLERANCE: f64 = 1e-12;

/// Far beyond the dozen iterations of ordinary meshes: triangles that are nearly flat need hundreds.
const MAX_ITERATIONS: usize = 500;

/// The P1 spaces with zero boundary values on `T_h`, `S_h` and its uniform refinements: each contains the one before.
pub(super) struct Multigrid<'d> {
    unknowns: &'d [usize],
    coarsest: Cholesky,
    levels: Vec<Level>,
}

/// One space; vectors have an entry for each vertex, zero on the boundary.
struct Level {
    stiffness: CsMat<f64>,
    free: Vec<bool>,
    parents: Parents,
}

/// From which vertices of the coarser mesh the further ones come, as midpoints first and barycentres then; a P1 function
/// takes the mean of its values there.
#[derive(Default)]
struct Parents {
    midpoints: Vec<[usize; 2]>,
    barycentres: Vec<[usize; 3]>,
}

impl<'d> Multigrid<'d> {
    /// Returns the spaces and the finest mesh, `S_h` refined `refinements` times.
    pub(super) fn new(
        d: &'d Discretization,
        sub: &SubTriangulation,
        refinements: usize,
    ) -> Result<(Self, Mesh), MeasureError> {
        let coarsest =
            Cholesky::new(d.interior_stiffness().clone()).map_err(|_| MeasureError::NotFactored)?;
        let mut levels = vec![Level::new(d.mesh(), Parents::default())];
        let mut finest = sub.mesh().clone();
        levels.push(Level::new(&finest, Parents::of_sub_triangulation(d.mesh(), sub)));
        for _ in 0..refinements {
            let Refinement { mesh, parents } = finest.refine()?;
            levels.push(Level::new(&mesh, Parents { midpoints: parents, barycentres: Vec::new() }));
            finest = mesh;
        }
        Ok((Self { unknowns: d.interior(), coarsest, levels }, finest))
    }

    /// The level of the finest mesh; 0 is `T_h`, 1 is `S_h`.
    pub(super) fn finest(&self) -> usize {
        self.levels.len() - 1
    }

    /// A functional on level `level`, given by its values at the hat functions, on the level below.
    pub(super) fn restrict(&self, level: usize, functional: &[f64]) -> Vec<f64> {
        self.levels[level].parents.restrict(functional)
    }

    /// `sup (rho, v) / |v|_1` over the space of a level, for a functional given by its values at the hat functions.
    ///
    /// With `K z = rho` it is `sqrt(rho' z)`, which the conjugate gradients gather term by term: `z` itself is not needed.
    pub(super) fn dual_norm(&self, level: usize, rho: &[f64]) -> Result<f64, MeasureError> {
        let space = &self.levels[level];
        let mut residual: Vec<f64> =
            rho.iter().zip(&space.free).map(|(&rho, &free)| if free { rho } else { 0.0 }).collect();
        let mut direction = self.v_cycle(level, &residual)?;
        let mut reduction = dot(&residual, &direction);
        let mut norm_sq: f64 = 0.0;
        for _ in 0..MAX_ITERATIONS {
            if reduction == 0.0 {
                return Ok(norm_sq.sqrt());
            }
            let product = space.product(&direction);
            let step = reduction / dot(&direction, &product);
            let gain = step * reduction;
            norm_sq += gain;
            if gain <= TOLERANCE * norm_sq {
                return Ok(norm_sq.sqrt());
            }
            add(&mut residual, -step, &product);
            let correction = self.v_cycle(level, &residual)?;
            let before = std::mem::replace(&mut reduction, dot(&residual, &correction));
            for (direction, correction) in direction.iter_mut().zip(&correction) {
                *direction = correction + reduction / before * *direction;
            }
        }
        Err(MeasureError::NotConverged { iterations: MAX_ITERATIONS })
    }

    /// One V-cycle for `K x = b`: symmetric, because the sweeps after the correction run backwards.
    fn v_cycle(&self, level: usize, b: &[f64]) -> Result<Vec<f64>, MeasureError> {
        let space = &self.levels[level];
        let mut x = vec![0.0; b.len()];
        if level == 0 {
            let b: Vec<f64> = self.unknowns.iter().map(|&a| b[a]).collect();
            let solved = self.coarsest.solve(&b).map_err(|_| MeasureError::NotFactored)?;
            for (&a, value) in self.unknowns.iter().zip(solved) {
                x[a] = value;
            }
            return Ok(x);
        }
        space.relax(&mut x, b, 0..b.len());
        let mut residual = space.product(&x);
        for (residual, b) in residual.iter_mut().zip(b) {
            *residual = b - *residual;
        }
        let correction = self.v_cycle(level - 1, &space.parents.restrict(&residual))?;
        space.parents.prolong_onto(&mut x, &correction);
        space.relax(&mut x, b, (0..b.len()).rev());
        Ok(x)
    }
}

impl Level {
    fn new(mesh: &Mesh, parents: Parents) -> Self {
        let free = mesh.kind().iter().map(|&kind| kind == VertexKind::Interior).collect();
        Self { stiffness: stiffness(mesh), free, parents }
    }

    /// `K x` at the free vertices, zero at the others.
    fn product(&self, x: &[f64]) -> Vec<f64> {
        let rows = self.stiffness.outer_iterator().zip(&self.free);
        rows.map(|(row, &free)| if free { row.iter().map(|(b, k)| k * x[b]).sum() } else { 0.0 }).collect()
    }

    /// A Gauss-Seidel sweep over the free vertices, in the order given.
    fn relax(&self, x: &mut [f64], b: &[f64], order: impl Iterator<Item = usize>) {
        for a in order.filter(|&a| self.free[a]) {
            let row = self.stiffness.outer_view(a).expect("a vertex has a row");
            let (mut right, mut diagonal) = (b[a], 0.0);
            for (c, k) in row.iter() {
                if c == a {
                    diagonal = *k;
                } else {
                    right -= k * x[c];
                }
            }
            x[a] = right / diagonal;
        }
    }
}

impl Parents {
    fn of_sub_triangulation(mesh: &Mesh, sub: &SubTriangulation) -> Self {
        let first = mesh.points().len();
        let midpoints = sub.mesh().points().len() - first - mesh.triangles().len();
        let mut parents = Self { midpoints: vec![[0; 2]; midpoints], barycentres: mesh.triangles().to_vec() };
        for (k, corners) in mesh.triangles().iter().enumerate() {
            for i in 0..3 {
                let [_, midpoint, _] = sub.mesh().triangles()[6 * k + 2 * i];
                parents.midpoints[midpoint - first] = [corners[i], corners[(i + 1) % 3]];
            }
        }
        parents
    }

    /// Adds a coarse function to the fine function `x`.
    fn prolong_onto(&self, x: &mut [f64], coarse: &[f64]) {
        add(&mut x[..coarse.len()], 1.0, coarse);
        let (midpoints, barycentres) = x[coarse.len()..].split_at_mut(self.midpoints.len());
        for (x, [a, b]) in midpoints.iter_mut().zip(&self.midpoints) {
            *x += 0.5 * (coarse[*a] + coarse[*b]);
        }
        for (x, [a, b, c]) in barycentres.iter_mut().zip(&self.barycentres) {
            *x += (coarse[*a] + coarse[*b] + coarse[*c]) / 3.0;
        }
    }

    /// The transpose of [`prolong_onto`](Self::prolong_onto).
    fn restrict(&self, fine: &[f64]) -> Vec<f64> {
        let (old, new) = fine.split_at(fine.len() - self.midpoints.len() - self.barycentres.len());
        let (midpoints, barycentres) = new.split_at(self.midpoints.len());
        let mut coarse = old.to_vec();
        for (value, ends) in midpoints.iter().zip(&self.midpoints) {
            ends.iter().for_each(|&a| coarse[a] += value / 2.0);
        }
        for (value, corners) in barycentres.iter().zip(&self.barycentres) {
            corners.iter().for_each(|&a| coarse[a] += value / 3.0);
        }
        coarse
    }
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

fn add(x: &mut [f64], factor: f64, y: &[f64]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x += factor * y;
    }
}
