//! Reads the triangles of a Gmsh mesh: MSH 2.2 and 4.1, ASCII and binary in either byte order.
//!
//! What the file says is checked here (indices, finite and flat coordinates); whether the triangles form a
//! valid triangulation is for the mesh made from them to decide. Format: Gmsh reference manual, "MSH file format".

mod elements;
mod error;
mod nodes;
mod scanner;
#[cfg(test)]
mod tests;
mod v2;
mod v4;

pub use error::{GmshError, Place};

use crate::text::excerpt;
use elements::Elements;
use nodes::Nodes;
use scanner::{ByteOrder, Encoding, Scanner};

/// Largest height of a node above the plane of the mesh, relative to the larger side of the box around the mesh.
///
/// It is the relative accuracy at which Gmsh itself takes two points for one (`Geometry.Tolerance`).
pub const FLATNESS: f64 = 1e-8;

/// The triangles of a Gmsh mesh in a plane `z = constant`, as they stand in the file.
///
/// Points, lines and physical groups of the file are left out. The nodes that only they use are kept.
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
}

/// Reads a mesh from the bytes of a `.msh` file.
///
/// Sections other than `$Nodes` and `$Elements` are skipped. A surface that is in several physical groups is
/// written several times by MSH 2.2: each triangle is taken once.
///
/// # Errors
/// When the file is no complete MSH 2.2 or 4.1 file, holds text outside its sections, holds elements that are
/// not triangles of three nodes (points and lines aside) or no triangle, names a node that does not exist, or
/// when the triangles are not [flat](FLATNESS). Memory and time stay proportional to the length of `bytes`,
/// whatever the file declares.
pub fn parse(bytes: &[u8]) -> Result<GmshTriangulation, GmshError> {
    let (mut scanner, version) = read_format(bytes)?;
    let mut nodes = None;
    let mut elements = None;
    while let Some(section) = scanner.open_section()? {
        match section {
            "Nodes" if nodes.is_some() => return Err(scanner.repeated_section()),
            "Elements" if elements.is_some() => return Err(scanner.repeated_section()),
            "Nodes" => nodes = Some(version.nodes(&mut scanner)?),
            "Elements" => {
                let nodes = nodes.as_ref().ok_or(GmshError::MissingNodes)?;
                elements = Some(version.elements(&mut scanner, nodes)?);
            }
            "ParametricNodes" => return Err(GmshError::ParametricNodes),
            _ => scanner.skip_section()?,
        }
        scanner.close_section()?;
    }
    let nodes = nodes.ok_or(GmshError::MissingNodes)?;
    let elements = elements.ok_or(GmshError::MissingElements)?;
    if elements.triangles.is_empty() {
        return Err(GmshError::NoTriangle { others: elements.others });
    }
    check_flat(&nodes, &elements.triangles)?;
    Ok(GmshTriangulation {
        points: nodes.points,
        triangles: elements.triangles,
        node_tags: nodes.tags,
        element_tags: elements.tags,
    })
}

/// The two layouts of `$Nodes` and `$Elements`.
enum Version {
    V2,
    V4,
}

impl Version {
    fn nodes(&self, scanner: &mut Scanner) -> Result<Nodes, GmshError> {
        match self {
            Self::V2 => v2::nodes(scanner),
            Self::V4 => v4::nodes(scanner),
        }
    }

    fn elements(&self, scanner: &mut Scanner, nodes: &Nodes) -> Result<Elements, GmshError> {
        match self {
            Self::V2 => v2::elements(scanner, nodes),
            Self::V4 => v4::elements(scanner, nodes),
        }
    }
}

/// Reads `$MeshFormat`, which tells how to read the rest.
fn read_format(bytes: &[u8]) -> Result<(Scanner<'_>, Version), GmshError> {
    let mut scanner = Scanner::new(bytes);
    match scanner.open_section() {
        Ok(Some("MeshFormat")) => {}
        Ok(Some("NOD")) => return Err(GmshError::Version { found: "1".into() }),
        _ => return Err(GmshError::NotGmsh),
    }
    let found = scanner.word("the version of the format")?;
    let version = match found.parse::<f64>() {
        Ok(2.2) => Version::V2,
        Ok(4.1) => Version::V4,
        _ => return Err(GmshError::Version { found: excerpt(found) }),
    };
    let binary = match scanner.word("the type of the file")? {
        "0" => false,
        "1" => true,
        found => return Err(scanner.unexpected("the type of the file, 0 or 1", found)),
    };
    match scanner.word("the size of a number")? {
        "8" => {}
        found => return Err(GmshError::DataSize { found: excerpt(found) }),
    }
    scanner.end_line()?;
    if binary {
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
