//! Scan conversion: which pixels a triangle or a line covers.

use crate::geometry::barycentric_gradients;

/// Pixels on an edge belong to both triangles, so that rounding leaves no hole between them.
const ON_EDGE: f64 = -1e-9;

/// Calls `paint(column, row, barycentric coordinates)` for each pixel of a grid of `size` columns and rows
/// whose centre lies in the triangle. A triangle without area has no pixels.
pub(crate) fn triangle(
    corners: [[f64; 2]; 3],
    size: [usize; 2],
    mut paint: impl FnMut(usize, usize, [f64; 3]),
) {
    let Some(gradients) = barycentric_gradients(corners) else { return };
    let [columns, rows] = [0, 1].map(|axis| {
        let low = corners.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
        let high = corners.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
        pixel_range(low, high, size[axis])
    });
    for row in rows {
        for column in columns.clone() {
            let centre = [column as f64 + 0.5, row as f64 + 0.5];
            let weights = [0, 1, 2].map(|k| {
                let from = corners[(k + 1) % 3];
                gradients[k][0] * (centre[0] - from[0]) + gradients[k][1] * (centre[1] - from[1])
            });
            if weights.iter().all(|&weight| weight >= ON_EDGE) {
                paint(column, row, weights);
            }
        }
    }
}

/// Calls `paint(column, row, place along the line from 0 to 1)` for each pixel within `radius` of the line.
pub(crate) fn line(
    [from, to]: [[f64; 2]; 2],
    radius: f64,
    size: [usize; 2],
    mut paint: impl FnMut(usize, usize, f64),
) {
    let [columns, rows] = [0, 1].map(|axis| {
        pixel_range(from[axis].min(to[axis]) - radius, from[axis].max(to[axis]) + radius, size[axis])
    });
    let along = [to[0] - from[0], to[1] - from[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    for row in rows {
        for column in columns.clone() {
            let offset = [column as f64 + 0.5 - from[0], row as f64 + 0.5 - from[1]];
            let projected = offset[0] * along[0] + offset[1] * along[1];
            let place = if square > 0.0 { (projected / square).clamp(0.0, 1.0) } else { 0.0 };
            let [dx, dy] = [offset[0] - place * along[0], offset[1] - place * along[1]];
            if dx * dx + dy * dy <= radius * radius {
                paint(column, row, place);
            }
        }
    }
}

/// The corner whose dual cell `D_a` holds the point with these barycentric coordinates.
pub(crate) fn nearest_corner(weights: [f64; 3]) -> usize {
    let second = if weights[1] > weights[0] { 1 } else { 0 };
    if weights[2] > weights[second] { 2 } else { second }
}

/// The pixels whose centres lie between `low` and `high`, cut off at the edges of the grid.
fn pixel_range(low: f64, high: f64, size: usize) -> std::ops::Range<usize> {
    let limit = size as f64;
    let first = (low - 0.5).ceil().clamp(0.0, limit) as usize;
    let end = ((high - 0.5).floor() + 1.0).clamp(0.0, limit) as usize;
    first..end.max(first)
}
