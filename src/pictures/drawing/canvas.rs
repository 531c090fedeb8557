//! The drawing surface: lines, areas and text on a fine grid of pixels, averaged down when encoded.

use ab_glyph::{Font, FontRef, Glyph, PxScale, ScaleFont, point};
use rayon::prelude::*;

use super::color::{PAPER, Rgb, mix};
use super::raster;

/// Fine pixels per pixel and direction: smooth edges without any blending of lines.
pub(crate) const FINE: usize = 3;

/// DejaVu Sans: Latin, Greek, Cyrillic, Arabic, Hebrew, sub- and superscripts.
static FONT: &[u8] = include_bytes!("../../../assets/DejaVuSans.ttf");

/// The height of capitals over the height of a line, for DejaVu Sans.
const CAPITALS: f64 = 0.626;

/// Which part of a text lies at the given point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Anchor {
    /// The left end.
    Left,
    /// The middle.
    Middle,
    /// The right end.
    Right,
}

/// A picture in the making; all lengths are in pixels of the finished picture, y downwards.
pub(crate) struct Canvas {
    size: [usize; 2],
    pixels: Vec<Rgb>,
    font: FontRef<'static>,
}

impl Canvas {
    /// White paper of `size` pixels.
    pub(crate) fn new(size: [usize; 2]) -> Canvas {
        let font = FontRef::try_from_slice(FONT).expect("the font in assets/ is a valid font file");
        let size = size.map(|length| length * FINE);
        Canvas { size, pixels: vec![PAPER; size[0] * size[1]], font }
    }

    /// Width and height in pixels.
    pub(crate) fn size(&self) -> [f64; 2] {
        self.size.map(|length| (length / FINE) as f64)
    }

    /// Paints the fine pixel (`column`, `row`), if it exists.
    pub(crate) fn blend(&mut self, column: usize, row: usize, color: Rgb, share: f64) {
        if column < self.size[0] && row < self.size[1] {
            let pixel = &mut self.pixels[row * self.size[0] + column];
            *pixel = if share < 1.0 { mix(*pixel, color, share) } else { color };
        }
    }

    /// A straight line with round ends.
    pub(crate) fn line(&mut self, ends: [[f64; 2]; 2], width: f64, color: Rgb) {
        let fine = FINE as f64;
        let (size, pixels) = (self.size, &mut self.pixels);
        raster::line(ends.map(|p| p.map(|x| x * fine)), width * fine / 2.0, size, |column, row, _| {
            pixels[row * size[0] + column] = color;
        });
    }

    /// A dashed straight line.
    pub(crate) fn dashed(&mut self, [from, to]: [[f64; 2]; 2], width: f64, color: Rgb) {
        const DASH: f64 = 12.0;
        const PERIOD: f64 = 20.0;
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let at = |distance: f64| [0, 1].map(|k| from[k] + (to[k] - from[k]) * (distance / length).min(1.0));
        for dash in 0..(length / PERIOD).ceil() as usize {
            let start = dash as f64 * PERIOD;
            self.line([at(start), at(start + DASH)], width, color);
        }
    }

    /// The filled rectangle between two corners.
    pub(crate) fn fill(&mut self, [low, high]: [[f64; 2]; 2], color: Rgb) {
        let [left, top] = low.map(|x| (x * FINE as f64).round().max(0.0) as usize);
        let [right, bottom] = high.map(|x| (x * FINE as f64).round().max(0.0) as usize);
        for row in top..bottom.min(self.size[1]) {
            for column in left..right.min(self.size[0]) {
                self.pixels[row * self.size[0] + column] = color;
            }
        }
    }

    /// A filled triangle.
    pub(crate) fn triangle(&mut self, corners: [[f64; 2]; 3], color: Rgb) {
        let (size, pixels) = (self.size, &mut self.pixels);
        raster::triangle(corners.map(|p| p.map(|x| x * FINE as f64)), size, |column, row, _| {
            pixels[row * size[0] + column] = color;
        });
    }

    /// Copies another canvas onto this one, its upper left corner to the pixel `[left, top]`; it must fit.
    pub(crate) fn paste(&mut self, other: &Canvas, [left, top]: [usize; 2]) {
        for (row, pixels) in other.pixels.chunks_exact(other.size[0]).enumerate() {
            let start = (top * FINE + row) * self.size[0] + left * FINE;
            self.pixels[start..start + other.size[0]].copy_from_slice(pixels);
        }
    }

    /// A filled disc.
    pub(crate) fn dot(&mut self, centre: [f64; 2], radius: f64, color: Rgb) {
        self.line([centre, centre], 2.0 * radius, color);
    }

    /// One line of text, its capitals centred on the height of `at`; `size` is the height of a line.
    pub(crate) fn text(&mut self, text: &str, at: [f64; 2], size: f64, color: Rgb, anchor: Anchor) {
        let fine = FINE as f64;
        let (glyphs, width) = self.set(text, size * fine);
        let left = match anchor {
            Anchor::Left => at[0] * fine,
            Anchor::Middle => at[0] * fine - width / 2.0,
            Anchor::Right => at[0] * fine - width,
        };
        let baseline = (at[1] + CAPITALS / 2.0 * size) * fine;
        for mut glyph in glyphs {
            glyph.position.x += left as f32;
            glyph.position.y = baseline as f32;
            let Some(outline) = self.font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|x, y, cover| {
                let [column, row] = [corner.x + x as f32, corner.y + y as f32];
                if column >= 0.0 && row >= 0.0 {
                    self.blend(column as usize, row as usize, color, f64::from(cover.clamp(0.0, 1.0)));
                }
            });
        }
    }

    /// The width of a text.
    pub(crate) fn width(&self, text: &str, size: f64) -> f64 {
        self.set(text, size).1
    }

    /// How many of the first letters fit into `room`.
    pub(crate) fn fitting(&self, letters: &[char], size: f64, room: f64) -> usize {
        let fits = |count: &usize| self.width(&letters[..*count].iter().collect::<String>(), size) <= room;
        (0..=letters.len()).rev().find(fits).unwrap_or(0)
    }

    /// The glyphs of a text side by side from 0, and their total width.
    fn set(&self, text: &str, size: f64) -> (Vec<Glyph>, f64) {
        let scale = PxScale::from(size as f32);
        let font = self.font.as_scaled(scale);
        let (mut glyphs, mut pen, mut last) = (Vec::new(), 0.0, None);
        for character in text.chars() {
            let id = font.glyph_id(character);
            pen += last.map_or(0.0, |last| font.kern(last, id));
            glyphs.push(id.with_scale_and_position(scale, point(pen, 0.0)));
            pen += font.h_advance(id);
            last = Some(id);
        }
        (glyphs, f64::from(pen))
    }

    /// The picture as PNG (RGB, 8 bits).
    pub(crate) fn encode(&self) -> Result<Vec<u8>, png::EncodingError> {
        let [width, height] = self.size.map(|length| length / FINE);
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.averaged(width, height))?;
        writer.finish()?;
        Ok(bytes)
    }

    fn averaged(&self, width: usize, height: usize) -> Vec<u8> {
        let count = (FINE * FINE) as u32;
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
