//! The dual cells on pixels: lambda, the contact region, and the line of the section.

use super::action::Action;
use super::cut::Cut;
use super::domain::Domain;
use crate::parallel::prelude::*;
use crate::pictures::drawing::axis::Axis;
use crate::pictures::drawing::canvas::{Bitmap, Canvas, FINE};
use crate::pictures::drawing::color::{CONTACT, FREE, INK, PAPER, force};
use crate::pictures::drawing::frame::Frame;
use crate::pictures::drawing::raster;

/// Elongated domains are drawn no longer than this, width over height or the reverse.
pub(crate) const MOST_ELONGATED: f64 = 8.0;

/// Width of the outline of the contact region in pixels.
const OUTLINE: f64 = 2.5;

/// No dual cell: the pixel lies outside of the domain.
const OUTSIDE: u32 = u32::MAX;

/// The vertex whose dual cell covers each fine pixel of a frame.
pub(crate) struct Cells {
    pub(crate) frame: Frame,
    size: [usize; 2],
    vertex: Vec<u32>,
}

impl Cells {
    /// The domain to scale, as large as it fits into `room`, in its middle; `marked` vertices are shown however small their
    /// dual cells are.
    pub(crate) fn new(domain: &Domain, room: Frame, marked: impl Fn(usize) -> bool) -> Cells {
        let aspect = domain.aspect(MOST_ELONGATED);
        let width = room.width.min(room.height * aspect).round();
        let height = (width / aspect).round();
        let left = (room.left + (room.width - width) / 2.0).round();
        let top = (room.top + (room.height - height) / 2.0).round();
        let frame = Frame { left, top, width, height };
        let size = [width, height].map(|length| length as usize * FINE);
        let at = |v: usize| {
            let [x, y] = domain.place(v);
            [x * size[0] as f64, (1.0 - y) * size[1] as f64]
        };
        let mut vertex = vec![OUTSIDE; size[0] * size[1]];
        let on_grid: Vec<[f64; 2]> =
            (0..domain.vertex_count()).into_par_iter().map(|v| raster::on_grid(at(v))).collect();
        let corners = |t: usize| domain.drawn()[t].map(|v| on_grid[v]);
        raster::in_bands(&mut vertex, size[0], (0..domain.drawn().len()).map(corners), |band, t| {
            let vertices = domain.drawn()[t];
            band.triangle(corners(t), |pixel, weights| {
                *pixel = vertices[raster::nearest_corner(weights)] as u32;
            });
        });
        let pixel = |v: usize| {
            let [column, row] = at(v).map(|at| at.max(0.0) as usize);
            row.min(size[1] - 1) * size[0] + column.min(size[0] - 1)
        };
        // Of triangles larger than those that there are not all vertices have been asked.
        if domain.is_simplified() {
            domain.used().iter().for_each(|&v| vertex[pixel(v)] = v as u32);
        }
        // A dual cell in contact may be smaller than a pixel: its vertex is shown in any case.
        for &v in domain.triangles().iter().flatten().filter(|&&v| marked(v)) {
            vertex[pixel(v)] = v as u32;
        }
        Cells { frame, size, vertex }
    }

    /// For each line across the domain at constant coordinate `axis`, from low to high: the pixels on it whose
    /// vertex is `wanted`.
    pub(crate) fn profile(&self, axis: usize, wanted: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut counts = vec![0; self.size[axis]];
        for (pixel, &vertex) in self.vertex.iter().enumerate() {
            if vertex != OUTSIDE && wanted(vertex as usize) {
                let from_low = [pixel % self.size[0], self.size[1] - 1 - pixel / self.size[0]];
                counts[from_low[axis]] += 1;
            }
        }
        counts
    }

    /// Draws the dual cells in their colours, the boundary of the domain and, if there is an action, the rim of its contact.
    pub(crate) fn draw(&self, canvas: &mut Canvas, domain: &Domain, action: Option<&Action>) {
        self.paint(canvas, |vertex| action.map_or(FREE, |action| action.color(vertex)));
        for &ends in &domain.boundary {
            canvas.line(ends.map(|v| self.frame.at(domain.place(v))), 2.0, INK);
        }
        if let Some(action) = action {
            self.rim(canvas, |vertex| action.in_contact(vertex));
        }
    }

    fn paint(&self, canvas: &mut Canvas, color: impl Fn(usize) -> [u8; 3]) {
        let covering = |vertex: u32| {
            if vertex == OUTSIDE {
                return [0; 4];
            }
            let [red, green, blue] = color(vertex as usize);
            [red, green, blue, 255]
        };
        let mut pixels = Vec::with_capacity(self.vertex.len());
        for cell in self.vertex.chunk_by(|a, b| a == b) {
            pixels.resize(pixels.len() + cell.len(), covering(cell[0]));
        }
        let corner = [self.frame.left, self.frame.top].map(|x| x as usize);
        canvas.bitmap(corner, Bitmap { size: self.size, pixels });
    }

    /// Draws the rim of the contact region: around its pixels that are next to a pixel without contact.
    fn rim(&self, canvas: &mut Canvas, in_contact: impl Fn(usize) -> bool) {
        let [columns, rows] = self.size;
        let touches = |column: usize, row: usize| {
            let vertex = self.vertex[row * columns + column];
            vertex != OUTSIDE && in_contact(vertex as usize)
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

    /// Draws the line of the section. Its far end.
    pub(crate) fn cut(&self, canvas: &mut Canvas, cut: &Cut) -> [f64; 2] {
        let ends = [0.0, 1.0].map(|along| self.frame.at(cut.point(along)));
        canvas.line(ends, 4.5, PAPER);
        canvas.dashed(ends, 2.5, INK);
        ends[1]
    }
}

/// The colours of lambda with their values to their right: about `count` ticks, and one for the greatest.
pub(crate) fn color_bar(canvas: &mut Canvas, bar: Frame, axis: &Axis, greatest: f64, count: usize) {
    let steps = bar.height as usize;
    for step in 0..steps {
        let place = step as f64 / steps as f64;
        let [low, high] = [bar.at([0.0, place + 1.0 / steps as f64]), bar.at([1.0, place])];
        canvas.fill([low, high], force(place));
    }
    bar.outline(canvas);
    // The greatest value has a tick of its own; others give way to it.
    const APART: f64 = 0.42;
    let greatest = axis.tick_at(greatest);
    let mut ticks = axis.ticks(count);
    ticks.retain(|tick| (tick.place - greatest.place).abs() > APART / count as f64);
    ticks.push(greatest);
    bar.right_ticks(canvas, &ticks);
}
