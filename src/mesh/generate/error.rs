//! Why a mesh cannot be made, and what may be asked for.

use thiserror::Error;

use crate::text::{Number, grouped};

/// More vertices than this are refused: the system of a mesh of this size needs about 64 GiB.
pub(crate) const MAX_VERTICES: f64 = 5e7;

/// Ruppert's algorithm ends for angles up to about 33 degrees; 30 is what it reaches on any input in practice.
pub(super) const MAX_MIN_ANGLE: f64 = 30.0;

/// Why a mesh cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum GenerateError {
    /// A grid of something else than a rectangle.
    #[error("a grid with cells along x and y is for a rectangle: give one number of cells")]
    Grid,
    /// No cells.
    #[error("cells is 0: give at least 1")]
    NoCells,
    /// A polygon has no structured mesh.
    #[error("a polygon has no structured mesh: give `size`, the target edge length, in place of `cells`")]
    StructuredPolygon,
    /// The domain's extent is not positive or not finite.
    #[error("the domain has {quantity} {}: it must be positive and finite", Number(*value))]
    Extent {
        /// Which.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// A coordinate that is not finite.
    #[error("the domain has a coordinate that is not finite")]
    NotFinite,
    /// Target edge length out of range.
    #[error("size is {}: the target edge length must be positive and finite", Number(*size))]
    Size {
        /// The value given.
        size: f64,
    },
    /// Least angle out of range.
    #[error("min_angle is {}: give degrees between 0 and {MAX_MIN_ANGLE}", Number(*min_angle))]
    MinAngle {
        /// The value given.
        min_angle: f64,
    },
    /// The mesh would not fit into memory.
    #[error(
        "the mesh would have about {vertices:.1e} vertices, more than {MAX_VERTICES:.0e}: make it coarser"
    )]
    TooLarge {
        /// The estimate.
        vertices: f64,
    },
    /// One ring of a polygon is no polygon.
    #[error("{ring} {problem}: give the corners of a simple polygon in order")]
    Ring {
        /// Which ring.
        ring: String,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// Rings cross each other or themselves.
    #[error("edges of the polygon cross: one of them runs from ({}, {}) to ({}, {})", Number(from[0]), Number(from[1]), Number(to[0]), Number(to[1]))]
    Crossing {
        /// Start of the edge.
        from: [f64; 2],
        /// Its end.
        to: [f64; 2],
    },
    /// Rings that touch, holes that are not inside of the polygon or in one another.
    #[error(
        "a ring touches itself or another one, or a hole lies outside of the polygon or in another hole: keep them apart"
    )]
    Holes,
    /// The triangulation does not take a coordinate.
    #[error("the polygon cannot be triangulated: {reason}; scale its coordinates")]
    Coordinates {
        /// What the triangulation says.
        reason: String,
    },
    /// Rounding makes vertices coincide.
    #[error(
        "rounding makes vertices coincide or lie on one line: scale the domain to a moderate size, move it nearer to the origin, or remove details of that size"
    )]
    Rounding,
    /// The refinement takes many more vertices than expected.
    #[error(
        "triangles with angles of {min_angle} degrees take more than {} vertices here, where `size` alone asks for about {}: the polygon has parts much narrower than `size`; give `min_angle = 0`, or a `size` as small as they are",
        grouped(*vertices),
        grouped(*expected)
    )]
    TooNarrow {
        /// The least angle that was asked for, degrees.
        min_angle: f64,
        /// Vertices at which it was stopped.
        vertices: usize,
        /// Vertices that triangles of the size asked for need.
        expected: usize,
    },
}

/// Refuses an expected number of vertices beyond the limit, before any memory is taken for them.
pub(super) fn check_vertex_estimate(vertices: f64) -> Result<usize, GenerateError> {
    if vertices <= MAX_VERTICES {
        Ok(vertices.ceil() as usize)
    } else {
        Err(GenerateError::TooLarge { vertices })
    }
}
