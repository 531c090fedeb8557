//! The plot of the section: both membranes, and lambda below on its own axis.

use super::scene::Scene;
use super::section::{Sample, Section};
use crate::pictures::drawing::axis::{Axis, times};
use crate::pictures::drawing::canvas::{Anchor, Canvas, FINE};
use crate::pictures::drawing::color::{CONTACT, CONTACT_BAND, INK, LOWER_LINE, Rgb, UPPER_LINE};
use crate::pictures::drawing::frame::{Frame, NORMAL, SMALL};
use crate::pictures::plan::Bars;

/// Width of the curves in pixels.
const CURVE: f64 = 4.0;
/// Room for labels above and below the curves, as part of their range.
const HEADROOM: f64 = 0.28;

/// A section with its two frames, one below the other, and their vertical axes.
pub(super) struct SectionPlot<'a> {
    scene: &'a Scene<'a>,
    section: &'a Section,
    membranes: Frame,
    height: Axis,
    bars: Bars<'a>,
}

impl<'a> SectionPlot<'a> {
    /// The plot of the membranes in the first frame and of lambda in the second.
    pub(super) fn new(scene: &'a Scene<'a>, section: &'a Section, [membranes, force]: [Frame; 2]) -> Self {
        let heights = section.samples.iter().flatten().flat_map(|sample| sample.heights);
        let height = Axis::over(heights, false).widened([HEADROOM, HEADROOM]);
        SectionPlot { scene, section, membranes, height, bars: Bars::new(force, &scene.action) }
    }

    /// Draws the plot.
    pub(super) fn draw(&self, canvas: &mut Canvas) {
        for [start, end] in self.section.contacts() {
            for frame in [self.membranes, self.bars.frame] {
                canvas.fill([frame.at([start, 1.0]), frame.at([end, 0.0])], CONTACT_BAND);
            }
        }
        self.membranes.rules(canvas, &self.height, 4);
        self.bars.draw(canvas, &self.section.forces(), &self.bars.axis.ticks(3));
        self.curve(canvas, 1, LOWER_LINE);
        self.curve(canvas, 0, UPPER_LINE);
        self.contact_curve(canvas);
        self.membrane_names(canvas);
        self.contact_names(canvas);
        self.axes(canvas);
    }

    /// The point of the canvas of a membrane at a sample.
    fn point(&self, step: usize, sample: &Sample, membrane: usize) -> [f64; 2] {
        self.membranes.at([self.section.along(step), self.height.place(sample.heights[membrane])])
    }

    fn curve(&self, canvas: &mut Canvas, membrane: usize, color: Rgb) {
        for (step, pair) in self.section.samples.windows(2).enumerate() {
            if let [Some(from), Some(to)] = pair {
                let ends = [self.point(step, from, membrane), self.point(step + 1, to, membrane)];
                canvas.line(ends, CURVE, color);
            }
        }
    }

    /// Both membranes as one thick line where they are in contact and no gap can be seen.
    fn contact_curve(&self, canvas: &mut Canvas) {
        for (step, sample) in self.section.samples.iter().enumerate() {
            let Some(sample) = sample.filter(|sample| sample.contact) else { continue };
            let [upper, lower] = [0, 1].map(|membrane| self.point(step, &sample, membrane));
            if (upper[1] - lower[1]).abs() < CURVE {
                canvas.dot([upper[0], (upper[1] + lower[1]) / 2.0], 0.9 * CURVE, CONTACT);
            }
        }
    }

    fn membrane_names(&self, canvas: &mut Canvas) {
        const MARGIN: f64 = 14.0;
        const CLEARANCE: f64 = 0.75 * NORMAL;
        let names = [("membrane 1 (u₁)", UPPER_LINE, -CLEARANCE), ("membrane 2 (u₂)", LOWER_LINE, CLEARANCE)];
        for (membrane, (name, color, shift)) in names.into_iter().enumerate() {
            let width = (canvas.width(name, NORMAL) + 2.0 * MARGIN) / self.membranes.width;
            if let Some([along, height]) = self.name_place(membrane, width) {
                let [x, y] = self.membranes.at([along, self.height.place(height)]);
                canvas.text(name, [x, y + shift], NORMAL, color, Anchor::Middle);
            }
        }
    }

    fn contact_names(&self, canvas: &mut Canvas) {
        const APART: f64 = 12.0;
        let half = canvas.width("contact", SMALL) / 2.0;
        let mut free_from = self.membranes.left;
        for [start, end] in self.section.contacts() {
            let [x, y] = self.membranes.at([(start + end) / 2.0, 1.0]);
            if x - half >= free_from {
                canvas.text("contact", [x, y - 0.65 * SMALL], SMALL, CONTACT, Anchor::Middle);
                free_from = x + half + APART;
            }
        }
    }

    /// Where a name of this width fits beside a membrane: the middle of a stretch where the membranes are apart
    /// and the curve is flat, and the outermost height of the membrane there.
    fn name_place(&self, membrane: usize, width: f64) -> Option<[f64; 2]> {
        const STEEPNESS_COUNTS: f64 = 0.25;
        let samples = &self.section.samples;
        let window = ((width * samples.len() as f64) as usize).clamp(1, samples.len());
        // A wider gap makes the name no clearer; outside of the domain there is none.
        let enough = self.height.length() / 7.0;
        let gap =
            |s: &Option<Sample>| s.map_or(f64::NEG_INFINITY, |s| s.heights[0] - s.heights[1]).min(enough);
        let height = |s: &Option<Sample>| s.map_or(0.0, |s| s.heights[membrane]);
        let gaps = least(samples.iter().map(gap).collect(), window);
        let lows = least(samples.iter().map(height).collect(), window);
        let depths = least(samples.iter().map(|s| -height(s)).collect(), window);
        let mut best: Option<(f64, [f64; 2])> = None;
        for start in (0..gaps.len()).step_by(FINE).filter(|&start| gaps[start] > f64::NEG_INFINITY) {
            let [low, high] = [lows[start], -depths[start]];
            let merit = gaps[start] - STEEPNESS_COUNTS * (high - low);
            if best.is_none_or(|(most, _)| merit > most) {
                let middle = self.section.along(start + window / 2);
                best = Some((merit, [middle, if membrane == 0 { high } else { low }]));
            }
        }
        best.map(|(_, place)| place)
    }

    fn axes(&self, canvas: &mut Canvas) {
        let (above, below, cut) = (&self.membranes, &self.bars.frame, &self.section.cut);
        above.outline(canvas);
        below.outline(canvas);
        above.left_axis(canvas, &self.height, 4);
        for (frame, name, axis) in [(above, "u₁, u₂", &self.height), (below, "λ", &self.bars.axis)] {
            let [x, y] = [frame.left - 95.0, frame.top + frame.height / 2.0];
            canvas.text(name, [x, y], NORMAL, INK, Anchor::Right);
            canvas.text(&axis.power(), [x, y + 1.2 * NORMAL], SMALL, INK, Anchor::Right);
        }
        if self.scene.action.pressed {
            below.left_axis(canvas, &self.bars.axis, 3);
        } else {
            let at = [below.left + below.width / 2.0, below.top + below.height / 2.0];
            let reason = if self.scene.action.touching { "λ = 0" } else { "no contact" };
            canvas.text(reason, at, NORMAL, INK, Anchor::Middle);
        }
        let [name, other] = if cut.along == 0 { ["x", "y"] } else { ["y", "x"] };
        let along = &self.scene.domain.plane[cut.along];
        below.bottom_axis(canvas, along);
        let under = [below.left + below.width / 2.0, below.bottom() + 58.0];
        canvas.text(&format!("{name}{}", along.suffix()), under, NORMAL, INK, Anchor::Middle);
        let place = self.scene.domain.plane[1 - cut.along].round(cut.place, cut.reach).label;
        let scale = |pixels: f64, axis: &Axis| pixels / axis.length();
        let heights =
            scale(above.height, &self.height) / scale(above.width, &self.scene.domain.plane[cut.along]);
        let title = format!("Section A–A: {other} = {place}, heights {}", times(heights));
        canvas.text(&title, [above.left, above.top - 52.0], NORMAL, INK, Anchor::Left);
    }
}

/// The least of each `window` neighbours, from the first of them on: from those of windows half as wide, which may overlap.
fn least(mut values: Vec<f64>, window: usize) -> Vec<f64> {
    let mut of = 1;
    while of < window {
        let shift = of.min(window - of);
        values = values.iter().zip(&values[shift..]).map(|(a, b)| a.min(*b)).collect();
        of += shift;
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_of_each_window_is_that_of_all_in_it() {
        let values: Vec<f64> = (0..50).map(|k| f64::from(k * k * 7919 % 101)).collect();
        for window in [1, 2, 3, 7, 8, 21, 49, 50] {
            let smallest = |window: &[f64]| window.iter().copied().fold(f64::INFINITY, f64::min);
            let expected: Vec<f64> = values.windows(window).map(smallest).collect();
            assert_eq!(least(values.clone(), window), expected, "{window}");
        }
    }
}
