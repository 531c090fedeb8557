//! A checked mesh from a Gmsh file.

use std::io;
use std::path::Path;

use thiserror::Error;

use super::gmsh::{GmshError, GmshTriangulation, parse};
use super::{Mesh, MeshError};

/// Why a mesh file cannot be used. The messages do not repeat the file's name.
#[derive(Debug, Error)]
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
        let GmshTriangulation { points, triangles, element_tags, .. } = parse(&std::fs::read(path)?)?;
        Self::new(points, triangles).map_err(|source| {
            let element = source.triangle().and_then(|t| element_tags.get(t).copied());
            ReadError::Mesh { source, element }
        })
    }
}
