//! Pixels: everything is painted on a fine grid, and averaged down.

use png::{BitDepth, ColorType, Compression, DeflateCompression, Encoder, EncodingError, Filter};

use crate::parallel::prelude::*;
use crate::pictures::drawing::canvas::{Bitmap, Canvas, FINE, Shape};
use crate::pictures::drawing::color::{PAPER, Rgb, mix};
use crate::pictures::drawing::font::Font;
use crate::pictures::drawing::raster;

/// Rows of the picture that are painted and averaged at once: few enough for a cache, and enough for all cores.
const BAND: usize = 64;

/// The picture as PNG (RGB, 8 bits).
pub(super) fn encode(canvas: &Canvas) -> Result<Vec<u8>, EncodingError> {
    let [width, height] = canvas.size().map(|length| length as usize);
    let mut bytes = vec![0; 3 * width * height];
    bytes.par_chunks_mut(3 * width * BAND).enumerate().for_each(|(band, bytes)| {
        let rows = bytes.len() / (3 * width);
        Pixels::of(canvas, FINE * BAND * band, FINE * rows).average(bytes);
    });
    compressed([width, height], ColorType::Rgb, &bytes, |encoder| {
        // A third of the time of the usual effort, for a file that is a tenth larger.
        encoder.set_filter(Filter::Up);
        encoder.set_deflate_compression(DeflateCompression::Level(2));
    })
}

/// A bitmap as PNG (RGBA, 8 bits), pixel by pixel.
pub(super) fn encode_bitmap(bitmap: &Bitmap) -> Result<Vec<u8>, EncodingError> {
    compressed(bitmap.size, ColorType::Rgba, bitmap.pixels.as_flattened(), |encoder| {
        encoder.set_compression(Compression::Balanced);
    })
}

fn compressed(
    size: [usize; 2],
    color: ColorType,
    data: &[u8],
    effort: impl FnOnce(&mut Encoder<&mut Vec<u8>>),
) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, size[0] as u32, size[1] as u32);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    effort(&mut encoder);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(data)?;
    writer.finish()?;
    Ok(bytes)
}

/// Fine pixels of a canvas: all columns of some rows.
struct Pixels {
    /// The first row.
    top: usize,
    size: [usize; 2],
    pixels: Vec<Rgb>,
}

/// A length in fine pixels.
fn fine(x: f64) -> f64 {
    x * FINE as f64
}

impl Pixels {
    /// `count` rows from the row `top` on.
    fn of(canvas: &Canvas, top: usize, count: usize) -> Pixels {
        let size = [canvas.size()[0] as usize * FINE, count];
        let mut pixels = Pixels { top, size, pixels: vec![PAPER; size[0] * size[1]] };
        canvas.shapes().iter().for_each(|shape| pixels.paint(shape, canvas.font()));
        pixels
    }

    fn paint(&mut self, shape: &Shape, font: &Font) {
        let top = self.top as f64;
        let at = |[x, y]: [f64; 2]| [fine(x), fine(y) - top];
        let (size, pixels) = (self.size, &mut self.pixels);
        match shape {
            Shape::Line { ends, width, color } => {
                raster::line(ends.map(at), fine(*width) / 2.0, size, |column, row, _| {
                    pixels[row * size[0] + column] = *color;
                });
            }
            Shape::Rectangle { corners, color } => self.rectangle(corners.map(at), *color),
            Shape::Star { centre, corners, color } => {
                for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                    raster::triangle([*centre, *from, *to].map(at), size, |column, row, _| {
                        pixels[row * size[0] + column] = *color;
                    });
                }
            }
            Shape::Text { text, start, size, color } => {
                self.text(font, text, at(*start), fine(*size), *color)
            }
            Shape::Bitmap { corner, bitmap } => self.bitmap(corner.map(|x| x * FINE), bitmap),
            Shape::Window { corner, canvas } => self.window(corner.map(|x| x * FINE), canvas),
        }
    }

    fn text(&mut self, font: &Font, text: &str, start: [f64; 2], height: f64, color: Rgb) {
        // No letter reaches farther from its baseline than a line is high.
        if start[1] + height < 0.0 || start[1] - height > self.size[1] as f64 {
            return;
        }
        font.paint(text, start, height, |column, row, share| {
            if column < self.size[0] && row < self.size[1] {
                let pixel = &mut self.pixels[row * self.size[0] + column];
                *pixel = if share < 1.0 { mix(*pixel, color, share) } else { color };
            }
        });
    }

    fn rectangle(&mut self, corners: [[f64; 2]; 2], color: Rgb) {
        let [[left, top], [right, bottom]] = corners.map(|p| p.map(|x| x.round().max(0.0) as usize));
        let [right, bottom] = [right.min(self.size[0]), bottom.min(self.size[1])];
        for row in top..bottom {
            self.pixels[row * self.size[0]..][left.min(right)..right].fill(color);
        }
    }

    fn bitmap(&mut self, corner: [usize; 2], bitmap: &Bitmap) {
        for (row, to) in self.rows_under(corner, bitmap.size) {
            for (&[red, green, blue, cover], pixel) in bitmap.pixels[row * bitmap.size[0]..].iter().zip(to) {
                *pixel = match cover {
                    0 => *pixel,
                    255 => [red, green, blue],
                    _ => mix(*pixel, [red, green, blue], f64::from(cover) / 255.0),
                };
            }
        }
    }

    fn window(&mut self, corner: [usize; 2], canvas: &Canvas) {
        let size = canvas.size().map(|length| length as usize * FINE);
        let mut rows = self.rows_under(corner, size).peekable();
        let Some(&(top, _)) = rows.peek() else { return };
        let window = Pixels::of(canvas, top, rows.len());
        for (from, (_, to)) in window.pixels.chunks_exact(size[0]).zip(rows) {
            to.copy_from_slice(&from[..to.len()]);
        }
    }

    /// The rows of something of `size` fine pixels at `corner` that are among these: which one it is, and what lies under it.
    fn rows_under(
        &mut self,
        [left, above]: [usize; 2],
        size: [usize; 2],
    ) -> impl ExactSizeIterator<Item = (usize, &mut [Rgb])> {
        let [left, right] = [left, left + size[0]].map(|column| column.min(self.size[0]));
        let first = self.top.saturating_sub(above).min(size[1]);
        let rows = self.pixels.chunks_exact_mut(self.size[0]).skip(above.saturating_sub(self.top));
        (first..size[1]).zip(rows.map(move |row| &mut row[left..right]))
    }

    /// Writes the mean colour of the fine pixels of each pixel, row by row.
    fn average(&self, bytes: &mut [u8]) {
        let count = (FINE * FINE) as u16;
        let width = self.size[0] / FINE;
        let mut sums = vec![0; 3 * self.size[0]];
        let rows = self.pixels.chunks_exact(FINE * self.size[0]);
        for (rows, bytes) in rows.zip(bytes.chunks_exact_mut(3 * width)) {
            sums.fill(0u16);
            for row in rows.chunks_exact(self.size[0]) {
                for (sum, &channel) in sums.iter_mut().zip(row.as_flattened()) {
                    *sum += u16::from(channel);
                }
            }
            let (sums, means) = (sums.as_chunks::<{ 3 * FINE }>().0, bytes.as_chunks_mut::<3>().0);
            for (sums, mean) in sums.iter().zip(means) {
                let total = |channel: usize| (0..FINE).map(|k| sums[3 * k + channel]).sum::<u16>();
                *mean = [0, 1, 2].map(|channel| ((total(channel) + count / 2) / count) as u8);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pictures::drawing::canvas::Anchor;
    use crate::pictures::drawing::color::{CURVES, INK};
    use crate::pictures::drawing::samples::Image;

    /// Every shape, across the edges of bands.
    fn tall() -> Canvas {
        let height = 3 * BAND + 10;
        let mut canvas = Canvas::new([90, height]);
        canvas.fill([[2.0, 3.0], [12.0, height as f64 - 3.0]], CURVES[0]);
        canvas.line([[15.0, 5.0], [25.0, height as f64]], 3.0, CURVES[1]);
        canvas.triangle([[30.0, 0.0], [40.0, 100.0], [28.0, height as f64]], CURVES[3]);
        canvas.text("λ = 1", [42.0, BAND as f64], 14.0, INK, Anchor::Left);
        let pixels =
            (0..20 * 300).map(|k| [(k % 251) as u8, (k % 7) as u8, 9, 255 - (k % 3) as u8]).collect();
        canvas.bitmap([70, 30], Bitmap { size: [20, 300], pixels });
        let mut window = Canvas::new([8, 150]);
        window.line([[0.0, 0.0], [8.0, 150.0]], 2.0, CURVES[4]);
        canvas.paste(window, [80, 20]);
        canvas
    }

    /// The least effort would make it twice as large.
    #[test]
    fn less_effort_makes_little_larger_files() {
        /// The largest share that was seen in pictures of solutions is 1.14.
        const LARGER: f64 = 1.25;
        let bytes = encode(&tall()).unwrap();
        let image = Image::decode(&bytes);
        let packed = |effort| {
            let size = [image.width, image.height];
            let packed = compressed(size, ColorType::Rgb, image.pixels.as_flattened(), |encoder| {
                encoder.set_compression(effort);
            });
            packed.unwrap().len() as f64
        };
        let most = LARGER * packed(Compression::Balanced);
        assert!((bytes.len() as f64) < most, "{}, {most}", bytes.len());
        assert!(packed(Compression::Fastest) > most);
    }

    #[test]
    fn bands_are_those_of_the_whole() {
        let canvas = tall();
        let height = canvas.size()[1] as usize * FINE;
        let whole = Pixels::of(&canvas, 0, height);
        for (top, count) in [(0, 1), (FINE * BAND - 3, 7), (131, 200), (height - 5, 5)] {
            let band = Pixels::of(&canvas, top, count);
            assert!(
                band.pixels == whole.pixels[top * whole.size[0]..][..count * whole.size[0]],
                "from {top}"
            );
        }
        let elsewhere = Pixels::of(&canvas, 132, 200);
        assert!(elsewhere.pixels != whole.pixels[131 * whole.size[0]..][..200 * whole.size[0]]);
    }
}
