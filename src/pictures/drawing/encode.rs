//! Finished pictures as files: pixels, or lines and outlines that stay sharp in print.

mod pdf;
mod png;
mod runs;
mod svg;

use super::canvas::Canvas;

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
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Drawing")
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

#[cfg(test)]
mod tests;
