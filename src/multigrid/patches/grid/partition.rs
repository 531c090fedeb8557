//! The coarse mesh whose triangles are the patches: what they have in common.
//!
//! The *interface* of a level are the vertices of the coarse mesh and the points on its edges: first the vertices, then the points
//! of each edge from its first end to its second, last a place for what has no point.

use super::lattice::Lattice;
use crate::multigrid::patches::lanes::LANES;

/// Patches and the edges and vertices at which they meet.
#[derive(Debug)]
pub(in crate::multigrid) struct Partition {
    pub(in crate::multigrid) vertices: usize,
    /// The vertices of each patch.
    pub(in crate::multigrid) corners: Vec<[u32; 3]>,
    /// The edges along the sides of each patch.
    sides: Vec<[Side; 3]>,
    /// The ends of each edge, the smaller number first.
    pub(in crate::multigrid) edges: Vec<[u32; 2]>,
    /// Where the edges at each vertex start among the spokes.
    first_spoke: Vec<u32>,
    spokes: Vec<Spoke>,
}

/// An edge as the side of a patch.
#[derive(Debug, Clone, Copy)]
struct Side {
    edge: u32,
    /// Whether the side runs from the second end to the first.
    is_reversed: bool,
}

/// An edge seen from one of its ends.
#[derive(Debug, Clone, Copy)]
pub(in crate::multigrid) struct Spoke {
    pub(in crate::multigrid) edge: usize,
    /// Whether that is the second end.
    pub(in crate::multigrid) is_second: bool,
}

impl Partition {
    /// By triangles over so many vertices.
    pub(in crate::multigrid) fn new(vertices: usize, triangles: &[[usize; 3]]) -> Self {
        let corners: Vec<[u32; 3]> = triangles.iter().map(|corners| corners.map(|a| a as u32)).collect();
        let ends = |[a, b, c]: [u32; 3]| [[a, b], [a, c], [b, c]];
        let sorted = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let mut edges: Vec<[u32; 2]> =
            corners.iter().flat_map(|&corners| ends(corners)).map(sorted).collect();
        edges.sort_unstable();
        edges.dedup();
        let side = |[a, b]: [u32; 2]| Side {
            edge: edges.binary_search(&sorted([a, b])).expect("it is an edge") as u32,
            is_reversed: a > b,
        };
        let sides = corners.iter().map(|&corners| ends(corners).map(side)).collect();
        let mut at_end: Vec<(u32, Spoke)> = Vec::with_capacity(2 * edges.len());
        for (edge, &[a, b]) in edges.iter().enumerate() {
            at_end.push((a, Spoke { edge, is_second: false }));
            at_end.push((b, Spoke { edge, is_second: true }));
        }
        at_end.sort_by_key(|&(a, _)| a);
        let first_spoke =
            (0..=vertices).map(|a| at_end.partition_point(|&(b, _)| (b as usize) < a) as u32).collect();
        let spokes = at_end.into_iter().map(|(_, spoke)| spoke).collect();
        Self { vertices, corners, sides, edges, first_spoke, spokes }
    }

    /// The groups of patches that are side by side.
    pub(in crate::multigrid) fn groups(&self) -> usize {
        self.corners.len().div_ceil(LANES)
    }

    /// The patches of a group, with their lanes.
    pub(in crate::multigrid) fn group(&self, g: usize) -> impl Iterator<Item = (usize, usize)> + use<> {
        let first = LANES * g;
        (first..self.corners.len().min(first + LANES)).map(move |patch| (patch - first, patch))
    }

    /// The edges at a vertex.
    pub(in crate::multigrid) fn spokes(&self, vertex: usize) -> &[Spoke] {
        &self.spokes[self.first_spoke[vertex] as usize..self.first_spoke[vertex + 1] as usize]
    }

    /// The length of vectors over the interface.
    pub(in crate::multigrid) fn interface(&self, segments: usize) -> usize {
        self.vertices + self.edges.len() * (segments - 1) + 1
    }

    /// The first point of an edge between its ends.
    #[inline(always)]
    pub(in crate::multigrid) fn first_on_edge(&self, edge: usize, segments: usize) -> usize {
        self.vertices + edge * (segments - 1)
    }

    /// The point of an edge so many segments from its first end, ends included.
    #[inline(always)]
    pub(in crate::multigrid) fn on_edge(&self, edge: usize, t: usize, segments: usize) -> usize {
        match t {
            0 => self.edges[edge][0] as usize,
            t if t == segments => self.edges[edge][1] as usize,
            t => self.first_on_edge(edge, segments) + t - 1,
        }
    }

    /// The point of an edge next to one of its ends, if there are at least two segments.
    #[inline(always)]
    pub(in crate::multigrid) fn nearest(&self, spoke: Spoke, segments: usize) -> usize {
        self.first_on_edge(spoke.edge, segments) + if spoke.is_second { segments - 2 } else { 0 }
    }

    /// The piece of an edge at one of its ends.
    #[inline(always)]
    pub(in crate::multigrid) fn piece(&self, spoke: Spoke, segments: usize) -> usize {
        spoke.edge * segments + if spoke.is_second { segments - 1 } else { 0 }
    }

    /// The piece of an edge that is so many pieces away from the start of the side of a patch.
    pub(in crate::multigrid) fn piece_of_side(
        &self,
        patch: usize,
        side: usize,
        piece: usize,
        segments: usize,
    ) -> usize {
        let Side { edge, is_reversed } = self.sides[patch][side];
        edge as usize * segments + if is_reversed { segments - 1 - piece } else { piece }
    }

    /// The places in the interface of the corners of a patch, and of its points on the sides in the order of a lattice.
    pub(in crate::multigrid) fn rim(&self, patch: usize, lattice: &Lattice) -> impl Iterator<Item = u32> {
        let segments = lattice.segments;
        let on_sides = self.sides[patch].into_iter().flat_map(move |Side { edge, is_reversed }| {
            let first = self.first_on_edge(edge as usize, segments);
            (1..segments).map(move |t| first + if is_reversed { segments - t } else { t } - 1)
        });
        self.corners[patch].into_iter().chain(on_sides.map(|place| place as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Pattern, rectangle};

    #[test]
    fn patches_name_the_points_on_a_common_edge_alike() {
        let mesh = rectangle([0.0; 2], [1.0; 2], [3, 2], Pattern::Crossed).unwrap();
        let partition = Partition::new(mesh.points().len(), mesh.triangles());
        let lattice = Lattice::new(4);
        let mut point = vec![None; partition.interface(4)];
        for (patch, corners) in mesh.triangles().iter().enumerate() {
            let corners = corners.map(|a| mesh.points()[a]);
            let at = |[i, j]: [usize; 2]| {
                let [u, v] = [i, j].map(|i| i as f64 / 4.0);
                [0, 1].map(|k| (1.0 - u - v) * corners[0][k] + u * corners[1][k] + v * corners[2][k])
            };
            let all: Vec<[usize; 2]> = lattice.all().collect();
            let of_place = |at: usize| *all.iter().find(|&&[i, j]| lattice.at(i, j) == at).unwrap();
            let places = lattice.corners().into_iter().chain(lattice.rim.iter().map(|point| point.at));
            for (place, number) in places.zip(partition.rim(patch, &lattice)) {
                let here = at(of_place(place));
                let there = *point[number as usize].get_or_insert(here);
                assert!((0..2).all(|k| (here[k] - there[k]).abs() < 1e-14), "{here:?} {there:?}");
            }
        }
        let filled = point.iter().filter(|point| point.is_some()).count();
        assert_eq!(filled, partition.interface(4) - 1, "all but the place for nothing");
        let spokes: usize = (0..partition.vertices).map(|a| partition.spokes(a).len()).sum();
        assert_eq!(spokes, 2 * partition.edges.len());
    }
}
