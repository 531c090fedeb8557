//! Which membranes move as one at each vertex, on the finest level of a cycle and, after it, on the coarser ones.

use crate::multigrid::hierarchy::Transfer;
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;

/// At each vertex, consecutive membranes that move as one form a block; its first member stands for it. Entry `a N + i` belongs to membrane
/// `i` (from 0) at vertex `a`.
#[derive(Debug, Clone, Default)]
pub(super) struct Partition {
    membranes: usize,
    /// The first membrane of the block; itself where it does not move.
    first: Vec<u16>,
    /// Members of the block at its first one, zero at others; and where nothing moves.
    len: Vec<u16>,
}

/// The blocks at one vertex.
#[derive(Debug)]
pub(super) struct Blocks<'a> {
    first: &'a mut [u16],
    len: &'a mut [u16],
}

impl Blocks<'_> {
    /// Nothing moves, as far as no block is added.
    fn clear(&mut self) {
        self.len.fill(0);
        (0..).zip(&mut *self.first).for_each(|(i, first)| *first = i);
    }

    /// These membranes move as one.
    pub(super) fn add(&mut self, start: usize, end: usize) {
        self.first[start..end].fill(start as u16);
        self.len[start] = (end - start) as u16;
    }
}

impl Partition {
    /// Nothing moves.
    pub(super) fn new(vertices: usize, membranes: usize) -> Self {
        let first = (0..vertices).flat_map(|_| 0..membranes as u16).collect();
        Self { membranes, first, len: vec![0; vertices * membranes] }
    }

    pub(super) fn membranes(&self) -> usize {
        self.membranes
    }

    /// The vertex of an entry.
    #[inline(always)]
    pub(super) fn vertex(&self, entry: usize) -> usize {
        entry / self.membranes
    }

    /// The entry of the block of an entry; its own where it does not move.
    #[inline(always)]
    pub(super) fn block(&self, a: usize, i: usize) -> usize {
        let at = a * self.membranes;
        at + self.first[at + i] as usize
    }

    /// How many membranes move with the first one of a block; zero at entries that are no block.
    #[inline(always)]
    pub(super) fn len(&self, entry: usize) -> usize {
        self.len[entry] as usize
    }

    /// The lengths at a vertex.
    #[inline(always)]
    pub(super) fn lens(&self, a: usize) -> &[u16] {
        &self.len[a * self.membranes..][..self.membranes]
    }

    /// How many blocks there are.
    #[cfg(test)]
    pub(super) fn blocks(&self) -> usize {
        self.len.iter().filter(|&&len| len != 0).count()
    }

    /// The blocks at `count` vertices each, to be made anew.
    pub(super) fn chunks(&mut self, count: usize) -> impl Iterator<Item = PartitionChunk<'_>> {
        let (size, membranes) = (count * self.membranes, self.membranes);
        let parts = self.first.chunks_mut(size).zip(self.len.chunks_mut(size));
        parts.map(move |(first, len)| PartitionChunk { membranes, first, len, old: Vec::new() })
    }

    /// The partition of the coarser level, where `held` entries do not move: membranes move as one where they do so at all vertices
    /// that a coarse hat function reaches. The coarse functions of two such membranes are the same.
    pub(super) fn coarsened(&self, transfer: &Transfer, held: &[bool]) -> Self {
        let n = self.membranes;
        let mut coarse = Self::new(transfer.coarse_rows(), n);
        let chunks = coarse.first.par_chunks_mut(BLOCK * n).zip(coarse.len.par_chunks_mut(BLOCK * n));
        chunks.enumerate().for_each(|(k, (first, len))| {
            let (mut moves, mut joined) = (vec![false; n], vec![false; n]);
            for (a, (first, len)) in (k * BLOCK..).zip(first.chunks_mut(n).zip(len.chunks_mut(n))) {
                moves.fill(false);
                joined.fill(true);
                for (i, _) in transfer.children(a) {
                    for p in 0..n {
                        let moves_here = self.len[self.block(i, p)] != 0;
                        moves[p] |= moves_here;
                        // With the one above: in one block, or neither moves.
                        joined[p] &= p > 0
                            && (self.block(i, p) == self.block(i, p - 1)
                                || !moves_here && self.len[self.block(i, p - 1)] == 0);
                    }
                }
                let held = &held[a * n..][..n];
                let mut blocks = Blocks { first, len };
                blocks.clear();
                let is_free = |p: usize| moves[p] && !held[p];
                let mut p = 0;
                while p < n {
                    let start = p;
                    p += 1;
                    if is_free(start) {
                        while p < n && is_free(p) && joined[p] {
                            p += 1;
                        }
                        blocks.add(start, p);
                    }
                }
            }
        });
        coarse
    }
}

/// The blocks at consecutive vertices.
pub(super) struct PartitionChunk<'a> {
    membranes: usize,
    first: &'a mut [u16],
    len: &'a mut [u16],
    old: Vec<u16>,
}

impl PartitionChunk<'_> {
    /// Makes those at the `k`-th vertex anew: whether they have changed.
    pub(super) fn renew(&mut self, k: usize, make: impl FnOnce(&mut Blocks)) -> bool {
        let range = k * self.membranes..(k + 1) * self.membranes;
        let mut blocks = Blocks { first: &mut self.first[range.clone()], len: &mut self.len[range] };
        self.old.clear();
        self.old.extend_from_slice(blocks.len);
        blocks.clear();
        make(&mut blocks);
        *self.old != *blocks.len
    }
}
