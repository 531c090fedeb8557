//! The circle that the boundary of a refined mesh follows.

use crate::mesh::{Mesh, MeshError, VertexKind};
use crate::problem::Domain;

/// The boundary of a disk.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Circle {
    pub(crate) centre: [f64; 2],
    pub(crate) radius: f64,
}

impl Circle {
    /// That of a domain which is a disk.
    pub(crate) fn of_domain(domain: &Domain) -> Option<Self> {
        match *domain {
            Domain::Disk { centre, radius } => Some(Self { centre, radius }),
            _ => None,
        }
    }

    /// Moves vertices on the boundary to the circle, along the ray from its centre; `kind` says which they are.
    pub(in crate::mesh) fn attract(self, points: &mut [[f64; 2]], kind: &[VertexKind]) {
        for (point, _) in points.iter_mut().zip(kind).filter(|(_, kind)| **kind == VertexKind::Boundary) {
            let [x, y] = [point[0] - self.centre[0], point[1] - self.centre[1]];
            let scale = self.radius / x.hypot(y);
            *point = [self.centre[0] + scale * x, self.centre[1] + scale * y];
        }
    }
}

impl Mesh {
    /// The same mesh, checked again because vertices were moved.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    pub(in crate::mesh) fn checked(self) -> Result<Self, MeshError> {
        Ok(Self::new(self.points, self.triangles)?.with_ancestry(self.ancestry).with_groups(self.groups))
    }
}
