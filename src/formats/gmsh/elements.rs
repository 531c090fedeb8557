//! The elements of a Gmsh file: triangles and quadrangles are kept, and lines that may belong to a physical group; points are
//! counted, all others are refused. Of elements of higher order the corners are kept.

mod cut;
mod kind;

pub(super) use cut::cut;
pub(super) use kind::{Kind, Shape};

use super::error::GmshError;
use super::nodes::Nodes;
use super::scanner::Scanner;

/// The fourth corner of a triangle.
const NO_NODE: u32 = u32::MAX;

/// The corners of a triangle or a quadrangle, as indices of nodes: three and [`NO_NODE`], or four in their order around it.
pub(super) type Cell = [u32; 4];

/// The corners that there are.
pub(super) fn corners(cell: &Cell) -> &[u32] {
    if cell[3] == NO_NODE { &cell[..3] } else { cell }
}

/// What was read from `$Elements`.
#[derive(Default)]
pub(super) struct Elements {
    /// The triangles and quadrangles.
    pub(super) cells: Vec<Cell>,
    /// Tag of each of them.
    pub(super) tags: Vec<u64>,
    /// Tags of cells that repeat another one, and that one. Only MSH 2 has such, where a tag is an `int`.
    pub(super) repetitions: Vec<(u32, u32)>,
    /// Number of points and lines.
    pub(super) others: usize,
    /// Number of lines, triangles and quadrangles of higher order.
    pub(super) curved: usize,
    /// Cells with their labels, in increasing order; one may have several labels, or none.
    pub(super) labels: Vec<(u32, Label)>,
    /// The nodes of the lines that have a label.
    pub(super) lines: Vec<([u32; 2], Label)>,
    /// Lines with a label and a node that is not there.
    pub(super) strays: Vec<Stray>,
    /// For each node whether an element of higher order has it between its corners; empty where none has.
    between: Vec<bool>,
}

/// What tells the groups of an element: the group itself in MSH 2, the entity of the geometry in MSH 4.
pub(super) type Label = u32;

/// A line with a node that is not there: an error where it belongs to a group, which the end of the file may tell.
pub(super) struct Stray {
    pub(super) label: Label,
    /// Index of a byte of the line.
    pub(super) at: usize,
    pub(super) element: u64,
    pub(super) node: u64,
}

/// Nodes and cells are counted in 32 bits: more would take a file of tens of gigabytes.
fn number(n: usize) -> u32 {
    u32::try_from(n).ok().filter(|&n| n != NO_NODE).expect("a file has less than 2^32 - 1 nodes and elements")
}

impl Elements {
    /// Appends the triangle or quadrangle whose corners have the tags `corners`.
    pub(super) fn add_cell(
        &mut self,
        scanner: &Scanner,
        nodes: &Nodes,
        element: u64,
        corners: &[u64],
    ) -> Result<(), GmshError> {
        let mut cell = [NO_NODE; 4];
        let shape = if corners.len() == 3 { "triangle" } else { "quadrangle" };
        for (index, &node) in cell.iter_mut().zip(corners) {
            let unknown = || GmshError::UnknownNode { place: scanner.place(), shape, element, node };
            *index = number(nodes.index(node).ok_or_else(unknown)?);
        }
        self.cells.push(cell);
        self.tags.push(element);
        Ok(())
    }

    /// Drops the last cell if it repeats the one before: for a surface in several physical groups MSH 2 has each
    /// cell once per group, one right behind the other (a negative group reverses it).
    pub(super) fn drop_repetition(&mut self) {
        let sorted = |mut cell: Cell| {
            cell.sort_unstable();
            cell
        };
        if let [.., before, last] = self.cells[..]
            && sorted(before) == sorted(last)
        {
            self.cells.pop();
            let tag = self.tags.pop().and_then(|tag| u32::try_from(tag).ok());
            let kept = self.last_cell();
            self.repetitions.extend(tag.map(|tag| (tag, kept)));
        }
    }

    /// The cell that was appended last has this label.
    pub(super) fn label_cell(&mut self, label: Label) {
        self.labels.push((self.last_cell(), label));
    }

    fn last_cell(&self) -> u32 {
        number(self.cells.len() - 1)
    }

    /// Appends the line whose ends have the tags `ends`.
    pub(super) fn add_line(
        &mut self,
        scanner: &Scanner,
        nodes: &Nodes,
        element: u64,
        ends: [u64; 2],
        label: Label,
    ) {
        let stray = |node| Stray { label, at: scanner.index(), element, node };
        match ends.map(|node| nodes.index(node).ok_or(node)) {
            [Ok(a), Ok(b)] => self.lines.push(([number(a), number(b)], label)),
            [Err(node), _] | [_, Err(node)] => self.strays.push(stray(node)),
        }
    }

    /// An element of higher order has this node between its corners. One that is not there is not missed.
    pub(super) fn add_between(&mut self, nodes: &Nodes, node: u64) {
        if self.between.is_empty() {
            self.between = vec![false; nodes.tags.len()];
        }
        if let Some(index) = nodes.index(node) {
            self.between[index] = true;
        }
    }

    /// Drops the nodes that are nothing but between the corners of others.
    pub(super) fn drop_between(&mut self, nodes: &mut Nodes) {
        let mut dropped = std::mem::take(&mut self.between);
        if dropped.is_empty() {
            return;
        }
        let ends = self.lines.iter().flat_map(|(ends, _)| ends);
        ends.chain(self.cells.iter().flat_map(corners)).for_each(|&a| dropped[a as usize] = false);
        let renumbered = nodes.without(&dropped);
        let renumber = |a: &mut u32| *a = renumbered[*a as usize];
        self.lines.iter_mut().flat_map(|(ends, _)| ends).for_each(renumber);
        self.cells.iter_mut().flatten().filter(|a| **a != NO_NODE).for_each(renumber);
    }
}

/// Finds cells by the tags of their elements.
pub(super) struct CellsOfTags(Vec<(u64, u32)>);

impl CellsOfTags {
    pub(super) fn new(tags: &[u64], repetitions: &[(u32, u32)]) -> Self {
        let repeated = repetitions.iter().map(|&(tag, cell)| (u64::from(tag), cell));
        let mut cells: Vec<_> = tags.iter().copied().zip(0..).chain(repeated).collect();
        cells.sort_unstable();
        Self(cells)
    }

    /// The cell that has this tag, of several the first.
    pub(super) fn cell(&self, tag: u64) -> Option<u32> {
        let found = self.0.get(self.0.partition_point(|&(other, _)| other < tag))?;
        (found.0 == tag).then_some(found.1)
    }
}
