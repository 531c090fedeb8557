//! One plot: curves with their names and slopes.

use super::coordinates::{Axes, Coordinates};
use super::curve::Curve;
use super::labels::Labels;
use super::marker::{self, MARKER, color};
use super::slopes::Fan;
use crate::pictures::drawing::canvas::{Anchor, Canvas};
use crate::pictures::drawing::color::{INK, PAPER, RULE};
use crate::pictures::drawing::frame::{Frame, NORMAL, SMALL};

/// Width and height in pixels of a picture with one plot.
pub(super) const SIZE: [usize; 2] = [1800, 1200];

/// Around the plot of a room: left of it, above, below.
const LEFT: f64 = 190.0;
const TOP: f64 = 150.0;
const BOTTOM: f64 = 110.0;

/// Width of a curve in pixels.
const CURVE: f64 = 3.5;

/// Curves to be drawn in one plot.
pub(super) struct Panel<'a> {
    /// What stands over it, apart from the heading of the picture.
    pub(super) title: &'a str,
    pub(super) names: Vec<String>,
    /// The names in other panels.
    pub(super) other_names: &'a [String],
    /// The slope of each curve.
    pub(super) slopes: Vec<String>,
    pub(super) curves: &'a [Curve],
    /// Curves of other panels, pale and without names.
    pub(super) others: &'a [Curve],
    pub(super) axes: Axes,
    /// The names of the abscissa and the ordinate.
    pub(super) axis_names: [&'a str; 2],
    /// The heading of the curves' slopes.
    pub(super) slope_name: &'a str,
    /// The slopes to compare with.
    pub(super) compared: &'a [f64],
    /// What is to be said of the lower edge.
    pub(super) note: Option<String>,
}

impl Panel<'_> {
    /// Draws the panel on all of a canvas below its heading.
    pub(super) fn draw_alone(&self, canvas: &mut Canvas) {
        let [width, height] = canvas.size();
        self.draw(canvas, Frame { left: 0.0, top: 0.0, width, height });
    }

    /// Draws the panel into a room of the canvas.
    pub(super) fn draw(&self, canvas: &mut Canvas, room: Frame) {
        let edges = [room.left, room.right()];
        let labels =
            Labels::new(canvas, [&self.names, self.other_names], self.slope_name, &self.slopes, edges);
        let (plot, fan) = self.place(room, labels.left());
        canvas.text(self.title, [plot.frame.left, plot.frame.top - 34.0], NORMAL, INK, Anchor::Left);
        plot.draw(canvas, self.axis_names);
        labels.draw(canvas, &plot, self.curves);
        self.draw_curves(canvas, &plot, fan.as_ref());
    }

    /// The coordinates of the plot left of `right`, with room for curves and slopes.
    pub(super) fn place(&self, room: Frame, right: f64) -> (Coordinates, Option<Fan>) {
        let [left, top] = [room.left + LEFT, room.top + TOP];
        let frame = Frame { left, top, width: right - left, height: room.bottom() - BOTTOM - top };
        let fan = Fan::new(self.compared, &self.axes, self.curves);
        let y = fan.as_ref().map_or(self.axes.y, |fan| self.axes.y.lowered(fan.low()));
        (Coordinates { frame, axes: Axes { y, ..self.axes } }, fan)
    }

    fn draw_curves(&self, canvas: &mut Canvas, plot: &Coordinates, fan: Option<&Fan>) {
        for ends in self.others.iter().flat_map(Curve::segments) {
            canvas.line(ends.map(|point| plot.at(point)), CURVE, RULE);
        }
        if let Some(fan) = fan {
            fan.draw(canvas, plot);
        }
        for (k, curve) in self.curves.iter().enumerate() {
            for ends in curve.segments() {
                canvas.line(ends.map(|point| plot.at(point)), CURVE, color(k));
            }
        }
        for (k, curve) in self.curves.iter().enumerate() {
            let on_edge = |x: f64| [plot.at([x, 0.0])[0], plot.frame.bottom()];
            let points = curve.points().map(|point| plot.at(point));
            for at in points.chain(curve.at_rounding().map(on_edge)) {
                marker::draw(canvas, k, at, MARKER + 2.5, PAPER);
                marker::draw(canvas, k, at, MARKER, color(k));
            }
        }
        if let Some(note) = &self.note {
            let at = [plot.frame.left + 16.0, plot.frame.bottom() - SMALL - MARKER];
            canvas.text(note, at, SMALL, INK, Anchor::Left);
        }
        if self.curves.iter().all(|curve| curve.points().next().is_none()) {
            let middle = plot.frame.at([0.5, 0.5]);
            canvas.text("no positive values", middle, NORMAL, INK, Anchor::Middle);
        }
    }
}
