//! Finished pictures, for the tests.

use super::canvas::Canvas;
use super::color::Rgb;
use super::encode::{Drawing, Format};

/// The pixels of a decoded picture.
pub(crate) struct Image {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) pixels: Vec<Rgb>,
}

impl Image {
    pub(crate) fn decode(bytes: &[u8]) -> Image {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG header");
        let mut data = vec![0; reader.output_buffer_size().expect("a size that fits into memory")];
        let info = reader.next_frame(&mut data).expect("PNG data");
        let pixels = data.chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        Image { width: info.width as usize, height: info.height as usize, pixels }
    }

    pub(crate) fn of(canvas: Canvas) -> Image {
        Image::decode(&Drawing::new(canvas).encode(Format::Png).expect("an image"))
    }

    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> Rgb {
        self.pixels[y as usize * self.width + x as usize]
    }

    pub(crate) fn count(&self, color: Rgb) -> usize {
        self.pixels.iter().filter(|&&pixel| pixel == color).count()
    }
}
