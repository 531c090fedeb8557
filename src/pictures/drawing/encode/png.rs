//! Pixels: everything is painted on a fine grid, and averaged down.

use crate::parallel::prelude::*;
use png::{BitDepth, ColorType, Encoder, EncodingError};

use crate::pictures::drawing::canvas::{Bitmap, Canvas, FINE, Shape};
use crate::pictures::drawing::color::{PAPER, Rgb, mix};
use crate::pictures::drawing::font::Font;
use crate::pictures::drawing::raster;

/// The picture as PNG (RGB, 8 bits).
pub(super) fn encode(canvas: &Canvas) -> Result<Vec<u8>, EncodingError> {
    let size = canvas.size().map(|length| length as usize);
    compressed(size, ColorType::Rgb, &Pixels::of(canvas).averaged())
}

/// A bitmap as PNG (RGBA, 8 bits), pixel by pixel.
pub(super) fn encode_bitmap(bitmap: &Bitmap) -> Result<Vec<u8>, EncodingError> {
    compressed(bitmap.size, ColorType::Rgba, bitmap.pixels.as_flattened())
}

fn compressed(size: [usize; 2], color: ColorType, data: &[u8]) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, size[0] as u32, size[1] as u32);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(data)?;
    writer.finish()?;
    Ok(bytes)
}

/// The fine pixels of a canvas.
struct Pixels {
    size: [usize; 2],
    pixels: Vec<Rgb>,
}

/// A length in fine pixels.
fn fine(x: f64) -> f64 {
    x * FINE as f64
}

impl Pixels {
    fn of(canvas: &Canvas) -> Pixels {
        let size = canvas.size().map(|length| length as usize * FINE);
        let mut pixels = Pixels { size, pixels: vec![PAPER; size[0] * size[1]] };
        canvas.shapes().iter().for_each(|shape| pixels.paint(shape, canvas.font()));
        pixels
    }

    fn paint(&mut self, shape: &Shape, font: &Font) {
        let (size, pixels) = (self.size, &mut self.pixels);
        match shape {
            Shape::Line { ends, width, color } => {
                raster::line(ends.map(|p| p.map(fine)), fine(*width) / 2.0, size, |column, row, _| {
                    pixels[row * size[0] + column] = *color;
                });
            }
            Shape::Rectangle { corners, color } => self.rectangle(*corners, *color),
            Shape::Star { centre, corners, color } => {
                for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                    raster::triangle([*centre, *from, *to].map(|p| p.map(fine)), size, |column, row, _| {
                        pixels[row * size[0] + column] = *color;
                    });
                }
            }
            Shape::Text { text, start, size, color } => {
                font.paint(text, start.map(fine), fine(*size), |column, row, cover| {
                    self.blend([column, row], *color, cover);
                });
            }
            Shape::Bitmap { corner, bitmap } => self.bitmap(corner.map(|x| x * FINE), bitmap),
            Shape::Window { corner, canvas } => self.window(corner.map(|x| x * FINE), &Pixels::of(canvas)),
        }
    }

    fn blend(&mut self, [column, row]: [usize; 2], color: Rgb, share: f64) {
        if column < self.size[0] && row < self.size[1] {
            let pixel = &mut self.pixels[row * self.size[0] + column];
            *pixel = if share < 1.0 { mix(*pixel, color, share) } else { color };
        }
    }

    fn rectangle(&mut self, corners: [[f64; 2]; 2], color: Rgb) {
        let [[left, top], [right, bottom]] = corners.map(|p| p.map(|x| fine(x).round().max(0.0) as usize));
        let [right, bottom] = [right.min(self.size[0]), bottom.min(self.size[1])];
        for row in top..bottom {
            self.pixels[row * self.size[0]..][left.min(right)..right].fill(color);
        }
    }

    fn bitmap(&mut self, [left, top]: [usize; 2], bitmap: &Bitmap) {
        let columns = bitmap.size[0].min(self.size[0].saturating_sub(left));
        let rows = self.pixels.chunks_exact_mut(self.size[0]).skip(top);
        for (from, to) in bitmap.pixels.chunks_exact(bitmap.size[0]).zip(rows) {
            for (&[red, green, blue, cover], pixel) in from[..columns].iter().zip(&mut to[left..]) {
                *pixel = match cover {
                    0 => *pixel,
                    255 => [red, green, blue],
                    _ => mix(*pixel, [red, green, blue], f64::from(cover) / 255.0),
                };
            }
        }
    }

    fn window(&mut self, [left, top]: [usize; 2], other: &Pixels) {
        for (row, pixels) in other.pixels.chunks_exact(other.size[0]).enumerate() {
            let start = (top + row) * self.size[0] + left;
            self.pixels[start..start + other.size[0]].copy_from_slice(pixels);
        }
    }

    /// The mean colour of the fine pixels of each pixel, row by row.
    fn averaged(&self) -> Vec<u8> {
        let count = (FINE * FINE) as u32;
        let [width, height] = self.size.map(|length| length / FINE);
        let mut bytes = vec![0; 3 * width * height];
        bytes.par_chunks_mut(3 * width).enumerate().for_each(|(row, bytes)| {
            for (column, mean) in bytes.chunks_exact_mut(3).enumerate() {
                let mut sum = [0u32; 3];
                for fine_row in FINE * row..FINE * (row + 1) {
                    let start = fine_row * self.size[0] + FINE * column;
                    for pixel in &self.pixels[start..start + FINE] {
                        (0..3).for_each(|k| sum[k] += u32::from(pixel[k]));
                    }
                }
                mean.copy_from_slice(&sum.map(|total| ((total + count / 2) / count) as u8));
            }
        });
        bytes
    }
}
