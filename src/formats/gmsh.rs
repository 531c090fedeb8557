//! Reads the triangles and quadrangles of a Gmsh mesh: MSH 2.0 to 2.2 and 4.1, ASCII and binary in either byte order, and MSH 4.0 in ASCII.
//!
//! What the file says is checked here (indices, finite coordinates in one plane); whether the triangles form a
//! valid triangulation is for the mesh made from them to decide. Format: Gmsh reference manual, "MSH file format".

mod elements;
mod entities;
mod error;
mod groups;
mod nodes;
mod note;
mod scanner;
#[cfg(test)]
mod tests;
mod v2;
mod v4;
mod views;

pub use error::{GmshError, Place};
pub use groups::{GroupMembers, PhysicalGroup};
pub use nodes::FLATNESS;
pub use note::GmshNote;
pub use views::{GmshView, ViewData, ViewFault, ViewPlace};

use crate::text::excerpt;
use elements::{CellsOfTags, Elements, corners, cut};
use entities::{entities, partitioned_entities};
use groups::Groups;
use nodes::{Nodes, flatten};
use scanner::{ByteOrder, Encoding, Scanner};
use v4::Layout;
use views::Views;

/// The triangles of a plane Gmsh mesh, in the order of the file.
///
/// Quadrangles are cut in two, along the shorter of their diagonals (of those that lie inside). Of elements of higher order
/// the corners are taken. Points of the file are left out, and lines in no physical group. The nodes that only they use are kept,
/// those between the corners of elements of higher order are not. A mesh in a plane of space gets its coordinates in that plane.
#[derive(Debug, Clone, PartialEq)]
pub struct GmshTriangulation {
    /// The coordinates of every node in the plane, in the order of the file, also of nodes that no triangle uses.
    pub points: Vec<[f64; 2]>,
    /// The three vertices of every triangle, as indices into `points`.
    pub triangles: Vec<[usize; 3]>,
    /// The number that Gmsh gave to each node; as long as `points`, all different.
    pub node_tags: Vec<u64>,
    /// The number that Gmsh gave to the element of each triangle; as long as `triangles`.
    pub element_tags: Vec<u64>,
    /// The physical groups that have a name or members, by dimension and tag, each once.
    pub groups: Vec<PhysicalGroup>,
    /// Which triangles and lines belong to which of `groups`.
    pub members: GroupMembers,
    /// The data views, by name.
    pub views: Vec<GmshView>,
    /// What was done to make it a mesh of plane triangles.
    pub notes: Vec<GmshNote>,
}

/// Reads a mesh from the bytes of a `.msh` file.
///
/// What Gmsh reads is read: data views by name; the mesh once more before a view that was appended; other sections, also before `$MeshFormat`, and lines between sections are skipped; the totals at
/// the head of the sections of MSH 4 may be wrong, the blocks count. A surface that is in several physical groups is written
/// several times by MSH 2: each triangle is taken once, and belongs to all of them.
///
/// # Errors
/// When the file is no complete file of these versions, holds elements that are not points, lines, triangles or quadrangles, or
/// no triangle or quadrangle, names a node that does not exist (as a corner, or in a line of a physical group), or when the mesh lies in no plane
/// up to [`FLATNESS`], or a quadrangle cannot be cut in two. Memory and time
/// stay proportional to the length of `bytes`, whatever the file declares.
pub fn parse(bytes: &[u8]) -> Result<GmshTriangulation, GmshError> {
    read_sections(bytes)?.triangulation()
}

/// What the sections of a file say.
struct Sections<'a> {
    scanner: Scanner<'a>,
    nodes: Nodes,
    elements: Elements,
    groups: Groups,
    views: Views,
}

fn read_sections(bytes: &[u8]) -> Result<Sections<'_>, GmshError> {
    let (mut scanner, version) = read_format(bytes)?;
    let mut groups = Groups::default();
    let mut views = Views::default();
    let mut nodes: Option<Repeatable<Nodes>> = None;
    let mut elements: Option<Repeatable<Elements>> = None;
    while let Some(section) = scanner.open_section()? {
        if !version.knows(section) {
            scanner.skip_section()?;
            scanner.close_section()?;
            continue;
        }
        scanner.end_line()?;
        let start = scanner.index();
        match section {
            "Elements" => match &elements {
                Some(elements) => scanner.skip_repeated(elements.body)?,
                None => {
                    let nodes = &nodes.as_ref().ok_or(GmshError::MissingNodes)?.content;
                    let content = version.elements(&mut scanner, nodes, &mut groups)?;
                    elements = Some(Repeatable { content, body: scanner.body_since(start) });
                }
            },
            "PhysicalNames" => groups.read_names(&mut scanner, version.names_have_dimensions())?,
            "Entities" => entities(&mut scanner, version.layout(), &mut groups)?,
            "PartitionedEntities" => partitioned_entities(&mut scanner, version.layout(), &mut groups)?,
            "NodeData" => views.read(&mut scanner, ViewPlace::Vertices)?,
            "ElementData" => views.read(&mut scanner, ViewPlace::Triangles)?,
            "ElementNodeData" => views.skip_element_nodes(&mut scanner)?,
            _ => match &nodes {
                Some(nodes) => scanner.skip_repeated(nodes.body)?,
                None => {
                    let content = version.nodes(&mut scanner, section)?;
                    nodes = Some(Repeatable { content, body: scanner.body_since(start) });
                }
            },
        }
        scanner.close_section()?;
    }
    let nodes = nodes.ok_or(GmshError::MissingNodes)?.content;
    let elements = elements.ok_or(GmshError::MissingElements)?.content;
    Ok(Sections { scanner, nodes, elements, groups, views })
}

impl Sections<'_> {
    /// The plane triangles, and what belongs to them.
    fn triangulation(self) -> Result<GmshTriangulation, GmshError> {
        let Self { scanner, mut nodes, mut elements, groups, views } = self;
        if elements.cells.is_empty() {
            return Err(GmshError::NoTriangle { others: elements.others });
        }
        elements.drop_between(&mut nodes);
        let Elements { cells, tags, curved, labels, lines, strays, repetitions, .. } = elements;
        let plane = flatten(&mut nodes, || cells.iter().flat_map(corners).map(|&a| a as usize))?;
        let cells_of_tags = views.are_on_elements().then(|| CellsOfTags::new(&tags, &repetitions));
        let cut = cut(&cells, tags, &nodes.points)?;
        let of_element = |tag| {
            let cell = cells_of_tags.as_ref().and_then(|cells| cells.cell(tag));
            cell.map_or(0..0, |cell| cut.of_cell(cell))
        };
        let views = views.on_mesh(|node| nodes.index(node).map(|a| a as u32), of_element);
        let (groups, mut members) = groups.of_elements(&scanner, labels, lines, &strays)?;
        let halves = |(cell, part)| cut.of_cell(cell).map(move |t| (t, part));
        members.triangles = members.triangles.into_iter().flat_map(halves).collect();
        let quadrangles = cut.quadrangles();
        let curved = (curved > 0).then_some(GmshNote::HigherOrder { elements: curved });
        let quadrangles = (quadrangles > 0).then_some(GmshNote::Quadrangles { quadrangles });
        let left_out = views.iter().filter_map(GmshView::left_out);
        let notes = [curved, quadrangles, plane].into_iter().flatten().chain(left_out).collect();
        let (triangles, element_tags) = (cut.triangles, cut.tags);
        let Nodes { points, tags: node_tags, .. } = nodes;
        Ok(GmshTriangulation { points, triangles, node_tags, element_tags, groups, members, views, notes })
    }
}

/// A section that Gmsh writes again before each view that it appends to a file.
struct Repeatable<'a, T> {
    content: T,
    /// What stands in it.
    body: &'a [u8],
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
            "NodeData" | "ElementData" | "ElementNodeData" => true,
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
