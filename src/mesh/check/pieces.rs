//! No piece of a triangulation lies in another one.

use std::collections::BTreeMap;

use super::boundary::{Boundary, BoundaryEdge};
use super::error::MeshError;
use super::winding::{Winding, wind};

/// A piece of the mesh, for its name and its place.
struct Piece {
    /// The first of its triangles at the boundary.
    triangle: usize,
    /// Its point farthest to the right: no edge of its own lies to the right of it.
    rightmost: [f64; 2],
}

/// A piece is what is connected through vertices. Where the boundaries of two do not cross, one lies wholly in the other
/// or wholly outside of it, so one vertex of each tells. Returns how many edges were looked at.
pub(super) fn check_pieces(boundary: &Boundary, triangles: &[[usize; 3]]) -> Result<usize, MeshError> {
    // Each piece has a boundary: when that is in one part, so is the mesh.
    let along_boundary = roots(boundary.points.len(), boundary.edges.iter().map(|edge| edge.ends));
    let first = along_boundary[boundary.edges[0].ends[0]];
    if boundary.edges.iter().all(|edge| along_boundary[edge.ends[0]] == first) {
        return Ok(0);
    }
    let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c]]);
    let piece_of = roots(boundary.points.len(), sides);
    let pieces = pieces(boundary, &piece_of);
    if pieces.len() == 1 {
        return Ok(0);
    }
    let mut by_height: Vec<&Piece> = pieces.values().collect();
    by_height.sort_by(|p, q| p.rightmost[1].total_cmp(&q.rightmost[1]));
    let mut windings: Vec<Winding> =
        by_height.iter().map(|piece| Winding { point: piece.rightmost, turns: 0 }).collect();
    let looks = wind(boundary.points, boundary.edges, &mut windings);
    // A piece winds round a point once if the point is in it, and else not at all: turns of several do not cancel.
    let nested = windings.iter().zip(&by_height).filter(|(winding, _)| winding.turns != 0);
    match nested.map(|(_, piece)| piece).min_by_key(|piece| piece.triangle) {
        Some(inner) => Err(nested_in(boundary, &piece_of, &pieces, inner)),
        None => Ok(looks),
    }
}

/// The pieces, by their least vertices.
fn pieces(boundary: &Boundary, piece_of: &[u32]) -> BTreeMap<u32, Piece> {
    let mut pieces: BTreeMap<u32, Piece> = BTreeMap::new();
    for BoundaryEdge { ends: [a, _], triangle } in boundary.edges {
        let point = boundary.points[*a];
        let piece = pieces.entry(piece_of[*a]).or_insert(Piece { triangle: *triangle, rightmost: point });
        if point[0] > piece.rightmost[0] {
            piece.rightmost = point;
        }
    }
    pieces
}

/// The error that names a piece around `inner`.
fn nested_in(
    boundary: &Boundary,
    piece_of: &[u32],
    pieces: &BTreeMap<u32, Piece>,
    inner: &Piece,
) -> MeshError {
    let mut turns: BTreeMap<u32, i32> = BTreeMap::new();
    for edge in boundary.edges {
        let mut winding = [Winding { point: inner.rightmost, turns: 0 }];
        wind(boundary.points, &[*edge], &mut winding);
        *turns.entry(piece_of[edge.ends[0]]).or_default() += winding[0].turns;
    }
    let around = turns.iter().find(|(_, turns)| **turns != 0).map(|(piece, _)| pieces[piece].triangle);
    MeshError::Nested { inner: inner.triangle, outer: around.unwrap_or(inner.triangle) }
}

/// For each vertex the least of those that edges connect it to.
fn roots(vertices: usize, edges: impl Iterator<Item = [usize; 2]>) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..vertices as u32).collect();
    let root = |parent: &mut [u32], mut a: u32| {
        while parent[a as usize] != a {
            parent[a as usize] = parent[parent[a as usize] as usize];
            a = parent[a as usize];
        }
        a
    };
    for ends in edges {
        let [p, q] = ends.map(|a| root(&mut parent, a as u32));
        parent[p.max(q) as usize] = p.min(q);
    }
    (0..vertices as u32).map(|a| root(&mut parent, a)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::around::Around;
    use super::*;
    use crate::mesh::samples::square;
    use crate::mesh::triangulation::VertexTriangles;

    /// `n x n` cells, every second of which in both directions is an island in a hole of the others.
    fn islands(n: usize) -> (Vec<[f64; 2]>, Vec<[usize; 3]>) {
        let square = square(2 * n + 1);
        let is_hole = |k: usize| (k % (2 * n + 1)) % 2 == 1 && (k / (2 * n + 1)) % 2 == 1;
        let mut points = square.points().to_vec();
        let mut triangles = Vec::new();
        for (k, cell) in square.triangles().chunks(2).enumerate() {
            if !is_hole(k) {
                triangles.extend_from_slice(cell);
                continue;
            }
            // The triangle below the diagonal, shrunk towards its centre.
            let corners = cell[0].map(|a| square.points()[a]);
            let centre = [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 3.0);
            let first = points.len();
            points.extend(corners.map(|corner| [0, 1].map(|axis| 0.5 * (corner[axis] + centre[axis]))));
            triangles.push([first, first + 1, first + 2]);
        }
        (points, triangles)
    }

    /// What `check_pieces` says of a mesh, and the number of its boundary edges.
    fn checked((points, triangles): &(Vec<[f64; 2]>, Vec<[usize; 3]>)) -> (Result<usize, MeshError>, usize) {
        let around = VertexTriangles::new(points.len(), triangles);
        let edges = Around { points, triangles, around: &around }.boundary_edges().unwrap();
        (check_pieces(&Boundary::new(points, &edges), triangles), edges.len())
    }

    #[test]
    fn islands_in_holes_are_apart_and_take_linear_work() {
        let looks_per_edge = |n: usize| {
            let (looks, edges) = checked(&islands(n));
            looks.unwrap() as f64 / edges as f64
        };
        // 100 and 6400 islands: a scan of all edges for each would look at 64 times as many an edge.
        let [few, many] = [10, 80].map(looks_per_edge);
        assert!(many < 2.5 * few, "{few} and {many} looks an edge");
    }

    #[test]
    fn an_island_that_is_no_island_is_found_among_many() {
        let (points, mut triangles) = islands(10);
        let hole = square(21).triangles()[2 * (21 * 9 + 9)..][..2].to_vec();
        let island = triangles.iter().position(|t| t.iter().all(|&a| a >= points.len() - 3)).unwrap();
        assert!(checked(&(points.clone(), triangles.clone())).0.is_ok());
        // The hole around an island is closed.
        triangles.extend(hole);
        let (result, _) = checked(&(points, triangles.clone()));
        let Err(MeshError::Nested { inner, outer }) = result else { panic!("{result:?}") };
        assert!(inner != island && triangles[inner].iter().all(|&a| a >= 22 * 22), "an island");
        assert!(triangles[outer].iter().all(|&a| a < 22 * 22), "the plate");
    }
}
