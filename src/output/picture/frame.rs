//! Two-dimensional plots: a rectangle with axes.

use super::SIZE;
use super::axis::{Axis, Tick};
use super::canvas::{Anchor, Canvas};
use super::color::{INK, RULE};

/// Line height of tick labels in pixels.
pub(super) const SMALL: f64 = 25.0;
/// Line height of axis titles and labels in pixels.
pub(super) const NORMAL: f64 = 29.0;

const TICK: f64 = 8.0;
/// Labels keep this distance from the edge of the picture.
const MARGIN: f64 = 8.0;

/// A plot's rectangle on the canvas.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Frame {
    pub(super) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// The point of the canvas at a place in the frame, both coordinates from 0 to 1, y upwards.
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.left + x * self.width, self.bottom() - y * self.height]
    }

    /// The border.
    pub(super) fn outline(&self, canvas: &mut Canvas) {
        let [left, top, right, bottom] = [self.left, self.top, self.right(), self.bottom()];
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        for ends in corners.windows(2) {
            canvas.line([ends[0], ends[1]], 1.5, INK);
        }
    }

    /// Horizontal rules at the ticks of the axis on the left.
    pub(super) fn rules(&self, canvas: &mut Canvas, axis: &Axis, count: usize) {
        for tick in axis.ticks(count) {
            canvas.line([self.at([0.0, tick.place]), self.at([1.0, tick.place])], 1.0, RULE);
        }
    }

    /// Ticks and labels below the frame, fewer if the labels would touch.
    pub(super) fn bottom_axis(&self, canvas: &mut Canvas, axis: &Axis) {
        for tick in fitting_ticks(canvas, axis, self.width) {
            let [x, y] = self.at([tick.place, 0.0]);
            canvas.line([[x, y], [x, y + TICK]], 1.5, INK);
            let rightmost = SIZE[0] as f64 - MARGIN - canvas.width(&tick.label, SMALL) / 2.0;
            let at = [x.min(rightmost), y + TICK + 0.6 * SMALL];
            canvas.text(&tick.label, at, SMALL, INK, Anchor::Middle);
        }
    }

    /// Ticks and labels left of the frame.
    pub(super) fn left_axis(&self, canvas: &mut Canvas, axis: &Axis, count: usize) {
        for tick in axis.ticks(count) {
            let [x, y] = self.at([0.0, tick.place]);
            canvas.line([[x - TICK, y], [x, y]], 1.5, INK);
            canvas.text(&tick.label, [x - TICK - 6.0, y], SMALL, INK, Anchor::Right);
        }
    }

    /// Ticks and labels right of the frame.
    pub(super) fn right_axis(&self, canvas: &mut Canvas, axis: &Axis, count: usize) {
        for tick in axis.ticks(count) {
            let [x, y] = self.at([1.0, tick.place]);
            canvas.line([[x, y], [x + TICK, y]], 1.5, INK);
            canvas.text(&tick.label, [x + TICK + 6.0, y], SMALL, INK, Anchor::Left);
        }
    }
}

/// The most ticks whose labels fit side by side on `length` pixels.
pub(super) fn fitting_ticks(canvas: &Canvas, axis: &Axis, length: f64) -> Vec<Tick> {
    const GAP: f64 = 24.0;
    let fits = |count: &usize| {
        let widths = axis.ticks(*count).into_iter().map(|tick| canvas.width(&tick.label, SMALL) + GAP);
        widths.sum::<f64>() <= length
    };
    axis.ticks((1..=8).rev().find(fits).unwrap_or(1))
}
