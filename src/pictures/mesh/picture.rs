//! What is drawn.

use crate::mesh::{DualMesh, Mesh};

/// A triangulation with its dual mesh, to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct MeshPicture<'a> {
    /// The heading; what does not fit into two lines is cut off.
    pub title: &'a str,
    /// The triangulation `T_h`.
    pub mesh: &'a Mesh,
    /// Its dual mesh `D_h`.
    pub dual: &'a DualMesh,
    /// Whether the membranes touch at each vertex of the mesh: the dual cells of these are tinted.
    pub contact: Option<&'a [bool]>,
}

/// Why a mesh could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum MeshPictureError {
    /// The dual mesh belongs to another mesh.
    #[error(
        "mesh picture: the dual mesh has a cell around vertex {vertex}, but the mesh has {vertices} vertices; pass the dual mesh of this mesh"
    )]
    OtherMesh {
        /// The vertex that is not there.
        vertex: usize,
        /// The number of vertices.
        vertices: usize,
    },
    /// The contact set has the wrong length.
    #[error("mesh picture: contact has {found} values for {expected} vertices; pass one per vertex")]
    Length {
        /// How many values it has.
        found: usize,
        /// The number of vertices.
        expected: usize,
    },
}

impl MeshPicture<'_> {
    /// Whether everything belongs to one mesh.
    pub(super) fn check(&self) -> Result<(), MeshPictureError> {
        let expected = self.mesh.points().len();
        if let Some(&vertex) = self.dual.vertices().iter().find(|&&a| a >= expected) {
            return Err(MeshPictureError::OtherMesh { vertex, vertices: expected });
        }
        match self.contact {
            Some(contact) if contact.len() != expected => {
                Err(MeshPictureError::Length { found: contact.len(), expected })
            }
            _ => Ok(()),
        }
    }
}
