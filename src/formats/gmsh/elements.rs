//! The elements of a Gmsh file: triangles are kept, and lines that may belong to a physical group; points are counted, all
//! others are refused.

use super::error::GmshError;
use super::nodes::Nodes;
use super::scanner::Scanner;

/// The kinds of elements that may be in the file of a plane triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Point,
    Line,
    Triangle,
}

impl Kind {
    /// Number of nodes of an element.
    pub(super) fn nodes(self) -> usize {
        match self {
            Self::Point => 1,
            Self::Line => 2,
            Self::Triangle => 3,
        }
    }

    /// The dimension of an element.
    pub(super) fn dimension(self) -> u8 {
        match self {
            Self::Point => 0,
            Self::Line => 1,
            Self::Triangle => 2,
        }
    }

    /// Reads the number that Gmsh gives to a kind of elements (`GmshDefines.h`).
    pub(super) fn read(scanner: &mut Scanner) -> Result<Self, GmshError> {
        let code = scanner.int("an element type")?;
        let (shape, remedy) = match code {
            15 => return Ok(Self::Point),
            1 => return Ok(Self::Line),
            2 => return Ok(Self::Triangle),
            3 | 10 | 16 | 36..=41 | 47..=51 | 57..=61 => {
                ("quadrangles", "mesh without `Recombine Surface` and with Mesh.RecombineAll = 0")
            }
            8 | 9 | 20..=28 | 42..=46 | 52..=56 | 62..=66 => {
                ("elements of higher order", "mesh with Mesh.ElementOrder = 1 (`gmsh -order 1`)")
            }
            4..=7 | 11..=14 | 17..=19 | 29..=33 | 71..=75 | 79..=83 | 90..=132 | 137 => {
                ("volume elements", "mesh a plane surface only (`gmsh -2`)")
            }
            _ => ("such elements", "mesh a plane surface with triangles of three nodes"),
        };
        Err(GmshError::Element { place: scanner.place(), shape, code, remedy })
    }
}

/// What was read from `$Elements`.
#[derive(Default)]
pub(super) struct Elements {
    /// The vertices of every triangle, as indices of nodes.
    pub(super) triangles: Vec<[usize; 3]>,
    /// Tag of every triangle.
    pub(super) tags: Vec<u64>,
    /// Number of points and lines.
    pub(super) others: usize,
    /// Triangles with their labels, in increasing order; one may have several labels, or none.
    pub(super) labels: Vec<(u32, Label)>,
    /// The nodes of the lines that have a label.
    pub(super) lines: Vec<([u32; 2], Label)>,
    /// Lines with a label and a node that is not there.
    pub(super) strays: Vec<Stray>,
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

/// Nodes and triangles are counted in 32 bits: more would take a file of tens of gigabytes.
fn number(n: usize) -> u32 {
    u32::try_from(n).expect("a file has less than 2^32 nodes and triangles")
}

impl Elements {
    /// Appends the triangle whose vertices have the tags `vertices`.
    pub(super) fn add(
        &mut self,
        scanner: &Scanner,
        nodes: &Nodes,
        element: u64,
        vertices: [u64; 3],
    ) -> Result<(), GmshError> {
        let mut triangle = [0; 3];
        for (index, node) in triangle.iter_mut().zip(vertices) {
            *index = nodes.index(node).ok_or_else(|| GmshError::UnknownNode {
                place: scanner.place(),
                shape: "triangle",
                element,
                node,
            })?;
        }
        self.triangles.push(triangle);
        self.tags.push(element);
        Ok(())
    }

    /// The triangle that was appended last has this label.
    pub(super) fn label_triangle(&mut self, label: Label) {
        self.labels.push((number(self.triangles.len() - 1), label));
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
}
