//! Slopes to compare with: dashed rays from one point, below the curves where the errors are large.

use super::coordinates::{Axes, Coordinates};
use super::curve::Curve;
use super::labels::spread;
use crate::pictures::drawing::canvas::{Anchor, Canvas};
use crate::pictures::drawing::color::INK;
use crate::pictures::drawing::frame::SMALL;

/// The width of the rays as part of the plot.
const WIDTH: f64 = 0.2;
/// Their greatest height, and their distance from the curves and the corner, as parts of the plot.
const HEIGHT: f64 = 0.35;
const APART: f64 = 0.05;
/// Their distance from the edge beside them, where their slopes stand between, in distances from the curves.
const BESIDE: f64 = 2.6;
/// Their distance from the lower edge, where "slope" stands between, in distances from the curves.
const UNDER: f64 = 1.8;

/// Rays of given slopes; places are decimal logarithms.
pub(super) struct Fan {
    pub(super) slopes: Vec<f64>,
    pub(super) apex: [f64; 2],
    /// From the apex to the other end of the rays, negative if that lies left.
    pub(super) run: f64,
    low: f64,
}

impl Fan {
    /// The rays in the lower corner on the side where the errors are large, below all curves there; `None` without
    /// slopes or without a segment to compare them with.
    pub(super) fn new(slopes: &[f64], Axes { x, y }: &Axes, curves: &[Curve]) -> Option<Fan> {
        let mut slopes: Vec<f64> = slopes.iter().copied().filter(|slope| slope.is_finite()).collect();
        slopes.sort_by(f64::total_cmp);
        slopes.dedup();
        let steepest = slopes.iter().map(|slope| slope.abs()).fold(0.0, f64::max);
        if slopes.is_empty() || curves.iter().all(|curve| curve.segments().next().is_none()) {
            return None;
        }
        let width = (WIDTH * x.length()).min(HEIGHT * y.length() / steepest);
        let side = if slopes.iter().sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
        let far = if side > 0.0 { x.at(1.0 - BESIDE * APART) } else { x.at(BESIDE * APART) };
        let run = side * width;
        let rises = slopes.iter().map(|slope| slope * run).chain([0.0]);
        let (fall, rise) = rises.fold((0.0, 0.0), |(low, high): (f64, f64), r| (low.min(r), high.max(r)));
        let margin = 2.0 * APART * x.length();
        let span = [far.min(far - run) - margin, far.max(far - run) + margin];
        let ceiling = curves.iter().map(|curve| curve.lowest_between(span)).fold(f64::INFINITY, f64::min);
        let apart = APART * y.length();
        let low = y.at(0.0).min(ceiling - (1.0 + UNDER) * apart - (rise - fall));
        Some(Fan { slopes, apex: [far - run, low + UNDER * apart - fall], run, low })
    }

    /// The least ordinate that the rays need.
    pub(super) fn low(&self) -> f64 {
        self.low
    }

    /// Draws the rays with their slopes, over a horizontal line.
    pub(super) fn draw(&self, canvas: &mut Canvas, plot: &Coordinates) {
        let end = |slope: f64| plot.at([self.apex[0] + self.run, self.apex[1] + slope * self.run]);
        let apex = plot.at(self.apex);
        canvas.line([apex, end(0.0)], 1.5, INK);
        let under = [(apex[0] + end(0.0)[0]) / 2.0, apex[1] + 0.7 * SMALL];
        canvas.text("slope", under, SMALL, INK, Anchor::Middle);
        let heights: Vec<f64> = self.slopes.iter().map(|&slope| end(slope)[1]).collect();
        let limits = [plot.frame.top, plot.frame.bottom() - 0.5 * SMALL];
        let places = spread(&heights, SMALL, limits);
        let (shift, anchor) = if self.run > 0.0 { (10.0, Anchor::Left) } else { (-10.0, Anchor::Right) };
        for (&slope, y) in self.slopes.iter().zip(places) {
            canvas.dashed([apex, end(slope)], 2.0, INK);
            canvas.text(&fraction(slope), [end(slope)[0] + shift, y], SMALL, INK, anchor);
        }
    }
}

/// A slope as a fraction with a small denominator where it is one.
pub(super) fn fraction(slope: f64) -> String {
    const EXACT: f64 = 1e-9;
    let whole = |multiple: f64| (multiple - multiple.round()).abs() < EXACT;
    let text = match [1.0, 2.0, 3.0, 4.0].into_iter().find(|&denominator| whole(slope * denominator)) {
        Some(1.0) => format!("{:.0}", slope),
        Some(denominator) => format!("{:.0}/{denominator:.0}", slope * denominator),
        None => format!("{slope:.2}"),
    };
    text.replace('-', "−")
}
