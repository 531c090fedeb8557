//! The letters: their widths and outlines.

use ab_glyph::{Font as _, FontRef, Glyph, OutlineCurve, Point, PxScale, ScaleFont, point};

/// DejaVu Sans: Latin, Greek, Cyrillic, Arabic, Hebrew, sub- and superscripts.
static FONT: &[u8] = include_bytes!("../../../assets/DejaVuSans.ttf");

/// The height of capitals over the height of a line, for DejaVu Sans.
pub(crate) const CAPITALS: f64 = 0.626;

/// A part of an outline, from where the last one ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Stroke {
    /// To a new contour.
    Move([f64; 2]),
    /// A straight line.
    Line([f64; 2]),
    /// A cubic Bézier curve, by its last three points.
    Curve([[f64; 2]; 3]),
}

/// The font of all pictures.
#[derive(Clone)]
pub(crate) struct Font(FontRef<'static>);

impl Font {
    pub(crate) fn new() -> Font {
        Font(FontRef::try_from_slice(FONT).expect("the font in assets/ is a valid font file"))
    }

    /// The glyphs of a text side by side from 0, and their total width.
    pub(crate) fn set(&self, text: &str, size: f64) -> (Vec<Glyph>, f64) {
        let scale = PxScale::from(size as f32);
        let font = self.0.as_scaled(scale);
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

    /// Calls `paint(column, row, cover)` for each pixel that a text touches; `start` is the left end of its baseline.
    pub(crate) fn paint(
        &self,
        text: &str,
        start: [f64; 2],
        size: f64,
        mut paint: impl FnMut(usize, usize, f64),
    ) {
        for mut glyph in self.set(text, size).0 {
            glyph.position.x += start[0] as f32;
            glyph.position.y = start[1] as f32;
            let Some(outline) = self.0.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|x, y, cover| {
                let [column, row] = [corner.x + x as f32, corner.y + y as f32];
                if column >= 0.0 && row >= 0.0 {
                    paint(column as usize, row as usize, f64::from(cover.clamp(0.0, 1.0)));
                }
            });
        }
    }

    /// The outlines of a text, filled where they wind around; `start` is the left end of its baseline.
    pub(crate) fn outlines(&self, text: &str, start: [f64; 2], size: f64) -> Vec<Stroke> {
        let mut strokes = Vec::new();
        let scale = size / f64::from(self.0.height_unscaled());
        for glyph in self.set(text, size).0 {
            let Some(outline) = self.0.outline(glyph.id) else { continue };
            let left = start[0] + f64::from(glyph.position.x);
            let at = |p: Point| [left + f64::from(p.x) * scale, start[1] - f64::from(p.y) * scale];
            let mut pen = None;
            for curve in outline.curves {
                let (from, stroke, to) = match curve {
                    OutlineCurve::Line(p, q) => (p, Stroke::Line(at(q)), q),
                    OutlineCurve::Quad(p, q, r) => (p, Stroke::Curve(cubic([p, q, r].map(at))), r),
                    OutlineCurve::Cubic(p, q, r, s) => (p, Stroke::Curve([q, r, s].map(at)), s),
                };
                if pen != Some(from) {
                    strokes.push(Stroke::Move(at(from)));
                }
                strokes.push(stroke);
                pen = Some(to);
            }
        }
        strokes
    }
}

/// The last three points of the cubic curve that is this quadratic one.
fn cubic([p, q, r]: [[f64; 2]; 3]) -> [[f64; 2]; 3] {
    let towards = |from: [f64; 2]| [0, 1].map(|k| from[k] + (q[k] - from[k]) * 2.0 / 3.0);
    [towards(p), towards(r), r]
}
