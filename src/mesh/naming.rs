//! Names for parts of a mesh, by where they lie, and for numbers on it.

use thiserror::Error;

use super::Mesh;
use super::topology::boundary_edges;
use super::views::{ViewError, ViewPlace};
use crate::text::excerpt;

/// Why a part of a mesh cannot be called like this.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum GroupError {
    /// There is a region of this name.
    #[error("there is a region `{}` already: choose another name", excerpt(name))]
    RegionTaken {
        /// The name.
        name: String,
    },
    /// There is a curve of this name.
    #[error("there is a curve `{}` already: choose another name", excerpt(name))]
    CurveTaken {
        /// The name.
        name: String,
    },
    /// A region without a triangle.
    #[error(
        "no triangle has its barycentre in the region `{}`: refine the mesh, or make the region larger",
        excerpt(name)
    )]
    EmptyRegion {
        /// The name.
        name: String,
    },
    /// A number of a triangle that is not there.
    #[error("the region `{}` names triangle {triangle}, of {triangles}: count from 0", excerpt(name))]
    NoSuchTriangle {
        /// The name.
        name: String,
        /// The number.
        triangle: usize,
        /// How many there are.
        triangles: usize,
    },
    /// Two vertices that no edge joins.
    #[error(
        "the curve `{}` names an edge from vertex {} to {}, which no triangle has: give its two ends",
        excerpt(name),
        ends[0],
        ends[1]
    )]
    NoSuchEdge {
        /// The name.
        name: String,
        /// The vertices.
        ends: [usize; 2],
    },
    /// A curve without an edge.
    #[error(
        "no edge of the boundary lies on the curve `{}` with both ends and its midpoint: allow for rounding, as in |x| < 1e-9, or refine the mesh",
        excerpt(name)
    )]
    EmptyCurve {
        /// The name.
        name: String,
    },
}

impl Mesh {
    /// The same mesh with a further data view, one value for each vertex or triangle. Linear time.
    ///
    /// # Errors
    /// [`ViewError`] when another view is called like it, and for values that are not finite or not as many.
    pub fn with_view(
        mut self,
        name: impl Into<String>,
        place: ViewPlace,
        values: impl IntoIterator<Item = f64>,
    ) -> Result<Self, ViewError> {
        let expected = match place {
            ViewPlace::Vertices => self.points.len(),
            ViewPlace::Triangles => self.triangles.len(),
        };
        self.views.add(name.into(), place, values, expected)?;
        Ok(self)
    }

    /// The same mesh, in which the triangles whose barycentres are `inside` are the region `name`. Linear time.
    ///
    /// It may overlap with others. See [`Groups`](super::Groups).
    ///
    /// # Errors
    /// [`GroupError`] when another region is called like it, or when there is no such triangle.
    pub fn with_region(
        self,
        name: impl Into<String>,
        inside: impl Fn([f64; 2]) -> bool,
    ) -> Result<Self, GroupError> {
        let barycentre = |t: usize| {
            let [a, b, c] = self.corners(t);
            [0, 1].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0)
        };
        let triangles: Vec<usize> = (0..self.triangles.len()).filter(|&t| inside(barycentre(t))).collect();
        self.with_region_of(name, triangles)
    }

    /// The same mesh, in which these triangles are the region `name`. It may overlap with others.
    ///
    /// # Errors
    /// [`GroupError`] when another region is called like it, when it is empty, or names a triangle that is not there.
    pub fn with_region_of(
        mut self,
        name: impl Into<String>,
        triangles: Vec<usize>,
    ) -> Result<Self, GroupError> {
        let name = name.into();
        if self.groups.regions().contains(&name) {
            return Err(GroupError::RegionTaken { name });
        }
        if triangles.is_empty() {
            return Err(GroupError::EmptyRegion { name });
        }
        if let Some(&triangle) = triangles.iter().find(|&&t| t >= self.triangles.len()) {
            return Err(GroupError::NoSuchTriangle { name, triangle, triangles: self.triangles.len() });
        }
        self.groups = std::mem::take(&mut self.groups).with_region(name, triangles);
        Ok(self)
    }

    /// The same mesh, in which the edges of the boundary that lie `on` a line with both ends and their midpoints are the
    /// curve `name`. Linear time.
    ///
    /// It may overlap with others, as with the sides that the generators name. Coordinates are rounded, and edges are
    /// straight: `on` has to allow for that. See [`Groups`](super::Groups).
    ///
    /// # Errors
    /// [`GroupError`] when another curve is called like it, or when there is no such edge.
    pub fn with_curve(
        self,
        name: impl Into<String>,
        on: impl Fn([f64; 2]) -> bool,
    ) -> Result<Self, GroupError> {
        let is_on = |ends: &[usize; 2]| ends.iter().all(|&a| on(self.points[a])) && on(self.midpoint(*ends));
        let edges: Vec<[usize; 2]> = boundary_edges(&self).into_iter().filter(is_on).collect();
        self.with_curve_of(name, edges)
    }

    /// The same mesh, in which the edges with these ends, of the boundary or inside, are the curve `name`. It may overlap with others.
    ///
    /// # Errors
    /// [`GroupError`] when another curve is called like it, when it is empty, or names what is no edge.
    pub fn with_curve_of(
        mut self,
        name: impl Into<String>,
        edges: Vec<[usize; 2]>,
    ) -> Result<Self, GroupError> {
        let name = name.into();
        if self.groups.curves().contains(&name) {
            return Err(GroupError::CurveTaken { name });
        }
        if edges.is_empty() {
            return Err(GroupError::EmptyCurve { name });
        }
        let is_edge = |&[a, b]: &[usize; 2]| {
            let mut around = if a < self.points.len() { self.around().triangles(a) } else { return false };
            a != b && around.any(|t| self.triangles[t].contains(&b))
        };
        if let Some(&ends) = edges.iter().find(|ends| !is_edge(ends)) {
            return Err(GroupError::NoSuchEdge { name, ends });
        }
        self.groups = std::mem::take(&mut self.groups).with_curve(name, edges);
        Ok(self)
    }
}
