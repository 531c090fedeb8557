//! A checked mesh from a Gmsh file.

use std::io;
use std::path::Path;

use thiserror::Error;

use super::{Mesh, MeshError};
use crate::formats::gmsh::{GmshError, GmshTriangulation, parse};

/// Why a mesh file cannot be used. The messages do not repeat the file's name.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file cannot be read.
    #[error("cannot read the mesh file: {0}")]
    Io(#[from] io::Error),
    /// It is not a mesh that the reader knows.
    #[error(transparent)]
    Gmsh(#[from] GmshError),
    /// Its triangles are no triangulation.
    #[error("{source}{}", element.map_or_else(String::new, |tag| format!(" (triangle {} is Gmsh's element {tag})", source.triangle().unwrap_or(0))))]
    Mesh {
        /// What is wrong.
        source: MeshError,
        /// Gmsh's number of the triangle that it names.
        element: Option<u64>,
    },
}

impl Mesh {
    /// Reads a Gmsh mesh: MSH 2.2 or 4.1, ASCII or binary. Vertices keep the order of the file.
    ///
    /// # Errors
    /// [`ReadError`]: unreadable, not such a file, or no conforming triangulation.
    pub fn read_gmsh(path: &Path) -> Result<Self, ReadError> {
        Self::from_gmsh(&std::fs::read(path)?)
    }

    /// Takes a Gmsh mesh from the bytes of its file, as [`Mesh::read_gmsh`]. Memory and time stay proportional to their number.
    ///
    /// # Errors
    /// [`ReadError`], but for [`ReadError::Io`].
    pub fn from_gmsh(bytes: &[u8]) -> Result<Self, ReadError> {
        let GmshTriangulation { points, triangles, element_tags, .. } = parse(bytes)?;
        Self::new(points, triangles).map_err(|source| {
            let element = source.triangle().and_then(|t| element_tags.get(t).copied());
            ReadError::Mesh { source, element }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square around its centre in four triangles, elements 11 to 14, and a vertex in no triangle.
    const SQUARE: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
6
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
9 7 7 0
5 0.5 0.5 0
$EndNodes
$Elements
4
11 2 2 1 1 1 2 5
12 2 2 1 1 2 3 5
13 2 2 1 1 3 4 5
14 2 2 1 1 1 5 4
$EndElements
";

    fn read(text: &str) -> Result<Mesh, ReadError> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        Mesh::read_gmsh(file.path())
    }

    #[test]
    fn vertices_keep_their_order_and_triangles_are_turned() {
        use super::super::VertexKind::{Boundary, Interior, Unused};
        let mesh = read(SQUARE).unwrap();
        assert_eq!(mesh.kind(), [Boundary, Boundary, Boundary, Boundary, Unused, Interior]);
        assert_eq!(mesh.points()[4..], [[7.0, 7.0], [0.5, 0.5]]);
        assert_eq!(mesh.triangles()[2..], [[2, 3, 5], [0, 5, 3]]);
        assert_eq!(mesh.area(), 1.0);
    }

    #[test]
    fn faults_of_the_mesh_are_named_by_gmshs_numbers_too() {
        let table = [
            (
                "13 2 2 1 1 3 4 5",
                "13 2 2 1 1 3 4 4",
                "triangle 2 (vertices 2, 3, 3) is degenerate: its corners coincide or lie on one line; remove it and mesh again (triangle 2 is Gmsh's element 13)",
            ),
            (
                "13 2 2 1 1 3 4 5",
                "13 2 2 1 1 1 2 5",
                "triangles 0 and 2 are the same (vertices 0, 1, 5): remove one (triangle 0 is Gmsh's element 11)",
            ),
        ];
        for (from, to, message) in table {
            let error = read(&SQUARE.replace(from, to)).expect_err(message);
            assert_eq!(error.to_string(), message);
        }
    }

    #[test]
    fn what_is_no_mesh_file_is_told_from_what_cannot_be_read() {
        assert!(matches!(read(&SQUARE.replace("2.2", "3.0")), Err(ReadError::Gmsh(_))));
        let nowhere = Mesh::read_gmsh(Path::new("no such folder/plate.msh")).expect_err("not there");
        assert!(matches!(nowhere, ReadError::Io(_)));
        assert!(nowhere.to_string().starts_with("cannot read the mesh file: "), "{nowhere}");
    }
}
