//! Seconds against vertices: curves that need not share their meshes.

use super::coordinates::Axes;
use super::curve::Curve;
use super::labels::decimal;
use super::panel::{Panel, SIZE};
use crate::pictures::drawing::canvas::Canvas;
use crate::pictures::drawing::encode::Drawing;
use crate::pictures::drawing::frame::Frame;
use crate::pictures::drawing::heading::heading;
use crate::study::exponent;

/// Up to this many curves can be told apart in one plot; more are drawn group by group.
const IN_ONE: usize = 7;
/// The most curves of a panel of a group.
const IN_PANEL: usize = 5;
/// Panels stand side by side, this many.
const COLUMNS: usize = 2;
/// Width and height of a panel in pixels.
const PANEL: [usize; 2] = [1100, 760];

/// Times of several solvers, to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct TimesPicture<'a> {
    /// The heading; what does not fit into two lines is cut off.
    pub title: &'a str,
    /// The curves.
    pub curves: &'a [Times<'a>],
    /// The slopes to be drawn for comparison; what is not finite is left out.
    pub slopes: &'a [f64],
}

/// The times of one solver.
#[derive(Clone, Copy, Debug)]
pub struct Times<'a> {
    /// What it is called beside its curve; cut off if it is very long.
    pub name: &'a str,
    /// What it belongs to: many curves are drawn group by group, each with the others behind them.
    pub group: &'a str,
    /// Vertices and seconds in any order. Those that are not positive and finite have no logarithm and are left out.
    pub points: &'a [[f64; 2]],
}

/// Draws seconds against vertices, beside each curve its slope by least squares, the same for the same data: seven curves in
/// one plot of 1800 x 1200 pixels, more in panels of their groups, of the same scale.
pub fn render_times(picture: &TimesPicture) -> Drawing {
    let curves = |times: &[Times]| times.iter().map(|times| Curve::through(times.points)).collect();
    let all: Vec<Curve> = curves(picture.curves);
    let groups = groups(picture.curves);
    let axes = Axes::over(&all);
    let panel = |title, names, slopes: &[Curve], compared| Panel {
        title,
        names,
        other_names: &[],
        slopes: slopes.iter().map(fitted).collect(),
        curves: &[],
        others: &[],
        axes,
        axis_names: ["vertices", "seconds"],
        slope_name: "slope",
        compared,
        note: None,
    };
    if all.len() <= IN_ONE {
        let several = groups.iter().any(|group| group.times[0].group != picture.curves[0].group);
        let name = |times: &Times| match (several, times.group) {
            (true, group) if !group.is_empty() => format!("{} ({group})", times.name),
            _ => times.name.to_owned(),
        };
        let names = picture.curves.iter().map(name).collect();
        let mut canvas = Canvas::new(SIZE);
        heading(&mut canvas, picture.title);
        Panel { curves: &all, ..panel("", names, &all, picture.slopes) }.draw_alone(&mut canvas);
        return Drawing::new(canvas);
    }
    let mut canvas = Canvas::new([COLUMNS * PANEL[0], 40 + PANEL[1] * groups.len().div_ceil(COLUMNS)]);
    heading(&mut canvas, picture.title);
    let [width, height] = PANEL.map(|length| length as f64);
    let every: Vec<String> = picture.curves.iter().map(|times| times.name.to_owned()).collect();
    for (k, group) in groups.iter().enumerate() {
        let names = group.times.iter().map(|times| times.name.to_owned()).collect();
        let own: Vec<Curve> = curves(&group.times);
        // The slopes to compare with stand once, for all panels have the same scale.
        let compared = if k == 0 { picture.slopes } else { &[] };
        let [left, top] = [(k % COLUMNS) as f64 * width, 40.0 + (k / COLUMNS) as f64 * height];
        let room = Frame { left, top, width, height };
        Panel {
            curves: &own,
            others: &all,
            other_names: &every,
            ..panel(&group.name, names, &own, compared)
        }
        .draw(&mut canvas, room);
    }
    Drawing::new(canvas)
}

/// The slope by least squares.
fn fitted(curve: &Curve) -> String {
    let points = curve.points().map(|point| point.map(|log| 10f64.powf(log)));
    exponent(points).map_or_else(|| "–".to_owned(), decimal)
}

/// Curves of one panel.
pub(super) struct Group<'a> {
    pub(super) name: String,
    pub(super) times: Vec<Times<'a>>,
}

/// The groups in the order of their first curves, large ones in parts.
pub(super) fn groups<'a>(curves: &[Times<'a>]) -> Vec<Group<'a>> {
    let mut names: Vec<&str> = Vec::new();
    for times in curves {
        if !names.contains(&times.group) {
            names.push(times.group);
        }
    }
    let parts = |name: &&'a str| {
        let times: Vec<Times> = curves.iter().copied().filter(|times| times.group == *name).collect();
        let count = times.len().div_ceil(IN_PANEL);
        let part = times.len().div_ceil(count);
        let title =
            |k: usize| if count == 1 { (*name).to_owned() } else { format!("{name}, {} of {count}", k + 1) };
        let group = |(k, times): (usize, &[Times<'a>])| Group { name: title(k), times: times.to_vec() };
        times.chunks(part).enumerate().map(group).collect::<Vec<_>>()
    };
    names.iter().flat_map(parts).collect()
}
