use std::f64::consts::PI;

use super::*;

/// Rounding of sums over the triangles of small meshes of size one.
const ROUNDING: f64 = 1e-12;

const CELLS: MeshSize = MeshSize::Cells { cells: 4, pattern: Pattern::Right };
const EDGES: MeshSize = MeshSize::EdgeLength { size: 0.2, min_angle: 25.0 };

fn rectangle_to(x: f64, y: f64) -> Domain {
    Domain::Rectangle { lower: [0.0, 0.0], upper: [x, y] }
}

fn disk_of(centre: [f64; 2], radius: f64) -> Domain {
    Domain::Disk { centre, radius }
}

fn polygon_of(vertices: &[[f64; 2]]) -> Domain {
    Domain::Polygon { vertices: vertices.to_vec(), holes: vec![] }
}

fn cells(cells: usize) -> MeshSize {
    MeshSize::Cells { cells, pattern: Pattern::Right }
}

fn edges(size: f64) -> MeshSize {
    MeshSize::EdgeLength { size, min_angle: 25.0 }
}

#[test]
fn each_mistake_has_its_message_and_its_fixed_counterpart() {
    let square = Domain::unit_square;
    let table = [
        (square(), cells(0), "cells is 0: give at least 1", square(), CELLS),
        (
            polygon_of(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
            CELLS,
            "a polygon has no structured mesh: give `size`, the target edge length, in place of `cells`",
            polygon_of(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
            EDGES,
        ),
        (
            rectangle_to(0.0, 1.0),
            CELLS,
            "the domain has width 0: it must be positive and finite",
            square(),
            CELLS,
        ),
        (
            rectangle_to(1.0, -2.0),
            EDGES,
            "the domain has height -2: it must be positive and finite",
            square(),
            EDGES,
        ),
        (rectangle_to(f64::NAN, 1.0), EDGES, "width NaN", square(), EDGES),
        (rectangle_to(1.0, f64::INFINITY), CELLS, "height inf", square(), CELLS),
        (
            Domain::LShape { half_width: -1.0 },
            CELLS,
            "the domain has half width -1: it must be positive and finite",
            Domain::LShape { half_width: 1.0 },
            CELLS,
        ),
        (disk_of([0.0, 0.0], 0.0), EDGES, "radius 0", disk_of([0.0, 0.0], 1.0), EDGES),
        (
            disk_of([f64::NAN, 0.0], 1.0),
            CELLS,
            "the domain has a coordinate that is not finite",
            disk_of([0.0, 0.0], 1.0),
            CELLS,
        ),
        (
            square(),
            edges(0.0),
            "size is 0: the target edge length must be positive and finite",
            square(),
            EDGES,
        ),
        (square(), edges(f64::NAN), "size is NaN", square(), EDGES),
        (
            disk_of([0.0, 0.0], 1.0),
            edges(f64::INFINITY),
            "size is inf",
            disk_of([0.0, 0.0], 1.0),
            edges(10.0),
        ),
        (
            square(),
            MeshSize::EdgeLength { size: 0.2, min_angle: 30.5 },
            "min_angle is 30.5: give degrees between 0 and 30",
            square(),
            MeshSize::EdgeLength { size: 0.2, min_angle: 30.0 },
        ),
        (
            disk_of([0.0, 0.0], 1e-300),
            CELLS,
            "scale the domain to a moderate size",
            disk_of([0.0, 0.0], 1e-30),
            CELLS,
        ),
        (disk_of([1e20, 0.0], 1.0), CELLS, "move it nearer to the origin", disk_of([1e5, 0.0], 1.0), CELLS),
    ];
    for (domain, size, message, fixed, fixed_size) in table {
        let found = generate(&domain, size).expect_err(message).to_string();
        assert!(found.contains(message) && !found.contains('\n'), "{found}");
        assert!(generate(&fixed, fixed_size).is_ok(), "fixed: {message}");
    }
}

/// Before any memory is taken.
#[test]
fn meshes_that_are_too_large_are_refused() {
    let long = rectangle_to(1e9, 1.0);
    let domains = [Domain::unit_square(), Domain::LShape { half_width: 1.0 }, disk_of([0.0, 0.0], 1.0)];
    let everywhere = domains.iter().flat_map(|domain| {
        [cells(usize::MAX), cells(10_000), edges(1e-5), edges(1e-300)].map(|size| (domain, size))
    });
    for (domain, size) in everywhere.chain([(&long, CELLS), (&long, edges(0.1))]) {
        let error = generate(domain, size).expect_err("too large");
        assert!(matches!(error, GenerateError::TooLarge { .. }), "{domain:?}, {size:?}: {error}");
    }
    let message = generate(&long, cells(1)).unwrap_err().to_string();
    assert_eq!(message, "the mesh would have about 2.0e9 vertices, more than 5e7: make it coarser");
    assert!(generate(&rectangle_to(1e4, 1.0), cells(1)).is_ok());
}

#[test]
fn cells_are_counted_along_the_shorter_side_and_stay_square() {
    for domain in [rectangle_to(3.0, 1.0), rectangle_to(1.0, 3.0), rectangle_to(0.3, 0.1)] {
        let mesh = generate(&domain, CELLS).unwrap();
        assert_eq!(mesh.triangles().len(), 2 * 4 * 12);
        assert!((mesh.quality().min_angle - 45.0).abs() < 45.0 * ROUNDING);
    }
    let crossed = MeshSize::Cells { cells: 4, pattern: Pattern::Crossed };
    assert_eq!(generate(&rectangle_to(3.0, 1.0), crossed).unwrap().triangles().len(), 4 * 4 * 12);
    let l_shape = generate(&Domain::LShape { half_width: 2.0 }, CELLS).unwrap();
    assert!((l_shape.triangles().len(), l_shape.area()) == (2 * 3 * 16, 12.0));
    assert_eq!(generate(&disk_of([0.0, 0.0], 1.0), CELLS).unwrap().triangles().len(), 6 * 16);
}

#[test]
fn unstructured_meshes_fill_their_domains() {
    let triangle = polygon_of(&[[0.0, 0.0], [0.0, 3.0], [4.0, 0.0]]);
    let inscribed = |edges: usize| 0.5 * edges as f64 * (2.0 * PI / edges as f64).sin();
    let areas = [
        (Domain::Rectangle { lower: [-1.0, 2.0], upper: [1.0, 3.0] }, 2.0),
        (Domain::LShape { half_width: 1.0 }, 3.0),
        (triangle, 6.0),
        // The circumference in edges of 0.2.
        (disk_of([5.0, 5.0], 1.0), inscribed(32)),
    ];
    for (domain, area) in areas {
        let mesh = generate(&domain, EDGES).unwrap();
        assert!((mesh.area() / area - 1.0).abs() < ROUNDING, "{domain:?}: {}", mesh.area());
        let quality = mesh.quality();
        assert!(quality.min_angle >= 25.0 && quality.h_max < 0.4, "{domain:?}: {quality:?}");
        let finer = generate(&domain, edges(0.1)).unwrap();
        assert!(finer.triangles().len() > 3 * mesh.triangles().len());
    }
}

#[test]
fn the_same_domain_gives_the_same_mesh() {
    let mesh = |size: f64| generate(&disk_of([0.0, 0.0], 1.0), edges(size)).unwrap();
    assert!(mesh(0.1).points() == mesh(0.1).points() && mesh(0.1).triangles() == mesh(0.1).triangles());
    assert!(mesh(0.1).points() != mesh(0.11).points());
}
