//! Lambda along the section as an area in the colours of the map.

use super::action::Action;
use crate::pictures::drawing::axis::{Axis, Tick};
use crate::pictures::drawing::canvas::{Anchor, Canvas};
use crate::pictures::drawing::color::{INK, force};
use crate::pictures::drawing::frame::{Frame, SMALL};

/// Bars are wider by this part of a pixel.
const OVERLAP: f64 = 0.2;
/// Room for the greatest lambda above the bars, as part of their range.
const OVER_BARS: f64 = 0.42;

/// The plot of lambda in a gap, with its vertical axis.
pub(crate) struct Bars<'a> {
    pub(crate) frame: Frame,
    pub(crate) axis: Axis,
    action: &'a Action<'a>,
}

impl<'a> Bars<'a> {
    pub(crate) fn new(frame: Frame, action: &'a Action<'a>) -> Self {
        Bars { frame, axis: action.axis.widened([0.0, OVER_BARS]), action }
    }

    /// Draws stretches of the section with one lambda each, rules at the ticks, and the greatest lambda as a number.
    pub(crate) fn draw(&self, canvas: &mut Canvas, forces: &[([f64; 2], f64)], ticks: &[Tick]) {
        if self.action.pressed {
            self.frame.rules_at(canvas, ticks);
        }
        let zero = self.axis.place(0.0);
        // Neighbours overlap a little: no paper shines through between them.
        let overlap = OVERLAP / self.frame.width;
        for &([start, end], lambda) in forces {
            let level = self.axis.place(lambda);
            let corners =
                [self.frame.at([start, level.max(zero)]), self.frame.at([end + overlap, level.min(zero)])];
            canvas.fill(corners, force(self.action.axis.place(lambda)));
        }
        let greatest = forces.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some(&([start, end], lambda)) = greatest.filter(|_| self.action.pressed) {
            self.greatest(canvas, (start + end) / 2.0, lambda);
        }
    }

    /// The greatest lambda of the section, over its place.
    fn greatest(&self, canvas: &mut Canvas, along: f64, lambda: f64) {
        let text = format!("max {}", self.action.axis.tick_at(lambda).label);
        let [x, y] = self.frame.at([along, self.axis.place(lambda)]);
        let half = canvas.width(&text, SMALL) / 2.0 + 6.0;
        let x = x.clamp(self.frame.left + half, self.frame.right() - half);
        canvas.text(&text, [x, y - 0.6 * SMALL], SMALL, INK, Anchor::Middle);
    }
}
