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

    /// Follows the partition of the finer level at the `touched` vertices: where that has changed something here.
    ///
    /// Membranes move as one where they do so at all vertices that a coarse hat function reaches: the coarse functions of two such
    /// membranes are the same. `held` entries do not move.
    pub(super) fn follow(
        &mut self,
        fine: &Self,
        transfer: &Transfer,
        held: &[bool],
        touched: &[u32],
    ) -> Vec<u32> {
        let n = self.membranes;
        let lens_of = |part: &[u32]| -> Vec<u16> {
            let mut lens = vec![0; part.len() * n];
            for (&a, lens) in part.iter().zip(lens.chunks_exact_mut(n)) {
                fine.common_blocks(transfer, a as usize, &held[a as usize * n..][..n], lens);
            }
            lens
        };
        let all_lens: Vec<Vec<u16>> = touched.par_chunks(BLOCK).map(lens_of).collect();
        let mut changed = Vec::new();
        for (part, lens) in touched.chunks(BLOCK).zip(&all_lens) {
            for (&a, lens) in part.iter().zip(lens.chunks_exact(n)) {
                if self.lens(a as usize) != lens {
                    changed.push(a);
                    let range = a as usize * n..(a as usize + 1) * n;
                    let mut blocks =
                        Blocks { first: &mut self.first[range.clone()], len: &mut self.len[range] };
                    blocks.clear();
                    for (start, &len) in lens.iter().enumerate().filter(|(_, len)| **len != 0) {
                        blocks.add(start, start + len as usize);
                    }
                }
            }
        }
        changed
    }

    /// What moves as one on all vertices that the hat function of a coarse one reaches: the lengths of the blocks.
    fn common_blocks(&self, transfer: &Transfer, a: usize, held: &[bool], lens: &mut [u16]) {
        let moves_at = |i: usize, p: usize| self.len[self.block(i, p)] != 0;
        let moves = |p: usize| !held[p] && transfer.children(a).any(|(i, _)| moves_at(i, p));
        // With the one above: everywhere in one block, or neither moves.
        let is_joined = |p: usize| {
            let is_one =
                |i: usize| self.block(i, p) == self.block(i, p - 1) || !moves_at(i, p) && !moves_at(i, p - 1);
            transfer.children(a).all(|(i, _)| is_one(i))
        };
        let mut p = 0;
        while p < lens.len() {
            let start = p;
            p += 1;
            if moves(start) {
                while p < lens.len() && is_joined(p) && moves(p) {
                    p += 1;
                }
                lens[start] = (p - start) as u16;
            }
        }
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
