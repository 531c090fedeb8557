//! Triangles that overlap: at an edge, at a vertex, anywhere.

use std::f64::consts::{PI, TAU};

use super::*;

/// The vertices of a regular polygon.
fn ring(centre: [f64; 2], radius: f64, corners: usize) -> Vec<[f64; 2]> {
    (0..corners)
        .map(|k| TAU * k as f64 / corners as f64)
        .map(|angle| [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()])
        .collect()
}

#[test]
fn a_fold_and_a_third_triangle_at_an_edge() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.5, 1.0], [0.6, 0.8], [0.5, -1.0]];
    let message = "triangles 0 and 1 overlap at their common edge (vertices 0, 1): an edge has one triangle on each side";
    let fixed = || parts(&points, &[[0, 1, 2], [0, 1, 4]]);
    assert_refused(parts(&points, &[[0, 1, 2], [0, 1, 3]]), message, Some(0), fixed());
    assert_refused(parts(&points, &[[0, 1, 2], [1, 0, 3], [4, 1, 0]]), message, Some(0), fixed());
    let message = message.replace("1 overlap", "2 overlap");
    assert_refused(parts(&points, &[[0, 1, 2], [4, 0, 1], [1, 0, 3]]), &message, Some(0), fixed());
}

/// Every edge has a triangle on each side, or lies on the boundary, but the fan goes twice round its centre.
#[test]
fn a_fan_that_winds_twice_round_its_centre() {
    for corners in [5, 7, 9] {
        let points = [ring([0.0, 0.0], 1.0, corners), vec![[0.0, 0.0]]].concat();
        let fan = |step: usize| -> Parts {
            (
                points.clone(),
                (0..corners).map(|k| [k * step % corners, (k + 1) * step % corners, corners]).collect(),
            )
        };
        let error = mesh(fan(2)).expect_err("twice round");
        assert!(matches!(error, MeshError::OverlapAtVertex { vertex, .. } if vertex == corners), "{error}");
        assert_eq!(mesh(fan(1)).unwrap().kind()[corners], VertexKind::Interior);
    }
}

/// Also when the boundary is spread out so that no edges cross near the centre: a spiral of two turns, closed.
#[test]
fn a_spiral_staircase() {
    let turns = |turns: usize| -> Parts {
        let steps = 6 * turns;
        let corner = |k: usize| {
            let angle = TAU * turns as f64 * k as f64 / steps as f64;
            let radius = 1.0 + 0.1 * k as f64;
            [radius * angle.cos(), radius * angle.sin()]
        };
        let points = std::iter::once([0.0, 0.0]).chain((0..steps).map(corner)).collect();
        (points, (0..steps).map(|k| [0, 1 + k, 1 + (k + 1) % steps]).collect())
    };
    assert!(mesh(turns(1)).is_ok());
    let error = mesh(turns(2)).expect_err("two turns");
    assert!(matches!(error, MeshError::OverlapAtVertex { vertex: 0, .. }), "{error}");
}

#[test]
fn fans_over_each_other_at_one_vertex() {
    // A full turn round vertex 0, and a further triangle inside of it.
    let outer = [vec![[0.0, 0.0]], ring([0.0, 0.0], 4.0, 6)].concat();
    let points = |at: f64| [&outer[..], &ring([at, 0.2], 1.0, 3)[..2]].concat();
    let mut triangles: Vec<[usize; 3]> = (0..6).map(|k| [0, 1 + k, 1 + (k + 1) % 6]).collect();
    triangles.push([0, 7, 8]);
    let error = mesh((points(0.0), triangles.clone())).expect_err("a further triangle");
    assert!(matches!(error, MeshError::OverlapAtVertex { vertex: 0, triangle: 6 }), "{error}");
    // With its vertex elsewhere, far outside, it is welcome.
    let mut moved = points(20.0);
    moved.push([20.0, -1.0]);
    triangles[6] = [9, 7, 8];
    assert!(mesh((moved, triangles)).is_ok());

    // Two triangles at vertex 0 whose angles overlap, although they do not make a full turn.
    let at = |degrees: f64, radius: f64| {
        [radius * degrees.to_radians().cos(), radius * degrees.to_radians().sin()]
    };
    let pair = |begin: f64, end: f64| {
        let points = [[0.0, 0.0], at(0.0, 1.0), at(60.0, 1.0), at(begin, 2.0), at(end, 2.0)];
        mesh(parts(&points, &[[0, 1, 2], [0, 3, 4]]))
    };
    for (begin, end) in [(20.0, 40.0), (-20.0, 80.0), (30.0, 90.0), (-30.0, 30.0)] {
        let error = pair(begin, end).expect_err("overlap");
        assert!(matches!(error, MeshError::OverlapAtVertex { vertex: 0, .. }), "{error}");
    }
    assert!(pair(70.0, 130.0).is_ok() && pair(-90.0, -10.0).is_ok() && pair(170.0, 190.0).is_ok());
    let message = "the triangles around vertex 0 overlap (triangle 1 among them): they must not cover more than one full turn, each direction once";
    assert_eq!(pair(20.0, 40.0).unwrap_err().to_string(), message);
}

#[test]
fn pieces_across_or_inside_one_another() {
    let big = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]];
    let with = |small: [[f64; 2]; 3]| parts(&[big, small].concat(), &[[3, 4, 5], [0, 1, 2]]);
    let outside = || with([[5.0, 0.0], [6.0, 0.0], [6.0, 1.0]]);
    assert_refused(
        with([[1.0, -1.0], [2.0, -1.0], [1.5, 1.0]]),
        "triangles 0 and 1 overlap: edges of theirs on the boundary cross; cut the surfaces at each other before meshing (in Gmsh: BooleanFragments)",
        Some(0),
        outside(),
    );
    assert_refused(
        with([[1.0, 1.0], [1.5, 1.0], [1.0, 1.5]]),
        "triangle 0 lies in another piece of the mesh, that of triangle 1: remove one of the two surfaces, or cut them at each other before meshing (in Gmsh: BooleanFragments)",
        Some(0),
        outside(),
    );
}

/// A piece in a hole of another is no overlap, a piece in the material is, also from both sides of many holes.
#[test]
fn pieces_in_holes() {
    let plate = square_without(8, |i, j| i % 2 == 1 && j % 2 == 1);
    let with_island = |x: f64, y: f64| {
        let first = plate.points().len();
        let points = [plate.points(), &[[x, y], [x + 0.01, y], [x, y + 0.01]]].concat();
        mesh((points, [plate.triangles(), &[[first, first + 1, first + 2]]].concat()))
    };
    for k in 0..8 {
        let centre = (k as f64 + 0.5) / 8.0;
        assert_eq!(with_island(centre, 0.17).is_ok(), k % 2 == 1, "column {k}");
        let error = with_island(centre, 0.05).expect_err("material");
        assert!(matches!(error, MeshError::Nested { .. }), "{error}");
    }
}

/// Whether two triangles have no inner point in common: an edge of one separates them.
fn disjoint(first: [[f64; 2]; 3], second: [[f64; 2]; 3]) -> bool {
    let separated_by_edge_of = |t: [[f64; 2]; 3], s: [[f64; 2]; 3]| {
        let orientation = twice_signed_area(t);
        (0..3).any(|i| s.iter().all(|&p| twice_signed_area([t[i], t[(i + 1) % 3], p]) * orientation <= 0.0))
    };
    separated_by_edge_of(first, second) || separated_by_edge_of(second, first)
}

/// Any triangles at all: the check refuses exactly what comparing all pairs refuses.
#[test]
fn the_verdict_is_that_of_all_pairs() {
    let mut verdicts = [0, 0];
    for seed in 0..20_000 {
        let mut random = Random::new(seed);
        let points: Vec<[f64; 2]> =
            (0..7).map(|_| [random.between(-1.0, 1.0), random.between(-1.0, 1.0)]).collect();
        let triangles: Vec<[usize; 3]> = (0..2 + random.below(3))
            .map(|_| random.permutation(7))
            .map(|order| [order[0], order[1], order[2]])
            .collect();
        let corners: Vec<_> = triangles.iter().map(|corners| corners.map(|a| points[a])).collect();
        let expected = (0..corners.len()).all(|t| (0..t).all(|s| disjoint(corners[s], corners[t])));
        let found = mesh((points, triangles));
        assert_eq!(found.is_ok(), expected, "seed {seed}: {:?}", found.err());
        verdicts[usize::from(expected)] += 1;
    }
    assert!(verdicts.into_iter().all(|count| count > 1000), "both verdicts occur: {verdicts:?}");
}

/// The same for meshes of several triangles: two rings, closed or with a gap, placed at random.
#[test]
fn the_verdict_on_two_rings_is_that_of_all_pairs() {
    let mut verdicts = [0, 0];
    for seed in 0..2000 {
        let mut random = Random::new(seed);
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for _ in 0..2 {
            let centre = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
            let size = random.between(0.1, 1.0);
            let (inner, outer) = (size * random.between(0.5, 0.8), size);
            let (turn, first) = (random.between(0.0, 1.0), points.len());
            for k in 0..6 {
                let angle = turn + PI * k as f64 / 3.0;
                for radius in [inner, outer] {
                    points.push([centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()]);
                }
            }
            for k in 0..6 - random.below(2) {
                let at = |i: usize| first + (2 * k + i) % 12;
                triangles.extend([[at(0), at(1), at(3)], [at(0), at(3), at(2)]]);
            }
        }
        let corners: Vec<_> =
            triangles.iter().map(|corners: &[usize; 3]| corners.map(|a| points[a])).collect();
        let expected = (0..corners.len()).all(|t| (0..t).all(|s| disjoint(corners[s], corners[t])));
        let found = mesh((points, triangles));
        assert_eq!(found.is_ok(), expected, "seed {seed}: {:?}", found.err());
        verdicts[usize::from(expected)] += 1;
    }
    assert!(verdicts.into_iter().all(|count| count > 100), "both verdicts occur: {verdicts:?}");
}
