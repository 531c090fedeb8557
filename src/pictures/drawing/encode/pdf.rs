//! Portable Document Format: one page, of the size of the picture. Letters are outlines, no font is needed.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref};

use super::runs::{polygons, polylines, runs};
use crate::pictures::drawing::canvas::{Bitmap, Canvas, FINE, Shape};
use crate::pictures::drawing::color::Rgb;
use crate::pictures::drawing::font::Stroke;

/// Points per pixel: a picture is as wide as the text of a page.
const POINT: f32 = 0.25;

const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const PAGE: Ref = Ref::new(3);
const CONTENT: Ref = Ref::new(4);
/// The first bitmap; each takes two numbers, for its colours and for how much it covers.
const BITMAPS: i32 = 5;

/// The picture as PDF.
pub(super) fn encode(canvas: &Canvas) -> Vec<u8> {
    let [width, height] = canvas.size().map(|length| length as f32 * POINT);
    let mut page = Page { content: Content::new(), bitmaps: Vec::new() };
    page.content.set_line_cap(LineCapStyle::RoundCap).set_line_join(LineJoinStyle::RoundJoin);
    page.content.transform([POINT, 0.0, 0.0, -POINT, 0.0, height]);
    page.draw(canvas);

    let mut pdf = Pdf::new();
    pdf.catalog(CATALOG).pages(PAGES);
    pdf.pages(PAGES).kids([PAGE]).count(1);
    let mut leaf = pdf.page(PAGE);
    leaf.parent(PAGES).media_box(Rect::new(0.0, 0.0, width, height)).contents(CONTENT);
    let mut resources = leaf.resources();
    let mut objects = resources.x_objects();
    for k in 0..page.bitmaps.len() {
        objects.pair(Name(name(k).as_bytes()), colors(k));
    }
    objects.finish();
    resources.finish();
    leaf.finish();
    let content = deflated(&page.content.finish());
    pdf.stream(CONTENT, &content).filter(Filter::FlateDecode);
    for (k, bitmap) in page.bitmaps.iter().enumerate() {
        write_bitmap(&mut pdf, k, bitmap);
    }
    pdf.finish()
}

fn name(bitmap: usize) -> String {
    format!("B{bitmap}")
}

fn colors(bitmap: usize) -> Ref {
    Ref::new(BITMAPS + 2 * bitmap as i32)
}

fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("memory can be written to")
}

fn write_bitmap(pdf: &mut Pdf, k: usize, bitmap: &Bitmap) {
    let [width, height] = bitmap.size.map(|length| length as i32);
    let covers = Ref::new(colors(k).get() + 1);
    let rgb: Vec<u8> = bitmap.pixels.iter().flat_map(|&[red, green, blue, _]| [red, green, blue]).collect();
    let cover: Vec<u8> = bitmap.pixels.iter().map(|pixel| pixel[3]).collect();
    let (rgb, cover) = (deflated(&rgb), deflated(&cover));
    let mut image = pdf.image_xobject(colors(k), &rgb);
    image.filter(Filter::FlateDecode);
    image.width(width).height(height).bits_per_component(8).s_mask(covers);
    image.color_space().device_rgb();
    image.finish();
    let mut mask = pdf.image_xobject(covers, &cover);
    mask.filter(Filter::FlateDecode);
    mask.width(width).height(height).bits_per_component(8);
    mask.color_space().device_gray();
}

/// The page in the making.
struct Page<'a> {
    content: Content,
    bitmaps: Vec<&'a Bitmap>,
}

impl<'a> Page<'a> {
    fn draw(&mut self, canvas: &'a Canvas) {
        for run in runs(canvas) {
            match &run[0] {
                Shape::Line { width, color, .. } => {
                    let [red, green, blue] = shares(*color);
                    self.content.set_stroke_rgb(red, green, blue).set_line_width(*width as f32);
                    polylines(run).iter().for_each(|line| self.trace(line));
                    self.content.stroke();
                }
                Shape::Rectangle { corners: [[left, top], [right, bottom]], color } => {
                    self.color(*color);
                    self.trace(&[[*left, *top], [*right, *top], [*right, *bottom], [*left, *bottom]]);
                    self.content.fill_nonzero();
                }
                Shape::Star { color, .. } => {
                    self.color(*color);
                    polygons(run).for_each(|polygon| self.trace(polygon));
                    self.content.fill_nonzero();
                }
                Shape::Text { text, start, size, color } => {
                    self.color(*color);
                    self.outlines(&canvas.font().outlines(text, *start, *size));
                }
                Shape::Bitmap { corner, bitmap } => self.bitmap(*corner, bitmap),
                Shape::Window { corner, canvas } => {
                    let [[left, top], [width, height]] =
                        [corner.map(|x| x as f32), canvas.size().map(|length| length as f32)];
                    self.content.save_state().transform([1.0, 0.0, 0.0, 1.0, left, top]);
                    self.content.rect(0.0, 0.0, width, height).clip_nonzero().end_path();
                    self.draw(canvas);
                    self.content.restore_state();
                }
            }
        }
    }

    fn color(&mut self, color: Rgb) {
        let [red, green, blue] = shares(color);
        self.content.set_fill_rgb(red, green, blue);
    }

    fn trace(&mut self, line: &[[f64; 2]]) {
        for (k, point) in line.iter().enumerate() {
            let [x, y] = point.map(|x| x as f32);
            let _ = if k == 0 { self.content.move_to(x, y) } else { self.content.line_to(x, y) };
        }
    }

    fn outlines(&mut self, strokes: &[Stroke]) {
        for stroke in strokes {
            match stroke {
                Stroke::Move([x, y]) => self.content.move_to(*x as f32, *y as f32),
                Stroke::Line([x, y]) => self.content.line_to(*x as f32, *y as f32),
                Stroke::Curve(points) => {
                    let [[a, b], [c, d], [x, y]] = points.map(|p| p.map(|x| x as f32));
                    self.content.cubic_to(a, b, c, d, x, y)
                }
            };
        }
        self.content.fill_nonzero();
    }

    /// A bitmap fills the unit square, upwards.
    fn bitmap(&mut self, corner: [usize; 2], bitmap: &'a Bitmap) {
        let [left, top] = corner.map(|x| x as f32);
        let [width, height] = bitmap.size.map(|length| length as f32 / FINE as f32);
        self.content.save_state().transform([width, 0.0, 0.0, -height, left, top + height]);
        self.content.x_object(Name(name(self.bitmaps.len()).as_bytes()));
        self.content.restore_state();
        self.bitmaps.push(bitmap);
    }
}

fn shares(color: Rgb) -> [f32; 3] {
    color.map(|part| f32::from(part) / 255.0)
}
