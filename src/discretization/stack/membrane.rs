//! One membrane of a stack on a mesh.

use super::error::StackError;
use super::fields::{IntegrationRule, NOT_NEGATIVE, borders, means, moments};
use super::supports::Held;
use crate::fem::LoadMoments;
use crate::mesh::{Mesh, VertexKind};
use crate::parallel::prelude::*;
use crate::problem::Membrane;

/// One membrane on the mesh.
#[derive(Debug, Clone)]
pub(crate) struct MembraneData {
    /// `K_i = factor * stiffness[profile] + diag(foundation)`.
    pub(super) factor: f64,
    pub(super) profile: usize,
    /// Over vertices.
    pub(super) foundation: Option<Vec<f64>>,
    /// The means `c_K`, over triangles.
    pub(super) foundation_means: Option<Vec<f64>>,
    pub(super) moments: LoadMoments,
    /// `F_i` over vertices, line loads included. Unit: force.
    pub(super) load: Vec<f64>,
    pub(super) held: Held,
    /// The number of the unknown at each vertex, where there is one.
    pub(super) number: Vec<Option<u32>>,
    /// The vertices with an unknown, in increasing order; they are numbered from `first`.
    pub(super) vertices: Vec<usize>,
    pub(super) first: usize,
    /// The edges where its tension jumps from one region to another.
    pub(super) tension_borders: Vec<[usize; 2]>,
}

impl MembraneData {
    pub(super) fn new(
        mesh: &Mesh,
        membrane: &Membrane,
        name: usize,
        rule: IntegrationRule,
        (factor, profile): (f64, usize),
        first: usize,
    ) -> Result<Self, StackError> {
        let held = Held::new(mesh, membrane, name)?;
        let foundation = match membrane.foundation.constant() {
            Some(0.0) => None,
            _ => Some(means(mesh, &membrane.foundation, &format!("foundation c{name}"), rule, NOT_NEGATIVE)?),
        };
        let over_vertices = |term: &(dyn Fn(usize) -> f64 + Sync)| -> Vec<f64> {
            let at = |a: usize| mesh.around().triangles(a).map(term).sum();
            (0..mesh.points().len()).into_par_iter().map(at).collect()
        };
        let moments = moments(mesh, &membrane.load, &format!("load f{name}"), rule)?;
        let mut load = moments.vector(mesh);
        for line in &held.line_loads {
            line.ends.iter().zip(line.force).for_each(|(&a, force)| load[a] += force);
        }
        let is_free = |a: &usize| mesh.kind()[*a] != VertexKind::Unused && held.height[*a].is_none();
        let vertices: Vec<usize> = (0..mesh.points().len()).filter(is_free).collect();
        let mut number = vec![None; mesh.points().len()];
        for (k, &a) in vertices.iter().enumerate() {
            number[a] = Some(u32::try_from(first + k).expect("fewer than 2^32 unknowns"));
        }
        Ok(Self {
            factor,
            profile,
            foundation: foundation.as_ref().map(|c| over_vertices(&|t| c[t] * mesh.triangle_area(t) / 3.0)),
            foundation_means: foundation,
            moments,
            load,
            held,
            number,
            vertices,
            first,
            tension_borders: borders(mesh, &membrane.tension, &format!("tension mu{name}"))?,
        })
    }

    /// Whether a height or a foundation holds it at a vertex.
    pub(super) fn is_held_at(&self, a: usize) -> bool {
        self.held.height[a].is_some() || self.foundation.as_ref().is_some_and(|c| c[a] > 0.0)
    }

    /// Whether one does on every one of the connected `parts` of the mesh.
    pub(super) fn is_held_everywhere(&self, mesh: &Mesh, parts: &[usize]) -> bool {
        let mut is_held = vec![false; mesh.points().len()];
        (0..parts.len()).filter(|&a| self.is_held_at(a)).for_each(|a| is_held[parts[a]] = true);
        (0..parts.len()).all(|a| mesh.kind()[a] == VertexKind::Unused || is_held[parts[a]])
    }
}

/// A vertex that stands for the connected part of the mesh in which each vertex lies.
pub(super) fn connected_parts(mesh: &Mesh) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..mesh.points().len()).collect();
    fn root(parent: &mut [usize], mut a: usize) -> usize {
        while parent[a] != a {
            parent[a] = parent[parent[a]];
            a = parent[a];
        }
        a
    }
    for &[a, b, c] in mesh.triangles() {
        for [a, b] in [[a, b], [b, c]] {
            let (a, b) = (root(&mut parent, a), root(&mut parent, b));
            parent[a.max(b)] = a.min(b);
        }
    }
    (0..parent.len()).map(|a| root(&mut parent, a)).collect()
}

/// A tension as a number times one of the profiles: membranes whose tensions are in proportion share one.
pub(super) fn profile(profiles: &mut Vec<Vec<f64>>, tension: &[f64]) -> (f64, usize) {
    let factor = tension.first().copied().unwrap_or(1.0);
    let is_that = |profile: &Vec<f64>| profile.iter().zip(tension).all(|(part, mu)| part * factor == *mu);
    let known = profiles.iter().position(is_that).unwrap_or_else(|| {
        let uniform = tension.iter().all(|mu| *mu == factor);
        profiles.push(tension.iter().map(|mu| if uniform { 1.0 } else { mu / factor }).collect());
        profiles.len() - 1
    });
    (factor, known)
}
