//! What the triangles around each vertex tell: whether they lie side by side, and go round it once at most.
//!
//! This says yes or no, on all cores; what is wrong with a mesh is left to those who name it.

use std::f64::consts::TAU;
use std::ops::Range;

use super::boundary::BoundaryEdge;
use super::quality::angles;
use crate::mesh::triangulation::{VertexTriangles, corner_of};
use crate::parallel::blocks;
use crate::parallel::prelude::*;

/// What rounding may add to a full turn, radians.
pub(super) const TURN_ROUNDING: f64 = 1e-9;

/// Counterclockwise triangles and their vertices.
pub(super) struct Around<'m> {
    pub(super) points: &'m [[f64; 2]],
    pub(super) triangles: &'m [[usize; 3]],
    pub(super) around: &'m VertexTriangles,
}

/// Memory for the edges at a vertex: their other ends, and their triangles.
#[derive(Default)]
struct Edges {
    /// Those that leave the vertex, when one runs round the triangles counterclockwise.
    leaving: Vec<(usize, usize)>,
    /// Those that arrive.
    arriving: Vec<(usize, usize)>,
}

impl Around<'_> {
    /// The edges with one triangle, in increasing order of their lower and upper ends; `None` when an edge has two triangles on one side, or
    /// the triangles around a vertex make more than one turn.
    pub(super) fn boundary_edges(&self) -> Option<Vec<BoundaryEdge>> {
        let blocks: Vec<_> =
            blocks(self.points.len()).into_par_iter().map(|block| self.of_block(block)).collect();
        let mut edges = blocks.into_iter().collect::<Option<Vec<_>>>()?.concat();
        edges.sort_unstable_by_key(|&BoundaryEdge { ends: [a, b], .. }| [a.min(b), a.max(b)]);
        Some(edges)
    }

    /// Those that leave a vertex of the block.
    fn of_block(&self, block: Range<usize>) -> Option<Vec<BoundaryEdge>> {
        let mut boundary = Vec::new();
        let mut edges = Edges::default();
        for a in block {
            let before = boundary.len();
            let turns = self.collect(a, &mut edges);
            let Edges { leaving, arriving } = &mut edges;
            if has_twins(leaving) || has_twins(arriving) {
                return None;
            }
            let mut arrivals = arriving.iter().peekable();
            for &(b, triangle) in leaving.iter() {
                while arrivals.next_if(|(c, _)| *c < b).is_some() {}
                if arrivals.next_if(|(c, _)| *c == b).is_none() {
                    boundary.push(BoundaryEdge { ends: [a, b], triangle });
                }
            }
            let on_boundary = boundary.len() > before;
            if on_boundary && self.turn(a) > TAU + TURN_ROUNDING || !on_boundary && turns > 1 {
                return None;
            }
        }
        Some(boundary)
    }

    /// Collects the edges at a vertex. Returns how many of its triangles hold the direction of the first axis: where they close
    /// around it, that is how many turns they make.
    fn collect(&self, a: usize, edges: &mut Edges) -> usize {
        let Edges { leaving, arriving } = edges;
        leaving.clear();
        arriving.clear();
        let height = self.points[a][1];
        let mut turns = 0;
        for t in self.around.triangles(a) {
            let corners = self.triangles[t];
            let corner = corner_of(corners, a);
            let [b, c] = [1, 2].map(|k| corners[(corner + k) % 3]);
            leaving.push((b, t));
            arriving.push((c, t));
            // The vertex lies to the left of the edge from b to c.
            turns += usize::from(self.points[b][1] < height && self.points[c][1] >= height);
        }
        turns
    }

    /// The sum of the angles at a vertex, radians.
    fn turn(&self, a: usize) -> f64 {
        let angle = |t: usize| {
            let corners = self.triangles[t];
            angles(corners.map(|b| self.points[b]))[corner_of(corners, a)]
        };
        self.around.triangles(a).map(angle).sum()
    }
}

/// Sorts edges at a vertex by their other ends; whether two have the same.
fn has_twins(edges: &mut [(usize, usize)]) -> bool {
    edges.sort_unstable();
    edges.windows(2).any(|pair| pair[0].0 == pair[1].0)
}
