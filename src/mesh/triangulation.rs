//! The mesh itself: what it consists of, and how it was refined.

mod adjacency;

use std::sync::{Arc, OnceLock};

use super::ancestry::Parents;
use super::groups::Groups;
use super::views::Views;
use crate::geometry::{distance_sq, twice_signed_area};
pub(in crate::mesh) use adjacency::VertexTriangles;
pub(crate) use adjacency::{HalfEdge, HalfEdges, corner_of};

/// Where a vertex lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VertexKind {
    /// Inside the domain: it carries unknowns (`a` in `V_h`).
    Interior,
    /// On the boundary: `u1 = g`, `u2 = 0`.
    Boundary,
    /// In no triangle: kept in the output, left out of the system.
    Unused,
}

/// A conforming triangulation of a bounded set of the plane: several components and holes are allowed.
///
/// Valid by construction ([`Mesh::new`]) and immutable; [`Mesh::refine`] returns a new one.
#[derive(Debug, Clone)]
pub struct Mesh {
    pub(super) points: Vec<[f64; 2]>,
    pub(super) triangles: Vec<[usize; 3]>,
    pub(super) kind: Vec<VertexKind>,
    pub(super) ancestry: Vec<Arc<Parents>>,
    pub(super) groups: Groups,
    pub(super) views: Views,
    /// Once somebody has asked for it.
    pub(super) around: OnceLock<VertexTriangles>,
}

impl Mesh {
    /// The vertices, in the order in which they were given. Shape: `vertices x 2`; unit: length.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// The triangles, as vertex numbers in counterclockwise order. Shape: `triangles x 3`.
    pub fn triangles(&self) -> &[[usize; 3]] {
        &self.triangles
    }

    /// The kind of each vertex. Shape: `vertices`.
    pub fn kind(&self) -> &[VertexKind] {
        &self.kind
    }

    /// The named regions and curves. Refinements inherit them.
    pub fn groups(&self) -> &Groups {
        &self.groups
    }

    /// The data views. Refinements inherit them.
    pub fn views(&self) -> &Views {
        &self.views
    }

    /// The triangles around each vertex.
    pub(crate) fn around(&self) -> &VertexTriangles {
        self.around.get_or_init(|| VertexTriangles::new(self.points.len(), &self.triangles))
    }

    /// The corners of triangle `t`, counterclockwise.
    pub fn corners(&self, t: usize) -> [[f64; 2]; 3] {
        self.triangles[t].map(|a| self.points[a])
    }

    /// The area of triangle `t`, positive.
    pub fn triangle_area(&self, t: usize) -> f64 {
        0.5 * twice_signed_area(self.corners(t))
    }

    /// The square of the diameter `h_K` of triangle `t`, its longest edge.
    pub(crate) fn diameter_sq(&self, t: usize) -> f64 {
        let corners = self.corners(t);
        (0..3).map(|i| distance_sq(corners[i], corners[(i + 1) % 3])).fold(0.0, f64::max)
    }

    /// The area of the domain `|omega|`.
    pub fn area(&self) -> f64 {
        (0..self.triangles.len()).map(|t| self.triangle_area(t)).sum()
    }

    /// The smallest rectangle around the triangles, as `(lower left, upper right)`.
    pub fn bounding_box(&self) -> ([f64; 2], [f64; 2]) {
        let mut lower = [f64::INFINITY; 2];
        let mut upper = [f64::NEG_INFINITY; 2];
        for (point, &kind) in self.points.iter().zip(&self.kind) {
            if kind != VertexKind::Unused {
                for axis in 0..2 {
                    lower[axis] = lower[axis].min(point[axis]);
                    upper[axis] = upper[axis].max(point[axis]);
                }
            }
        }
        (lower, upper)
    }
}

impl Mesh {
    /// The refinements that made this mesh, from the coarsest mesh to this one; empty when none is known. Multigrid and
    /// nested iteration run along them.
    pub fn ancestry(&self) -> &[Arc<Parents>] {
        &self.ancestry
    }

    /// The same mesh, with its ancestry known.
    ///
    /// # Panics
    /// When the last refinement does not lead to this mesh.
    pub(in crate::mesh) fn with_ancestry(mut self, ancestry: Vec<Arc<Parents>>) -> Self {
        let vertices = ancestry.last().map(|parents| parents.ends().len());
        assert!(vertices.is_none_or(|vertices| vertices == self.points.len()), "parents of every vertex");
        self.ancestry = ancestry;
        self
    }

    /// The same mesh, its parts named by `groups` in place of what they were called.
    pub(in crate::mesh) fn with_groups(self, groups: Groups) -> Self {
        Self { groups, ..self }
    }

    /// The same mesh with these views in place of those that it had.
    pub(in crate::mesh) fn with_views(self, views: Views) -> Self {
        Self { views, ..self }
    }

    /// The same mesh without the views that are not wanted: refinements have less to inherit.
    #[cfg(feature = "cli")]
    pub(crate) fn keeping_views(mut self, is_wanted: impl Fn(&str) -> bool) -> Self {
        self.views.keep(is_wanted);
        self
    }

    /// The ancestry of a refinement of this mesh.
    pub(in crate::mesh) fn ancestry_of_refinement(&self, midpoints: &[[usize; 2]]) -> Vec<Arc<Parents>> {
        let parents = Parents::of_refinement(self.points.len(), midpoints);
        self.ancestry.iter().cloned().chain([Arc::new(parents)]).collect()
    }
}
