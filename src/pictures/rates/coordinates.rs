//! Where logarithms lie in a plot.

use super::curve::Curve;
use crate::pictures::drawing::canvas::{Anchor, Canvas};
use crate::pictures::drawing::color::{INK, RULE};
use crate::pictures::drawing::frame::{Frame, NORMAL};
use crate::pictures::drawing::log_axis::LogAxis;

/// Labelled ticks are at least this many pixels apart.
const APART: [f64; 2] = [160.0, 100.0];

/// The axes of some curves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    pub(super) x: LogAxis,
    pub(super) y: LogAxis,
}

impl Axes {
    /// The axes over all points of the curves, with room around them.
    pub(super) fn over(curves: &[Curve]) -> Axes {
        let all = |axis: usize| curves.iter().flat_map(Curve::points).map(move |point| point[axis]);
        let below = curves.iter().flat_map(Curve::at_rounding);
        Axes {
            x: LogAxis::over(all(0).chain(below)).widened([0.05, 0.05]),
            y: LogAxis::over(all(1)).widened([0.06, 0.06]),
        }
    }
}

/// Axes in a frame on the canvas.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coordinates {
    pub(super) frame: Frame,
    pub(super) axes: Axes,
}

impl Coordinates {
    /// The point of the canvas of a pair of logarithms.
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        self.frame.at([self.axes.x.place(x), self.axes.y.place(y)])
    }

    /// Draws rules, ticks and the names of abscissa and ordinate.
    pub(super) fn draw(&self, canvas: &mut Canvas, [abscissa, ordinate]: [&str; 2]) {
        let (frame, Axes { x, y }) = (&self.frame, &self.axes);
        let count = |length: f64, apart: f64| (length / apart).max(2.0) as usize;
        let (across, up) =
            (x.ticks(count(frame.width, APART[0]).min(6)), y.ticks(count(frame.height, APART[1])));
        frame.rules_at(canvas, &up);
        for tick in &across {
            canvas.line([frame.at([tick.place, 0.0]), frame.at([tick.place, 1.0])], 1.0, RULE);
        }
        frame.bottom_ticks(canvas, &x.minor_ticks());
        frame.left_ticks(canvas, &y.minor_ticks());
        frame.outline(canvas);
        frame.bottom_ticks(canvas, &across);
        frame.left_ticks(canvas, &up);
        let below = [frame.left + frame.width / 2.0, frame.bottom() + 66.0];
        canvas.text(abscissa, below, NORMAL, INK, Anchor::Middle);
        canvas.text(ordinate, [frame.left - 14.0, frame.top - 34.0], NORMAL, INK, Anchor::Right);
    }
}
