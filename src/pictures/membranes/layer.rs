//! One surface of the oblique view with its depth, pixel by pixel.

use super::scene::{Scene, TOUCHING};
use super::view::View;
use crate::geometry::barycentric_gradients;
use crate::parallel::prelude::*;
use crate::pictures::drawing::canvas::{Bitmap, FINE};
use crate::pictures::drawing::color::{CONTACT, Rgb, mix};
use crate::pictures::drawing::frame::Frame;
use crate::pictures::drawing::raster;

/// Lines win over the surface they lie on, and membrane 1 over membrane 2 where they touch.
const NEARER: f32 = 0.004;
/// Grid lines on a surface per side of length 1.
const GRID: f64 = 16.0;

/// What a fine pixel of the view shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Nothing,
    Membrane,
    Contact,
    Line,
}

#[derive(Clone, Copy)]
struct Texel {
    nearness: f32,
    color: Rgb,
    kind: Kind,
}

/// How a membrane is painted.
pub(super) struct Style {
    /// 0 for `u1`, 1 for `u2`.
    pub(super) membrane: usize,
    /// Of the surface.
    pub(super) color: Rgb,
    /// Of the boundary and the section.
    pub(super) line: Rgb,
    /// Only what lies farther from the viewer than this place of the box is painted.
    pub(super) from: f64,
}

/// A picture of one membrane with its lines, on the fine pixels of a frame.
pub(super) struct Layer {
    frame: Frame,
    size: [usize; 2],
    texels: Vec<Texel>,
}

impl Layer {
    pub(super) fn new(frame: Frame) -> Layer {
        let size = [frame.width, frame.height].map(|length| length as usize * FINE);
        let empty = Texel { nearness: f32::NEG_INFINITY, color: [0; 3], kind: Kind::Nothing };
        Layer { frame, size, texels: vec![empty; size[0] * size[1]] }
    }

    /// The upper left corner of the frame.
    pub(super) fn corner(&self) -> [usize; 2] {
        [self.frame.left, self.frame.top].map(|x| x as usize)
    }

    /// Paints a membrane, shaded, with grid lines and the contact region.
    pub(super) fn surface(&mut self, scene: &Scene, view: &View, style: &Style) {
        let shades = brightness(scene, view, style.membrane);
        let in_box = |v: usize| view.in_box(scene.domain.place(v), scene.levels(v)[style.membrane]);
        let project = |v: usize| {
            let [x, y, nearness] = view.project(in_box(v));
            (raster::on_grid(self.fine([x, y])), nearness)
        };
        let projected: Vec<([f64; 2], f64)> = (0..scene.domain.vertex_count()).map(project).collect();
        let spacing = [0, 1].map(|k| 1.0 / (GRID * view.sides()[k]).round().max(2.0));
        for corners in scene.domain.drawn() {
            let flat = corners.map(|v| projected[v].0);
            let Some(gradients) = barycentric_gradients(flat) else { continue };
            let places = corners.map(in_box);
            if places.iter().all(|place| place[1] < style.from) {
                continue;
            }
            let gaps = corners.map(|v| scene.levels(v)[0] - scene.levels(v)[1]);
            let nearnesses = corners.map(|v| projected[v].1);
            let shades = corners.map(|v| f64::from(shades[v]));
            let contacts = corners.map(|v| scene.action.in_contact(v));
            let across = [0, 1].map(|k| places.map(|place| place[k]));
            let steepness = [0, 1].map(|k| {
                let slope = |axis: usize| (0..3).map(|i| gradients[i][axis] * places[i][k]).sum::<f64>();
                let [right, down] = [slope(0), slope(1)];
                (right * right + down * down).sqrt()
            });
            let size = self.size;
            raster::triangle(flat, size, |column, row, weights| {
                let [a, b, c] = weights;
                let blend = |[x, y, z]: [f64; 3]| a * x + b * y + c * z;
                let nearness = blend(nearnesses) as f32;
                let texel = &mut self.texels[row * size[0] + column];
                if nearness <= texel.nearness {
                    return;
                }
                let at = [blend(across[0]), blend(across[1])];
                if at[1] < style.from {
                    return;
                }
                let contact = contacts[raster::nearest_corner(weights)]
                    && (style.membrane == 1 || blend(gaps) < TOUCHING);
                let base = if contact { CONTACT } else { style.color };
                let shade = blend(shades);
                let grid = |k: usize| grid_line(at[k], spacing[k], steepness[k]);
                let kind = if contact { Kind::Contact } else { Kind::Membrane };
                *texel = Texel { nearness, color: lit(base, shade, grid(0).max(grid(1)), contact), kind };
            });
        }
    }

    /// Draws a line of the box where no surface hides it.
    pub(super) fn line(&mut self, view: &View, ends: [[f64; 3]; 2], width: f64, color: Rgb) {
        let [from, to] = ends.map(|place| view.project(place));
        let flat = [from, to].map(|[x, y, _]| self.fine([x, y]));
        let size = self.size;
        raster::line(flat, width * FINE as f64 / 2.0, size, |column, row, place| {
            let nearness = (from[2] + place * (to[2] - from[2])) as f32 + NEARER;
            let texel = &mut self.texels[row * size[0] + column];
            if nearness > texel.nearness {
                *texel = Texel { nearness, color, kind: Kind::Line };
            }
        });
    }

    /// The layer over another one, where that does not hide it: `share` of the membrane, contact and lines in full.
    pub(super) fn over(&self, behind: &Layer, share: f64) -> Bitmap {
        let look = |(texel, behind): (&Texel, &Texel)| {
            let [red, green, blue] = behind.color;
            let hidden = texel.kind == Kind::Nothing || behind.nearness > texel.nearness + NEARER;
            match (hidden, behind.kind) {
                (true, Kind::Nothing) => [0; 4],
                (true, _) => [red, green, blue, 255],
                (false, below) => {
                    let share = if texel.kind == Kind::Membrane { share } else { 1.0 };
                    let seen = below != Kind::Nothing && share < 1.0;
                    let color = if seen { mix(behind.color, texel.color, share) } else { texel.color };
                    let cover = if seen { 255 } else { (255.0 * share).round() as u8 };
                    [color[0], color[1], color[2], cover]
                }
            }
        };
        Bitmap { size: self.size, pixels: self.texels.par_iter().zip(&behind.texels).map(look).collect() }
    }

    /// The point of the canvas nearest to `label` that shows `kind` and, if possible, has it all around.
    pub(super) fn anchor(&self, kind: Kind, label: [f64; 2], hidden_by: Option<&Layer>) -> Option<[f64; 2]> {
        const CLEARANCES: [usize; 4] = [16, 8, 3, 0];
        /// Every second pixel is looked at, in both directions.
        const STEP: usize = 2 * FINE;
        let visible = |column: usize, row: usize| {
            let pixel = row * self.size[0] + column;
            self.texels[pixel].kind == kind
                && hidden_by.is_none_or(|layer| layer.texels[pixel].kind == Kind::Nothing)
        };
        let target = self.fine(label);
        let distance = |&[column, row]: &[usize; 2]| {
            ((column as f64 - target[0]).powi(2) + (row as f64 - target[1]).powi(2)) as u64
        };
        CLEARANCES
            .iter()
            .find_map(|clearance| {
                let reach = clearance * FINE;
                let around = |column: usize, row: usize| {
                    visible(column, row)
                        && [[0, reach], [2 * reach, reach], [reach, 0], [reach, 2 * reach]]
                            .iter()
                            .all(|[dx, dy]| visible(column + dx - reach, row + dy - reach))
                };
                let columns = reach..self.size[0].saturating_sub(reach);
                let rows = (reach..self.size[1].saturating_sub(reach)).step_by(STEP);
                rows.flat_map(|row| columns.clone().step_by(STEP).map(move |column| [column, row]))
                    .filter(|&[column, row]| around(column, row))
                    .min_by_key(distance)
            })
            .map(|[column, row]| {
                [self.frame.left + column as f64 / FINE as f64, self.frame.top + row as f64 / FINE as f64]
            })
    }

    /// Fine pixels of the frame from pixels of the canvas.
    fn fine(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(x - self.frame.left) * FINE as f64, (y - self.frame.top) * FINE as f64]
    }
}

/// Light and the grid lines on the colour of a surface.
fn lit(base: Rgb, shade: f64, line: f64, contact: bool) -> Rgb {
    let (dark, bright) =
        if contact { ([20, 20, 24], [150, 150, 160]) } else { ([40, 30, 20], [255, 255, 255]) };
    let shaded = if shade < 0.7 {
        mix(dark, base, 0.45 + 0.55 * shade / 0.7)
    } else {
        mix(base, bright, (shade - 0.7) / 0.3 * 0.45)
    };
    let ruled = if contact { bright } else { dark };
    mix(shaded, ruled, 0.4 * line)
}

/// How much of a grid line covers the place `at`: lines `spacing` apart, `steepness` of the place per pixel;
/// fading where they would run together.
fn grid_line(at: f64, spacing: f64, steepness: f64) -> f64 {
    // The nearest line: places are positive.
    let nearest = (at / spacing + 0.5) as u32;
    let offset = (at - f64::from(nearest) * spacing).abs();
    let pixels_apart = spacing / steepness;
    let half_width = 0.45 * FINE as f64;
    if offset <= half_width * steepness { (pixels_apart / (8.0 * FINE as f64)).min(1.0) } else { 0.0 }
}

/// The brightness of a membrane at each vertex, from the mean slope of the triangles around it.
fn brightness(scene: &Scene, view: &View, membrane: usize) -> Vec<f32> {
    let mut sums = vec![[0.0; 3]; scene.domain.vertex_count()];
    for corners in scene.domain.drawn() {
        let places = corners.map(|v| view.in_box(scene.domain.place(v), scene.levels(v)[membrane]));
        let Some(gradients) = barycentric_gradients(places.map(|[s, t, _]| [s, t])) else { continue };
        let slope = [0, 1].map(|axis| (0..3).map(|i| gradients[i][axis] * places[i][2]).sum::<f64>());
        let [a, b, c] = places;
        let area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
        for vertex in corners {
            let more = [area * slope[0], area * slope[1], area];
            (0..3).for_each(|k| sums[*vertex][k] += more[k]);
        }
    }
    let shade =
        |[s, t, area]: [f64; 3]| if area > 0.0 { view.brightness([s / area, t / area]) as f32 } else { 1.0 };
    sums.into_iter().map(shade).collect()
}
