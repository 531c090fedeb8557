//! The data of a stack as the mesh sees them, triangle by triangle: what bounds of the error need beside the discrete problem.

use super::StackDiscretization;
use super::error::StackError;
use super::fields::IntegrationRule;
use super::membrane::MembraneData;
use super::samples::{Samples, at_samples, is_constant_on_triangles, samples};
use super::supports::Held;
use crate::fem::LoadMoments;
use crate::geometry::distance_sq;
use crate::problem::{ContactProblem, Field};

impl StackDiscretization {
    /// The problem.
    pub fn problem(&self) -> &ContactProblem {
        &self.problem
    }

    /// How the data are integrated.
    pub fn rule(&self) -> IntegrationRule {
        self.rule
    }

    /// The tension of membrane `i` (from 1) on triangle `t`, as it is in `K_i`.
    pub(crate) fn tension_on(&self, i: usize, t: usize) -> f64 {
        let MembraneData { factor, profile, .. } = &self.membranes[i - 1];
        factor * self.profiles[*profile][t]
    }

    /// The factor and the number of the profile in `K_i = factor * K_profile + C_i`: membranes whose tensions are in proportion share a
    /// profile.
    pub(crate) fn profile(&self, i: usize) -> (f64, usize) {
        let MembraneData { factor, profile, .. } = self.membranes[i - 1];
        (factor, profile)
    }

    /// The tension of membrane `i` at the points of each triangle; `None` where it has one value on each.
    ///
    /// # Errors
    /// When it has no value somewhere.
    pub(crate) fn tension_samples(&self, i: usize) -> Result<Option<Vec<Samples>>, StackError> {
        let tension = &self.problem.membranes()[i - 1].tension;
        if is_constant_on_triangles(&self.mesh, tension) {
            return Ok(None);
        }
        samples(&self.mesh, tension, &format!("tension mu{i}")).map(Some)
    }

    /// The ceiling (0) or the floor (1) at the points of each triangle; `None` where it is affine on each, or not there.
    ///
    /// # Errors
    /// When it has no value somewhere.
    pub(crate) fn obstacle_samples(&self, k: usize) -> Result<Option<Vec<Samples>>, StackError> {
        let (field, name) = match k {
            0 => (self.problem.ceiling(), "the ceiling"),
            _ => (self.problem.floor(), "the floor"),
        };
        match field {
            None | Some(Field::PerVertex(_)) => Ok(None),
            Some(field) if field.constant().is_some() => Ok(None),
            Some(field) => samples(&self.mesh, field, name).map(Some),
        }
    }

    /// A P1 function at the points of triangle `t`.
    pub(crate) fn at_samples(&self, t: usize, values: &[f64]) -> Samples {
        at_samples(self.mesh.triangles()[t].map(|a| values[a]))
    }

    /// The load of membrane `i` triangle by triangle, without line loads.
    pub(crate) fn moments(&self, i: usize) -> &LoadMoments {
        &self.membranes[i - 1].moments
    }

    /// Whether the foundation of membrane `i` has one value on each triangle.
    pub(crate) fn has_even_foundation(&self, i: usize) -> bool {
        is_constant_on_triangles(&self.mesh, &self.problem.membranes()[i - 1].foundation)
    }

    /// The mean of the foundation of membrane `i` on triangle `t`.
    pub(crate) fn foundation_on(&self, i: usize, t: usize) -> f64 {
        self.membranes[i - 1].foundation_means.as_ref().map_or(0.0, |means| means[t])
    }

    /// The edges along which the action in gap `k` may have a density of its own: those where one of the membranes is free or its
    /// tension jumps from one region to another, and those where an obstacle is given by another region; the lower end first.
    pub(crate) fn lines(&self, k: usize) -> Vec<[usize; 2]> {
        let last = self.membranes.len() + 1;
        let of_layer = |layer: usize| match layer {
            0 => [self.obstacle_lines[0].as_slice(), &[]],
            _ if layer == last => [self.obstacle_lines[1].as_slice(), &[]],
            _ => {
                let MembraneData { held, tension_borders, .. } = &self.membranes[layer - 1];
                [held.free_edges.as_slice(), tension_borders]
            }
        };
        let mut lines = [of_layer(k), of_layer(k + 1)].concat().concat();
        lines.sort_unstable();
        lines.dedup();
        lines
    }

    /// The length of an edge.
    pub(crate) fn edge_length(&self, [a, b]: [usize; 2]) -> f64 {
        distance_sq(self.mesh.points()[a], self.mesh.points()[b]).sqrt()
    }

    /// How membrane `i` is held.
    pub(crate) fn held(&self, i: usize) -> &Held {
        &self.membranes[i - 1].held
    }

    /// By how much two quadrature rules differ in the loads, membrane by membrane; see
    /// [`PairDiscretization::quadrature_difference`](crate::discretization::PairDiscretization::quadrature_difference).
    pub fn quadrature_difference(&self) -> Vec<f64> {
        let of = |membrane: &MembraneData| {
            let profile = self.profiles[membrane.profile].iter().copied().fold(f64::INFINITY, f64::min);
            membrane.moments.quadrature_difference() / (membrane.factor * profile).sqrt()
        };
        self.membranes.iter().map(of).collect()
    }
}
