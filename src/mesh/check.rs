//! The checked constructor: what it returns is a conforming triangulation.

mod boundary;
mod boxes;
mod pieces;
mod quality;
#[cfg(test)]
mod tests;

use thiserror::Error;

use super::{Mesh, Refinement, VertexKind};
use crate::geometry::{distance_sq, twice_signed_area};
use crate::mesh::topology::{HalfEdge, HalfEdges};
use crate::text::Number;
pub(super) use boundary::resolution;
pub use quality::MeshQuality;

use boundary::{Boundary, BoundaryEdge};
use pieces::check_pieces;
pub(in crate::mesh) use quality::angles;

/// A triangle whose doubled area is below this fraction of its longest edge squared is degenerate. Rounding of the
/// coordinates moves that fraction by about 1e-16; a sliver of 0.01 degrees has 1.7e-4.
const MIN_RELATIVE_AREA: f64 = 1e-12;

/// Coordinates beyond this are refused, and triangles below its inverse: products of areas, loads and
/// displacements must not overflow.
const MAX_COORDINATE: f64 = 1e40;

/// What rounding may add to a full turn, radians.
const TURN_ROUNDING: f64 = 1e-9;

/// Why points and triangles are not a triangulation. Vertices and triangles are counted from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// There is nothing to solve on.
    #[error("the mesh has no triangle: export the surface, not only its boundary")]
    Empty,
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
        "triangle {triangle} names vertex {vertex}, but there are only {vertices} vertices (counted from 0)"
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
    /// A triangle cannot be divided any more.
    #[error(
        "triangle {triangle} (vertices {}, {}, {}) cannot be divided: the size of the mesh or of its coordinates leaves too few digits for its parts; refine less often there", corners[0], corners[1], corners[2]
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
            Self::Empty | Self::Coordinates { .. } | Self::NotGraded { .. } => None,
        }
    }
}

impl Mesh {
    /// Checks `points` (shape: vertices x 2) and `triangles` (shape: triangles x 3, vertex numbers from 0).
    ///
    /// Clockwise triangles are turned round. Vertices in no triangle are kept as [`VertexKind::Unused`]. No two triangles of
    /// the result overlap: they lie on opposite sides of inner edges, make at most one full turn around every vertex, and
    /// the boundary does not touch itself but at common vertices. Takes linear time (the edges at one vertex are sorted
    /// among themselves, and boundary edges meet only those near them).
    ///
    /// # Errors
    /// [`MeshError`], naming the triangle, for: no triangles, coordinates out of range, unknown vertices, degenerate or
    /// repeated triangles, overlaps, hanging vertices, unmerged coincident vertices.
    pub fn new(points: Vec<[f64; 2]>, mut triangles: Vec<[usize; 3]>) -> Result<Self, MeshError> {
        check_points(&points)?;
        orient(&points, &mut triangles)?;
        let boundary_edges = boundary_edges(points.len(), &triangles)?;
        check_turns(&points, &triangles)?;
        let boundary = Boundary::new(&points, &boundary_edges);
        boundary.check()?;
        check_pieces(&boundary, &triangles)?;

        let mut kind = vec![VertexKind::Unused; points.len()];
        for &a in triangles.iter().flatten() {
            kind[a] = VertexKind::Interior;
        }
        for &a in boundary_edges.iter().flat_map(|edge| &edge.ends) {
            kind[a] = VertexKind::Boundary;
        }
        Ok(Self { points, triangles, kind, ancestry: Vec::new() })
    }
}

impl Mesh {
    /// Divides every triangle into four, unless rounding leaves a part no area.
    ///
    /// # Errors
    /// [`MeshError::TooSmall`], naming the triangle.
    pub(super) fn refine_checked(&self) -> Result<Refinement, MeshError> {
        let refinement = self.refine();
        let fine = &refinement.mesh;
        let has_area = |&t: &usize| sense(fine.corners(t)) == Sense::Counterclockwise;
        match (0..fine.triangles.len()).find(|t| !has_area(t)).map(|part| part / 4) {
            Some(triangle) => Err(MeshError::TooSmall { triangle, corners: self.triangles[triangle] }),
            None => Ok(refinement),
        }
    }
}

fn check_points(points: &[[f64; 2]]) -> Result<(), MeshError> {
    match points.iter().position(|point| !point.iter().all(|x| x.abs() < MAX_COORDINATE)) {
        Some(vertex) => Err(MeshError::Coordinates { vertex, point: points[vertex] }),
        None => Ok(()),
    }
}

/// Checks each triangle by itself and turns it counterclockwise.
fn orient(points: &[[f64; 2]], triangles: &mut [[usize; 3]]) -> Result<(), MeshError> {
    if triangles.is_empty() {
        return Err(MeshError::Empty);
    }
    for (triangle, corners) in triangles.iter_mut().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&a| a >= points.len()) {
            return Err(MeshError::NoSuchVertex { triangle, vertex, vertices: points.len() });
        }
        match sense(corners.map(|a| points[a])) {
            Sense::Counterclockwise => {}
            Sense::Clockwise => corners.swap(1, 2),
            Sense::Degenerate => return Err(MeshError::Degenerate { triangle, corners: *corners }),
            Sense::Tiny => return Err(MeshError::Tiny { triangle }),
        }
    }
    Ok(())
}

/// How the corners of a triangle run around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sense {
    Counterclockwise,
    Clockwise,
    /// It has no area that rounding leaves.
    Degenerate,
    /// Its longest edge is too short.
    Tiny,
}

pub(super) fn sense([a, b, c]: [[f64; 2]; 3]) -> Sense {
    let longest_sq = distance_sq(a, b).max(distance_sq(b, c)).max(distance_sq(c, a));
    let area = twice_signed_area([a, b, c]);
    if a != b && b != c && c != a && longest_sq * MAX_COORDINATE * MAX_COORDINATE <= 1.0 {
        Sense::Tiny
    } else if !(area.abs() > MIN_RELATIVE_AREA * longest_sq) {
        Sense::Degenerate
    } else if area > 0.0 {
        Sense::Counterclockwise
    } else {
        Sense::Clockwise
    }
}

/// The edges with one triangle; those with two must have one on each side.
fn boundary_edges(vertices: usize, triangles: &[[usize; 3]]) -> Result<Vec<BoundaryEdge>, MeshError> {
    let mut boundary = Vec::new();
    for (lower, upper, sides) in HalfEdges::new(vertices, triangles).edges() {
        match sides {
            [side] => {
                let ends = if side.reversed { [upper, lower] } else { [lower, upper] };
                boundary.push(BoundaryEdge { ends, triangle: side.triangle });
            }
            [left, right] if left.reversed != right.reversed => {}
            _ => return Err(overlap(triangles, [lower, upper], sides)),
        }
    }
    Ok(boundary)
}

/// Names two triangles on the same side of an edge (there are some: more than two sides, or two alike).
fn overlap(triangles: &[[usize; 3]], edge: [usize; 2], sides: &[HalfEdge]) -> MeshError {
    let pair = sides.windows(2).find(|pair| pair[0].reversed == pair[1].reversed);
    let [first, second] = [0, 1].map(|k| pair.expect("sides of one kind are neighbours")[k].triangle);
    let apex = |t: usize| triangles[t].into_iter().find(|a| !edge.contains(a));
    if apex(first) == apex(second) {
        MeshError::Duplicate { first, second, corners: triangles[first] }
    } else {
        MeshError::Overlap { first, second, edge }
    }
}

/// The triangles around an inner vertex make one full turn, those around a boundary vertex less.
fn check_turns(points: &[[f64; 2]], triangles: &[[usize; 3]]) -> Result<(), MeshError> {
    let mut turn = vec![0.0; points.len()];
    for (triangle, corners) in triangles.iter().enumerate() {
        for (&vertex, angle) in corners.iter().zip(angles(corners.map(|a| points[a]))) {
            turn[vertex] += angle;
            if turn[vertex] > std::f64::consts::TAU + TURN_ROUNDING {
                return Err(MeshError::OverlapAtVertex { vertex, triangle });
            }
        }
    }
    Ok(())
}
