//! The P1 spaces with zero boundary values on `T_h`, `S_h` and its uniform refinements: each contains the one before.

use super::MeasureError;
use crate::discretization::PairDiscretization;
use crate::fem::stiffness;
use crate::mesh::{Mesh, Refinement, SubTriangulation};
use crate::multigrid::hierarchy::{Genealogy, Hierarchy, Mean, inside};
use crate::multigrid::linear::{MAX_ITERATIONS, NoNorm, dual_norm};

/// The spaces of a discretization, as the levels of a hierarchy.
pub(super) struct Spaces {
    hierarchy: Hierarchy,
}

impl Spaces {
    /// Returns the spaces and the finest mesh, `S_h` refined `refinements` times.
    pub(super) fn new(
        d: &PairDiscretization,
        sub: &SubTriangulation,
        refinements: usize,
    ) -> Result<(Self, Mesh), MeasureError> {
        let mut means = Vec::new();
        let mut finest = sub.mesh().clone();
        for _ in 0..refinements {
            let coarse = finest.points().len();
            let Refinement { mesh, parents } = finest.refine()?;
            means.push((coarse, parents.into_iter().map(|[a, b]| Mean::of_two(a, b)).collect::<Vec<_>>()));
            finest = mesh;
        }
        let mut genealogy = Genealogy::unknown(finest.points().len());
        for (coarse, means) in means.iter().rev() {
            genealogy.refines(*coarse, means);
        }
        genealogy.refines(d.mesh().points().len(), &means_of_sub_triangulation(d.mesh(), sub));
        genealogy.follow(d.mesh().ancestry());
        let hierarchy = Hierarchy::over(&stiffness(&finest), &inside(&finest), &genealogy);
        Ok((Self { hierarchy }, finest))
    }

    /// A functional on the finest space, given over the vertices of its mesh by its values at the hat functions.
    pub(super) fn functional(&self, over_vertices: &[f64]) -> Functional {
        Functional { below: 0, rows: self.hierarchy.to_rows(|a| over_vertices[a]) }
    }

    /// The same functional on the next coarser space.
    pub(super) fn restrict(&self, functional: &Functional) -> Functional {
        let level = &self.hierarchy.levels()[self.hierarchy.finest() - functional.below];
        Functional { below: functional.below + 1, rows: level.transfer.restrict(&functional.rows) }
    }

    /// `sup (rho, v) / |v|_1` over the space of the functional.
    pub(super) fn dual_norm(&self, rho: &Functional) -> Result<f64, MeasureError> {
        dual_norm(&self.hierarchy, self.hierarchy.finest() - rho.below, &rho.rows).map_err(
            |error| match error {
                NoNorm::NotFactored => MeasureError::NotFactored,
                NoNorm::NotConverged => MeasureError::NotConverged { iterations: MAX_ITERATIONS },
            },
        )
    }
}

/// A functional on one of the spaces.
pub(super) struct Functional {
    /// How many spaces below the finest one.
    below: usize,
    /// Its values at the hat functions, over the rows of the level.
    rows: Vec<f64>,
}

/// The vertices of `T_h` whose mean each further vertex of `S_h` is: midpoints first, barycentres then.
fn means_of_sub_triangulation(mesh: &Mesh, sub: &SubTriangulation) -> Vec<Mean> {
    let first = mesh.points().len();
    let mut means = vec![Mean::of_two(0, 0); sub.mesh().points().len() - first];
    for (k, corners) in mesh.triangles().iter().enumerate() {
        means[sub.barycentre(k) - first] = Mean::of_three(*corners);
        for i in 0..3 {
            let [_, midpoint, _] = sub.mesh().triangles()[6 * k + 2 * i];
            means[midpoint - first] = Mean::of_two(corners[i], corners[(i + 1) % 3]);
        }
    }
    means
}

#[cfg(test)]
impl Functional {
    /// Over the vertices of the mesh of its space, whose vertices are the first ones of each finer mesh.
    pub(super) fn over_vertices(&self, spaces: &Spaces) -> Vec<f64> {
        let hierarchy = &spaces.hierarchy;
        let mut number = hierarchy.to_rows(|a| a as f64);
        for l in 0..self.below {
            number = hierarchy.levels()[hierarchy.finest() - l].transfer.inject(&number);
        }
        let mut values = vec![0.0; number.len()];
        number.iter().zip(&self.rows).for_each(|(&a, &value)| values[a as usize] = value);
        values
    }
}
