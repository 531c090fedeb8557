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

/// A vertex of a surface.
struct Corner {
    /// The corner of fine pixels next to it.
    at: [f64; 2],
    nearness: f64,
    /// The place in the box, along the cut and away from the viewer.
    place: [f64; 2],
    /// The brightness of the surface.
    shade: f64,
    /// Between the membranes, on the axis of heights.
    gap: f64,
    contact: bool,
}

/// Grid lines in one direction, on one triangle.
struct Rule {
    /// How many there are on a length of 1.
    lines: f64,
    /// How far from its middle a line is drawn, where they are 1 apart.
    reach: f64,
    /// How much of the surface it covers there: lines fade where they would run together.
    cover: f64,
}

impl Rule {
    /// That of lines of which there are as many, where the place changes by `steepness` from one fine pixel to the next.
    fn new(lines: f64, steepness: f64) -> Self {
        let half_width = 0.45 * FINE as f64;
        let per_pixel = lines * steepness;
        Self { lines, reach: half_width * per_pixel, cover: (1.0 / (per_pixel * 8.0 * FINE as f64)).min(1.0) }
    }

    /// How much of a grid line covers the place `at`.
    fn cover(&self, at: f64) -> f64 {
        let at = at * self.lines;
        // The nearest line: places are positive.
        let nearest = (at + 0.5) as u32;
        if (at - f64::from(nearest)).abs() <= self.reach { self.cover } else { 0.0 }
    }
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
        let corners = self.corners(scene, view, style.membrane);
        let lines = [0, 1].map(|k| (GRID * view.sides()[k]).round().max(2.0));
        let [apart, in_contact] = [Lit::membrane(style.color), Lit::contact()];
        let triangles = scene.domain.drawn();
        let flat = |t: usize| triangles[t].map(|v| corners[v].at);
        raster::in_bands(&mut self.texels, self.size[0], (0..triangles.len()).map(flat), |band, t| {
            let corners = triangles[t].map(|v| &corners[v]);
            if corners.iter().all(|corner| corner.place[1] < style.from) {
                return;
            }
            let Some(gradients) = barycentric_gradients(flat(t)) else { return };
            let across = [0, 1].map(|k| corners.map(|corner| corner.place[k]));
            let rules = [0, 1].map(|k| {
                let slope = |axis: usize| (0..3).map(|i| gradients[i][axis] * across[k][i]).sum::<f64>();
                Rule::new(lines[k], (slope(0) * slope(0) + slope(1) * slope(1)).sqrt())
            });
            let nearnesses = corners.map(|corner| corner.nearness);
            let shades = corners.map(|corner| corner.shade);
            band.triangle(flat(t), |texel: &mut Texel, weights| {
                let [a, b, c] = weights;
                let blend = |[x, y, z]: [f64; 3]| a * x + b * y + c * z;
                let nearness = blend(nearnesses) as f32;
                if nearness <= texel.nearness {
                    return;
                }
                let at = across.map(blend);
                if at[1] < style.from {
                    return;
                }
                let contact = corners[raster::nearest_corner(weights)].contact
                    && (style.membrane == 1 || blend(corners.map(|corner| corner.gap)) < TOUCHING);
                let line = rules[0].cover(at[0]).max(rules[1].cover(at[1]));
                let (kind, lit) =
                    if contact { (Kind::Contact, &in_contact) } else { (Kind::Membrane, &apart) };
                *texel = Texel { nearness, color: lit.color(blend(shades), line), kind };
            });
        });
    }

    /// What a surface is blended from, at all vertices.
    fn corners(&self, scene: &Scene, view: &View, membrane: usize) -> Vec<Corner> {
        let in_box = |v: usize| view.in_box(scene.domain.place(v), scene.levels(v)[membrane]);
        let places: Vec<[f64; 3]> = (0..scene.domain.vertex_count()).into_par_iter().map(in_box).collect();
        let normals = normals(scene.domain.drawn(), &places);
        let corner = |v: usize| {
            let [x, y, nearness] = view.project(places[v]);
            let [upper, lower] = scene.levels(v);
            let [s, t, up] = normals[v];
            Corner {
                at: raster::on_grid(self.fine([x, y])),
                nearness,
                place: [places[v][0], places[v][1]],
                shade: if up > 0.0 { view.brightness([-s / up, -t / up]) } else { 1.0 },
                gap: upper - lower,
                contact: scene.action.in_contact(v),
            }
        };
        (0..places.len()).into_par_iter().map(corner).collect()
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
        let look = |texel: &Texel, behind: &Texel| {
            let [red, green, blue] = behind.color;
            let hidden = texel.kind == Kind::Nothing || behind.nearness > texel.nearness + NEARER;
            if hidden {
                return [red, green, blue, 255];
            }
            let share = if texel.kind == Kind::Membrane { share } else { 1.0 };
            let seen = behind.kind != Kind::Nothing && share < 1.0;
            let color = if seen { mix(behind.color, texel.color, share) } else { texel.color };
            let cover = if seen { 255 } else { (255.0 * share).round() as u8 };
            [color[0], color[1], color[2], cover]
        };
        let mut pixels = vec![[0; 4]; self.texels.len()];
        let rows = pixels.par_chunks_mut(self.size[0]).zip(self.texels.par_chunks(self.size[0]));
        rows.zip(behind.texels.par_chunks(self.size[0])).for_each(|((pixels, texels), behind)| {
            for ((pixel, texel), behind) in pixels.iter_mut().zip(texels).zip(behind) {
                // Most of the frame shows nothing, and its memory is not even touched.
                if [texel.kind, behind.kind] != [Kind::Nothing; 2] {
                    *pixel = look(texel, behind);
                }
            }
        });
        Bitmap { size: self.size, pixels }
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

/// The colours of a surface in the light, or of the contact region on it.
struct Lit {
    /// From no light to the brightest.
    colors: [Rgb; Lit::LEVELS],
    /// Of the grid lines.
    ruled: Rgb,
}

impl Lit {
    /// So many that neighbours differ by no more than one level of a channel.
    const LEVELS: usize = 512;

    fn new(base: Rgb, [dark, bright]: [Rgb; 2], ruled: Rgb) -> Self {
        let color = |level: usize| match level as f64 / (Self::LEVELS - 1) as f64 {
            shade if shade < 0.7 => mix(dark, base, 0.45 + 0.55 * shade / 0.7),
            shade => mix(base, bright, (shade - 0.7) / 0.3 * 0.45),
        };
        Self { colors: std::array::from_fn(color), ruled }
    }

    /// Outside of the contact region.
    fn membrane(base: Rgb) -> Self {
        let dark = [40, 30, 20];
        Self::new(base, [dark, [255, 255, 255]], dark)
    }

    fn contact() -> Self {
        let bright = [150, 150, 160];
        Self::new(CONTACT, [[20, 20, 24], bright], bright)
    }

    /// At a brightness from 0 to 1, under a grid line that covers so much of it.
    fn color(&self, shade: f64, line: f64) -> Rgb {
        let color = self.colors[((shade * (Self::LEVELS - 1) as f64 + 0.5) as usize).min(Self::LEVELS - 1)];
        if line > 0.0 { mix(color, self.ruled, 0.4 * line) } else { color }
    }
}

/// The upward normals of a surface at its vertices, of no certain length: the sum of those of the triangles around each, which
/// count with their areas.
fn normals(triangles: &[[usize; 3]], places: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut normals = vec![[0.0; 3]; places.len()];
    for &corners in triangles {
        let [a, b, c] = corners.map(|v| places[v]);
        let [p, q] = [b, c].map(|d| [d[0] - a[0], d[1] - a[1], d[2] - a[2]]);
        let normal = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        // Seen from above it has no area, and does not count.
        if normal[2] == 0.0 {
            continue;
        }
        let upward = normal[2].signum();
        for v in corners {
            (0..3).for_each(|k| normals[v][k] += upward * normal[k]);
        }
    }
    normals
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pictures::drawing::color::{LOWER, UPPER};

    #[test]
    fn light_has_no_visible_steps_and_all_brightnesses_a_color() {
        for lit in [Lit::membrane(UPPER), Lit::membrane(LOWER), Lit::contact()] {
            let step = |pair: &[Rgb]| (0..3).map(|k| pair[0][k].abs_diff(pair[1][k])).max().unwrap();
            assert!(lit.colors.windows(2).all(|pair| step(pair) <= 1));
            let [dark, bright] = [0.0, 1.0].map(|shade| lit.color(shade, 0.0));
            assert!((0..3).all(|k| dark[k] < bright[k]), "{dark:?} {bright:?}");
            // Rounding may take a blend of brightnesses beyond the ends.
            assert_eq!([-1e-9, 1.0 + 1e-9].map(|shade| lit.color(shade, 0.0)), [dark, bright]);
            assert_ne!(lit.color(0.5, 1.0), lit.color(0.5, 0.0));
        }
    }
}
