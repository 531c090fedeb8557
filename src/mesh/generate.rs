//! A mesh of a [`Domain`], structured or unstructured.

mod polygon;
mod structured;

use thiserror::Error;

pub use polygon::polygon;
pub use structured::{Pattern, disk, l_shape, rectangle};

use super::Mesh;
use crate::problem::Domain;
use crate::text::Number;
use polygon::{MAX_MIN_ANGLE, largest_triangle};

/// More vertices than this are refused: the system of a mesh of this size needs about 64 GiB.
pub(crate) const MAX_VERTICES: f64 = 5e7;

/// How fine a mesh to make.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum MeshSize {
    /// A structured mesh with this number of cells along the shorter side of a rectangle, the half width of an
    /// L-shape, or the radius of a disk.
    Cells {
        /// Number of cells.
        cells: usize,
        /// How a cell is divided (not for the disk, which has rings).
        pattern: Pattern,
    },
    /// An unstructured mesh.
    EdgeLength {
        /// Target edge length.
        size: f64,
        /// Least angle, degrees, at most 30.
        min_angle: f64,
    },
}

/// Why a mesh cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum GenerateError {
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
    /// Refinement did not end.
    #[error(
        "the refinement does not end: the polygon has features much smaller than `size`; lower `min_angle` or `size`"
    )]
    Incomplete,
}

/// Makes a mesh of `domain`. An unstructured disk, like a structured one, is an inscribed polygon.
///
/// # Errors
/// [`GenerateError`]: sizes or extents out of range, too many vertices, a polygon that is none.
pub fn generate(domain: &Domain, size: MeshSize) -> Result<Mesh, GenerateError> {
    check_extent(domain)?;
    match size {
        MeshSize::Cells { cells: 0, .. } => Err(GenerateError::NoCells),
        MeshSize::Cells { cells, pattern } => structured(domain, cells, pattern),
        MeshSize::EdgeLength { size, .. } if !(size > 0.0 && size.is_finite()) => {
            Err(GenerateError::Size { size })
        }
        MeshSize::EdgeLength { size, min_angle } => unstructured(domain, size, min_angle),
    }
}

/// About how many vertices the mesh will have; exact for a structured one but on an L-shape.
pub fn estimated_vertices(domain: &Domain, size: MeshSize) -> f64 {
    match size {
        MeshSize::Cells { cells, pattern } => {
            let n = cells as f64;
            let per_cell = if pattern == Pattern::Crossed { 2.0 } else { 1.0 };
            match domain {
                Domain::Rectangle { lower, upper } => {
                    let [a, b] = cells_along(*lower, *upper, n);
                    per_cell * (a + 1.0) * (b + 1.0)
                }
                Domain::LShape { .. } => per_cell * 3.0 * n * n,
                Domain::Disk { .. } | Domain::Polygon { .. } => 3.0 * n * n,
            }
        }
        MeshSize::EdgeLength { size, .. } => domain.area() / largest_triangle(size),
    }
}

/// Cells along both sides of a rectangle with `n` along the shorter one.
fn cells_along(lower: [f64; 2], upper: [f64; 2], n: f64) -> [f64; 2] {
    let sides = [upper[0] - lower[0], upper[1] - lower[1]];
    sides.map(|side| (n * (side / sides[0].min(sides[1]))).round())
}

fn check_extent(domain: &Domain) -> Result<(), GenerateError> {
    let (extents, coordinates) = match domain {
        Domain::Rectangle { lower, upper } => {
            (vec![("width", upper[0] - lower[0]), ("height", upper[1] - lower[1])], vec![*lower, *upper])
        }
        Domain::LShape { half_width } => (vec![("half width", *half_width)], vec![]),
        Domain::Disk { centre, radius } => (vec![("radius", *radius)], vec![*centre]),
        Domain::Polygon { .. } => return Ok(()),
    };
    for (quantity, value) in extents {
        if !(value > 0.0 && value.is_finite()) {
            return Err(GenerateError::Extent { quantity, value });
        }
    }
    if coordinates.into_iter().flatten().all(f64::is_finite) { Ok(()) } else { Err(GenerateError::NotFinite) }
}

fn structured(domain: &Domain, cells: usize, pattern: Pattern) -> Result<Mesh, GenerateError> {
    let check = || check_vertex_estimate(estimated_vertices(domain, MeshSize::Cells { cells, pattern }));
    let mesh = match *domain {
        Domain::Polygon { .. } => return Err(GenerateError::StructuredPolygon),
        Domain::Rectangle { lower, upper } => {
            check()?;
            let along = cells_along(lower, upper, cells as f64);
            rectangle(lower, upper, along.map(|cells| cells as usize), pattern)
        }
        Domain::LShape { half_width } => {
            check()?;
            l_shape(half_width, cells, pattern)
        }
        Domain::Disk { centre, radius } => {
            check()?;
            disk(centre, radius, cells)
        }
    };
    // Grids and rings are triangulations, up to rounding.
    mesh.map_err(|_| GenerateError::Rounding)
}

fn unstructured(domain: &Domain, size: f64, min_angle: f64) -> Result<Mesh, GenerateError> {
    match domain {
        Domain::Rectangle { lower: [x0, y0], upper: [x1, y1] } => {
            polygon(&[[*x0, *y0], [*x1, *y0], [*x1, *y1], [*x0, *y1]], &[], size, min_angle)
        }
        &Domain::LShape { half_width: a } => {
            let corners = [[0.0, 0.0], [0.0, -a], [-a, -a], [-a, a], [a, a], [a, 0.0]];
            polygon(&corners, &[], size, min_angle)
        }
        Domain::Disk { centre, radius } => {
            check_vertex_estimate((radius / size).powi(2))?;
            let edges = (std::f64::consts::TAU * (radius / size)).ceil().max(6.0) as usize;
            let corner = |k: usize| {
                let angle = std::f64::consts::TAU * k as f64 / edges as f64;
                [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()]
            };
            polygon(&(0..edges).map(corner).collect::<Vec<_>>(), &[], size, min_angle)
        }
        Domain::Polygon { vertices, holes } => polygon(vertices, holes, size, min_angle),
    }
}

/// Refuses an expected number of vertices beyond the limit, before any memory is taken for them.
pub(super) fn check_vertex_estimate(vertices: f64) -> Result<usize, GenerateError> {
    if vertices <= MAX_VERTICES {
        Ok(vertices.ceil() as usize)
    } else {
        Err(GenerateError::TooLarge { vertices })
    }
}

#[cfg(test)]
mod tests;
