use std::f64::consts::PI;

use super::*;
use crate::mesh::{MeshQuality, VertexKind};

/// Rounding of sums over the triangles of small meshes of size one.
const ROUNDING: f64 = 1e-12;

const PATTERNS: [Pattern; 2] = [Pattern::Right, Pattern::Crossed];

fn count(mesh: &Mesh, kind: VertexKind) -> usize {
    mesh.kind().iter().filter(|&&k| k == kind).count()
}

/// All triangles are halves or quarters of squares.
#[track_caller]
fn assert_right_isosceles(mesh: &Mesh) {
    let MeshQuality { min_angle, max_angle, .. } = mesh.quality();
    assert!((min_angle - 45.0).abs() < ROUNDING * 45.0 && (max_angle - 90.0).abs() < ROUNDING * 90.0);
}

#[test]
fn rectangles_have_their_counts_area_and_angles() {
    for (nx, ny) in [(1, 1), (4, 3), (2, 16)] {
        for pattern in PATTERNS {
            let upper = [1.0 + 0.5 * nx as f64, -2.0 + 0.5 * ny as f64];
            let mesh = rectangle([1.0, -2.0], upper, [nx, ny], pattern).unwrap();
            let (centres, per_cell) = if pattern == Pattern::Crossed { (nx * ny, 4) } else { (0, 2) };
            assert_eq!(mesh.points().len(), (nx + 1) * (ny + 1) + centres);
            assert_eq!(mesh.triangles().len(), per_cell * nx * ny);
            assert_eq!(count(&mesh, VertexKind::Boundary), 2 * (nx + ny));
            assert_eq!(count(&mesh, VertexKind::Unused), 0);
            assert_eq!(mesh.area(), 0.25 * (nx * ny) as f64);
            assert_eq!(mesh.bounding_box(), ([1.0, -2.0], upper));
            assert_right_isosceles(&mesh);
        }
    }
    let stretched = rectangle([0.0, 0.0], [2.0, 1.0], [4, 4], Pattern::Right).unwrap();
    assert!(stretched.quality().min_angle < 44.0, "cells that are not square have other angles");
}

#[test]
fn coordinates_are_exact_on_dyadic_grids_and_at_the_ends() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [8, 8], Pattern::Crossed).unwrap();
    let corners = (0..81).map(|k| [(k % 9) as f64 / 8.0, (k / 9) as f64 / 8.0]);
    let centres = (0..64).map(|k| [(2 * (k % 8) + 1) as f64 / 16.0, (2 * (k / 8) + 1) as f64 / 16.0]);
    assert_eq!(mesh.points(), corners.chain(centres).collect::<Vec<_>>());
    let decimal = rectangle([0.1, -0.3], [0.7, 0.9], [7, 7], Pattern::Right).unwrap();
    assert_eq!(decimal.bounding_box(), ([0.1, -0.3], [0.7, 0.9]));
    // All vertices of a grid line share the coordinate to the last bit.
    let points = decimal.points();
    assert!((0..64).all(|k| points[k][0] == points[k % 8][0] && points[k][1] == points[k / 8 * 8][1]));
    assert_ne!(points[1][0], points[2][0]);
}

#[test]
fn an_l_shape_is_three_quarters_of_a_square() {
    for (n, pattern) in [(1, Pattern::Right), (5, Pattern::Right), (4, Pattern::Crossed)] {
        let mesh = l_shape(1.5, n, pattern).unwrap();
        let (centres, per_cell) = if pattern == Pattern::Crossed { (3 * n * n, 4) } else { (0, 2) };
        assert_eq!(mesh.points().len(), (2 * n + 1) * (2 * n + 1) - n * n + centres);
        assert_eq!(mesh.triangles().len(), per_cell * 3 * n * n);
        assert_eq!(count(&mesh, VertexKind::Boundary), 8 * n);
        assert_eq!(count(&mesh, VertexKind::Unused), 0);
        assert!((mesh.area() - 3.0 * 1.5 * 1.5).abs() < ROUNDING);
        assert_right_isosceles(&mesh);
        let origin =
            mesh.points().iter().position(|&point| point == [0.0, 0.0]).expect("the re-entrant corner");
        assert_eq!(mesh.kind()[origin], VertexKind::Boundary);
        let removed = |[x, y]: [f64; 2]| x > 0.0 && y < 0.0;
        assert!(!mesh.points().iter().any(|&point| removed(point)));
        assert!(mesh.points().iter().any(|&[x, y]| removed([-x, y])), "the other quadrants are there");
    }
}

#[test]
fn a_disk_is_made_of_rings() {
    let (centre, radius) = ([1.0, -2.0], 0.5);
    for rings in [1, 2, 5, 16] {
        let mesh = disk(centre, radius, rings).unwrap();
        assert_eq!(mesh.points().len(), 1 + 3 * rings * (rings + 1));
        assert_eq!(mesh.triangles().len(), 6 * rings * rings);
        assert_eq!(count(&mesh, VertexKind::Boundary), 6 * rings);
        for (k, point) in mesh.points().iter().enumerate() {
            // Ring r begins at vertex 1 + 3 r (r - 1).
            let ring = (0..=rings).rfind(|&r| k > 0 && k > 3 * r * r.saturating_sub(1)).unwrap_or(0);
            let distance = (point[0] - centre[0]).hypot(point[1] - centre[1]);
            assert!((distance - radius * ring as f64 / rings as f64).abs() < ROUNDING, "vertex {k}");
            assert_eq!(mesh.kind()[k] == VertexKind::Boundary, ring == rings);
        }
        let polygon = 3.0 * rings as f64 * radius * radius * (PI / (3 * rings) as f64).sin();
        assert!((mesh.area() - polygon).abs() < ROUNDING);
        assert!(mesh.quality().min_angle > 35.0, "{rings} rings: {:?}", mesh.quality());
    }
}

/// The area of the inscribed polygon misses the disk's by `pi^3 / 54 n^2` to leading order.
#[test]
fn the_area_of_a_disk_tends_to_pi_at_second_order() {
    let missing = |rings: usize| PI - disk([0.0, 0.0], 1.0, rings).unwrap().area();
    for rings in [8, 16, 32] {
        let expected = PI.powi(3) / (54 * rings * rings) as f64;
        assert!((missing(rings) / expected - 1.0).abs() < 0.01, "{rings} rings");
        assert!(missing(rings) > 1e9 * ROUNDING * expected, "it is no rounding");
    }
}

#[test]
fn grids_that_rounding_destroys_are_refused() {
    let cells = [64, 64];
    assert!(rectangle([1e17, 0.0], [1e17 + 64.0, 64.0], cells, Pattern::Right).is_err());
    assert!(rectangle([1e7, 0.0], [1e7 + 64.0, 64.0], cells, Pattern::Right).is_ok());
    assert!(l_shape(1e-300, 4, Pattern::Right).is_err() && l_shape(1e-30, 4, Pattern::Right).is_ok());
    assert!(disk([0.0, 1e17], 1.0, 4).is_err() && disk([0.0, 1e7], 1.0, 4).is_ok());
    assert!(disk([0.0, 0.0], 1e-300, 4).is_err() && disk([0.0, 0.0], f64::INFINITY, 4).is_err());
}

#[test]
#[should_panic(expected = "an empty grid")]
fn a_rectangle_without_height_is_a_mistake_of_the_caller() {
    let _ = rectangle([0.0, 1.0], [1.0, 1.0], [2, 2], Pattern::Right);
}

#[test]
#[should_panic(expected = "an empty disk")]
fn a_disk_without_rings_is_a_mistake_of_the_caller() {
    let _ = disk([0.0, 0.0], 1.0, 0);
}
