//! Which edges of the boundary of a mesh are on which side of a polygon.

use crate::geometry::signed_ring_area;
use crate::mesh::Mesh;
use crate::mesh::topology::boundary_edges;

/// An edge of the boundary.
pub(super) struct SideEdge {
    pub(super) ends: [usize; 2],
    /// The ring: the outer one, or from 1 that of a hole.
    pub(super) ring: usize,
    /// The side of that ring, from its vertex of this number to the next one.
    pub(super) side: usize,
}

/// All edges of the boundary, found on a walk along the rings: `corners` are the vertices of the mesh at the corners of the
/// rings, one ring after the other; `usize::MAX` where there is none. `None` when that is not the boundary, as for a ring that runs back on itself.
pub(super) fn edges_of_sides<'r>(
    mesh: &Mesh,
    rings: impl IntoIterator<Item = &'r [[f64; 2]]>,
    corners: &[usize],
) -> Option<Vec<SideEdge>> {
    // A corner that is in no triangle is at the end of a spike.
    if corners.contains(&usize::MAX) {
        return None;
    }
    // Edges that start at one vertex are neighbours.
    let mut boundary = boundary_edges(mesh);
    boundary.sort_unstable();
    let mut found = Vec::with_capacity(boundary.len());
    let mut first = 0;
    for (ring, points) in rings.into_iter().enumerate() {
        // Edges have the mesh on their left, and so have the sides of an outer ring that is counterclockwise.
        let turns_left = signed_ring_area(points) > 0.0;
        let along = turns_left == (ring == 0);
        for side in 0..points.len() {
            let [start, end] = [side, (side + 1) % points.len()].map(|k| corners[first + k]);
            let [mut at, to] = if along { [start, end] } else { [end, start] };
            while at != to {
                let next = step(mesh, &boundary, at, to)?;
                found.push(SideEdge { ends: [at, next], ring, side });
                if found.len() > boundary.len() {
                    return None;
                }
                at = next;
            }
        }
        first += points.len();
    }
    (found.len() == boundary.len()).then_some(found)
}

/// The next vertex on the way along the boundary from vertex `at` straight to vertex `to`.
fn step(mesh: &Mesh, boundary: &[[usize; 2]], at: usize, to: usize) -> Option<usize> {
    let start = boundary.partition_point(|&[from, _]| from < at);
    let ways = || boundary[start..].iter().take_while(|&&[from, _]| from == at).map(|&[_, next]| next);
    // Where rings touch there are several ways.
    if ways().nth(1).is_none() {
        return ways().next();
    }
    let points = mesh.points();
    let towards = |a: usize| {
        let [x, y] = [0, 1].map(|axis| points[a][axis] - points[at][axis]);
        let length = x.hypot(y);
        [x / length, y / length]
    };
    let cosine = |a: usize| {
        let ([x, y], [to_x, to_y]) = (towards(a), towards(to));
        x * to_x + y * to_y
    };
    ways().max_by(|&a, &b| cosine(a).total_cmp(&cosine(b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::samples::square_without;

    #[test]
    fn rings_that_are_not_the_boundary_are_noticed() {
        // Vertex (i, j) of the grid is 4 j + i.
        let mesh = square_without(3, |i, j| (i, j) == (1, 1));
        let (outer, hole) = ([0, 3, 15, 12], [5, 6, 10, 9]);
        let found = |rings: &[[usize; 4]]| {
            let points: Vec<Vec<[f64; 2]>> =
                rings.iter().map(|ring| ring.iter().map(|&a| mesh.points()[a.min(15)]).collect()).collect();
            edges_of_sides(&mesh, points.iter().map(Vec::as_slice), &rings.concat())
        };
        let edges = found(&[outer, hole]).expect("they are the boundary");
        let of = |ring: usize, side: usize| edges.iter().filter(|e| (e.ring, e.side) == (ring, side)).count();
        assert!((0..4).all(|side| of(0, side) == 3 && of(1, side) == 1));
        assert!(found(&[outer]).is_none(), "a hole is missing");
        assert!(found(&[outer, hole, hole]).is_none(), "one is there twice");
        assert!(found(&[outer, [0, 1, 2, 3]]).is_none(), "it runs back on itself");
        assert!(found(&[outer, [5, 6, 10, usize::MAX]]).is_none(), "a corner is in no triangle");
    }
}
