//! The elements of a Gmsh file: triangles are kept, points and lines are counted, all others are refused.

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
                element,
                node,
            })?;
        }
        self.triangles.push(triangle);
        self.tags.push(element);
        Ok(())
    }
}
