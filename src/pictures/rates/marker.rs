//! Markers that are told apart by their shape alone.

use crate::pictures::drawing::canvas::Canvas;
use crate::pictures::drawing::color::{CURVES, Rgb};

/// The number of shapes.
pub(super) const KINDS: usize = 7;

/// The half width of a marker in pixels.
pub(super) const MARKER: f64 = 11.0;

/// The colour of a curve: beside its marker, what tells it from the others.
pub(super) fn color(index: usize) -> Rgb {
    CURVES[(index + index / KINDS) % CURVES.len()]
}

/// Draws the marker of curve `index`; shapes of one `radius` have about the same area.
pub(super) fn draw(canvas: &mut Canvas, index: usize, at: [f64; 2], radius: f64, color: Rgb) {
    let point = |x: f64, y: f64| [at[0] + radius * x, at[1] + radius * y];
    let mut lines = |ends: [[[f64; 2]; 2]; 2]| {
        ends.into_iter().for_each(|ends| canvas.line(ends, 0.62 * radius, color));
    };
    match index % KINDS {
        0 => canvas.dot(at, radius, color),
        1 => canvas.fill([point(-0.88, -0.88), point(0.88, 0.88)], color),
        2 => canvas.triangle([point(0.0, -1.25), point(1.15, 0.8), point(-1.15, 0.8)], color),
        3 => {
            let [north, east, south, west] =
                [point(0.0, -1.25), point(1.25, 0.0), point(0.0, 1.25), point(-1.25, 0.0)];
            canvas.triangle([north, east, south], color);
            canvas.triangle([south, west, north], color);
        }
        4 => canvas.triangle([point(0.0, 1.25), point(1.15, -0.8), point(-1.15, -0.8)], color),
        5 => lines([[point(-0.8, -0.8), point(0.8, 0.8)], [point(-0.8, 0.8), point(0.8, -0.8)]]),
        _ => lines([[point(-1.0, 0.0), point(1.0, 0.0)], [point(0.0, -1.0), point(0.0, 1.0)]]),
    }
}
