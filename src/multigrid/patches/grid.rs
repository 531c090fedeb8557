//! The points of a level, and how those on the sides of the patches hang together.

mod lattice;
mod numbers;
mod partition;

pub(super) use lattice::{DIRECTIONS, Lattice, parents};
pub(super) use numbers::Numbers;
pub(super) use partition::Partition;

use std::sync::Arc;

use super::lanes::{LANES, Lanes, Real};
use crate::parallel::BLOCK;

/// A level: all patches refined into lattices of so many segments.
#[derive(Debug)]
pub(super) struct Grid {
    pub(super) partition: Arc<Partition>,
    pub(super) lattice: Lattice,
    /// For each group the places in the interface of the corners of its patches, and of the points on their sides.
    rim: Vec<[u32; LANES]>,
    /// Whether the value at a point of the interface is given.
    pub(super) is_held: Vec<bool>,
}

impl Grid {
    /// With nothing held but the place for no point.
    pub(super) fn new(partition: &Arc<Partition>, segments: usize) -> Self {
        let lattice = Lattice::new(segments);
        let nowhere = partition.interface(segments) - 1;
        let of_group = 3 * segments;
        let mut rim = vec![[nowhere as u32; LANES]; partition.groups() * of_group];
        for g in 0..partition.groups() {
            for (lane, patch) in partition.group(g) {
                let places = &mut rim[g * of_group..][..of_group];
                for (lanes, place) in places.iter_mut().zip(partition.rim(patch, &lattice)) {
                    lanes[lane] = place;
                }
            }
        }
        let mut is_held = vec![false; nowhere + 1];
        is_held[nowhere] = true;
        Self { partition: Arc::clone(partition), lattice, rim, is_held }
    }

    pub(super) fn segments(&self) -> usize {
        self.lattice.segments
    }

    pub(super) fn groups(&self) -> usize {
        self.partition.groups()
    }

    /// The length of vectors over the interface.
    pub(super) fn interface(&self) -> usize {
        self.partition.interface(self.segments())
    }

    /// All points, each once.
    pub(super) fn vertices(&self) -> usize {
        let m = self.segments();
        self.interface() - 1 + self.partition.corners.len() * (m - 1) * (m - 2) / 2
    }

    /// The places in the interface of the corners, and of the points on the sides.
    #[inline(always)]
    pub(super) fn places(&self, g: usize) -> (&[[u32; LANES]], &[[u32; LANES]]) {
        let of_group = 3 * self.segments();
        self.rim[g * of_group..][..of_group].split_at(3)
    }

    /// All points on the rim of the patches of a group, with their places in the interface.
    pub(super) fn rim(&self, g: usize) -> impl Iterator<Item = (usize, &[u32; LANES])> {
        let (corners, sides) = self.places(g);
        let at = self.lattice.corners().into_iter().chain(self.lattice.rim.iter().map(|point| point.at));
        at.zip(corners.iter().chain(sides))
    }

    /// Gives the values at the interface to the patches of a group.
    #[inline(always)]
    pub(super) fn gather<T: Real>(&self, g: usize, interface: &[T], patches: &mut [Lanes<T>]) {
        for (at, places) in self.rim(g) {
            patches[at] = Lanes(places.map(|a| interface[a as usize]));
        }
    }

    /// The number of points on the sides of a patch.
    pub(super) fn on_sides(&self) -> usize {
        self.lattice.rim.len()
    }

    /// Adds what patches have for the points on their sides, group by group.
    pub(super) fn add_sides<T: Real>(&self, sides: &[Lanes<T>], interface: &mut [T]) {
        for (g, sides) in sides.chunks(self.on_sides()).enumerate() {
            for (places, lanes) in self.places(g).1.iter().zip(sides) {
                add_at(interface, places, *lanes);
            }
        }
    }

    /// So many groups are worth a task of their own.
    pub(super) fn task(&self) -> usize {
        BLOCK.div_ceil(LANES * self.lattice.points())
    }

    /// Gives the values on the rim of the patches of a group to the interface.
    pub(super) fn give_rim<T: Real>(&self, g: usize, patches: &[Lanes<T>], interface: &mut [T]) {
        for (at, places) in self.rim(g) {
            for (&a, value) in places.iter().zip(patches[at].0) {
                interface[a as usize] = value;
            }
        }
    }

    /// The places that the interface has on a grid of twice the segments.
    pub(super) fn places_on<'g>(&'g self, finer: &'g Self) -> impl Iterator<Item = usize> + 'g {
        let (m, partition) = (self.segments(), &self.partition);
        let on_edge = move |edge| {
            let first = partition.first_on_edge(edge, finer.segments());
            (1..m).map(move |t| first + 2 * t - 1)
        };
        (0..partition.vertices)
            .chain((0..partition.edges.len()).flat_map(on_edge))
            .chain([finer.interface() - 1])
    }

    /// Whether what is held, and not on the grid with half the segments, lies between two points that are held.
    pub(super) fn is_held_between_held(&self) -> bool {
        let (m, partition) = (self.segments(), &self.partition);
        (0..partition.edges.len()).all(|edge| {
            let at = |t: usize| self.is_held[partition.on_edge(edge, t, m)];
            (1..m).step_by(2).all(|t| !at(t) || (at(t - 1) && at(t + 1)))
        })
    }
}

/// Adds the lanes at these places.
pub(super) fn add_at<T: Real>(values: &mut [T], places: &[u32; LANES], lanes: Lanes<T>) {
    for (&a, lane) in places.iter().zip(lanes.0) {
        values[a as usize] += lane;
    }
}
