//! The plan view: lambda on the dual cells, the contact region and the line of the section.

use super::picture::SIZE;
use super::scene::Scene;
use crate::pictures::drawing::canvas::{Anchor, Canvas};
use crate::pictures::drawing::color::INK;
use crate::pictures::drawing::frame::{Frame, NORMAL, SMALL};
use crate::pictures::plan::{Action, Cells, Cut, color_bar};

/// The dual cells of a solution.
pub(super) struct Map(Cells);

impl Map {
    /// The domain to scale, as large as it fits into `room`, in its middle.
    pub(super) fn new(scene: &Scene, room: Frame) -> Map {
        Map(Cells::new(&scene.domain, room, |vertex| scene.action.in_contact(vertex)))
    }

    /// For each line across the domain at constant coordinate `axis`, from low to high: the pixels on it whose
    /// vertex is `wanted`.
    pub(super) fn profile(&self, axis: usize, wanted: impl Fn(usize) -> bool) -> Vec<usize> {
        self.0.profile(axis, wanted)
    }

    /// Draws the map with axes, the outlines, the cut and a colour bar.
    pub(super) fn draw(&self, canvas: &mut Canvas, scene: &Scene, cut: &Cut) {
        let frame = &self.0.frame;
        self.0.draw(canvas, &scene.domain, Some(&scene.action));
        self.axes(canvas, scene);
        self.cut(canvas, cut);
        self.headings(canvas, &scene.action);
        if scene.action.pressed {
            self.color_bar(canvas, &scene.action);
        }
        if !scene.action.touching {
            let [x, y] = frame.at([0.5, 0.5]);
            canvas.text("no contact", [x, y - NORMAL], NORMAL, INK, Anchor::Middle);
        }
    }

    fn headings(&self, canvas: &mut Canvas, action: &Action) {
        let frame = &self.0.frame;
        let extent = if action.touching {
            format!("contact on {} of the area (dual cells Dₐ)", action.percentage())
        } else {
            "no contact".to_owned()
        };
        let force = if action.touching && !action.pressed {
            "Contact without force, λ = 0"
        } else {
            "Contact force per area, λ"
        };
        canvas.text(force, [frame.left, frame.top - 94.0], NORMAL, INK, Anchor::Left);
        canvas.text(&extent, [frame.left, frame.top - 60.0], SMALL, INK, Anchor::Left);
    }

    fn axes(&self, canvas: &mut Canvas, scene: &Scene) {
        let frame = &self.0.frame;
        let [x, y] = &scene.domain.plane;
        frame.outline(canvas);
        frame.bottom_axis(canvas, x);
        frame.left_axis(canvas, y, (frame.height / 90.0).clamp(1.0, 6.0) as usize);
        let below = [frame.left + frame.width / 2.0, frame.bottom() + 58.0];
        canvas.text(&format!("x{}", x.suffix()), below, NORMAL, INK, Anchor::Middle);
        let above = [frame.left - 14.0, frame.top - 32.0];
        canvas.text(&format!("y{}", y.suffix()), above, NORMAL, INK, Anchor::Right);
    }

    fn cut(&self, canvas: &mut Canvas, cut: &Cut) {
        let [x, y] = self.0.cut(canvas, cut);
        let (at, anchor) =
            if cut.along == 0 { ([x + 10.0, y], Anchor::Left) } else { ([x, y - 22.0], Anchor::Middle) };
        canvas.text("A–A", at, SMALL, INK, anchor);
    }

    /// The colours of lambda with their values, right of the map.
    fn color_bar(&self, canvas: &mut Canvas, action: &Action) {
        let map = &self.0.frame;
        let height = map.height.max(240.0);
        let bar = Frame {
            left: map.right() + 80.0,
            top: map.top + (map.height - height) / 2.0,
            width: 26.0,
            height,
        };
        color_bar(canvas, bar, &action.axis, action.greatest, 6);
        let title = [(bar.left + 24.0).min(SIZE[0] as f64 - 60.0), bar.top - 24.0];
        canvas.text(&format!("λ{}", action.axis.suffix()), title, NORMAL, INK, Anchor::Middle);
    }
}
