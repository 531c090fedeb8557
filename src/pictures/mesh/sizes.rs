//! How fine a mesh is, as a colour.

use crate::geometry::distance_sq;
use crate::mesh::Mesh;
use crate::pictures::drawing::axis::{Axis, scientific};
use crate::pictures::drawing::canvas::{Anchor, Canvas};
use crate::pictures::drawing::color::{INK, Rgb, force};
use crate::pictures::drawing::frame::SMALL;

/// The range of the diameters of triangles.
pub(super) struct Sizes {
    /// Of their decimal logarithms.
    axis: Axis,
    range: [f64; 2],
    /// The corners of the smallest triangle.
    pub(super) finest: [usize; 3],
}

impl Sizes {
    pub(super) fn of(mesh: &Mesh) -> Sizes {
        let diameters = (0..mesh.triangles().len()).map(|t| diameter(mesh.corners(t)));
        let start = ([f64::INFINITY, 0.0], 0);
        let (range, finest) = diameters.enumerate().fold(start, |([low, high], finest), (t, d)| {
            ([low.min(d), high.max(d)], if d < low { t } else { finest })
        });
        let [low, high] = range.map(f64::log10);
        Sizes { axis: Axis::new(low, high), range, finest: mesh.triangles()[finest] }
    }

    /// The colour of a triangle, darker if it is smaller.
    pub(super) fn color(&self, corners: [[f64; 2]; 3]) -> Rgb {
        force(1.0 - self.axis.place(diameter(corners).log10()))
    }

    /// The colours with the least and the greatest diameter, from the point `[x, y]` to the right.
    pub(super) fn bar(&self, canvas: &mut Canvas, [x, y]: [f64; 2]) {
        const LENGTH: f64 = 180.0;
        const STEPS: usize = 60;
        const GAP: f64 = 14.0;
        let [low, high] = self.range.map(scientific);
        let low = format!("h = {low}");
        canvas.text(&low, [x, y], SMALL, INK, Anchor::Left);
        let left = x + canvas.width(&low, SMALL) + GAP;
        for step in 0..STEPS {
            let [from, to] = [step, step + 1].map(|step| left + LENGTH * step as f64 / STEPS as f64);
            let color = force(1.0 - (step as f64 + 0.5) / STEPS as f64);
            canvas.fill([[from, y - 14.0], [to, y + 14.0]], color);
        }
        canvas.text(&high, [left + LENGTH + GAP, y], SMALL, INK, Anchor::Left);
    }
}

/// The longest side.
fn diameter([a, b, c]: [[f64; 2]; 3]) -> f64 {
    distance_sq(a, b).max(distance_sq(b, c)).max(distance_sq(c, a)).sqrt()
}
