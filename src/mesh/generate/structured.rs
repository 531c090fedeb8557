//! Structured meshes: rectangle, L-shape, disk.

mod ancestry;
mod numbering;
mod pattern;
mod sides;

use crate::mesh::{Groups, Mesh, MeshError};
use ancestry::{ancestry, disk_ancestry};
use numbering::{GridNumbering, rows};
pub use pattern::Pattern;
use sides::{re_entrant_sides, sides_of_box};

/// The rectangle `(lower, upper)` in `cells[0] x cells[1]` cells. Vertices run along `x` first; the cell centres of the
/// crossed pattern follow. Its sides are the curves `left`, `right`, `bottom`, `top`.
///
/// # Errors
/// When rounding makes vertices coincide: extreme coordinates, or cells that are tiny for their distance from the origin.
///
/// # Panics
/// When a side is not positive or a number of cells is zero.
pub fn rectangle(
    lower: [f64; 2],
    upper: [f64; 2],
    cells: [usize; 2],
    pattern: Pattern,
) -> Result<Mesh, MeshError> {
    grid(lower, upper, cells, pattern, |_, _| true, |numbering| Groups::of_curves(sides_of_box(numbering)))
}

/// The L-shape `(-a, a)^2` without `[0, a] x [-a, 0]`, `cells` cells along its half width `a`. Its sides are the curves
/// `left`, `right`, `bottom`, `top`, and `corner`: the two that meet at the re-entrant corner.
///
/// # Errors
/// As [`rectangle`].
///
/// # Panics
/// When `half_width` is not positive or `cells` is zero.
pub fn l_shape(half_width: f64, cells: usize, pattern: Pattern) -> Result<Mesh, MeshError> {
    let corner = [half_width; 2];
    let curves = |numbering: &GridNumbering| {
        let corner = ("corner", re_entrant_sides(numbering, cells));
        Groups::of_curves(sides_of_box(numbering).into_iter().chain([corner]))
    };
    grid(corner.map(|a| -a), corner, [2 * cells; 2], pattern, |i, j| i < cells || j >= cells, curves)
}

/// The cells `(i, j)` of a grid that belong to the domain, divided by the pattern, and the names of its sides.
fn grid(
    lower: [f64; 2],
    upper: [f64; 2],
    [nx, ny]: [usize; 2],
    pattern: Pattern,
    inside: impl Fn(usize, usize) -> bool,
    groups: impl FnOnce(&GridNumbering) -> Groups,
) -> Result<Mesh, MeshError> {
    assert!(nx > 0 && ny > 0 && lower[0] < upper[0] && lower[1] < upper[1], "an empty grid");
    // Ends are met exactly, and a dyadic grid on the unit square has exact coordinates.
    let coordinate = |axis: usize, k: f64| {
        let t = k / [nx, ny][axis] as f64;
        lower[axis] * (1.0 - t) + upper[axis] * t
    };
    let numbering = GridNumbering::new([nx, ny], pattern, &inside);
    let points = points(&numbering, pattern, coordinate);
    let triangles =
        rows(ny, |j| numbering.cells(j).flat_map(|i| in_cell(&numbering, pattern, i, j)).collect());
    let groups = groups(&numbering);
    let ancestry = ancestry(numbering, pattern, &inside);
    Ok(Mesh::new(points, triangles)?.with_ancestry(ancestry).with_groups(groups))
}

/// Corners, then the centres of the crossed pattern; `coordinate(axis, k)` is that of the line `k`.
fn points(
    numbering: &GridNumbering,
    pattern: Pattern,
    coordinate: impl Fn(usize, f64) -> f64 + Sync,
) -> Vec<[f64; 2]> {
    let [nx, ny] = numbering.cells;
    let lines = |axis: usize, count: usize, shift: f64| -> Vec<f64> {
        (0..count).map(|k| coordinate(axis, k as f64 + shift)).collect()
    };
    let (x, y) = (lines(0, nx + 1, 0.0), lines(1, ny + 1, 0.0));
    let mut points = rows(ny + 1, |j| numbering.corners(j).map(|i| [x[i], y[j]]).collect());
    if pattern == Pattern::Crossed {
        let (x, y) = (lines(0, nx, 0.5), lines(1, ny, 0.5));
        points.extend(rows(ny, |j| numbering.cells(j).map(|i| [x[i], y[j]]).collect()));
    }
    points
}

/// The triangles in the cell `(i, j)`.
fn in_cell(
    numbering: &GridNumbering,
    pattern: Pattern,
    i: usize,
    j: usize,
) -> impl Iterator<Item = [usize; 3]> {
    let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| numbering.corner(i, j));
    let (triangles, count) = match pattern {
        Pattern::Right => ([[a, b, c], [a, c, d], [0; 3], [0; 3]], 2),
        Pattern::Crossed => {
            let centre = numbering.centre(i, j);
            ([[a, b, centre], [b, c, centre], [c, d, centre], [d, a, centre]], 4)
        }
    };
    triangles.into_iter().take(count)
}

/// A disk, as `rings` rings of triangles around its centre; ring `k` has `6 k` vertices. The domain of the mesh is the
/// polygon inscribed in the disk, its boundary the curve `rim`.
///
/// # Errors
/// As [`rectangle`].
///
/// # Panics
/// When `radius` is not positive or `rings` is zero.
pub fn disk(centre: [f64; 2], radius: f64, rings: usize) -> Result<Mesh, MeshError> {
    assert!(rings > 0 && radius > 0.0, "an empty disk");
    let first = |ring: usize| if ring == 0 { 0 } else { 1 + 3 * ring * (ring - 1) };
    let mut points = vec![centre];
    let mut triangles = Vec::new();
    for ring in 1..=rings {
        let r = radius * ring as f64 / rings as f64;
        for k in 0..6 * ring {
            let angle = std::f64::consts::TAU * k as f64 / (6 * ring) as f64;
            points.push([centre[0] + r * angle.cos(), centre[1] + r * angle.sin()]);
        }
        let outer = |k: usize| first(ring) + k % (6 * ring);
        let inner = |k: usize| first(ring - 1) + if ring == 1 { 0 } else { k % (6 * (ring - 1)) };
        for sextant in 0..6 {
            for k in 0..ring {
                let (o, i) = (sextant * ring + k, sextant * (ring - 1) + k);
                triangles.push([outer(o), outer(o + 1), inner(i)]);
                if k + 1 < ring {
                    triangles.push([outer(o + 1), inner(i + 1), inner(i)]);
                }
            }
        }
    }
    let on_rim = |k: usize| first(rings) + k % (6 * rings);
    let rim = (0..6 * rings).map(|k| [on_rim(k), on_rim(k + 1)]).collect();
    let groups = Groups::of_curves([("rim", rim)]);
    Ok(Mesh::new(points, triangles)?.with_ancestry(disk_ancestry(rings)).with_groups(groups))
}

#[cfg(test)]
mod tests;
