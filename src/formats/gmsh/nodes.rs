//! The nodes of a Gmsh file, found by their tags.

mod plane;

pub use plane::FLATNESS;
pub(super) use plane::flatten;

use super::error::GmshError;
use super::scanner::Scanner;

/// All nodes in the order of the file.
pub(super) struct Nodes {
    /// `(x, y)` of every node.
    pub(super) points: Vec<[f64; 2]>,
    /// `z` of every node.
    pub(super) heights: Vec<f64>,
    /// Tag of every node.
    pub(super) tags: Vec<u64>,
    /// Tag and index of every node, sorted.
    by_tag: Vec<(u64, usize)>,
}

impl Nodes {
    /// Puts the nodes in order; the three vectors have one length.
    pub(super) fn new(tags: Vec<u64>, points: Vec<[f64; 2]>, heights: Vec<f64>) -> Result<Self, GmshError> {
        let mut by_tag: Vec<_> = tags.iter().copied().zip(0..).collect();
        by_tag.sort_unstable();
        if let Some(twice) = by_tag.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let (first, second) = (twice[0].1 + 1, twice[1].1 + 1);
            return Err(GmshError::RepeatedNode { node: twice[0].0, first, second });
        }
        Ok(Self { points, heights, tags, by_tag })
    }

    /// Takes nodes out; the new number of each that is left.
    pub(super) fn without(&mut self, dropped: &[bool]) -> Vec<u32> {
        let mut kept = 0;
        let next = |&dropped: &bool| {
            kept += u32::from(!dropped);
            kept.wrapping_sub(1)
        };
        let renumbered: Vec<u32> = dropped.iter().map(next).collect();
        let is_kept = || dropped.iter().map(|dropped| !dropped);
        retain(&mut self.points, is_kept());
        retain(&mut self.heights, is_kept());
        retain(&mut self.tags, is_kept());
        self.by_tag.retain(|&(_, k)| !dropped[k]);
        self.by_tag.iter_mut().for_each(|(_, k)| *k = renumbered[*k] as usize);
        renumbered
    }

    /// Index of the node that has this tag.
    pub(super) fn index(&self, tag: u64) -> Option<usize> {
        let last = self.by_tag.len().checked_sub(1)?;
        let below = tag.checked_sub(self.by_tag[0].0)?;
        let above = self.by_tag[last].0.checked_sub(tag)?;
        // The tags are distinct, so at most `below` of them are smaller and at most `above` larger: where few
        // numbers are left out, hardly anything remains to be searched.
        let within = |distance: u64| usize::try_from(distance).map_or(last, |distance| distance.min(last));
        let low = last - within(above);
        let candidates = &self.by_tag[low..=within(below)];
        let found = candidates.binary_search_by_key(&tag, |&(tag, _)| tag).ok()?;
        Some(candidates[found].1)
    }
}

fn retain<T>(values: &mut Vec<T>, mut is_kept: impl Iterator<Item = bool>) {
    values.retain(|_| is_kept.next() == Some(true));
}

/// Reads the coordinates of a node and appends them to `points` and `heights`.
pub(super) fn read_point(
    scanner: &mut Scanner,
    node: u64,
    points: &mut Vec<[f64; 2]>,
    heights: &mut Vec<f64>,
) -> Result<(), GmshError> {
    let mut coordinate = |expected| {
        let value = scanner.double(expected)?;
        if !value.is_finite() {
            return Err(GmshError::NotFinite { place: scanner.place(), node, value });
        }
        Ok(value)
    };
    points.push([coordinate("the x of a node")?, coordinate("the y of a node")?]);
    heights.push(coordinate("the z of a node")?);
    Ok(())
}
