//! The plan view: lambda on the dual cells, the contact region and the line of the section.

use super::picture::SIZE;
use super::scene::Scene;
use super::section::Cut;
use crate::pictures::drawing::axis::Axis;
use crate::pictures::drawing::canvas::{Anchor, Bitmap, Canvas, FINE};
use crate::pictures::drawing::color::{CONTACT, CONTACT_BAND, FREE, INK, PAPER, force};
use crate::pictures::drawing::frame::{Frame, NORMAL, SMALL};
use crate::pictures::drawing::raster;

/// Elongated domains are drawn no longer than this, width over height or the reverse.
const MOST_ELONGATED: f64 = 8.0;

/// Width of the outline of the contact region in pixels.
const OUTLINE: f64 = 2.5;

/// No dual cell: the pixel lies outside of the domain.
const OUTSIDE: usize = usize::MAX;

/// The vertex whose dual cell covers each fine pixel of a frame.
pub(super) struct Map {
    frame: Frame,
    size: [usize; 2],
    vertex: Vec<usize>,
}

impl Map {
    /// The domain to scale, as large as it fits into `room`, in its middle.
    pub(super) fn new(scene: &Scene, room: Frame) -> Map {
        let aspect = scene.aspect(MOST_ELONGATED);
        let width = room.width.min(room.height * aspect).round();
        let height = (width / aspect).round();
        let left = (room.left + (room.width - width) / 2.0).round();
        let top = (room.top + (room.height - height) / 2.0).round();
        let frame = Frame { left, top, width, height };
        let size = [width, height].map(|length| length as usize * FINE);
        let at = |v: usize| {
            let [x, y] = scene.place(v);
            [x * size[0] as f64, (1.0 - y) * size[1] as f64]
        };
        let mut vertex = vec![OUTSIDE; size[0] * size[1]];
        for corners in scene.triangles() {
            raster::triangle(corners.map(|v| raster::on_grid(at(v))), size, |column, row, weights| {
                vertex[row * size[0] + column] = corners[raster::nearest_corner(weights)];
            });
        }
        // A dual cell in contact may be smaller than a pixel: its vertex is shown in any case.
        for &v in scene.triangles().iter().flatten().filter(|&&v| scene.in_contact(v)) {
            let [column, row] = at(v).map(|at| at.max(0.0) as usize);
            vertex[row.min(size[1] - 1) * size[0] + column.min(size[0] - 1)] = v;
        }
        Map { frame, size, vertex }
    }

    /// For each line across the domain at constant coordinate `axis`, from low to high: the pixels on it whose
    /// vertex is `wanted`.
    pub(super) fn profile(&self, axis: usize, wanted: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut counts = vec![0; self.size[axis]];
        for (pixel, &vertex) in self.vertex.iter().enumerate() {
            if vertex != OUTSIDE && wanted(vertex) {
                let from_low = [pixel % self.size[0], self.size[1] - 1 - pixel / self.size[0]];
                counts[from_low[axis]] += 1;
            }
        }
        counts
    }

    /// Draws the map with axes, the outlines, the cut and a colour bar.
    pub(super) fn draw(&self, canvas: &mut Canvas, scene: &Scene, cut: &Cut) {
        self.cells(canvas, scene);
        for &ends in &scene.boundary {
            canvas.line(ends.map(|v| self.frame.at(scene.place(v))), 2.0, INK);
        }
        self.outline(canvas, scene);
        self.axes(canvas, scene);
        self.cut(canvas, cut);
        self.headings(canvas, scene);
        if scene.pressed {
            color_bar(canvas, &scene.force, scene.greatest, self.frame);
        }
        if !scene.touching {
            let [x, y] = self.frame.at([0.5, 0.5]);
            canvas.text("no contact", [x, y - NORMAL], NORMAL, INK, Anchor::Middle);
        }
    }

    fn headings(&self, canvas: &mut Canvas, scene: &Scene) {
        let share = match 100.0 * scene.contact_share {
            percent if percent >= 0.1 => format!("{percent:.1} %"),
            _ => "less than 0.1 %".to_owned(),
        };
        let extent = if scene.touching {
            format!("contact on {share} of the area (dual cells Dₐ)")
        } else {
            "no contact".to_owned()
        };
        let force = if scene.touching && !scene.pressed {
            "Contact without force, λ = 0"
        } else {
            "Contact force per area, λ"
        };
        canvas.text(force, [self.frame.left, self.frame.top - 94.0], NORMAL, INK, Anchor::Left);
        canvas.text(&extent, [self.frame.left, self.frame.top - 60.0], SMALL, INK, Anchor::Left);
    }

    fn cells(&self, canvas: &mut Canvas, scene: &Scene) {
        let color = |&vertex: &usize| {
            let [red, green, blue] = match vertex {
                OUTSIDE => return [0; 4],
                _ if !scene.in_contact(vertex) => FREE,
                _ if scene.pressed => force(scene.force.place(scene.lambda(vertex))),
                _ => CONTACT_BAND,
            };
            [red, green, blue, 255]
        };
        let pixels = self.vertex.iter().map(color).collect();
        let corner = [self.frame.left, self.frame.top].map(|x| x as usize);
        canvas.bitmap(corner, Bitmap { size: self.size, pixels });
    }

    /// Draws the rim of the contact region: around its pixels that are next to a pixel without contact.
    fn outline(&self, canvas: &mut Canvas, scene: &Scene) {
        let [columns, rows] = self.size;
        let touches = |column: usize, row: usize| {
            let vertex = self.vertex[row * columns + column];
            vertex != OUTSIDE && scene.in_contact(vertex)
        };
        for row in 0..rows {
            for column in (0..columns).filter(|&column| touches(column, row)) {
                let beside = [column.saturating_sub(1), (column + 1).min(columns - 1)];
                let over = [row.saturating_sub(1), (row + 1).min(rows - 1)];
                if !(beside.into_iter().all(|c| touches(c, row))
                    && over.into_iter().all(|r| touches(column, r)))
                {
                    let [x, y] =
                        self.on_canvas(row * columns + column).map(|fine| (fine as f64 + 0.5) / FINE as f64);
                    canvas.dot([x, y], OUTLINE / 2.0, CONTACT);
                }
            }
        }
    }

    fn on_canvas(&self, pixel: usize) -> [usize; 2] {
        let [left, top] = [self.frame.left, self.frame.top].map(|x| x as usize * FINE);
        [left + pixel % self.size[0], top + pixel / self.size[0]]
    }

    fn axes(&self, canvas: &mut Canvas, scene: &Scene) {
        let frame = &self.frame;
        let [x, y] = &scene.plane;
        frame.outline(canvas);
        frame.bottom_axis(canvas, x);
        frame.left_axis(canvas, y, (frame.height / 90.0).clamp(1.0, 6.0) as usize);
        let below = [frame.left + frame.width / 2.0, frame.bottom() + 58.0];
        canvas.text(&format!("x{}", x.suffix()), below, NORMAL, INK, Anchor::Middle);
        let above = [frame.left - 14.0, frame.top - 32.0];
        canvas.text(&format!("y{}", y.suffix()), above, NORMAL, INK, Anchor::Right);
    }

    fn cut(&self, canvas: &mut Canvas, cut: &Cut) {
        let ends = [0.0, 1.0].map(|along| self.frame.at(cut.point(along)));
        canvas.line(ends, 4.5, PAPER);
        canvas.dashed(ends, 2.5, INK);
        let [x, y] = ends[1];
        let (at, anchor) =
            if cut.along == 0 { ([x + 10.0, y], Anchor::Left) } else { ([x, y - 22.0], Anchor::Middle) };
        canvas.text("A–A", at, SMALL, INK, anchor);
    }
}

/// The colours of lambda with their values, right of the map.
fn color_bar(canvas: &mut Canvas, axis: &Axis, greatest: f64, map: Frame) {
    let height = map.height.max(240.0);
    let bar =
        Frame { left: map.right() + 80.0, top: map.top + (map.height - height) / 2.0, width: 26.0, height };
    let steps = bar.height as usize;
    for step in 0..steps {
        let place = step as f64 / steps as f64;
        let [low, high] = [bar.at([0.0, place + 1.0 / steps as f64]), bar.at([1.0, place])];
        canvas.fill([low, high], force(place));
    }
    bar.outline(canvas);
    // The greatest value has a tick of its own; others give way to it.
    const APART: f64 = 0.07;
    let greatest = axis.tick_at(greatest);
    let mut ticks = axis.ticks(6);
    ticks.retain(|tick| (tick.place - greatest.place).abs() > APART);
    ticks.push(greatest);
    bar.right_ticks(canvas, &ticks);
    let title = [(bar.left + 24.0).min(SIZE[0] as f64 - 60.0), bar.top - 24.0];
    canvas.text(&format!("λ{}", axis.suffix()), title, NORMAL, INK, Anchor::Middle);
}
