//! The plot of the section: all layers, and where they touch.

use super::scene::{Gap, Kind, Layer, Scene};
use super::section::{Sample, Section};
use super::spread::{spread, spread_between};
use super::walls;
use crate::pictures::drawing::axis::{Axis, subscript, times};
use crate::pictures::drawing::canvas::{Anchor, Canvas};
use crate::pictures::drawing::color::{CONTACT, INK};
use crate::pictures::drawing::frame::{Frame, NORMAL, SMALL};

/// Layers are drawn at least this far from each other, in pixels,
const APART: f64 = 5.0;
/// with curves that take this part of it,
const CURVE: f64 = 0.66;
/// and a seam between those that touch, which reaches under both curves.
const SEAM: f64 = 0.66;
/// Room above and below the curves, as part of their range: for those that are drawn side by side.
const HEADROOM: f64 = 0.12;
/// Obstacles are drawn this far off the membranes, as part of the range of these; farther ones are outside of the picture.
const FAR: f64 = 2.0;
/// How far outside of the frame obstacles that are not in it lie, in pixels: farther than membranes are moved.
const OUTSIDE: f64 = 200.0;
/// From the frame to the names of the layers.
const NAMES: f64 = 48.0;

pub(super) struct SectionPlot<'a> {
    scene: &'a Scene<'a>,
    section: &'a Section,
    frame: Frame,
    height: Axis,
    apart: f64,
    /// Where the layers are drawn at each sample, on the canvas.
    layers: Vec<Option<Vec<f64>>>,
}

impl<'a> SectionPlot<'a> {
    pub(super) fn new(scene: &'a Scene<'a>, section: &'a Section, frame: Frame) -> Self {
        let height = heights(scene, section).widened([HEADROOM, HEADROOM]);
        let headroom = 2.0 * HEADROOM / (1.0 + 2.0 * HEADROOM) * frame.height;
        let apart = APART.min(headroom / scene.layers.len() as f64);
        let [top, bottom] = [frame.top - OUTSIDE, frame.bottom() + OUTSIDE];
        let on_canvas = |u: &f64| (frame.bottom() - height.place(*u) * frame.height).clamp(top, bottom);
        let drawn = |sample: &Sample| {
            let wanted: Vec<f64> = sample.heights.iter().map(on_canvas).collect();
            spread(&wanted, |layer| scene.layers[layer].kind != Kind::Membrane, apart)
        };
        let layers = section.samples.iter().map(|sample| sample.as_ref().map(drawn)).collect();
        SectionPlot { scene, section, frame, height, apart, layers }
    }

    /// Draws the plot.
    pub(super) fn draw(&self, canvas: &mut Canvas) {
        self.frame.rules(canvas, &self.height, 5);
        self.bodies(canvas);
        self.seams(canvas);
        for layer in 0..self.scene.layers.len() {
            self.curve(canvas, layer);
        }
        self.frame.outline(canvas);
        self.frame.left_axis(canvas, &self.height, 5);
        self.names(canvas);
        self.headings(canvas);
    }

    /// The obstacles.
    fn bodies(&self, canvas: &mut Canvas) {
        for (index, layer) in self.scene.layers.iter().enumerate() {
            let end = match layer.kind {
                Kind::Membrane => continue,
                Kind::Ceiling => self.frame.top,
                Kind::Floor => self.frame.bottom(),
            };
            let surface: Vec<Option<f64>> =
                self.layers.iter().map(|layers| layers.as_ref().map(|layers| layers[index])).collect();
            walls::draw(canvas, &self.frame, &surface, end);
        }
    }

    /// Dark seams where layers touch and no gap can be seen.
    fn seams(&self, canvas: &mut Canvas) {
        for gap in self.scene.gaps.iter().filter(|gap| gap.action.touching) {
            for (step, pair) in self.layers.windows(2).enumerate() {
                let [Some(from), Some(to)] = pair else { continue };
                let touching = |step: usize| {
                    self.section.samples[step]
                        .as_ref()
                        .is_some_and(|sample| gap.action.in_contact(sample.vertex))
                };
                let between = |layers: &[f64]| (layers[gap.upper + 1] - layers[gap.upper]) < 1.5 * self.apart;
                if touching(step) && touching(step + 1) && between(from) && between(to) {
                    let middle = |layers: &[f64]| (layers[gap.upper] + layers[gap.upper + 1]) / 2.0;
                    let ends = [[self.x(step), middle(from)], [self.x(step + 1), middle(to)]];
                    canvas.line(ends, SEAM * self.apart, CONTACT);
                }
            }
        }
    }

    fn curve(&self, canvas: &mut Canvas, layer: usize) {
        let inside = self.frame.top..=self.frame.bottom();
        for (step, pair) in self.layers.windows(2).enumerate() {
            let [Some(from), Some(to)] = pair else { continue };
            let ends = [[self.x(step), from[layer]], [self.x(step + 1), to[layer]]];
            if ends.iter().all(|[_, y]| inside.contains(y)) {
                canvas.line(ends, CURVE * self.apart, self.scene.layers[layer].color);
            }
        }
    }

    /// The names of the layers right of the frame, with leaders to the ends of the curves; only some if there is no room for all.
    fn names(&self, canvas: &mut Canvas) {
        let Some(last) = self.layers.iter().rposition(Option::is_some) else { return };
        let Some(ends) = &self.layers[last] else { return };
        let most = (self.frame.height / SMALL) as usize;
        let every = ends.len().div_ceil(most);
        let named: Vec<usize> = (0..ends.len()).step_by(every).collect();
        let within = [self.frame.top + SMALL / 2.0, self.frame.bottom() - SMALL / 2.0];
        let wanted: Vec<f64> = named.iter().map(|&layer| ends[layer].clamp(within[0], within[1])).collect();
        for ((&layer, &from), to) in named.iter().zip(&wanted).zip(spread_between(&wanted, SMALL, within)) {
            let Layer { name, color, .. } = &self.scene.layers[layer];
            let right = self.frame.right() + NAMES;
            let text = if self.is_seen(layer) { name.clone() } else { format!("{name}, far off") };
            if self.is_seen(layer) {
                canvas.line([[self.x(last) + 4.0, from], [right - 26.0, to]], 1.5, *color);
                canvas.line([[right - 26.0, to], [right - 10.0, to]], 4.0, *color);
            }
            canvas.text(&text, [right, to], SMALL, INK, Anchor::Left);
        }
    }

    /// Whether any part of a layer lies in the frame.
    fn is_seen(&self, layer: usize) -> bool {
        let inside = self.frame.top..=self.frame.bottom();
        self.layers.iter().flatten().any(|layers| inside.contains(&layers[layer]))
    }

    fn headings(&self, canvas: &mut Canvas) {
        let (frame, cut, plane) = (&self.frame, &self.section.cut, &self.scene.domain.plane);
        let [x, y] = [frame.left - 95.0, frame.top + frame.height / 2.0];
        let name = match self.scene.membranes() {
            1 => "u₁".to_owned(),
            2 => "u₁, u₂".to_owned(),
            n => format!("u₁ … u{}", subscript(n)),
        };
        canvas.text(&name, [x, y], NORMAL, INK, Anchor::Right);
        canvas.text(&self.height.power(), [x, y + 1.2 * NORMAL], SMALL, INK, Anchor::Right);
        let other = ["y", "x"][cut.along];
        let place = plane[1 - cut.along].round(cut.place, cut.reach).label;
        let scale = |pixels: f64, axis: &Axis| pixels / axis.length();
        let heights = scale(frame.height, &self.height) / scale(frame.width, &plane[cut.along]);
        let title = format!("Section A–A: {other} = {place}, heights {}", times(heights));
        let over = frame.top - 34.0;
        canvas.text(&title, [frame.left, over], NORMAL, INK, Anchor::Left);
        if let Some(gap) = self.scene.gaps.iter().find(|gap| gap.action.touching) {
            self.legend(canvas, gap, over);
        }
    }

    /// What contact in a gap looks like.
    fn legend(&self, canvas: &mut Canvas, gap: &Gap, y: f64) {
        const SAMPLE: f64 = 60.0;
        let text = "contact: a dark seam; lines that are close are drawn side by side";
        let left = self.frame.right() - canvas.width(text, SMALL) - SAMPLE - 12.0;
        let [upper, lower] = [0, 1].map(|k| self.scene.layers[gap.upper + k].color);
        let half = APART / 2.0;
        for (shift, part, color) in [(0.0, SEAM, CONTACT), (-half, CURVE, upper), (half, CURVE, lower)] {
            canvas.line([[left, y + shift], [left + SAMPLE, y + shift]], part * APART, color);
        }
        canvas.text(text, [left + SAMPLE + 12.0, y], SMALL, INK, Anchor::Left);
    }

    fn x(&self, step: usize) -> f64 {
        self.frame.left + self.section.along(step) * self.frame.width
    }
}

/// The axis of heights: all membranes, and obstacles that are not far off.
fn heights(scene: &Scene, section: &Section) -> Axis {
    let all = |obstacles: bool| {
        let of_sample = move |sample: &'_ Sample| -> Vec<f64> {
            let layers = scene.layers.iter().zip(&sample.heights);
            layers
                .filter(|(layer, _)| obstacles || layer.kind == Kind::Membrane)
                .map(|(_, height)| *height)
                .collect()
        };
        section.samples.iter().flatten().flat_map(of_sample)
    };
    let [low, high] =
        all(false).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], u| [low.min(u), high.max(u)]);
    let reach = FAR * (high - low);
    if reach > 0.0 {
        Axis::over(all(true).filter(|u| (low - reach..=high + reach).contains(u)), false)
    } else {
        Axis::over(all(true), false)
    }
}
