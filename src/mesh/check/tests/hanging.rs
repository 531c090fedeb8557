//! Vertices inside edges: every place, every order.

use super::*;

/// Ends and points of the edge from `(0, 0)` to `(4, 0)`, with a vertex below (2) and one above (3); then the vertices on
/// the edge, from left to right.
fn edge(on_edge: &[[f64; 2]]) -> Vec<[f64; 2]> {
    [&[[0.0, 0.0], [4.0, 0.0], [2.0, -2.0], [2.0, 3.0]], on_edge].concat()
}

/// The side of the edge with this apex, divided at these vertices of the edge.
fn side(apex: usize, division: &[usize]) -> Vec<[usize; 3]> {
    let along: Vec<usize> = [&[0], division, &[1]].concat();
    along.windows(2).map(|ends| [ends[0], ends[1], apex]).collect()
}

/// The numbers of the hanging vertex and of the triangle in which it hangs, `None` if the mesh is accepted.
fn hanging(points: &[[f64; 2]], below: &[usize], above: &[usize]) -> Option<(usize, usize)> {
    match mesh((points.to_vec(), [side(2, below), side(3, above)].concat())) {
        Ok(_) => None,
        Err(MeshError::HangingVertex { vertex, triangle, .. }) => Some((vertex, triangle)),
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn the_message_names_vertex_edge_and_triangle() {
    assert_refused(
        (edge(&[[1.0, 0.0]]), [side(2, &[]), side(3, &[4])].concat()),
        "the mesh is not conforming: vertex 4 lies inside the edge (1, 0) of triangle 0; split that triangle there",
        Some(0),
        (edge(&[[1.0, 0.0]]), [side(2, &[4]), side(3, &[4])].concat()),
    );
}

#[test]
fn one_vertex_anywhere_on_the_edge_on_either_side() {
    for x in [1e-6, 0.1, 1.0, 2.0, 3.0, 3.9, 4.0 - 1e-6] {
        let points = edge(&[[x, 0.0]]);
        assert_eq!(hanging(&points, &[], &[4]), Some((4, 0)), "above, at {x}");
        assert_eq!(hanging(&points, &[4], &[]), Some((4, 2)), "below, at {x}");
        assert_eq!(hanging(&points, &[4], &[4]), None);
    }
}

#[test]
fn several_vertices_on_one_edge_on_both_sides() {
    let points = edge(&[[1.0, 0.0], [2.5, 0.0]]);
    assert_eq!(hanging(&points, &[], &[4, 5]).map(|(_, triangle)| triangle), Some(0));
    assert_eq!(hanging(&points, &[4, 5], &[]).map(|(_, triangle)| triangle), Some(3));
    // Each side divided at a vertex of its own.
    assert!(hanging(&points, &[4], &[5]).is_some());
    assert!(hanging(&points, &[5], &[4]).is_some());
    // One of two glued.
    assert!(hanging(&points, &[4], &[4, 5]).is_some());
    assert!(hanging(&points, &[5], &[4, 5]).is_some());
    assert_eq!(hanging(&points, &[4, 5], &[4, 5]), None);
}

/// Rounding of coordinates does not hide the vertex: here it lies on a slanted edge only as far as numbers go, also far
/// from the origin. The order of vertices, triangles, corners does not either.
#[test]
fn turned_moved_and_in_any_order() {
    for seed in 0..200 {
        let mut random = Random::new(seed);
        let (angle, reach) = (random.between(0.0, 6.3), [1.0, 1e3, 1e6][seed as usize % 3]);
        let shift = [random.between(-reach, reach), random.between(-reach, reach)];
        let place = |[x, y]: [f64; 2]| {
            let (sin, cos) = angle.sin_cos();
            [shift[0] + cos * x - sin * y, shift[1] + sin * x + cos * y]
        };
        let points: Vec<_> = edge(&[[random.between(0.1, 3.9), 0.0]]).into_iter().map(place).collect();
        let number = random.permutation(5);
        let mut renumbered_points = points.clone();
        for (a, &b) in number.iter().enumerate() {
            renumbered_points[b] = points[a];
        }
        let mut shuffle = |triangles: Vec<[usize; 3]>| -> Vec<[usize; 3]> {
            let order = random.permutation(triangles.len());
            let turn = random.below(3);
            order.iter().map(|&t| [0, 1, 2].map(|i| number[triangles[t][(i + turn) % 3]])).collect()
        };
        let broken = mesh((renumbered_points.clone(), shuffle([side(2, &[]), side(3, &[4])].concat())));
        let found = broken.expect_err("a vertex hangs");
        assert!(
            matches!(found, MeshError::HangingVertex { vertex, .. } if vertex == number[4]),
            "seed {seed}: {found}"
        );
        let fixed = mesh((renumbered_points, shuffle([side(2, &[4]), side(3, &[4])].concat())));
        assert!(fixed.is_ok(), "seed {seed}: {}", fixed.unwrap_err());
    }
}

#[test]
fn a_vertex_beside_the_edge_opens_a_slit_or_overlaps() {
    // Above the edge, it leaves a hole between the two sides, which is a domain like others.
    let slit = |y: f64| mesh((edge(&[[1.0, y]]), [side(2, &[]), side(3, &[4])].concat()));
    assert_eq!(slit(1e-3).unwrap().kind()[4], VertexKind::Boundary);
    assert!(matches!(slit(0.0), Err(MeshError::HangingVertex { .. })));
    assert!(matches!(slit(-1e-3), Err(MeshError::OverlapAtVertex { .. })));
}

/// Surfaces that were not cut at each other can touch without a common vertex.
#[test]
fn a_piece_that_ends_inside_an_edge_of_another() {
    let apart = [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0], [1.0, 0.0], [2.0, 0.0], [1.5, -1.0]];
    assert_refused(
        parts(&apart, &[[0, 1, 2], [3, 5, 4]]),
        "the mesh is not conforming: vertex 4 lies inside the edge (0, 1) of triangle 0; split that triangle there",
        Some(0),
        parts(&apart, &[[0, 3, 2], [3, 4, 2], [4, 1, 2], [3, 5, 4]]),
    );
    // With its tip on the edge.
    let tip = [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0], [1.0, 0.0], [2.0, -1.0], [1.0, -1.0]];
    assert_refused(
        parts(&tip, &[[3, 5, 4], [0, 1, 2]]),
        "the mesh is not conforming: vertex 3 lies inside the edge (0, 1) of triangle 1; split that triangle there",
        Some(1),
        parts(&tip, &[[3, 5, 4], [0, 3, 2], [3, 1, 2]]),
    );
}
