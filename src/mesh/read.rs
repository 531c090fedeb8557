//! A checked mesh from a Gmsh file.

mod named;

use std::io;
use std::path::Path;

use thiserror::Error;

use super::views::Views;
use super::{Mesh, MeshError};
use crate::formats::gmsh::{GmshError, GmshNote, GmshTriangulation, PhysicalGroup, parse};
use crate::formats::read_regular;
use named::named_parts;

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
    #[error("{source}{}", in_gmsh(elements, nodes))]
    Mesh {
        /// What is wrong.
        source: MeshError,
        /// The triangles that it names, and Gmsh's numbers of them.
        elements: Vec<(usize, u64)>,
        /// The vertices that it names, and Gmsh's numbers of them.
        nodes: Vec<(usize, u64)>,
    },
}

/// A mesh from a Gmsh file, and what the file calls its parts.
#[derive(Debug, Clone)]
pub struct GmshMesh {
    /// The mesh, its vertices in the order of the file. Its regions and curves are the physical groups of surfaces and curves;
    /// those without a name are called as they are printed: `curves 2`, `surfaces 1`. Lines that are no edges of triangles
    /// are left out of their curves, which may be left empty. It has the data views of the file.
    pub mesh: Mesh,
    /// The number that Gmsh gave to each vertex. Shape: vertices.
    pub node_tags: Vec<u64>,
    /// The physical groups, by dimension and tag.
    pub groups: Vec<PhysicalGroup>,
    /// What was done to make it a mesh of plane triangles.
    pub notes: Vec<GmshNote>,
}

impl GmshMesh {
    /// Checks what was read from a file.
    ///
    /// # Errors
    /// [`ReadError::Mesh`]: no conforming triangulation.
    pub fn new(triangulation: GmshTriangulation) -> Result<Self, ReadError> {
        let GmshTriangulation { points, triangles, node_tags, element_tags, groups, members, views, notes } =
            triangulation;
        match Mesh::new(points, triangles) {
            Ok(mesh) => {
                let named = named_parts(&mesh, &groups, members);
                let views = Views::of_file(views);
                Ok(Self { mesh: mesh.with_groups(named).with_views(views), node_tags, groups, notes })
            }
            Err(source) => Err(ReadError::Mesh {
                elements: with_tags(&source.triangles(), &element_tags),
                nodes: with_tags(&source.vertices(), &node_tags),
                source,
            }),
        }
    }

    /// Reads a regular file of at most `most_bytes`.
    ///
    /// # Errors
    /// [`ReadError`]: unreadable, longer, not such a file, or no conforming triangulation.
    pub fn read(path: &Path, most_bytes: u64) -> Result<Self, ReadError> {
        let triangulation = parse(&read_regular(path, most_bytes)?)?;
        Self::new(triangulation)
    }
}

impl Mesh {
    /// Reads a Gmsh mesh: MSH 2.0 to 2.2 or 4.1, ASCII or binary, or 4.0 in ASCII, from a regular file. Vertices keep the order
    /// of the file, and its groups their names. Quadrangles are cut in two, elements of higher order taken by their corners, and a
    /// plane in space gets coordinates of its own. [`GmshMesh::read`] takes a limit, and also returns Gmsh's numbers and groups,
    /// and tells what was done.
    ///
    /// # Errors
    /// [`ReadError`]: unreadable, not such a file, or no conforming triangulation.
    pub fn read_gmsh(path: &Path) -> Result<Self, ReadError> {
        Ok(GmshMesh::read(path, u64::MAX)?.mesh)
    }

    /// Takes a Gmsh mesh from the bytes of its file, as [`Mesh::read_gmsh`]. Memory and time stay proportional to their number.
    ///
    /// # Errors
    /// [`ReadError`], but for [`ReadError::Io`].
    pub fn from_gmsh(bytes: &[u8]) -> Result<Self, ReadError> {
        Ok(GmshMesh::new(parse(bytes)?)?.mesh)
    }
}

/// What numbers Gmsh has for vertices that a message names, to be put behind it; empty where no number is known.
#[cfg(any(test, feature = "cli"))]
pub(crate) fn gmsh_nodes(vertices: &[usize], node_tags: &[u64]) -> String {
    in_gmsh(&[], &with_tags(vertices, node_tags))
}

fn with_tags(numbers: &[usize], tags: &[u64]) -> Vec<(usize, u64)> {
    numbers.iter().filter_map(|&number| Some((number, *tags.get(number)?))).collect()
}

fn in_gmsh(elements: &[(usize, u64)], nodes: &[(usize, u64)]) -> String {
    let kinds = [("triangle", "triangles", "element", elements), ("vertex", "vertices", "node", nodes)];
    let sentence = |(one, many, name, known): (&str, &str, &str, &[(usize, u64)])| match known {
        [] => None,
        [(number, tag)] => Some(format!("{one} {number} is Gmsh's {name} {tag}")),
        _ => {
            let list =
                |of: &dyn Fn(&(usize, u64)) -> String| known.iter().map(of).collect::<Vec<_>>().join(", ");
            let (numbers, tags) = (list(&|known| known.0.to_string()), list(&|known| known.1.to_string()));
            Some(format!("{many} {numbers} are Gmsh's {name}s {tags}"))
        }
    };
    let sentences: Vec<String> = kinds.into_iter().filter_map(sentence).collect();
    if sentences.is_empty() { String::new() } else { format!(" ({})", sentences.join("; ")) }
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
                "triangle 2 (vertices 2, 3, 3) is degenerate: its corners coincide or lie on one line; remove it and mesh again (triangle 2 is Gmsh's element 13; vertices 2, 3 are Gmsh's nodes 3, 4)",
            ),
            (
                "13 2 2 1 1 3 4 5",
                "13 2 2 1 1 1 2 5",
                "triangles 0 and 2 are the same (vertices 0, 1, 5): remove one (triangles 0, 2 are Gmsh's elements 11, 13; vertices 0, 1, 5 are Gmsh's nodes 1, 2, 5)",
            ),
            (
                "3 1 1 0",
                "3 1e41 1 0",
                "vertex 2 has the coordinates (1e41, 1e0): all must be finite and below 1e40; choose another unit of length (vertex 2 is Gmsh's node 3)",
            ),
        ];
        for (from, to, message) in table {
            let error = read(&SQUARE.replace(from, to)).expect_err(message);
            assert_eq!(error.to_string(), message);
        }
    }

    #[test]
    fn numbers_and_groups_of_the_file_are_kept() {
        let found = GmshMesh::new(parse(SQUARE.as_bytes()).unwrap()).unwrap();
        assert_eq!(found.node_tags, [1, 2, 3, 4, 9, 5]);
        assert_eq!(found.groups, [PhysicalGroup { dimension: 2, tag: 1, name: None }]);
        assert_eq!(gmsh_nodes(&[4], &found.node_tags), " (vertex 4 is Gmsh's node 9)");
        assert_eq!(gmsh_nodes(&[6], &found.node_tags), "", "a vertex that a refinement has made");
    }

    #[test]
    fn a_file_that_is_longer_than_allowed_is_not_read() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), SQUARE).unwrap();
        assert!(GmshMesh::read(file.path(), SQUARE.len() as u64).is_ok());
        assert!(matches!(GmshMesh::read(file.path(), SQUARE.len() as u64 - 1), Err(ReadError::Io(_))));
    }

    #[test]
    fn what_is_no_mesh_file_is_told_from_what_cannot_be_read() {
        assert!(matches!(read(&SQUARE.replace("2.2", "3.0")), Err(ReadError::Gmsh(_))));
        let nowhere = Mesh::read_gmsh(Path::new("no such folder/plate.msh")).expect_err("not there");
        assert!(matches!(nowhere, ReadError::Io(_)));
        assert!(nowhere.to_string().starts_with("cannot read the mesh file: "), "{nowhere}");
    }
}
