//! How small a triangle may be: one measure for meshes that are given and for those that are made.

use crate::geometry::{distance_sq, twice_signed_area};
use crate::mesh::Mesh;

/// A triangle whose doubled area is below this fraction of its longest edge squared is degenerate. Rounding of the
/// coordinates moves that fraction by about 1e-16; a sliver of 0.01 degrees has 1.7e-4.
const MIN_RELATIVE_AREA: f64 = 1e-12;

/// Coordinates beyond this are refused, and triangles below its inverse: products of areas, loads and
/// displacements must not overflow.
pub(super) const MAX_COORDINATE: f64 = 1e40;

/// Boundary vertices closer than this fraction of the mesh's extent are the same point, given twice.
const COINCIDENCE: f64 = 1e-12;

/// What rounding can move a coordinate by, relative to the largest: far from the origin it exceeds [`COINCIDENCE`].
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Edges of meshes that are made are at least this many times as long as the distance at which points are told apart: then
/// [`Mesh::new`] accepts the mesh down to angles of 0.01, half a degree, and its sub-triangulation too.
const RESOLVED: f64 = 100.0;

/// Points of a mesh between these corners are not told apart when they are closer than this.
pub(super) fn resolution(lower: [f64; 2], upper: [f64; 2]) -> f64 {
    let longer_side = (upper[0] - lower[0]).max(upper[1] - lower[1]);
    let largest = lower.into_iter().chain(upper).fold(0.0, |l: f64, x| l.max(x.abs()));
    (COINCIDENCE * longer_side).max(ROUNDING * largest)
}

/// How the corners of a triangle run around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sense {
    Counterclockwise,
    Clockwise,
    /// It has no area that rounding leaves.
    Degenerate,
    /// Its longest edge is too short.
    Tiny,
}

pub(super) fn sense([a, b, c]: [[f64; 2]; 3]) -> Sense {
    let longest_sq = distance_sq(a, b).max(distance_sq(b, c)).max(distance_sq(c, a));
    let area = twice_signed_area([a, b, c]);
    if a != b && b != c && c != a && longest_sq * MAX_COORDINATE * MAX_COORDINATE <= 1.0 {
        Sense::Tiny
    } else if !(area.abs() > MIN_RELATIVE_AREA * longest_sq) {
        Sense::Degenerate
    } else if area > 0.0 {
        Sense::Counterclockwise
    } else {
        Sense::Clockwise
    }
}

/// The smallest triangles that meshes made from a given one may have. What they allow, [`Mesh::new`] accepts.
#[derive(Debug, Clone, Copy)]
pub(in crate::mesh) struct Smallest {
    /// The shortest edge.
    pub(in crate::mesh) edge: f64,
}

impl Smallest {
    /// Those of refinements of `mesh`.
    pub(in crate::mesh) fn of(mesh: &Mesh) -> Self {
        let (lower, upper) = mesh.bounding_box();
        Self { edge: RESOLVED * resolution(lower, upper) }
    }

    /// Whether the corners are apart, and in counterclockwise order.
    pub(in crate::mesh) fn allows(self, corners: [[f64; 2]; 3]) -> bool {
        self.has_edges_apart(corners) && sense(corners) == Sense::Counterclockwise
    }

    /// Whether the corners are apart.
    pub(in crate::mesh) fn has_edges_apart(self, [a, b, c]: [[f64; 2]; 3]) -> bool {
        let shortest_sq = distance_sq(a, b).min(distance_sq(b, c)).min(distance_sq(c, a));
        shortest_sq >= self.edge * self.edge
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_triangles_follow_the_extent_and_the_coordinates() {
        let triangle = |x: f64, side: f64| [[x, x], [x + side, x], [x, x + side]];
        let smallest = |x: f64, side: f64| {
            Smallest::of(&Mesh::new(triangle(x, side).to_vec(), vec![[0, 1, 2]]).unwrap())
        };
        assert_eq!([smallest(0.0, 1.0).edge, smallest(0.0, 8.0).edge], [1e-10, 8e-10]);
        assert!((smallest(1e6, 1.0).edge / (100.0 * ROUNDING * 1e6) - 1.0).abs() < 1e-5);
        let unit = smallest(0.0, 1.0);
        assert!(unit.allows(triangle(0.0, 2e-10)) && !unit.allows(triangle(0.0, 0.9e-10)));
        let [a, b, c] = triangle(0.0, 1.0);
        assert!(!unit.allows([a, c, b]), "clockwise");
        assert!(unit.has_edges_apart([a, c, b]));
    }
}
