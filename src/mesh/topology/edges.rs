//! The edges of a mesh, numbered.

use std::ops::Range;

use crate::mesh::Mesh;
use crate::parallel::blocks;
use crate::parallel::prelude::*;

/// The edges, in increasing order of their ends.
pub(in crate::mesh) struct Edges {
    /// The ends of each edge, the lower one first.
    pub(in crate::mesh) ends: Vec<[usize; 2]>,
    triangles: Vec<[u32; 2]>,
    of_triangle: Vec<[u32; 3]>,
}

/// The edges from some consecutive vertices to upper ones.
#[derive(Default)]
struct Rows {
    /// How many there are after each vertex.
    count: Vec<u32>,
    ends: Vec<[usize; 2]>,
    triangles: Vec<[u32; 2]>,
}

impl Edges {
    pub(in crate::mesh) fn new(mesh: &Mesh) -> Self {
        let vertices = mesh.points.len();
        let blocks: Vec<Rows> = blocks(vertices).into_par_iter().map(|block| rows_of(mesh, block)).collect();
        let count = blocks.iter().map(|rows| rows.ends.len()).sum();
        let (mut ends, mut triangles) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut first = Vec::with_capacity(vertices + 1);
        first.push(0);
        for rows in blocks {
            let before = ends.len() as u32;
            first.extend(rows.count.iter().map(|count| before + count));
            ends.extend(rows.ends);
            triangles.extend(rows.triangles);
        }
        let number = |a: usize, b: usize| {
            let (lower, upper) = (a.min(b), a.max(b));
            let row = first[lower] as usize..first[lower + 1] as usize;
            let mut row = row.clone().zip(&ends[row]);
            row.find(|(_, ends)| ends[1] == upper).expect("an edge of a triangle is one of the mesh").0 as u32
        };
        let of_triangle = |&[a, b, c]: &[usize; 3]| [number(a, b), number(b, c), number(c, a)];
        let of_triangle = mesh.triangles.par_iter().map(of_triangle).collect();
        Self { ends, triangles, of_triangle }
    }

    /// The triangles on both sides of an edge; twice the same on the boundary.
    pub(in crate::mesh) fn triangles(&self, edge: usize) -> [usize; 2] {
        self.triangles[edge].map(|t| t as usize)
    }

    /// The numbers of the edges from corner `i` to corner `i + 1` of triangle `t`, for `i = 0, 1, 2`.
    pub(in crate::mesh) fn of_triangle(&self, t: usize) -> [usize; 3] {
        self.of_triangle[t].map(|edge| edge as usize)
    }

    /// Whether the edge lies on the boundary.
    pub(in crate::mesh) fn on_boundary(&self, edge: usize) -> bool {
        let [one, other] = self.triangles[edge];
        one == other
    }
}

/// The edges from the vertices of a block to upper ones.
fn rows_of(mesh: &Mesh, block: Range<usize>) -> Rows {
    let mut rows = Rows::default();
    let mut sides: Vec<(usize, u32)> = Vec::new();
    for a in block {
        sides.clear();
        for &t in mesh.around().of(a) {
            sides.extend(mesh.triangles[t as usize].into_iter().filter(|&b| b > a).map(|b| (b, t)));
        }
        sides.sort_unstable();
        for of_edge in sides.chunk_by(|one, other| one.0 == other.0) {
            rows.ends.push([a, of_edge[0].0]);
            rows.triangles.push([of_edge[0].1, of_edge[of_edge.len() - 1].1]);
        }
        rows.count.push(rows.ends.len() as u32);
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::samples::assorted;

    #[test]
    fn edges_and_triangles_know_each_other() {
        for mesh in assorted() {
            let edges = Edges::new(&mesh);
            let mut seen = vec![0; edges.ends.len()];
            for (t, corners) in mesh.triangles().iter().enumerate() {
                for i in 0..3 {
                    let edge = edges.of_triangle(t)[i];
                    let [a, b] = [corners[i], corners[(i + 1) % 3]];
                    assert_eq!(edges.ends[edge], [a.min(b), a.max(b)]);
                    assert!(edges.triangles(edge).contains(&t));
                    seen[edge] += 1;
                }
            }
            let sides = |edge: usize| if edges.on_boundary(edge) { 1 } else { 2 };
            assert!((0..seen.len()).all(|edge| seen[edge] == sides(edge)));
            assert!(seen.contains(&1) && seen.contains(&2), "there are both kinds");
        }
    }
}
