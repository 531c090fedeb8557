//! The drawing surface: lines, areas, text and bitmaps, kept as what they are until they are encoded.

use super::color::Rgb;
use super::font::{CAPITALS, Font};

/// Fine pixels per pixel and direction: smooth edges without any blending of lines.
pub(crate) const FINE: usize = 2;

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

/// What lies on a canvas, in its pixels, y downwards.
pub(crate) enum Shape {
    /// A straight line with round ends.
    Line { ends: [[f64; 2]; 2], width: f64, color: Rgb },
    /// A rectangle between its upper left and lower right corner.
    Rectangle { corners: [[f64; 2]; 2], color: Rgb },
    /// A polygon that is star-shaped around a point.
    Star { centre: [f64; 2], corners: Vec<[f64; 2]>, color: Rgb },
    /// A text from the left end of its baseline.
    Text { text: String, start: [f64; 2], size: f64, color: Rgb },
    /// Fine pixels from an upper left corner.
    Bitmap { corner: [usize; 2], bitmap: Bitmap },
    /// Another canvas, cut off at its edges, from an upper left corner.
    Window { corner: [usize; 2], canvas: Box<Canvas> },
}

/// Fine pixels: red, green, blue, and how much they cover.
pub(crate) struct Bitmap {
    /// Columns and rows.
    pub(crate) size: [usize; 2],
    pub(crate) pixels: Vec<[u8; 4]>,
}

/// A picture in the making; all lengths are in pixels of the finished picture, y downwards.
pub(crate) struct Canvas {
    size: [usize; 2],
    shapes: Vec<Shape>,
    font: Font,
}

impl Canvas {
    /// White paper of `size` pixels.
    pub(crate) fn new(size: [usize; 2]) -> Canvas {
        Canvas { size, shapes: Vec::new(), font: Font::new() }
    }

    /// Width and height in pixels.
    pub(crate) fn size(&self) -> [f64; 2] {
        self.size.map(|length| length as f64)
    }

    /// What was drawn, in its order.
    pub(crate) fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// The font of its texts.
    pub(crate) fn font(&self) -> &Font {
        &self.font
    }

    /// A straight line with round ends.
    pub(crate) fn line(&mut self, ends: [[f64; 2]; 2], width: f64, color: Rgb) {
        self.shapes.push(Shape::Line { ends, width, color });
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
    pub(crate) fn fill(&mut self, corners: [[f64; 2]; 2], color: Rgb) {
        self.shapes.push(Shape::Rectangle { corners, color });
    }

    /// A filled triangle.
    pub(crate) fn triangle(&mut self, corners: [[f64; 2]; 3], color: Rgb) {
        self.star(corners[0], corners.to_vec(), color);
    }

    /// A filled polygon that is star-shaped around `centre`.
    pub(crate) fn star(&mut self, centre: [f64; 2], corners: Vec<[f64; 2]>, color: Rgb) {
        self.shapes.push(Shape::Star { centre, corners, color });
    }

    /// A filled disc.
    pub(crate) fn dot(&mut self, centre: [f64; 2], radius: f64, color: Rgb) {
        self.line([centre, centre], 2.0 * radius, color);
    }

    /// Fine pixels, from the upper left `corner` in pixels.
    pub(crate) fn bitmap(&mut self, corner: [usize; 2], bitmap: Bitmap) {
        self.shapes.push(Shape::Bitmap { corner, bitmap });
    }

    /// Puts what lies on another canvas of the same size on top of this one.
    pub(crate) fn lay(&mut self, over: Canvas) {
        self.shapes.extend(over.shapes);
    }

    /// Puts another canvas onto this one, its upper left corner to the pixel `corner`; it must fit.
    pub(crate) fn paste(&mut self, canvas: Canvas, corner: [usize; 2]) {
        self.shapes.push(Shape::Window { corner, canvas: Box::new(canvas) });
    }

    /// One line of text, its capitals centred on the height of `at`; `size` is the height of a line.
    pub(crate) fn text(&mut self, text: &str, at: [f64; 2], size: f64, color: Rgb, anchor: Anchor) {
        let left = match anchor {
            Anchor::Left => at[0],
            Anchor::Middle => at[0] - self.width(text, size) / 2.0,
            Anchor::Right => at[0] - self.width(text, size),
        };
        let start = [left, at[1] + CAPITALS / 2.0 * size];
        self.shapes.push(Shape::Text { text: text.to_owned(), start, size, color });
    }

    /// The width of a text.
    pub(crate) fn width(&self, text: &str, size: f64) -> f64 {
        self.font.set(text, size).1
    }

    /// How many of the first letters fit into `room`.
    pub(crate) fn fitting(&self, letters: &[char], size: f64, room: f64) -> usize {
        let fits = |count: &usize| self.width(&letters[..*count].iter().collect::<String>(), size) <= room;
        (0..=letters.len()).rev().find(fits).unwrap_or(0)
    }
}
