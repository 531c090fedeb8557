//! Why a Gmsh file cannot be used.

use std::fmt;

use thiserror::Error;

use crate::text::grouped;

/// A position in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Line of an ASCII file, from 1.
    Line(usize),
    /// Number of bytes of a binary file that were read by then.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// Why a Gmsh file cannot be used. Every message is one line and says what to do.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum GmshError {
    /// No `$MeshFormat` before the mesh.
    #[error(
        "not a Gmsh mesh: there is no section $MeshFormat before the mesh; \
         make a mesh with `gmsh -2 -format msh41 -o plate.msh plate.geo`"
    )]
    NotGmsh,
    /// A version other than 2.0 to 2.2, 4.0 and 4.1.
    #[error(
        "MSH version {found} is not read, only 2 to 2.2, 4.0 and 4.1; \
         convert the file with `gmsh old.msh -save -format msh41 -o new.msh`"
    )]
    Version {
        /// The version that the file declares.
        found: String,
    },
    /// A binary file of MSH 4.0.
    #[error(
        "binary MSH 4.0 is not read, not even by Gmsh itself: \
         mesh the geometry again with `gmsh -2 -format msh41 -o plate.msh plate.geo`"
    )]
    Binary40,
    /// Numbers of a size other than 8 bytes.
    #[error("numbers of {found} bytes are not read, only of 8; write the file with a 64-bit Gmsh")]
    DataSize {
        /// The size that the file declares.
        found: String,
    },
    /// The integer after the header of a binary file is not 1 in either byte order.
    #[error(
        "$MeshFormat: bytes {found:?} where a binary file has the integer 1; \
         the file is damaged (was it copied as text?): write it again with Gmsh"
    )]
    ByteOrder {
        /// The four bytes that were found.
        found: [u8; 4],
    },
    /// Something else than what the format demands, or the end of the file.
    #[error(
        "{place}, ${section}: expected {expected}, found {found}; \
         the file is cut short or damaged: write it again with Gmsh"
    )]
    Syntax {
        /// Where.
        place: Place,
        /// Name of the section.
        section: String,
        /// What the format demands there.
        expected: String,
        /// What stands there.
        found: String,
    },
    /// A count that is negative or larger than the rest of the file can hold.
    #[error(
        "{place}, ${section}: {count} {of} are declared, but {} bytes are left; \
         the file is cut short or damaged: write it again with Gmsh",
        grouped(*left)
    )]
    Count {
        /// Where.
        place: Place,
        /// Name of the section.
        section: String,
        /// What is counted.
        of: &'static str,
        /// The declared number.
        count: i128,
        /// Bytes from there to the end of the file.
        left: usize,
    },
    /// `$Nodes` or `$Elements` twice.
    #[error("{place}: a second section ${section}; put one mesh into a file")]
    RepeatedSection {
        /// Where the second one begins.
        place: Place,
        /// Name of the section.
        section: String,
    },
    /// No `$Nodes`, or not before `$Elements`.
    #[error("there is no section $Nodes before $Elements; write the file again with Gmsh")]
    MissingNodes,
    /// No `$Elements`.
    #[error("there is no section $Elements; mesh the surface (`gmsh -2`) and write the file again with Gmsh")]
    MissingElements,
    /// A coordinate that is infinite or no number.
    #[error("{place}, $Nodes: node {node} has a coordinate {value}; every coordinate must be finite")]
    NotFinite {
        /// Where.
        place: Place,
        /// Its tag.
        node: u64,
        /// The coordinate.
        value: f64,
    },
    /// Two nodes with one tag.
    #[error(
        "$Nodes: nodes number {first} and {second} both have the tag {node}; \
         make the tags unique (`RenumberMeshNodes` in Gmsh)"
    )]
    RepeatedNode {
        /// The tag.
        node: u64,
        /// Number of the first node that has it, from 1.
        first: usize,
        /// Number of the second one.
        second: usize,
    },
    /// A triangle or quadrangle, or a line of a physical group, with a vertex that is not in `$Nodes`.
    #[error(
        "{place}, $Elements: {shape} {element} names the node {node}, which is not in $Nodes; \
         write the file again with Gmsh"
    )]
    UnknownNode {
        /// Where.
        place: Place,
        /// What it is.
        shape: &'static str,
        /// Its tag.
        element: u64,
        /// Tag of the node.
        node: u64,
    },
    /// Elements that are neither points, lines, triangles nor quadrangles.
    #[error("{place}, $Elements: {shape} (element type {code}) are not read; {remedy}")]
    Element {
        /// Where.
        place: Place,
        /// What they are.
        shape: &'static str,
        /// Gmsh's number for them.
        code: i32,
        /// How to get a mesh without them.
        remedy: &'static str,
    },
    /// A quadrangle that neither of its diagonals divides.
    #[error(
        "$Elements: quadrangle {element} cannot be cut in two triangles: its sides cross, or its corners lie on a line; \
         mesh the surface again, or without `Recombine Surface`"
    )]
    Quadrangle {
        /// Its tag.
        element: u64,
    },
    /// Nodes of the mesh that lie in no plane.
    #[error(
        "the mesh is not flat: node {node} is {distance:.3e} away from the plane through the nodes {}, {} and {}; \
         turn the surface into a plane one",
        through[0], through[1], through[2]
    )]
    NotFlat {
        /// Tag of the node.
        node: u64,
        /// Its distance from the plane.
        distance: f64,
        /// Tags of three nodes of the mesh, far from each other.
        through: [u64; 3],
    },
    /// Only points and lines.
    #[error(
        "no triangle or quadrangle among the elements ({} points and lines); mesh the surface (`gmsh -2`), and if there \
         are physical groups, put the surface into one or set Mesh.SaveAll = 1",
        grouped(*others)
    )]
    NoTriangle {
        /// Number of other elements.
        others: usize,
    },
}
