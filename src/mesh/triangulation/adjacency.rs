//! Who meets whom: the triangles around a vertex, the half edges of a mesh.

use std::ops::Range;

/// Which corner of a triangle (0, 1 or 2) a vertex is.
///
/// # Panics
/// When it is none of them: callers take the triangles around the vertex.
pub(crate) fn corner_of(triangle: [usize; 3], vertex: usize) -> usize {
    triangle.iter().position(|&a| a == vertex).expect("a vertex is a corner of the triangles around it")
}

/// The triangles `T_a` around each vertex `a`, in compressed rows, in increasing order.
#[derive(Debug, Clone)]
pub(crate) struct VertexTriangles {
    start: Vec<u32>,
    triangles: Vec<u32>,
}

impl VertexTriangles {
    /// Collects the rows by counting: linear in the number of triangles.
    pub(crate) fn new(vertices: usize, triangles: &[[usize; 3]]) -> Self {
        let corners = || triangles.iter().zip(0u32..).flat_map(|(corners, t)| corners.map(|a| (a, t)));
        let (start, triangles) = group_by_key(vertices, corners);
        Self { start, triangles }
    }

    /// Where the row of vertex `a` lies among all rows.
    pub(crate) fn row(&self, a: usize) -> Range<usize> {
        self.start[a] as usize..self.start[a + 1] as usize
    }

    /// The triangles that share vertex `a`.
    pub(crate) fn of(&self, a: usize) -> &[u32] {
        &self.triangles[self.row(a)]
    }

    /// Likewise, as numbers to index with.
    pub(crate) fn triangles(&self, a: usize) -> impl ExactSizeIterator<Item = usize> + Clone {
        self.of(a).iter().map(|&t| t as usize)
    }

    /// Where triangle `t`, one of those around vertex `a`, lies among all rows.
    pub(crate) fn place(&self, a: usize, t: usize) -> usize {
        let place = self.of(a).binary_search(&(t as u32));
        self.row(a).start + place.expect("a triangle is around its corners")
    }
}

/// An edge as one of its triangles sees it, filed under its lower end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) struct HalfEdge {
    end: u32,
    /// The number of the triangle; the highest bit says whether the edge is reversed.
    side: u32,
}

impl HalfEdge {
    const REVERSED: u32 = 1 << 31;

    fn new(end: usize, is_reversed: bool, triangle: u32) -> Self {
        Self { end: end as u32, side: triangle | if is_reversed { Self::REVERSED } else { 0 } }
    }

    /// The upper end.
    pub(crate) fn end(self) -> usize {
        self.end as usize
    }

    /// Whether the triangle, run through counterclockwise, passes from the upper to the lower end.
    pub(crate) fn is_reversed(self) -> bool {
        self.side & Self::REVERSED != 0
    }

    /// The triangle.
    pub(crate) fn triangle(self) -> usize {
        (self.side & !Self::REVERSED) as usize
    }
}

/// All half edges, filed under their lower ends, sorted there: those of one edge are neighbours.
#[derive(Debug)]
pub(crate) struct HalfEdges {
    start: Vec<u32>,
    half_edges: Vec<HalfEdge>,
}

impl HalfEdges {
    pub(crate) fn new(vertices: usize, triangles: &[[usize; 3]]) -> Self {
        let sides = || {
            triangles.iter().zip(0..).flat_map(|(&[a, b, c], triangle)| {
                [(a, b), (b, c), (c, a)]
                    .map(|(from, to)| (from.min(to), HalfEdge::new(from.max(to), from > to, triangle)))
            })
        };
        let (start, mut half_edges) = group_by_key(vertices, sides);
        for row in start.windows(2) {
            half_edges[row[0] as usize..row[1] as usize].sort_unstable();
        }
        Self { start, half_edges }
    }

    /// The edges of the mesh: lower end, upper end, and the triangles that see it. In increasing order of the ends.
    pub(crate) fn edges(&self) -> impl Iterator<Item = (usize, usize, &[HalfEdge])> {
        (0..self.start.len() - 1).flat_map(move |lower| {
            self.half_edges[self.start[lower] as usize..self.start[lower + 1] as usize]
                .chunk_by(|a, b| a.end == b.end)
                .map(move |sides| (lower, sides[0].end(), sides))
        })
    }
}

/// Counting sort: values grouped by their keys `0..keys`, the order within a group kept.
fn group_by_key<V: Copy + Default, I: Iterator<Item = (usize, V)>>(
    keys: usize,
    items: impl Fn() -> I,
) -> (Vec<u32>, Vec<V>) {
    let mut start = vec![0u32; keys + 1];
    for (key, _) in items() {
        start[key + 1] += 1;
    }
    for key in 0..keys {
        start[key + 1] += start[key];
    }
    let mut next = start.clone();
    let mut values = vec![V::default(); start[keys] as usize];
    for (key, value) in items() {
        values[next[key] as usize] = value;
        next[key] += 1;
    }
    (start, values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::samples::{irregular, renumbered};

    #[test]
    fn triangles_around_vertices_are_those_of_a_search() {
        let (mesh, _) = renumbered(&irregular(4), 1);
        let around = VertexTriangles::new(mesh.points().len() + 1, mesh.triangles());
        for a in 0..mesh.points().len() {
            let found: Vec<usize> =
                (0..mesh.triangles().len()).filter(|&t| mesh.triangles()[t].contains(&a)).collect();
            assert!(around.triangles(a).eq(found.iter().copied()));
            assert!(!found.is_empty());
        }
        assert!(around.of(mesh.points().len()).is_empty(), "a vertex in no triangle");
    }

    #[test]
    fn a_corner_is_found_by_its_vertex() {
        assert_eq!([7, 3, 5].map(|a| corner_of([7, 3, 5], a)), [0, 1, 2]);
        assert!(std::panic::catch_unwind(|| corner_of([7, 3, 5], 4)).is_err(), "it is no corner");
    }

    #[test]
    fn edges_of_two_triangles() {
        let half_edges = HalfEdges::new(5, &[[0, 1, 2], [0, 2, 4]]);
        let side = HalfEdge::new;
        let found: Vec<_> = half_edges.edges().map(|(a, b, sides)| (a, b, sides.to_vec())).collect();
        let expected = [
            (0, 1, vec![side(1, false, 0)]),
            (0, 2, vec![side(2, false, 1), side(2, true, 0)]),
            (0, 4, vec![side(4, true, 1)]),
            (1, 2, vec![side(2, false, 0)]),
            (2, 4, vec![side(4, false, 1)]),
        ];
        assert_eq!(found, expected);
        // Turned round, a triangle passes its edges the other way.
        let turned = HalfEdges::new(5, &[[0, 2, 1], [0, 2, 4]]);
        let sides = turned.edges().find(|&(a, b, _)| (a, b) == (0, 2)).unwrap().2;
        assert_eq!(sides, [side(2, false, 0), side(2, false, 1)]);
    }
}
