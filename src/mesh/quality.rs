//! Shape regularity of a mesh.

use super::{Mesh, distance_sq, twice_signed_area};

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
    /// Measures all triangles. Linear time.
    pub fn quality(&self) -> MeshQuality {
        let mut quality = MeshQuality {
            min_angle: 180.0,
            max_angle: 0.0,
            h_min: f64::INFINITY,
            h_max: 0.0,
            shape_regularity: 0.0,
        };
        for t in 0..self.triangles().len() {
            let corners = self.corners(t);
            let twice_area = twice_signed_area(corners);
            // lengths[i] is opposite to corner i
            let lengths = [1, 2, 0].map(|i| distance_sq(corners[i], corners[(i + 1) % 3]).sqrt());
            let perimeter: f64 = lengths.iter().sum();
            let longest = lengths.into_iter().fold(0.0, f64::max);
            for i in 0..3 {
                let [p, q, r] = [corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3]];
                let dot = (q[0] - p[0]) * (r[0] - p[0]) + (q[1] - p[1]) * (r[1] - p[1]);
                let angle = twice_area.atan2(dot).to_degrees();
                quality.min_angle = quality.min_angle.min(angle);
                quality.max_angle = quality.max_angle.max(angle);
                quality.h_min = quality.h_min.min(lengths[i]);
            }
            quality.h_max = quality.h_max.max(longest);
            // The inscribed circle has the diameter rho = 4 area / perimeter.
            quality.shape_regularity = quality.shape_regularity.max(longest * perimeter / (2.0 * twice_area));
        }
        quality
    }
}
