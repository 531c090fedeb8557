//! A part of the plane, drawn to scale.

use crate::mesh::{Mesh, VertexKind};
use crate::pictures::drawing::axis::Axis;

/// Pixels around the domain, so that its boundary is drawn in full width.
const PAD: f64 = 14.0;

/// The half width of an enlarged part, in mean distances of vertices, is at most this: a thin strip leaves most of a square
/// empty.
const WIDEST: f64 = 16.0;

/// A rectangle of the plane and its scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    low: [f64; 2],
    high: [f64; 2],
    /// Pixels per unit of length.
    scale: f64,
    /// How many vertices the window shows.
    pub(super) vertices: usize,
    /// The mean distance of neighbouring vertices in pixels.
    pub(super) spacing: f64,
}

impl Window {
    /// The whole domain, as large as it fits into `room` pixels.
    pub(super) fn whole(mesh: &Mesh, room: [f64; 2]) -> Window {
        let (low, high) = mesh.bounding_box();
        let length = [0, 1].map(|axis| high[axis] - low[axis]);
        let scale = (0..2).map(|axis| (room[axis] - 2.0 * PAD) / length[axis]).fold(f64::INFINITY, f64::min);
        let pixels = length.map(|length| (length * scale).ceil() + 2.0 * PAD);
        let low = low.map(|x| x - PAD / scale);
        let vertices = used(mesh).count();
        Window {
            low,
            high: [0, 1].map(|axis| low[axis] + pixels[axis] / scale),
            scale,
            vertices,
            spacing: (mesh.area() * scale * scale / vertices as f64).sqrt(),
        }
    }

    /// A square of `side` pixels with about `count` vertices around that of the `candidates` which is nearest to the middle
    /// of the domain; without candidates, of all vertices.
    pub(super) fn enlarged(mesh: &Mesh, count: usize, side: f64, candidates: &[[f64; 2]]) -> Window {
        let (low, high) = mesh.bounding_box();
        let centre = [0, 1].map(|axis| low[axis] + (high[axis] - low[axis]) / 2.0);
        let distance = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).abs().max((p[1] - q[1]).abs());
        let nearer = |p: &[f64; 2], q: &[f64; 2]| distance(*p, centre).total_cmp(&distance(*q, centre));
        let nearest = candidates.iter().copied().min_by(nearer);
        let middle = nearest.or_else(|| used(mesh).min_by(nearer)).expect("a mesh has a triangle");
        let mut distances: Vec<f64> = used(mesh).map(|p| distance(p, middle)).collect();
        let last = count.min(distances.len()) - 1;
        let around = 1.02 * *distances.select_nth_unstable_by(last, f64::total_cmp).1;
        let radius = around.min(WIDEST * (mesh.area() / distances.len() as f64).sqrt());
        let vertices = distances.iter().filter(|&&distance| distance < radius).count();
        Window {
            low: middle.map(|x| x - radius),
            high: middle.map(|x| x + radius),
            scale: side / (2.0 * radius),
            vertices,
            spacing: side / (vertices as f64).sqrt(),
        }
    }

    /// Width and height in pixels.
    pub(super) fn size(&self) -> [usize; 2] {
        [0, 1].map(|axis| ((self.high[axis] - self.low[axis]) * self.scale).round() as usize)
    }

    /// The pixel of a point, from the upper left corner.
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(x - self.low[0]) * self.scale, (self.high[1] - y) * self.scale]
    }

    /// Width and height, in pixels, of the rectangle around points; `None` if it lies outside.
    pub(super) fn extent(&self, points: impl Iterator<Item = [f64; 2]> + Clone) -> Option<[f64; 2]> {
        let mut extent = [0.0; 2];
        for axis in 0..2 {
            let values = points.clone().map(|p| p[axis]);
            let (low, high) =
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
            if high < self.low[axis] || low > self.high[axis] {
                return None;
            }
            extent[axis] = (high - low) * self.scale;
        }
        Some(extent)
    }

    /// Lower left and upper right corner.
    pub(super) fn corners(&self) -> [[f64; 2]; 2] {
        [self.low, self.high]
    }

    /// The axes of x and y.
    pub(super) fn axes(&self) -> [Axis; 2] {
        [0, 1].map(|axis| Axis::new(self.low[axis], self.high[axis]))
    }
}

/// The vertices of triangles.
fn used(mesh: &Mesh) -> impl Iterator<Item = [f64; 2]> {
    mesh.points().iter().zip(mesh.kind()).filter(|(_, kind)| **kind != VertexKind::Unused).map(|(&p, _)| p)
}
