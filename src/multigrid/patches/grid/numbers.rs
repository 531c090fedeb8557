//! Which vertex of a mesh each point of the patches is.

use super::lattice::{Lattice, parents};
use super::partition::Partition;
use crate::mesh::Parents;
use crate::multigrid::patches::lanes::LANES;
use crate::parallel::prelude::*;

/// In place of a point of a patch that is not there.
const NONE: u32 = u32::MAX;

/// For each point of the patches, group by group, the number of its vertex.
#[derive(Debug, Clone)]
pub(in crate::multigrid) struct Numbers(pub(in crate::multigrid) Vec<[u32; LANES]>);

impl Numbers {
    /// The corners of the patches, by the vertices of the coarse mesh.
    pub(in crate::multigrid) fn of_corners(partition: &Partition) -> Self {
        let mut numbers = vec![[NONE; LANES]; 3 * partition.groups()];
        for g in 0..partition.groups() {
            for (lane, patch) in partition.group(g) {
                for (k, &corner) in partition.corners[patch].iter().enumerate() {
                    numbers[3 * g + k][lane] = corner;
                }
            }
        }
        Self(numbers)
    }

    /// The points of lattices with twice the segments, by the vertices of the refined mesh; `None` if it is not refined uniformly.
    pub(in crate::multigrid) fn refined(
        &self,
        coarse: &Lattice,
        fine: &Lattice,
        refinement: &Parents,
    ) -> Option<Self> {
        let midpoints = Midpoints::of(refinement);
        let mut numbers = vec![[NONE; LANES]; self.0.len() / coarse.points() * fine.points()];
        let groups = numbers.par_chunks_mut(fine.points()).zip(self.0.par_chunks(coarse.points()));
        let is_refined = |(numbers, coarse_numbers): (&mut [[u32; LANES]], &[[u32; LANES]])| {
            fine.all().zip(numbers).all(|(point, number)| {
                let [a, b] = parents(point).map(|[i, j]| coarse_numbers[coarse.at(i, j)]);
                (0..LANES).filter(|&lane| a[lane] != NONE).all(|lane| {
                    number[lane] = midpoints.between(a[lane], b[lane]);
                    number[lane] != NONE
                })
            })
        };
        groups.map(is_refined).all(|is_refined| is_refined).then_some(Self(numbers))
    }

    /// Each number replaced by another one.
    pub(in crate::multigrid) fn map(&self, number: impl Fn(u32) -> u32) -> Self {
        Self(self.0.iter().map(|lanes| lanes.map(|a| if a == NONE { NONE } else { number(a) })).collect())
    }

    /// Whether there is a point.
    #[inline(always)]
    pub(in crate::multigrid) fn is_one(number: u32) -> bool {
        number != NONE
    }
}

/// What a refinement makes of the vertices and edges of the coarser mesh.
struct Midpoints {
    kept: Vec<u32>,
    /// Where the edges to larger ends start for each vertex.
    start: Vec<u32>,
    /// The larger end and the midpoint.
    edges: Vec<[u32; 2]>,
}

impl Midpoints {
    fn of(refinement: &Parents) -> Self {
        let mut kept = vec![NONE; refinement.coarse_vertices()];
        let mut start = vec![0u32; refinement.coarse_vertices() + 1];
        for (&[a, b], v) in refinement.ends().iter().zip(0..) {
            if a == b {
                kept[a as usize] = v;
            } else {
                start[a.min(b) as usize + 1] += 1;
            }
        }
        for a in 1..start.len() {
            start[a] += start[a - 1];
        }
        let mut next = start.clone();
        let mut edges = vec![[NONE; 2]; start[start.len() - 1] as usize];
        for (&[a, b], v) in refinement.ends().iter().zip(0..).filter(|([a, b], _)| a != b) {
            let at = &mut next[a.min(b) as usize];
            edges[*at as usize] = [a.max(b), v];
            *at += 1;
        }
        Self { kept, start, edges }
    }

    /// The midpoint of an edge, a vertex itself if it is named twice; [`NONE`] if there is none.
    fn between(&self, a: u32, b: u32) -> u32 {
        if a == b {
            return self.kept[a as usize];
        }
        let [least, largest] = [a.min(b), a.max(b)];
        let edges = self.start[least as usize] as usize..self.start[least as usize + 1] as usize;
        let found = self.edges[edges].iter().find(|&&[end, _]| end == largest);
        found.map_or(NONE, |&[_, midpoint]| midpoint)
    }
}
