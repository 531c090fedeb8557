//! Scalable Vector Graphics 1.1. Letters are outlines: they look the same wherever the file is opened.

use std::fmt::{Display, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use png::EncodingError;

use super::png::encode_bitmap;
use super::runs::{polygons, polylines, runs};
use crate::pictures::drawing::canvas::{Canvas, FINE, Shape};
use crate::pictures::drawing::color::{PAPER, Rgb};
use crate::pictures::drawing::font::Stroke;

/// The picture as SVG.
pub(super) fn encode(canvas: &Canvas) -> Result<String, EncodingError> {
    let [width, height] = canvas.size();
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
         width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
    );
    text += &shapes(canvas)?;
    Ok(text + "</svg>\n")
}

/// White paper, and what is on it.
fn shapes(canvas: &Canvas) -> Result<String, EncodingError> {
    let [width, height] = canvas.size();
    let mut text = format!("<path fill=\"{}\" d=\"M0 0H{width}V{height}H0Z\"/>\n", hex(PAPER));
    for run in runs(canvas) {
        text += &match &run[0] {
            Shape::Line { width, color, .. } => format!(
                "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" \
                 stroke-linejoin=\"round\" d=\"{}\"/>\n",
                hex(*color),
                short(*width),
                path(polylines(run).iter().map(Vec::as_slice), "")
            ),
            Shape::Rectangle { corners: [[left, top], [right, bottom]], color } => {
                let corners = [[*left, *top], [*right, *top], [*right, *bottom], [*left, *bottom]];
                area(*color, &path([corners.as_slice()].into_iter(), "Z"))
            }
            Shape::Star { color, .. } => area(*color, &path(polygons(run), "Z")),
            Shape::Text { text, start, size, color } => {
                area(*color, &outlines(&canvas.font().outlines(text, *start, *size)))
            }
            Shape::Bitmap { corner: [left, top], bitmap } => {
                let [width, height] = bitmap.size.map(|length| short(length as f64 / FINE as f64));
                let data = STANDARD.encode(encode_bitmap(bitmap)?);
                format!(
                    "<image x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" \
                     xlink:href=\"data:image/png;base64,{data}\"/>\n"
                )
            }
            Shape::Window { corner: [left, top], canvas } => {
                let [width, height] = canvas.size();
                let inside = shapes(canvas)?;
                // No two windows lie on one another. Nested `svg` elements would do as well, but not in every program.
                let name = format!("w{left}-{top}");
                format!(
                    "<clipPath id=\"{name}\"><path d=\"M0 0H{width}V{height}H0Z\"/></clipPath>\n\
                     <g transform=\"translate({left} {top})\" clip-path=\"url(#{name})\">\n{inside}</g>\n"
                )
            }
        };
    }
    Ok(text)
}

fn area(color: Rgb, data: &str) -> String {
    format!("<path fill=\"{}\" d=\"{data}\"/>\n", hex(color))
}

/// Polylines, each ended by `end`.
fn path<'a>(lines: impl Iterator<Item = &'a [[f64; 2]]>, end: &str) -> String {
    let mut data = String::new();
    for line in lines {
        for (k, &point) in line.iter().enumerate() {
            push(&mut data, if k == 0 { "M" } else { "L" }, &[point]);
        }
        data += end;
    }
    data
}

fn outlines(strokes: &[Stroke]) -> String {
    let mut data = String::new();
    for stroke in strokes {
        match stroke {
            Stroke::Move(point) => push(&mut data, "M", &[*point]),
            Stroke::Line(point) => push(&mut data, "L", &[*point]),
            Stroke::Curve(points) => push(&mut data, "C", points),
        }
    }
    data
}

fn push(data: &mut String, letter: &str, points: &[[f64; 2]]) {
    data.push_str(letter);
    for (k, [x, y]) in points.iter().enumerate() {
        let apart = if k == 0 { "" } else { " " };
        write!(data, "{apart}{} {}", short(*x), short(*y)).expect("a string can be written to");
    }
}

/// A length to a hundredth of a pixel.
fn short(x: f64) -> impl Display {
    (x * 100.0).round() / 100.0
}

fn hex([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}
