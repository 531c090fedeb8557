//! The oblique view: a parallel projection of the box that holds both membranes.

use super::scene::Scene;
use crate::pictures::drawing::axis::{Axis, times};
use crate::pictures::drawing::frame::Frame;
use crate::pictures::plan::Cut;

/// The direction of the cut is turned by this angle (radians) out of the plane of the paper.
const TURN: f64 = 0.38;
/// The view is from above by this angle (radians).
const RISE: f64 = 0.52;
/// The box is drawn at most this times longer than deep.
const MOST_ELONGATED: f64 = 2.5;
/// The height of the box over the longer side of the domain.
const HEIGHT: f64 = 0.40;

/// A projection onto the canvas. A place in the box has the coordinates along the cut, away from the viewer and
/// upwards, each from 0 to 1.
pub(super) struct View {
    along: usize,
    sides: [f64; 3],
    scale: f64,
    origin: [f64; 2],
}

impl View {
    /// The view of the box that fills `room`.
    pub(super) fn new(scene: &Scene, cut: &Cut, room: Frame) -> View {
        let aspect = scene.domain.aspect(MOST_ELONGATED);
        let depth = if cut.along == 0 { 1.0 / aspect } else { aspect };
        let mut view = View { along: cut.along, sides: [1.0, depth, HEIGHT], scale: 1.0, origin: [0.0; 2] };
        let corners: Vec<[f64; 3]> =
            (0..8).map(|c| view.project([c & 1, c >> 1 & 1, c >> 2].map(f64::from))).collect();
        let range = |axis: usize| {
            let values = corners.iter().map(|p| p[axis]);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
        };
        let [(left, right), (top, bottom)] = [range(0), range(1)];
        view.scale = (room.width / (right - left)).min(room.height / (bottom - top));
        view.origin = [
            room.left + (room.width - view.scale * (left + right)) / 2.0,
            room.top + (room.height - view.scale * (top + bottom)) / 2.0,
        ];
        view
    }

    /// The place in the box of a place in the domain's rectangle.
    pub(super) fn in_box(&self, [x, y]: [f64; 2], up: f64) -> [f64; 3] {
        if self.along == 0 { [x, y, up] } else { [y, 1.0 - x, up] }
    }

    /// The point on the canvas (y downwards), and its nearness to the viewer.
    pub(super) fn project(&self, place: [f64; 3]) -> [f64; 3] {
        let [s, t, z] = [0, 1, 2].map(|k| place[k] * self.sides[k]);
        let (turn_sin, turn_cos) = TURN.sin_cos();
        let (rise_sin, rise_cos) = RISE.sin_cos();
        let away = s * turn_sin + t * turn_cos;
        [
            self.origin[0] + self.scale * (s * turn_cos - t * turn_sin),
            self.origin[1] - self.scale * (away * rise_sin + z * rise_cos),
            z * rise_sin - away * rise_cos,
        ]
    }

    /// The point on the canvas only.
    pub(super) fn on_canvas(&self, place: [f64; 3]) -> [f64; 2] {
        let [x, y, _] = self.project(place);
        [x, y]
    }

    /// The brightness, from 0 to 1, of a surface whose height rises by these slopes along the first two axes of
    /// the box.
    pub(super) fn brightness(&self, slopes: [f64; 2]) -> f64 {
        const LIGHT: [f64; 3] = [-0.45, -0.35, 0.82];
        let [s, t] = [0, 1].map(|k| slopes[k] * self.sides[2] / self.sides[k]);
        let normal = (1.0 + s * s + t * t).sqrt();
        ((LIGHT[2] - s * LIGHT[0] - t * LIGHT[1]) / normal).clamp(0.0, 1.0)
    }

    /// By how much the heights are enlarged compared with the direction of the cut, and the other direction, where it is.
    pub(super) fn enlargement(&self, scene: &Scene) -> String {
        let scale = |side: f64, axis: &Axis| side / axis.length();
        let along = scale(self.sides[0], &scene.domain.plane[self.along]);
        let heights = times(scale(self.sides[2], &scene.height) / along);
        let across = times(scale(self.sides[1], &scene.domain.plane[1 - self.along]) / along);
        let name = ["y", "x"][self.along];
        if across == times(1.0) {
            format!("heights {heights}")
        } else {
            format!("heights {heights}, {name} {across}")
        }
    }

    /// The lengths of the sides of the box.
    pub(super) fn sides(&self) -> [f64; 3] {
        self.sides
    }
}
