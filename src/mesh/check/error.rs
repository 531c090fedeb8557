//! Why a mesh is refused.

use thiserror::Error;

use super::size::MAX_COORDINATE;
use crate::mesh::Mesh;
use crate::text::{Number, grouped};

/// Why points and triangles are not a triangulation. Vertices and triangles are counted from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// There is nothing to solve on.
    #[error("the mesh has no triangle: export the surface, not only its boundary")]
    Empty,
    /// More triangles than can be counted.
    #[error("the mesh has {} triangles, more than can be numbered: make it coarser", grouped(*triangles))]
    TooLarge {
        /// How many there are.
        triangles: usize,
    },
    /// A coordinate is NaN, infinite, or huge.
    #[error("vertex {vertex} has the coordinates ({:e}, {:e}): all must be finite and below {MAX_COORDINATE:e}; choose another unit of length", point[0], point[1])]
    Coordinates {
        /// The vertex.
        vertex: usize,
        /// Its coordinates.
        point: [f64; 2],
    },
    /// A triangle names a vertex that is not there.
    #[error(
        "triangle {triangle} names vertex {vertex}, but there are only {} vertices (counted from 0)",
        grouped(*vertices)
    )]
    NoSuchVertex {
        /// The triangle.
        triangle: usize,
        /// The vertex that it names.
        vertex: usize,
        /// How many there are.
        vertices: usize,
    },
    /// A triangle of no area.
    #[error("triangle {triangle} (vertices {}, {}, {}) is degenerate: its corners coincide or lie on one line; remove it and mesh again", corners[0], corners[1], corners[2])]
    Degenerate {
        /// The triangle.
        triangle: usize,
        /// Its corners.
        corners: [usize; 3],
    },
    /// A triangle of no size that can be computed with.
    #[error("triangle {triangle} is smaller than {:e}: choose another unit of length", 1.0 / MAX_COORDINATE)]
    Tiny {
        /// The triangle.
        triangle: usize,
    },
    /// The same triangle twice.
    #[error("triangles {first} and {second} are the same (vertices {}, {}, {}): remove one", corners[0], corners[1], corners[2])]
    Duplicate {
        /// The first.
        first: usize,
        /// The second.
        second: usize,
        /// Their corners.
        corners: [usize; 3],
    },
    /// Two triangles on the same side of their common edge, or more than two triangles at one edge.
    #[error("triangles {first} and {second} overlap at their common edge (vertices {}, {}): an edge has one triangle on each side", edge[0], edge[1])]
    Overlap {
        /// The first.
        first: usize,
        /// The second.
        second: usize,
        /// The ends of the edge.
        edge: [usize; 2],
    },
    /// The triangles around a vertex overlap.
    #[error(
        "the triangles around vertex {vertex} overlap (triangle {triangle} among them): they must not cover more than one full turn, each direction once"
    )]
    OverlapAtVertex {
        /// The vertex.
        vertex: usize,
        /// One of the triangles.
        triangle: usize,
    },
    /// Two edges of the boundary cross.
    #[error(
        "triangles {first} and {second} overlap: edges of theirs on the boundary cross; cut the surfaces at each other before meshing (in Gmsh: BooleanFragments)"
    )]
    Crossing {
        /// The first.
        first: usize,
        /// The second.
        second: usize,
    },
    /// A piece of the mesh covers a part of another one.
    #[error(
        "triangle {inner} lies in another piece of the mesh, that of triangle {outer}: remove one of the two surfaces, or cut them at each other before meshing (in Gmsh: BooleanFragments)"
    )]
    Nested {
        /// A triangle of the inner piece.
        inner: usize,
        /// A triangle of the outer piece.
        outer: usize,
    },
    /// A vertex lies inside the edge of a triangle: a hanging node.
    #[error("the mesh is not conforming: vertex {vertex} lies inside the edge ({}, {}) of triangle {triangle}; split that triangle there", edge[0], edge[1])]
    HangingVertex {
        /// The vertex.
        vertex: usize,
        /// The triangle that is not split.
        triangle: usize,
        /// The ends of its edge.
        edge: [usize; 2],
    },
    /// Two vertices at one place: the pieces of the mesh are not glued together.
    #[error(
        "the mesh is not conforming: vertices {first} and {second} (of triangle {triangle}) coincide; merge them (in Gmsh: Coherence Mesh, or BooleanFragments before meshing)"
    )]
    CoincidentVertices {
        /// The first.
        first: usize,
        /// The second.
        second: usize,
        /// A triangle at the second.
        triangle: usize,
    },
    /// A triangle cannot be divided or made smaller any more.
    #[error(
        "triangle {triangle} (vertices {}, {}, {}) cannot be divided or made smaller: the size of the mesh or of its coordinates leaves too few digits; refine less often there, or grade less", corners[0], corners[1], corners[2]
    )]
    TooSmall {
        /// The triangle.
        triangle: usize,
        /// Its corners.
        corners: [usize; 3],
    },
    /// A mesh cannot be graded like this.
    #[error(
        "the mesh cannot be graded with the exponent {}: give a number >= 1, and a domain that is a square around the point or has it as its corner",
        Number(*exponent)
    )]
    NotGraded {
        /// The exponent.
        exponent: f64,
    },
}

impl MeshError {
    /// The vertices that the error names, each once, in the order in which they come.
    pub fn vertices(&self) -> Vec<usize> {
        let mut named = match *self {
            Self::Coordinates { vertex, .. }
            | Self::NoSuchVertex { vertex, .. }
            | Self::OverlapAtVertex { vertex, .. } => vec![vertex],
            Self::HangingVertex { vertex, edge: [a, b], .. } => vec![vertex, a, b],
            Self::CoincidentVertices { first, second, .. } => vec![first, second],
            Self::Overlap { edge, .. } => edge.to_vec(),
            Self::Degenerate { corners, .. }
            | Self::Duplicate { corners, .. }
            | Self::TooSmall { corners, .. } => corners.to_vec(),
            Self::Empty
            | Self::TooLarge { .. }
            | Self::Tiny { .. }
            | Self::Crossing { .. }
            | Self::Nested { .. }
            | Self::NotGraded { .. } => vec![],
        };
        let mut seen = Vec::new();
        named.retain(|a| {
            !seen.contains(a) && {
                seen.push(*a);
                true
            }
        });
        named
    }

    /// The triangles that the error names.
    pub fn triangles(&self) -> Vec<usize> {
        let second = match *self {
            Self::Duplicate { second, .. } | Self::Overlap { second, .. } | Self::Crossing { second, .. } => {
                Some(second)
            }
            Self::Nested { outer, .. } => Some(outer),
            _ => None,
        };
        self.triangle().into_iter().chain(second).collect()
    }

    /// The (first) triangle that the error names.
    pub fn triangle(&self) -> Option<usize> {
        match *self {
            Self::NoSuchVertex { triangle, .. }
            | Self::Degenerate { triangle, .. }
            | Self::Tiny { triangle }
            | Self::OverlapAtVertex { triangle, .. }
            | Self::HangingVertex { triangle, .. }
            | Self::TooSmall { triangle, .. }
            | Self::CoincidentVertices { triangle, .. } => Some(triangle),
            Self::Duplicate { first, .. } | Self::Overlap { first, .. } | Self::Crossing { first, .. } => {
                Some(first)
            }
            Self::Nested { inner, .. } => Some(inner),
            Self::Empty | Self::TooLarge { .. } | Self::Coordinates { .. } | Self::NotGraded { .. } => None,
        }
    }
}

impl Mesh {
    /// The error of parts of `triangle` that are too small.
    pub(in crate::mesh) fn too_small(&self, triangle: usize) -> MeshError {
        MeshError::TooSmall { triangle, corners: self.triangles()[triangle] }
    }
}
