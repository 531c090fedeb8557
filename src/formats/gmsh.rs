//! Reads the triangles of a Gmsh mesh: MSH 2.0 to 2.2 and 4.1, ASCII and binary in either byte order, and MSH 4.0 in ASCII.
//!
//! What the file says is checked here (indices, finite and flat coordinates); whether the triangles form a
//! valid triangulation is for the mesh made from them to decide. Format: Gmsh reference manual, "MSH file format".

mod elements;
mod entities;
mod error;
mod groups;
mod nodes;
mod scanner;
#[cfg(test)]
mod tests;
mod v2;
mod v4;

pub use error::{GmshError, Place};
pub use groups::{GroupMembers, PhysicalGroup};

use crate::text::excerpt;
use elements::Elements;
use entities::{entities, partitioned_entities};
use groups::Groups;
use nodes::Nodes;
use scanner::{ByteOrder, Encoding, Scanner};
use v4::Layout;

/// Largest height of a node above the plane of the mesh, relative to the larger side of the box around the mesh.
///
/// It is the relative accuracy at which Gmsh itself takes two points for one (`Geometry.Tolerance`).
pub const FLATNESS: f64 = 1e-8;

/// The triangles of a Gmsh mesh in a plane `z = constant`, as they stand in the file.
///
/// Points of the file are left out, and lines in no physical group. The nodes that only they use are kept.
#[derive(Debug, Clone, PartialEq)]
pub struct GmshTriangulation {
    /// `(x, y)` of every node, in the order of the file, also of nodes that no triangle uses.
    pub points: Vec<[f64; 2]>,
    /// The three vertices of every triangle, as indices into `points`.
    pub triangles: Vec<[usize; 3]>,
    /// The number that Gmsh gave to each node; as long as `points`, all different.
    pub node_tags: Vec<u64>,
    /// The number that Gmsh gave to each triangle; as long as `triangles`.
    pub element_tags: Vec<u64>,
    /// The physical groups that have a name or members, by dimension and tag, each once.
    pub groups: Vec<PhysicalGroup>,
    /// Which triangles and lines belong to which of `groups`.
    pub members: GroupMembers,
}

/// Reads a mesh from the bytes of a `.msh` file.
///
/// What Gmsh reads is read: other sections, also before `$MeshFormat`, and lines between sections are skipped; the totals at
/// the head of the sections of MSH 4 may be wrong, the blocks count. A surface that is in several physical groups is written
/// several times by MSH 2: each triangle is taken once, and belongs to all of them.
///
/// # Errors
/// When the file is no complete file of these versions, holds elements that are not triangles of three nodes (points and lines
/// aside) or no triangle, names a node that does not exist (in a triangle, or a line of a physical group), or when the triangles are not [flat](FLATNESS). Memory and time
/// stay proportional to the length of `bytes`, whatever the file declares.
pub fn parse(bytes: &[u8]) -> Result<GmshTriangulation, GmshError> {
    let (mut scanner, version) = read_format(bytes)?;
    let mut groups = Groups::default();
    let mut nodes = None;
    let mut elements = None;
    while let Some(section) = scanner.open_section()? {
        if !version.knows(section) {
            scanner.skip_section()?;
            scanner.close_section()?;
            continue;
        }
        scanner.end_line()?;
        match section {
            "Elements" if elements.is_some() => return Err(scanner.repeated_section()),
            "Elements" => {
                let nodes = nodes.as_ref().ok_or(GmshError::MissingNodes)?;
                elements = Some(version.elements(&mut scanner, nodes, &mut groups)?);
            }
            "PhysicalNames" => groups.read_names(&mut scanner, version.names_have_dimensions())?,
            "Entities" => entities(&mut scanner, version.layout(), &mut groups)?,
            "PartitionedEntities" => partitioned_entities(&mut scanner, version.layout(), &mut groups)?,
            _ if nodes.is_some() => return Err(scanner.repeated_section()),
            _ => nodes = Some(version.nodes(&mut scanner, section)?),
        }
        scanner.close_section()?;
    }
    let nodes = nodes.ok_or(GmshError::MissingNodes)?;
    let Elements { triangles, tags, others, labels, lines, strays } =
        elements.ok_or(GmshError::MissingElements)?;
    if triangles.is_empty() {
        return Err(GmshError::NoTriangle { others });
    }
    check_flat(&nodes, &triangles)?;
    let Nodes { points, tags: node_tags, .. } = nodes;
    let (groups, members) = groups.of_elements(&scanner, labels, lines, &strays)?;
    Ok(GmshTriangulation { points, triangles, node_tags, element_tags: tags, groups, members })
}

/// The layouts of the sections.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Version {
    V20,
    /// MSH 2.1 and 2.2.
    V21,
    V40,
    V41,
}

impl Version {
    /// The one with this number.
    fn from_number(number: f64) -> Option<Self> {
        match number {
            2.0 => Some(Self::V20),
            2.1 | 2.2 => Some(Self::V21),
            4.0 => Some(Self::V40),
            4.1 => Some(Self::V41),
            _ => None,
        }
    }

    /// Whether it has a section of this name that is read; the others are skipped.
    fn knows(self, section: &str) -> bool {
        match section {
            "Nodes" | "Elements" | "PhysicalNames" => true,
            "ParametricNodes" => matches!(self, Self::V20 | Self::V21),
            "Entities" | "PartitionedEntities" => matches!(self, Self::V40 | Self::V41),
            _ => false,
        }
    }

    fn names_have_dimensions(self) -> bool {
        self != Self::V20
    }

    /// That of the sections of MSH 4.
    fn layout(self) -> Layout {
        if self == Self::V40 { Layout::V40 } else { Layout::V41 }
    }

    fn nodes(self, scanner: &mut Scanner, section: &str) -> Result<Nodes, GmshError> {
        match self {
            Self::V20 | Self::V21 => v2::nodes(scanner, section == "ParametricNodes"),
            Self::V40 | Self::V41 => v4::nodes(scanner, self.layout()),
        }
    }

    fn elements(
        self,
        scanner: &mut Scanner,
        nodes: &Nodes,
        groups: &mut Groups,
    ) -> Result<Elements, GmshError> {
        match self {
            Self::V20 | Self::V21 => v2::elements(scanner, nodes, groups),
            Self::V40 | Self::V41 => v4::elements(scanner, self.layout(), nodes),
        }
    }
}

/// Goes to `$MeshFormat`, over comments and sections that may stand before it.
fn find_format(scanner: &mut Scanner) -> Result<(), GmshError> {
    loop {
        match scanner.open_section() {
            Ok(Some("MeshFormat")) => return scanner.end_line(),
            Ok(Some("NOD" | "NOE")) => return Err(GmshError::Version { found: "1".into() }),
            Ok(Some("Nodes" | "ParametricNodes" | "Elements") | None) | Err(_) => {
                return Err(GmshError::NotGmsh);
            }
            Ok(Some(_)) => {
                scanner.skip_section().map_err(|_| GmshError::NotGmsh)?;
                scanner.close_section()?;
            }
        }
    }
}

/// Reads `$MeshFormat`, which tells how to read the rest.
fn read_format(bytes: &[u8]) -> Result<(Scanner<'_>, Version), GmshError> {
    let mut scanner = Scanner::new(bytes);
    find_format(&mut scanner)?;
    let found = scanner.word("the version of the format")?;
    let version = found.parse().ok().and_then(Version::from_number);
    let version = version.ok_or_else(|| GmshError::Version { found: excerpt(found) })?;
    let binary = match scanner.word("the type of the file")? {
        "0" => false,
        "1" => true,
        found => return Err(scanner.unexpected("the type of the file, 0 or 1", found)),
    };
    let size = scanner.word("the size of a number")?;
    scanner.end_line()?;
    if binary {
        if version == Version::V40 {
            return Err(GmshError::Binary40);
        }
        if size != "8" {
            return Err(GmshError::DataSize { found: excerpt(size) });
        }
        let order = match scanner.bytes("the integer 1 that shows the byte order")? {
            [1, 0, 0, 0] => ByteOrder::Little,
            [0, 0, 0, 1] => ByteOrder::Big,
            found => return Err(GmshError::ByteOrder { found }),
        };
        scanner.set_encoding(Encoding::Binary(order));
    }
    scanner.close_section()?;
    Ok((scanner, version))
}

/// Demands that the nodes of the triangles lie in one plane `z = constant`.
fn check_flat(nodes: &Nodes, triangles: &[[usize; 3]]) -> Result<(), GmshError> {
    let used = || triangles.iter().flatten().copied();
    let side = |axis: usize| {
        let bounds = used().map(|k| nodes.points[k][axis]);
        let (low, high) =
            bounds.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        // Scaled before the difference, which could overflow.
        FLATNESS * high - FLATNESS * low
    };
    let tolerance = side(0).max(side(1));
    let plane = nodes.heights[triangles[0][0]];
    match used().find(|&k| (nodes.heights[k] - plane).abs() > tolerance) {
        Some(k) => Err(GmshError::NotFlat { node: nodes.tags[k], height: nodes.heights[k], plane }),
        None => Ok(()),
    }
}
