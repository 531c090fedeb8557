//! Scan conversion: which pixels a triangle or a line covers.
//!
//! Line by line of pixels, and on each only between the ends of what it cuts out of the shape: the work is in proportion to
//! the pixels painted and to the lines that a shape meets in its shorter direction (at most four times as many), not to its bounding box.

mod bands;

pub(crate) use bands::in_bands;

use std::ops::Range;

use crate::geometry::barycentric_gradients;

/// Pixels on an edge belong to both triangles, so that rounding leaves no hole between them.
const ON_EDGE: f64 = -1e-9;

/// By how much of a pixel the ends of a span may be rounded: which pixels of it are covered is asked of each.
const SLACK: f64 = 1e-6;

/// Of so few pixels all are asked: that takes less time than to find the ends of the span.
const SHORT: usize = 8;

/// Calls `paint(column, row, barycentric coordinates)` for each pixel of a grid of `size` columns and rows
/// whose centre lies in the triangle. A triangle without area has no pixels.
pub(crate) fn triangle(
    corners: [[f64; 2]; 3],
    size: [usize; 2],
    mut paint: impl FnMut(usize, usize, [f64; 3]),
) {
    let bounds = [0, 1].map(|axis| extent(corners.map(|p| p[axis])));
    let ranges = [0, 1].map(|axis| pixel_range(bounds[axis], size[axis]));
    // Most triangles of a fine mesh have no pixel.
    if ranges.iter().any(Range::is_empty) {
        return;
    }
    let Some(gradients) = barycentric_gradients(corners) else { return };
    let [along, across] = directions(bounds);
    let is_short = ranges[along].len() <= SHORT;
    let slopes = gradients.map(|gradient| gradient[along]);
    for line in ranges[across].clone() {
        let middle = line as f64 + 0.5;
        // On the line each weight is linear, and its zero an end of the span.
        let start = |k: usize| {
            let from = corners[(k + 1) % 3];
            gradients[k][across] * (middle - from[across]) - slopes[k] * from[along]
        };
        let starts = [start(0), start(1), start(2)];
        let narrowed = || {
            let mut span = bounds[along];
            for k in 0..3 {
                let zero = (ON_EDGE - starts[k]) / slopes[k];
                if slopes[k] > 0.0 {
                    span[0] = span[0].max(zero - SLACK);
                } else if slopes[k] < 0.0 {
                    span[1] = span[1].min(zero + SLACK);
                }
            }
            pixel_range(span, size[along])
        };
        for pixel in if is_short { ranges[along].clone() } else { narrowed() } {
            let weight = |k: usize| starts[k] + slopes[k] * (pixel as f64 + 0.5);
            let weights = [weight(0), weight(1), weight(2)];
            visited();
            if weights[0] >= ON_EDGE && weights[1] >= ON_EDGE && weights[2] >= ON_EDGE {
                let [column, row] = in_order(along, [pixel, line]);
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
    let vector = [to[0] - from[0], to[1] - from[1]];
    let square = vector[0] * vector[0] + vector[1] * vector[1];
    let bounds = [0, 1].map(|axis| grown(extent([from[axis], to[axis]]), radius));
    if pixel_range(bounds[1], size[1]).is_empty() {
        return;
    }
    let [along, across] = directions(bounds);
    for line in pixel_range(bounds[across], size[across]) {
        let middle = line as f64 + 0.5;
        // Only the part of the line within `radius` of these pixels, across, can be near them.
        let place = |at: f64| ((at - from[across]) / vector[across]).clamp(0.0, 1.0);
        let ends = if vector[across] == 0.0 {
            [from[along], to[along]]
        } else {
            [middle - radius, middle + radius].map(|at| from[along] + place(at) * vector[along])
        };
        for pixel in pixel_range(grown(extent(ends), radius + SLACK), size[along]) {
            let [column, row] = in_order(along, [pixel, line]);
            let offset = [column as f64 + 0.5 - from[0], row as f64 + 0.5 - from[1]];
            let projected = offset[0] * vector[0] + offset[1] * vector[1];
            let place = if square > 0.0 { (projected / square).clamp(0.0, 1.0) } else { 0.0 };
            let [dx, dy] = [offset[0] - place * vector[0], offset[1] - place * vector[1]];
            visited();
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

/// The corner of pixels nearest to a point. A mesh whose vertices are moved there keeps no holes, and loses the triangles that
/// are too thin to be seen: those that remain have at least half a pixel, so that there are not many more than pixels.
pub(crate) fn on_grid(point: [f64; 2]) -> [f64; 2] {
    point.map(f64::round)
}

/// The direction of the lines that are scanned, and that across: along rows, whose pixels are neighbours in memory, unless the
/// columns are far fewer.
fn directions(bounds: [[f64; 2]; 2]) -> [usize; 2] {
    const FAR_FEWER: f64 = 4.0;
    let [width, height] = bounds.map(|[low, high]| high - low);
    if FAR_FEWER * width < height { [1, 0] } else { [0, 1] }
}

/// A pair in the directions of [`directions`] as one of column and row.
fn in_order<T>(along: usize, [first, second]: [T; 2]) -> [T; 2] {
    if along == 0 { [first, second] } else { [second, first] }
}

fn extent<const N: usize>(values: [f64; N]) -> [f64; 2] {
    let start = [f64::INFINITY, f64::NEG_INFINITY];
    values.into_iter().fold(start, |[low, high], x| [low.min(x), high.max(x)])
}

fn grown([low, high]: [f64; 2], by: f64) -> [f64; 2] {
    [low - by, high + by]
}

/// The pixels whose centres lie between `low` and `high`, cut off at the edges of the grid.
fn pixel_range([low, high]: [f64; 2], size: usize) -> Range<usize> {
    // `ceil` and `floor` are calls of a library, and this is asked of every line of every triangle.
    let limit = size as f64;
    let below = |x: f64| x.clamp(0.0, limit) as usize;
    let first = below(low - 0.5);
    let first = if (first as f64) < low - 0.5 { first + 1 } else { first };
    first..below(high + 0.5).max(first)
}

/// Tests count the pixels that are looked at.
#[cfg(not(test))]
fn visited() {}

#[cfg(test)]
use tests::visited;

#[cfg(test)]
mod tests;
