//! The levels for one membrane.

use std::borrow::Cow;

use super::cholesky::NotFactored;
use super::half::{self, HalfProblem, HalfSolution};
use super::hierarchy::{Genealogy, Hierarchy};
use super::patches::{self, Patches};
use crate::fem::StiffnessMatrix;
use crate::mesh::Mesh;
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;
use crate::qp::Limits;

/// Patches where the mesh has them, else stored rows.
pub(crate) enum MembraneLevels<'k> {
    Patches(Box<Patches>, Cow<'k, StiffnessMatrix>),
    Stored(Hierarchy),
}

impl<'k> MembraneLevels<'k> {
    /// Those that follow the refinements that made the mesh, for a matrix over its vertices, of which those with an unknown are `free`.
    pub(crate) fn new(mesh: &Mesh, k: Cow<'k, StiffnessMatrix>, free: &[bool]) -> Self {
        match Patches::new(mesh, &k, free) {
            Some(patches) => Self::Patches(Box::new(patches), k),
            None => Self::Stored(Hierarchy::over(&k, free, &Genealogy::of(mesh))),
        }
    }

    /// Algebraic ones.
    pub(crate) fn algebraic(k: &StiffnessMatrix, free: &[bool]) -> Self {
        Self::Stored(Hierarchy::over(k, free, &Genealogy::unknown(k.rows())))
    }

    /// How many levels follow the refinements that made the mesh.
    pub(crate) fn refinements(&self) -> usize {
        match self {
            Self::Patches(patches, _) => patches.refinements(),
            Self::Stored(hierarchy) => hierarchy.refinements(),
        }
    }

    /// From a vector over the vertices of the mesh to one over the rows of the finest level.
    pub(crate) fn to_rows(&self, over_vertices: impl Fn(usize) -> f64 + Sync) -> Vec<f64> {
        match self {
            Self::Patches(_, k) => {
                (0..k.rows()).into_par_iter().with_min_len(BLOCK).map(&over_vertices).collect()
            }
            Self::Stored(hierarchy) => hierarchy.to_rows(over_vertices),
        }
    }

    /// And back.
    pub(crate) fn to_vertices<'v>(&self, over_rows: &'v [f64]) -> Cow<'v, [f64]> {
        match self {
            Self::Patches(..) => over_rows.into(),
            Self::Stored(hierarchy) => hierarchy.to_vertices(over_rows).into(),
        }
    }

    /// Solves a problem over the rows of the finest level.
    pub(crate) fn solve(&self, problem: HalfProblem, limits: &Limits) -> Result<HalfSolution, NotFactored> {
        match self {
            Self::Patches(patches, k) => patches::solve(patches, k, problem, limits),
            Self::Stored(hierarchy) => half::solve(hierarchy, problem, limits),
        }
    }
}
