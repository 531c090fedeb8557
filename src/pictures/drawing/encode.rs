//! Finished pictures as files: pixels, or lines and outlines that stay sharp in print.

mod pdf;
mod png;
mod svg;

use super::canvas::{Canvas, Shape};

/// What the file of a picture is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// Pixels: RGB, 8 bits.
    Png,
    /// Lines, areas and outlines of letters; surfaces seen from the side, and fields, are pixels in it.
    Svg,
    /// The same on a page of its own size, four pixels to a point.
    Pdf,
}

/// Why a picture could not be encoded.
#[derive(Debug, thiserror::Error)]
#[error("picture: cannot encode the image: {0}; free memory and run again")]
pub struct EncodingError(#[from] ::png::EncodingError);

/// A finished picture. It needs no file, and no font, to be shown.
pub struct Drawing(Canvas);

impl std::fmt::Debug for Drawing {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let [width, height] = self.0.size();
        write!(f, "Drawing({width} x {height})")
    }
}

impl Drawing {
    pub(crate) fn new(canvas: Canvas) -> Drawing {
        Drawing(canvas)
    }

    /// The bytes of a file, the same for the same data.
    ///
    /// # Errors
    /// If there is no memory for its pixels.
    pub fn encode(&self, format: Format) -> Result<Vec<u8>, EncodingError> {
        match format {
            Format::Png => Ok(png::encode(&self.0)?),
            Format::Svg => Ok(svg::encode(&self.0)?.into_bytes()),
            Format::Pdf => Ok(pdf::encode(&self.0)),
        }
    }
}

/// Neighbours that can be drawn as one: lines of one pen, areas of one colour.
fn runs(canvas: &Canvas) -> impl Iterator<Item = &[Shape]> {
    canvas.shapes().chunk_by(|a, b| match (a, b) {
        (Shape::Line { width: a, color: c, .. }, Shape::Line { width: b, color: d, .. }) => a == b && c == d,
        (Shape::Star { color: c, .. }, Shape::Star { color: d, .. }) => c == d,
        _ => false,
    })
}

/// The lines of a run as polylines.
fn polylines(run: &[Shape]) -> Vec<Vec<[f64; 2]>> {
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
fn polygons(run: &[Shape]) -> impl Iterator<Item = &[[f64; 2]]> {
    run.iter().filter_map(|shape| match shape {
        Shape::Star { corners, .. } => Some(corners.as_slice()),
        _ => None,
    })
}

#[cfg(test)]
mod tests;
