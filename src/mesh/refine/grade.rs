//! Meshes graded towards a point (Remark 10).

use crate::mesh::check::Smallest;
use crate::mesh::{Mesh, MeshError};

/// The area may change by rounding only; a boundary that the map does not keep changes it more.
const AREA_TOLERANCE: f64 = 1e-10;

impl Mesh {
    /// Moves the vertices towards `point`, so that elements at distance `r` have a size of about `h r^(1 - 1/exponent)`
    /// and the smallest one of about `h^exponent`: `x -> p + (x - p) (|x - p| / R)^(exponent - 1)` in the maximum norm,
    /// where `R` is the largest distance.
    ///
    /// For the centre of a square and the re-entrant corner of an L-shape: the map keeps squares around the point, and
    /// lines through it.
    ///
    /// # Errors
    /// [`MeshError::NotGraded`] when the exponent is below 1 or not finite, or when the map does not keep the domain;
    /// [`MeshError::TooSmall`] when triangles become too small to be told apart.
    pub fn graded(&self, point: [f64; 2], exponent: f64) -> Result<Self, MeshError> {
        if !(exponent >= 1.0 && exponent.is_finite()) {
            return Err(MeshError::NotGraded { exponent });
        }
        let distance = |x: [f64; 2]| (x[0] - point[0]).abs().max((x[1] - point[1]).abs());
        let used = self.triangles.iter().flatten().map(|&a| self.points[a]);
        let farthest = used.map(distance).fold(0.0, f64::max);
        let move_closer = |&x: &[f64; 2]| {
            let factor = (distance(x) / farthest).powf(exponent - 1.0);
            [0, 1].map(|axis| point[axis] + factor * (x[axis] - point[axis]))
        };
        let points: Vec<[f64; 2]> = self.points.iter().map(move_closer).collect();
        let smallest = Smallest::of(self);
        let is_too_small = |corners: &[usize; 3]| !smallest.has_edges_apart(corners.map(|a| points[a]));
        if let Some(triangle) = self.triangles.iter().position(is_too_small) {
            return Err(self.too_small(triangle));
        }
        let graded = Self::new(points, self.triangles.clone())?;
        let same_area = (graded.area() - self.area()).abs() <= AREA_TOLERANCE * self.area();
        if same_area && graded.triangles == self.triangles {
            Ok(graded
                .with_ancestry(self.ancestry.clone())
                .with_groups(self.groups.clone())
                .with_views(self.views.clone()))
        } else {
            Err(MeshError::NotGraded { exponent })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Pattern, disk, l_shape, rectangle};

    #[test]
    fn the_smallest_element_is_the_power_of_the_mesh_size() {
        let n = 16;
        let corner = l_shape(1.0, n, Pattern::Right).unwrap();
        for exponent in [1.0, 2.0, 3.0] {
            let graded = corner.graded([0.0, 0.0], exponent).unwrap();
            let expected = (n as f64).powf(-exponent);
            assert!((graded.quality().h_min / expected - 1.0).abs() < 1e-9);
            assert_eq!(graded.kind(), corner.kind());
        }
        let square = rectangle([0.0, 0.0], [1.0, 1.0], [8, 8], Pattern::Crossed).unwrap();
        let graded = square.graded([0.5, 0.5], 2.0).unwrap();
        assert!(graded.quality().h_max < 2.0 * square.quality().h_max);
        assert!(graded.quality().min_angle > 10.0, "{:?}", graded.quality());
    }

    #[test]
    fn a_grading_beyond_the_digits_is_refused() {
        let square = rectangle([0.0, 0.0], [1.0, 1.0], [8, 8], Pattern::Right).unwrap();
        // 0.5 * 4^-exponent
        assert!(square.graded([0.5, 0.5], 16.0).is_ok());
        assert!(matches!(square.graded([0.5, 0.5], 18.0), Err(MeshError::TooSmall { .. })));
        assert!(matches!(square.graded([0.5, 0.5], 1e3), Err(MeshError::TooSmall { .. })));
    }

    #[test]
    fn what_cannot_be_graded_is_refused() {
        let square = rectangle([0.0, 0.0], [1.0, 1.0], [8, 8], Pattern::Right).unwrap();
        let refused = |mesh: &Mesh, point, exponent| {
            matches!(mesh.graded(point, exponent), Err(MeshError::NotGraded { .. }))
        };
        for exponent in [0.5, -1.0, f64::NAN, f64::INFINITY] {
            assert!(refused(&square, [0.5, 0.5], exponent));
        }
        assert!(refused(&square, [0.3, 0.5], 2.0), "the square is no square around this point");
        assert!(refused(&disk([0.0, 0.0], 1.0, 4).unwrap(), [0.0, 0.0], 2.0), "nor is the disk");
        assert!(!refused(&square, [0.5, 0.5], 2.0));
    }
}
