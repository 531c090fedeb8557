//! Shapes that a file of lines holds as one.

use crate::pictures::drawing::canvas::{Canvas, Shape};

/// Neighbours that can be drawn as one: lines of one pen, areas of one colour.
pub(super) fn runs(canvas: &Canvas) -> impl Iterator<Item = &[Shape]> {
    canvas.shapes().chunk_by(|a, b| match (a, b) {
        (Shape::Line { width: a, color: c, .. }, Shape::Line { width: b, color: d, .. }) => a == b && c == d,
        (Shape::Star { color: c, .. }, Shape::Star { color: d, .. }) => c == d,
        _ => false,
    })
}

/// The lines of a run as polylines.
pub(super) fn polylines(run: &[Shape]) -> Vec<Vec<[f64; 2]>> {
    let mut lines: Vec<Vec<[f64; 2]>> = Vec::new();
    for shape in run {
        let Shape::Line { ends: [from, to], .. } = shape else { continue };
        match lines.last_mut() {
            Some(line) if line.last() == Some(from) => line.push(*to),
            _ => lines.push(vec![*from, *to]),
        }
    }
    lines
}

/// The areas of a run.
pub(super) fn polygons(run: &[Shape]) -> impl Iterator<Item = &[[f64; 2]]> {
    run.iter().filter_map(|shape| match shape {
        Shape::Star { corners, .. } => Some(corners.as_slice()),
        _ => None,
    })
}
