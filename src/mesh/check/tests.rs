use proptest::prelude::*;

use super::*;
use crate::geometry::twice_signed_area;
use crate::mesh::samples::{irregular, renumbered, square, square_without};
use crate::numeric::Random;

mod hanging;
mod overlap;

type Parts = (Vec<[f64; 2]>, Vec<[usize; 3]>);

/// Rounding of sums over the triangles of small meshes of size one.
const ROUNDING: f64 = 1e-12;

/// The unit square: two triangles, or four with its centre.
const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
const HALVES: [[usize; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

fn parts(points: &[[f64; 2]], triangles: &[[usize; 3]]) -> Parts {
    (points.to_vec(), triangles.to_vec())
}

fn mesh((points, triangles): Parts) -> Result<Mesh, MeshError> {
    Mesh::new(points, triangles)
}

/// Asserts that `broken` is refused with exactly this message and triangle, and that `fixed` is accepted.
#[track_caller]
fn assert_refused(broken: Parts, message: &str, triangle: Option<usize>, fixed: Parts) {
    let error = mesh(broken).expect_err(message);
    assert_eq!(error.to_string(), message);
    assert_eq!(error.triangle(), triangle);
    if let Err(error) = mesh(fixed) {
        panic!("the fixed mesh is refused: {error}");
    }
}

#[test]
fn clockwise_triangles_are_turned_and_others_are_left() {
    let mesh = mesh(parts(&CORNERS, &[[0, 2, 1], [0, 2, 3]])).unwrap();
    assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
    assert!((0..2).all(|t| mesh.triangle_area(t) == 0.5));
    assert!(twice_signed_area([0, 2, 1].map(|a| CORNERS[a])) < 0.0, "it was clockwise");
}

#[test]
fn unused_vertices_are_kept_and_count_for_nothing() {
    let mut points = CORNERS.to_vec();
    points.extend([[1e6, -1e6], [0.5, 0.5]]);
    let with_unused = Mesh::new(points, HALVES.to_vec()).unwrap();
    assert_eq!(with_unused.points().len(), 6);
    assert_eq!(with_unused.kind()[..4], [VertexKind::Boundary; 4]);
    assert_eq!(with_unused.kind()[4..], [VertexKind::Unused; 2]);
    assert_eq!(with_unused.bounding_box(), ([0.0, 0.0], [1.0, 1.0]));
    assert_eq!(with_unused.area(), 1.0);
    // In triangles, the same vertex counts.
    let fan = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
    let used = Mesh::new([&CORNERS[..], &[[0.5, 0.5]]].concat(), fan.to_vec()).unwrap();
    assert_eq!(used.kind()[4], VertexKind::Interior);
}

#[test]
fn no_triangles() {
    let message = "the mesh has no triangle: export the surface, not only its boundary";
    assert_refused(parts(&CORNERS, &[]), message, None, parts(&CORNERS, &HALVES));
    assert_refused(parts(&[], &[]), message, None, parts(&CORNERS, &HALVES));
}

#[test]
fn coordinates_out_of_range() {
    let fixed = || parts(&CORNERS, &HALVES);
    for (x, printed) in
        [(f64::NAN, "NaN"), (f64::INFINITY, "inf"), (f64::NEG_INFINITY, "-inf"), (-1e41, "-1e41")]
    {
        let mut points = CORNERS.to_vec();
        points[2] = [0.25, x];
        let message = format!(
            "vertex 2 has the coordinates (2.5e-1, {printed}): all must be finite and below 1e40; choose another unit of length"
        );
        assert_refused((points, HALVES.to_vec()), &message, None, fixed());
    }
    // Just below the limit, nothing overflows.
    let large = CORNERS.map(|point| point.map(|x| 0.99e40 * x));
    assert!(mesh(parts(&large, &HALVES)).unwrap().area().is_finite());
}

#[test]
fn unknown_vertices() {
    assert_refused(
        parts(&CORNERS, &[[0, 1, 2], [0, 2, 4]]),
        "triangle 1 names vertex 4, but there are only 4 vertices (counted from 0)",
        Some(1),
        parts(&CORNERS, &HALVES),
    );
}

#[test]
fn degenerate_triangles() {
    let message = |[a, b, c]: [usize; 3]| {
        format!(
            "triangle 1 (vertices {a}, {b}, {c}) is degenerate: its corners coincide or lie on one line; remove it and mesh again"
        )
    };
    let repeated = [0, 2, 2];
    assert_refused(
        parts(&CORNERS, &[[0, 1, 2], repeated]),
        &message(repeated),
        Some(1),
        parts(&CORNERS, &HALVES),
    );
    // On one line, and on one line but for rounding: 0.1 + 0.2 is not 0.3.
    for last in [[-2.0, -2.0], [-0.3, -(0.1 + 0.2)]] {
        let points = |last| [&CORNERS[..3], &[[-0.1, -0.1], last]].concat();
        assert_refused(
            parts(&points(last), &[[0, 1, 2], [0, 3, 4]]),
            &message([0, 3, 4]),
            Some(1),
            parts(&points([-0.3, -0.2]), &[[0, 1, 2], [0, 3, 4]]),
        );
    }
    // So small that areas underflow.
    let tiny = |size: f64| [&CORNERS[..3], &[[-size, 0.0], [0.0, -size]]].concat();
    assert_refused(
        parts(&tiny(1e-41), &[[0, 1, 2], [0, 3, 4]]),
        "triangle 1 is smaller than 1e-40: choose another unit of length",
        Some(1),
        parts(&tiny(1e-4), &[[0, 1, 2], [0, 3, 4]]),
    );
}

#[test]
fn slivers_are_accepted() {
    for degrees in [0.01f64, 1e-6] {
        let height = degrees.to_radians().tan();
        let mesh = mesh(parts(&[[0.0, 0.0], [1.0, 0.0], [1.0, height]], &[[0, 1, 2]])).unwrap();
        assert!((mesh.quality().min_angle / degrees - 1.0).abs() < ROUNDING);
    }
}

#[test]
fn repeated_triangles() {
    let message = "triangles 1 and 2 are the same (vertices 0, 2, 3): remove one";
    for again in [[0, 2, 3], [3, 2, 0], [2, 3, 0]] {
        let broken = parts(&CORNERS, &[HALVES[0], HALVES[1], again]);
        assert_refused(broken, message, Some(1), parts(&CORNERS, &HALVES));
    }
}

#[test]
fn coincident_vertices_of_pieces_that_are_not_glued() {
    // Two squares side by side, the common side given twice.
    let beside = |x: f64| CORNERS.map(|[u, v]| [x + u, v]);
    let apart = |x: f64| parts(&[CORNERS, beside(x)].concat(), &[[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]);
    let glued = [[0, 1, 2], [0, 2, 3], [1, 5, 6], [1, 6, 2]];
    let message = "the mesh is not conforming: vertices 1 and 4 (of triangle 2) coincide; merge them (in Gmsh: Coherence Mesh, or BooleanFragments before meshing)";
    for x in [1.0, 1.0 + 1e-14, 1.0 - 1e-14] {
        assert_refused(apart(x), message, Some(2), parts(&[CORNERS, beside(1.0)].concat(), &glued));
    }
    // Farther apart than rounding, they are two components.
    let components = mesh(apart(1.0 + 1e-9)).unwrap();
    assert!(components.kind().iter().all(|&kind| kind == VertexKind::Boundary));
}

#[test]
fn holes_and_holes_that_touch_are_accepted() {
    let interior = |mesh: &Mesh| mesh.kind().iter().filter(|&&kind| kind == VertexKind::Interior).count();
    let full = square(4);
    assert_eq!((full.area(), interior(&full)), (1.0, 9));
    let hole = square_without(4, |i, j| (i, j) == (1, 1));
    assert_eq!((hole.area(), interior(&hole)), (15.0 / 16.0, 5));
    let touching = square_without(4, |i, j| (i, j) == (1, 1) || (i, j) == (2, 2));
    assert_eq!((touching.area(), interior(&touching)), (14.0 / 16.0, 2));
    // Everything hangs together through vertices alone.
    let chessboard = square_without(4, |i, j| (i + j) % 2 == 0);
    assert_eq!((chessboard.area(), interior(&chessboard)), (0.5, 0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_order_of_vertices_triangles_and_corners_does_not_matter(cells in 1..9usize, seed: u64) {
        let mesh = irregular(cells);
        let (other, number) = renumbered(&mesh, seed);
        prop_assert!((other.area() - mesh.area()).abs() < ROUNDING);
        for (a, &b) in number.iter().enumerate() {
            prop_assert_eq!(other.kind()[b], mesh.kind()[a]);
        }
        let (expected, found) = (mesh.quality(), other.quality());
        prop_assert_eq!([found.h_min, found.h_max], [expected.h_min, expected.h_max]);
        prop_assert!((found.min_angle / expected.min_angle - 1.0).abs() < ROUNDING);
        prop_assert!((found.max_angle / expected.max_angle - 1.0).abs() < ROUNDING);
        prop_assert!((found.shape_regularity / expected.shape_regularity - 1.0).abs() < ROUNDING);
    }
}

#[test]
fn another_mesh_has_another_quality() {
    assert_ne!(irregular(5).quality(), irregular(6).quality());
    assert_ne!(renumbered(&irregular(5), 1).0.triangles(), irregular(5).triangles());
}
