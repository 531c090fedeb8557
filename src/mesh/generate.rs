//! A mesh of a [`Domain`], structured or unstructured.

mod error;
mod polygon;
mod structured;

pub use error::GenerateError;
pub use polygon::polygon;
pub use structured::{Pattern, disk, l_shape, rectangle};

use super::Mesh;
use crate::problem::Domain;
#[cfg(feature = "cli")]
pub(crate) use error::MAX_VERTICES;

use error::check_vertex_estimate;
use polygon::{largest_triangle, polygon_with_names};

/// How fine a mesh to make.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeshSize {
    /// A structured mesh with this number of cells along the shorter side of a rectangle, the half width of an
    /// L-shape, or the radius of a disk.
    Cells {
        /// Number of cells.
        cells: usize,
        /// How a cell is divided (not for the disk, which has rings).
        pattern: Pattern,
    },
    /// A structured mesh of a rectangle with these numbers of cells along `x` and `y`.
    Grid {
        /// Numbers of cells.
        cells: [usize; 2],
        /// How a cell is divided.
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

/// Makes a mesh of `domain`. An unstructured disk, like a structured one, is an inscribed polygon.
///
/// The sides have names, which an unstructured mesh shares with a structured one: see [`rectangle`], [`l_shape`], [`disk`]
/// and [`polygon()`].
///
/// # Errors
/// [`GenerateError`]: sizes or extents out of range, too many vertices, a polygon that is none.
pub fn generate(domain: &Domain, size: MeshSize) -> Result<Mesh, GenerateError> {
    check_extent(domain)?;
    match size {
        MeshSize::Cells { cells: 0, .. } | MeshSize::Grid { cells: [0, _] | [_, 0], .. } => {
            Err(GenerateError::NoCells)
        }
        MeshSize::Cells { cells, pattern } => structured(domain, cells, pattern),
        MeshSize::Grid { cells, pattern } => {
            let Domain::Rectangle { lower, upper } = *domain else { return Err(GenerateError::Grid) };
            check_vertex_estimate(estimated_vertices(domain, size))?;
            rectangle(lower, upper, cells, pattern).map_err(|_| GenerateError::Rounding)
        }
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
                    vertices_of_grid(cells_along(*lower, *upper, n), pattern)
                }
                Domain::LShape { .. } => per_cell * 3.0 * n * n,
                Domain::Disk { .. } | Domain::Polygon { .. } => 3.0 * n * n,
            }
        }
        MeshSize::Grid { cells, pattern } => vertices_of_grid(cells.map(|n| n as f64), pattern),
        MeshSize::EdgeLength { size, .. } => domain.area() / largest_triangle(size),
    }
}

fn vertices_of_grid([a, b]: [f64; 2], pattern: Pattern) -> f64 {
    let per_cell = if pattern == Pattern::Crossed { 2.0 } else { 1.0 };
    per_cell * (a + 1.0) * (b + 1.0)
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
            let corners = [[*x0, *y0], [*x1, *y0], [*x1, *y1], [*x0, *y1]];
            polygon_with_names(&corners, &["bottom", "right", "top", "left"], size, min_angle)
        }
        &Domain::LShape { half_width: a } => {
            let corners = [[0.0, 0.0], [0.0, -a], [-a, -a], [-a, a], [a, a], [a, 0.0]];
            let names = ["corner", "bottom", "left", "top", "right", "corner"];
            polygon_with_names(&corners, &names, size, min_angle)
        }
        Domain::Disk { centre, radius } => {
            check_vertex_estimate((radius / size).powi(2))?;
            let edges = (std::f64::consts::TAU * (radius / size)).ceil().max(6.0) as usize;
            let corner = |k: usize| {
                let angle = std::f64::consts::TAU * k as f64 / edges as f64;
                [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()]
            };
            polygon_with_names(&(0..edges).map(corner).collect::<Vec<_>>(), &["rim"], size, min_angle)
        }
        Domain::Polygon { vertices, holes } => polygon(vertices, holes, size, min_angle),
    }
}

#[cfg(test)]
mod tests;
