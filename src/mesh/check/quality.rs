//! Shape regularity of a mesh.

use std::ops::Range;

use crate::geometry::{distance_sq, twice_signed_area};
use crate::mesh::Mesh;
use crate::parallel::blocks;
use crate::parallel::prelude::*;

/// How well the triangles are shaped: the constants of the estimates depend on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshQuality {
    /// The smallest angle of all triangles, degrees.
    pub min_angle: f64,
    /// The largest angle of all triangles, degrees. Above 90, the stiffness matrix need not be an M-matrix.
    pub max_angle: f64,
    /// The length of the shortest edge.
    pub h_min: f64,
    /// The length of the longest edge, `h`.
    pub h_max: f64,
    /// The largest ratio `h_K / rho_K` of the longest edge to the diameter of the inscribed circle; equilateral: 1.73.
    pub shape_regularity: f64,
}

impl Mesh {
    /// Measures all triangles. Linear time, in parallel.
    pub fn quality(&self) -> MeshQuality {
        let of_block = |block: Range<usize>| {
            block.fold(Extremes::default(), |extremes, t| extremes.with(self.corners(t)))
        };
        let blocks: Vec<Extremes> = blocks(self.triangles().len()).into_par_iter().map(of_block).collect();
        blocks.into_iter().fold(Extremes::default(), Extremes::and).quality()
    }
}

/// What some triangles have at most and at least.
#[derive(Clone, Copy)]
struct Extremes {
    /// Sine and cosine, up to a common factor, of the smallest and the largest angle.
    smallest: [f64; 2],
    largest: [f64; 2],
    shortest_sq: f64,
    longest_sq: f64,
    shape_regularity: f64,
}

impl Default for Extremes {
    fn default() -> Self {
        Self {
            smallest: [0.0, -1.0],
            largest: [0.0, 1.0],
            shortest_sq: f64::INFINITY,
            longest_sq: 0.0,
            shape_regularity: 0.0,
        }
    }
}

/// Whether an angle is smaller than another, both from zero to half a turn, by their sines and cosines up to positive factors.
fn is_smaller([sin, cos]: [f64; 2], [other_sin, other_cos]: [f64; 2]) -> bool {
    // The sine of the difference.
    sin * other_cos < cos * other_sin
}

impl Extremes {
    fn with(self, corners: [[f64; 2]; 3]) -> Self {
        let twice_area = twice_signed_area(corners);
        let lengths_sq = [1, 2, 0].map(|i| distance_sq(corners[i], corners[(i + 1) % 3]));
        let lengths = lengths_sq.map(f64::sqrt);
        let longest = lengths.into_iter().fold(0.0, f64::max);
        let perimeter: f64 = lengths.iter().sum();
        let angles = corner_products(corners).map(|product| [twice_area, product]);
        angles.into_iter().zip(lengths_sq).fold(
            // The inscribed circle has the diameter rho = 4 area / perimeter.
            Self {
                shape_regularity: self.shape_regularity.max(longest * perimeter / (2.0 * twice_area)),
                ..self
            },
            |extremes, (angle, length_sq)| Self {
                smallest: if is_smaller(angle, extremes.smallest) { angle } else { extremes.smallest },
                largest: if is_smaller(extremes.largest, angle) { angle } else { extremes.largest },
                shortest_sq: extremes.shortest_sq.min(length_sq),
                longest_sq: extremes.longest_sq.max(length_sq),
                ..extremes
            },
        )
    }

    fn and(self, other: Self) -> Self {
        Self {
            smallest: if is_smaller(other.smallest, self.smallest) { other.smallest } else { self.smallest },
            largest: if is_smaller(self.largest, other.largest) { other.largest } else { self.largest },
            shortest_sq: self.shortest_sq.min(other.shortest_sq),
            longest_sq: self.longest_sq.max(other.longest_sq),
            shape_regularity: self.shape_regularity.max(other.shape_regularity),
        }
    }

    fn quality(self) -> MeshQuality {
        let [min_angle, max_angle] =
            [self.smallest, self.largest].map(|[sin, cos]| sin.atan2(cos).to_degrees());
        let [h_min, h_max] = [self.shortest_sq, self.longest_sq].map(f64::sqrt);
        MeshQuality { min_angle, max_angle, h_min, h_max, shape_regularity: self.shape_regularity }
    }
}

/// The angles at the corners of a triangle, radians.
pub(in crate::mesh) fn angles(corners: [[f64; 2]; 3]) -> [f64; 3] {
    let twice_area = twice_signed_area(corners);
    corner_products(corners).map(|product| twice_area.atan2(product))
}

/// The scalar products of the two edges from each corner.
fn corner_products(corners: [[f64; 2]; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let [p, q, r] = [corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3]];
        (q[0] - p[0]) * (r[0] - p[0]) + (q[1] - p[1]) * (r[1] - p[1])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of a few operations on numbers of order one, relative.
    const ROUNDING: f64 = 1e-14;

    fn quality_of(triangles: &[[[f64; 2]; 3]]) -> MeshQuality {
        let corners = (0..triangles.len()).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        Mesh::new(triangles.concat(), corners).unwrap().quality()
    }

    #[track_caller]
    fn assert_close(found: MeshQuality, expected: [f64; 5]) {
        let MeshQuality { min_angle, max_angle, h_min, h_max, shape_regularity } = found;
        for (found, expected) in
            [min_angle, max_angle, h_min, h_max, shape_regularity].into_iter().zip(expected)
        {
            assert!((found / expected - 1.0).abs() < ROUNDING, "{found} is not {expected}");
        }
    }

    #[test]
    fn known_triangles() {
        let equilateral = [[0.0, 0.0], [2.0, 0.0], [1.0, 3f64.sqrt()]];
        let right = [[10.0, 0.0], [11.0, 0.0], [10.0, 1.0]];
        let (root_2, root_3) = (2f64.sqrt(), 3f64.sqrt());
        assert_close(quality_of(&[equilateral]), [60.0, 60.0, 2.0, 2.0, root_3]);
        // h / rho with rho = 2 |T| / (half of the perimeter) = 2 / (2 + sqrt 2)
        assert_close(quality_of(&[right]), [45.0, 90.0, 1.0, root_2, 1.0 + root_2]);
        // Of several triangles the worst of each counts.
        assert_close(quality_of(&[equilateral, right]), [45.0, 90.0, 1.0, 2.0, 1.0 + root_2]);
        assert!(quality_of(&[right]) != quality_of(&[equilateral]));
    }

    /// The obtuse triangle with the sides 3, 5, 7 has the angle 120 degrees and the area 15 sqrt(3) / 4.
    #[test]
    fn an_obtuse_triangle() {
        let obtuse = [[0.0, 0.0], [5.0, 0.0], [-1.5, 1.5 * 3f64.sqrt()]];
        let smallest = (13f64 / 14.0).acos().to_degrees();
        assert_close(quality_of(&[obtuse]), [smallest, 120.0, 3.0, 7.0, 7.0 * 15.0 / (15.0 * 3f64.sqrt())]);
    }
}
