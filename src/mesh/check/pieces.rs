//! No piece of a triangulation lies in another one.

use std::collections::BTreeMap;

use super::MeshError;
use super::boundary::{Boundary, BoundaryEdge};
use super::boxes::{Bounds, BoxIndex};
use crate::geometry::twice_signed_area;

/// A piece is what is connected through vertices. Where the boundaries of two do not cross, one lies wholly in the other
/// or wholly outside of it, so one vertex of each tells.
pub(super) fn check_pieces(boundary: &Boundary, triangles: &[[usize; 3]]) -> Result<(), MeshError> {
    let piece = piece_of_vertices(boundary.points.len(), triangles);
    let mut pieces: BTreeMap<usize, Vec<BoundaryEdge>> = BTreeMap::new();
    for edge in boundary.edges {
        pieces.entry(piece[edge.ends[0]]).or_default().push(*edge);
    }
    if pieces.len() == 1 {
        return Ok(());
    }
    let pieces: Vec<Vec<BoundaryEdge>> = pieces.into_values().collect();
    let bounds = |edges: &Vec<BoundaryEdge>| {
        Bounds::around(edges.iter().map(|edge| boundary.points[edge.ends[0]]), boundary.resolution)
    };
    let index = BoxIndex::new(pieces.iter().map(bounds).collect());
    for (k, edges) in pieces.iter().enumerate() {
        let point = boundary.points[edges[0].ends[0]];
        let others = index.larger_meeting(Bounds::around([point], boundary.resolution));
        let outer = others.filter(|&other| other != k).find(|&other| {
            let turns: i32 = pieces[other].iter().map(|edge| crossing(boundary.points, edge, point)).sum();
            turns != 0
        });
        if let Some(outer) = outer {
            return Err(MeshError::Nested { inner: edges[0].triangle, outer: pieces[outer][0].triangle });
        }
    }
    Ok(())
}

/// For each vertex the least vertex of its piece.
fn piece_of_vertices(vertices: usize, triangles: &[[usize; 3]]) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..vertices).collect();
    let root = |parent: &mut [usize], mut a: usize| {
        while parent[a] != a {
            parent[a] = parent[parent[a]];
            a = parent[a];
        }
        a
    };
    for &[a, b, c] in triangles {
        for (a, b) in [(a, b), (b, c)] {
            let (p, q) = (root(&mut parent, a), root(&mut parent, b));
            parent[p.max(q)] = p.min(q);
        }
    }
    (0..vertices).map(|a| root(&mut parent, a)).collect()
}

/// How an edge crosses the half-line from `point` to the right: 1 upwards, -1 downwards, 0 not at all. The sum over closed
/// curves is how often they wind round the point.
fn crossing(points: &[[f64; 2]], edge: &BoundaryEdge, point: [f64; 2]) -> i32 {
    let [from, to] = edge.ends.map(|a| points[a]);
    let on_the_left = twice_signed_area([from, to, point]) > 0.0;
    match (from[1] <= point[1], to[1] <= point[1]) {
        (true, false) if on_the_left => 1,
        (false, true) if !on_the_left => -1,
        _ => 0,
    }
}
