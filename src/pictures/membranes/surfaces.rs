//! The oblique view: membrane 2 in full, membrane 1 cut open along the section.

use super::layer::{Kind, Layer, Style};
use super::scene::{Scene, TOUCHING};
use super::section::{Sample, Section};
use super::view::View;
use crate::pictures::drawing::axis::Tick;
use crate::pictures::drawing::canvas::{Anchor, Canvas};
use crate::pictures::drawing::color::{
    CONTACT, CONTACT_BAND, INK, LOWER, LOWER_LINE, PAPER, RULE, UPPER, UPPER_LINE, mix,
};
use crate::pictures::drawing::frame::{Frame, NORMAL, SMALL, fitting_ticks};
use crate::pictures::plan::Cut;

/// Beyond this place of the left edge of the floor its labels would run into those of the heights.
const FAR_END: f64 = 0.93;

/// What lines may reach beyond the box, in pixels.
const MARGIN: f64 = 4.0;

/// How much membrane 1 covers what lies behind it.
const VEIL: f64 = 0.72;

/// Draws the view into `room`; `section` is the cut that opens membrane 1.
pub(super) fn draw(canvas: &mut Canvas, scene: &Scene, section: &Section, room: Frame) {
    let cut = &section.cut;
    let inner = Frame {
        left: room.left + 70.0,
        top: room.top + 60.0,
        width: room.width - 110.0,
        height: room.height - 150.0,
    };
    let view = View::new(scene, cut, inner);
    let cut_at = view.in_box(cut.point(0.5), 0.0)[1];
    let lower_style = Style { membrane: 1, color: LOWER, line: LOWER_LINE, from: f64::NEG_INFINITY };
    let upper_style = Style { membrane: 0, color: UPPER, line: UPPER_LINE, from: cut_at };
    let layer = |style: &Style| membrane(scene, section, &view, style, inner.grown(MARGIN));
    let (lower, upper) = crate::parallel::join(|| layer(&lower_style), || layer(&upper_style));
    floor(canvas, scene, cut, &view);
    canvas.bitmap(lower.corner(), upper.over(&lower, VEIL));
    names(canvas, &lower, &upper, room);
    axes(canvas, scene, cut, &view);
    let above = [room.left + 20.0, room.top + 0.06 * room.height];
    canvas.text(&view.enlargement(scene), above, SMALL, INK, Anchor::Left);
}

/// A membrane with its boundary and its line along the section.
fn membrane(scene: &Scene, section: &Section, view: &View, style: &Style, frame: Frame) -> Layer {
    let mut layer = Layer::new(frame);
    layer.surface(scene, view, style);
    rim(&mut layer, scene, view, style);
    profile(&mut layer, scene, section, view, style);
    layer
}

/// The boundary of a membrane, thin and pale where it is cut away.
fn rim(layer: &mut Layer, scene: &Scene, view: &View, style: &Style) {
    let pale = mix(style.line, PAPER, 0.4);
    for edge in &scene.domain.boundary {
        let ends = edge.map(|v| view.in_box(scene.domain.place(v), scene.levels(v)[style.membrane]));
        let cut_away = ends[0][1].min(ends[1][1]) < style.from;
        let (width, color) = if cut_away { (1.0, pale) } else { (2.5, style.line) };
        layer.line(view, ends, width, color);
    }
}

/// A membrane along the section, light on the dark contact region.
fn profile(layer: &mut Layer, scene: &Scene, section: &Section, view: &View, style: &Style) {
    let place = |step: usize, sample: &Sample| {
        let level = scene.height.place(sample.heights[style.membrane]);
        view.in_box(section.cut.point(section.along(step)), level)
    };
    for (step, pair) in section.samples.windows(2).enumerate() {
        if let [Some(from), Some(to)] = pair {
            let [above, below] = to.heights.map(|height| scene.height.place(height));
            let touching = to.contact && above - below < TOUCHING;
            let color = if touching { CONTACT_BAND } else { style.line };
            layer.line(view, [place(step, from), place(step + 1, to)], 4.0, color);
        }
    }
}

/// The ticks of the front edge of the floor and of its left edge, as places in the box.
fn floor_ticks(canvas: &Canvas, scene: &Scene, cut: &Cut, view: &View) -> [Vec<Tick>; 2] {
    let [[left, _], [right, _]] = [0.0, 1.0].map(|s| view.on_canvas([s, 0.0, 0.0]));
    let front = fitting_ticks(canvas, &scene.domain.plane[cut.along], 0.8 * (right - left));
    let side = scene.domain.plane[1 - cut.along].ticks(4);
    let in_box = |tick: Tick| Tick { place: view.in_box(cut.parallel(tick.place), 0.0)[1], ..tick };
    [front, side.into_iter().map(in_box).collect()]
}

/// The floor of the box, ruled at the ticks.
fn floor(canvas: &mut Canvas, scene: &Scene, cut: &Cut, view: &View) {
    let rule = |canvas: &mut Canvas, ends: [[f64; 2]; 2], width, color| {
        canvas.line(ends.map(|[s, t]| view.on_canvas([s, t, 0.0])), width, color);
    };
    let [front, side] = floor_ticks(canvas, scene, cut, view);
    for Tick { place, .. } in front {
        rule(canvas, [[place, 0.0], [place, 1.0]], 1.0, RULE);
    }
    for Tick { place, .. } in side {
        rule(canvas, [[0.0, place], [1.0, place]], 1.0, RULE);
    }
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
    for ends in corners.windows(2) {
        rule(canvas, [ends[0], ends[1]], 1.5, INK);
    }
}

/// Ticks and names of the axes: of the plane along the front and the left edge of the floor, where no surface is behind
/// them, of the heights above its left corner.
fn axes(canvas: &mut Canvas, scene: &Scene, cut: &Cut, view: &View) {
    let [front, side] = floor_ticks(canvas, scene, cut, view);
    for tick in front {
        let [x, y] = view.on_canvas([tick.place, 0.0, 0.0]);
        canvas.line([[x, y], [x + 3.0, y + 8.0]], 1.5, INK);
        let ([x, y], half) = ([x + 8.0, y + 26.0], canvas.width(&tick.label, SMALL) / 2.0 + 3.0);
        canvas.fill([[x - half, y - 11.0], [x + half, y + 11.0]], PAPER);
        canvas.text(&tick.label, [x, y], SMALL, INK, Anchor::Middle);
    }
    for tick in side {
        let [x, y] = view.on_canvas([0.0, tick.place, 0.0]);
        canvas.line([[x - 8.0, y + 2.0], [x, y]], 1.5, INK);
        // The labels of the heights stand over the far end of this edge.
        if tick.place < FAR_END {
            canvas.text(&tick.label, [x - 14.0, y + 5.0], SMALL, INK, Anchor::Right);
        }
    }
    let names = ["x", "y"];
    let name = |axis: usize| format!("{}{}", names[axis], scene.domain.plane[axis].suffix());
    let [x, y] = view.on_canvas([0.5, 0.0, 0.0]);
    canvas.text(&name(cut.along), [x + 36.0, y + 62.0], NORMAL, INK, Anchor::Middle);
    let [x, y] = view.on_canvas([0.0, 0.5, 0.0]);
    canvas.text(&name(1 - cut.along), [x - 78.0, y + 34.0], NORMAL, INK, Anchor::Right);
    heights(canvas, scene, view);
}

fn heights(canvas: &mut Canvas, scene: &Scene, view: &View) {
    let at = |place: f64| view.on_canvas([0.0, 1.0, place]);
    canvas.line([at(0.0), at(1.0)], 1.5, INK);
    for tick in scene.height.ticks(4) {
        let [x, y] = at(tick.place);
        canvas.line([[x - 8.0, y], [x, y]], 1.5, INK);
        canvas.text(&tick.label, [x - 14.0, y], SMALL, INK, Anchor::Right);
    }
    let [x, y] = at(1.0);
    let name = format!("u₁, u₂{}", scene.height.suffix());
    canvas.text(&name, [x - 40.0, y - 30.0], NORMAL, INK, Anchor::Left);
}

/// Names with leaders to a visible point of what they name.
fn names(canvas: &mut Canvas, lower: &Layer, upper: &Layer, room: Frame) {
    let names = [
        ("membrane 1 (u₁), cut open along A–A", UPPER_LINE, upper, None, Kind::Membrane, [0.62, 0.06]),
        ("contact", CONTACT, lower, Some(upper), Kind::Contact, [0.30, 0.97]),
        ("membrane 2 (u₂)", LOWER_LINE, lower, Some(upper), Kind::Membrane, [0.84, 0.94]),
    ];
    for (name, color, layer, hidden_by, kind, [x, y]) in names {
        let at = [room.left + x * room.width, room.top + y * room.height];
        if let Some(point) = layer.anchor(kind, at, hidden_by).or_else(|| layer.anchor(kind, at, None)) {
            let from = [at[0], at[1] + if point[1] > at[1] { 0.6 * NORMAL } else { -0.6 * NORMAL }];
            canvas.line([from, point], 2.0, color);
            canvas.dot(point, 6.5, PAPER);
            canvas.dot(point, 4.5, color);
            canvas.text(name, at, NORMAL, color, Anchor::Middle);
        }
    }
}
