//! Two-dimensional plots: a rectangle with axes.

use super::axis::{Axis, Tick};
use super::canvas::{Anchor, Canvas};
use super::color::{INK, RULE};

/// Line height of tick labels in pixels.
pub(crate) const SMALL: f64 = 25.0;
/// Line height of axis titles and labels in pixels.
pub(crate) const NORMAL: f64 = 29.0;

const TICK: f64 = 8.0;
/// Labels keep this distance from the edge of the picture.
const MARGIN: f64 = 8.0;

/// A plot's rectangle on the canvas.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Frame {
    pub(crate) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// The point of the canvas at a place in the frame, both coordinates from 0 to 1, y upwards.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.left + x * self.width, self.bottom() - y * self.height]
    }

    /// The frame with a margin around it.
    pub(crate) fn grown(&self, margin: f64) -> Frame {
        Frame {
            left: self.left - margin,
            top: self.top - margin,
            width: self.width + 2.0 * margin,
            height: self.height + 2.0 * margin,
        }
    }

    /// The border.
    pub(crate) fn outline(&self, canvas: &mut Canvas) {
        let [left, top, right, bottom] = [self.left, self.top, self.right(), self.bottom()];
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        for ends in corners.windows(2) {
            canvas.line([ends[0], ends[1]], 1.5, INK);
        }
    }

    /// Horizontal rules at the ticks of the axis on the left.
    pub(crate) fn rules(&self, canvas: &mut Canvas, axis: &Axis, count: usize) {
        self.rules_at(canvas, &axis.ticks(count));
    }

    /// Horizontal rules at these ticks.
    pub(crate) fn rules_at(&self, canvas: &mut Canvas, ticks: &[Tick]) {
        for tick in ticks {
            canvas.line([self.at([0.0, tick.place]), self.at([1.0, tick.place])], 1.0, RULE);
        }
    }

    /// Ticks and labels below the frame, fewer if the labels would touch.
    pub(crate) fn bottom_axis(&self, canvas: &mut Canvas, axis: &Axis) {
        self.bottom_ticks(canvas, &fitting_ticks(canvas, axis, self.width));
    }

    /// These ticks and their labels below the frame.
    pub(crate) fn bottom_ticks(&self, canvas: &mut Canvas, ticks: &[Tick]) {
        for tick in ticks {
            let [x, y] = self.at([tick.place, 0.0]);
            canvas.line([[x, y], [x, y + tick_length(tick)]], 1.5, INK);
            let rightmost = canvas.size()[0] - MARGIN - canvas.width(&tick.label, SMALL) / 2.0;
            let at = [x.min(rightmost), y + TICK + 0.6 * SMALL];
            canvas.text(&tick.label, at, SMALL, INK, Anchor::Middle);
        }
    }

    /// Ticks and labels left of the frame.
    pub(crate) fn left_axis(&self, canvas: &mut Canvas, axis: &Axis, count: usize) {
        self.left_ticks(canvas, &axis.ticks(count));
    }

    /// These ticks and their labels left of the frame.
    pub(crate) fn left_ticks(&self, canvas: &mut Canvas, ticks: &[Tick]) {
        for tick in ticks {
            let [x, y] = self.at([0.0, tick.place]);
            canvas.line([[x - tick_length(tick), y], [x, y]], 1.5, INK);
            canvas.text(&tick.label, [x - TICK - 6.0, y], SMALL, INK, Anchor::Right);
        }
    }

    /// Ticks and labels right of the frame.
    pub(crate) fn right_axis(&self, canvas: &mut Canvas, axis: &Axis, count: usize) {
        self.right_ticks(canvas, &axis.ticks(count));
    }

    /// These ticks and their labels right of the frame.
    pub(crate) fn right_ticks(&self, canvas: &mut Canvas, ticks: &[Tick]) {
        for tick in ticks {
            let [x, y] = self.at([1.0, tick.place]);
            canvas.line([[x, y], [x + TICK, y]], 1.5, INK);
            canvas.text(&tick.label, [x + TICK + 6.0, y], SMALL, INK, Anchor::Left);
        }
    }
}

/// Ticks without a label are short.
fn tick_length(tick: &Tick) -> f64 {
    if tick.label.is_empty() { TICK / 2.0 } else { TICK }
}

/// The most ticks whose labels fit side by side on `length` pixels.
pub(crate) fn fitting_ticks(canvas: &Canvas, axis: &Axis, length: f64) -> Vec<Tick> {
    const GAP: f64 = 24.0;
    let fits = |count: &usize| {
        let widths = axis.ticks(*count).into_iter().map(|tick| canvas.width(&tick.label, SMALL) + GAP);
        widths.sum::<f64>() <= length
    };
    axis.ticks((1..=8).rev().find(fits).unwrap_or(1))
}
