//! One window onto the triangulation and its dual mesh.

use super::picture::MeshPicture;
use super::sizes::Sizes;
use super::window::Window;
use crate::pictures::drawing::canvas::{Bitmap, Canvas, FINE};
use crate::pictures::drawing::color::{DUAL, DUAL_CELL, DUAL_CONTACT, INK, RIM, Rgb, TRIANGULATION};
use crate::pictures::drawing::raster;

/// Lines of triangles and cells with a shorter or longer side of fewer pixels would run together: they are shown by their
/// tint only.
const SMALLEST: [f64; 2] = [4.0, 9.0];
/// Cells with a shorter side of at least this many pixels have a dot at their vertex.
const DOTTED: f64 = 22.0;
/// At this distance of the vertices in pixels the lines have their full width.
const ROOMY: f64 = 50.0;

/// Width in pixels of the rim of the contact over the whole domain.
pub(super) const RIM_WIDTH: f64 = 2.0;

/// Width in pixels of the lines of `T_h`, in full.
pub(super) const THIN: f64 = 1.6;
/// Width in pixels of the lines of `D_h`, in full.
pub(super) const STRONG: f64 = 3.4;

/// Both meshes in a window; `boundary` are the edges of the domain.
pub(super) fn meshes(picture: &MeshPicture, window: &Window, boundary: &[[usize; 2]]) -> Canvas {
    let mut canvas = Canvas::new(window.size());
    let width = (window.spacing / ROOMY).clamp(0.4, 1.0);
    tints(&mut canvas, picture, window);
    triangulation(&mut canvas, picture, window, THIN * width);
    outline(&mut canvas, picture, window, boundary);
    dual_mesh(&mut canvas, picture, window, STRONG * width);
    canvas
}

/// The domain without the meshes, in the colours of `sizes`, with the rim of the contact, or in those of the contact.
pub(super) fn domain(
    picture: &MeshPicture,
    window: &Window,
    boundary: &[[usize; 2]],
    sizes: Option<&Sizes>,
) -> Canvas {
    let mut canvas = Canvas::new(window.size());
    match sizes {
        Some(sizes) => {
            let color = |t: usize, _: usize| Some(sizes.color(picture.mesh.corners(t)));
            canvas.bitmap([0, 0], field(picture, window, color));
            rim(&mut canvas, picture, window);
        }
        None => {
            let mut tints = vec![None; picture.mesh.points().len()];
            for &a in picture.dual.vertices() {
                tints[a] = Some(tint(picture, a));
            }
            canvas.bitmap([0, 0], field(picture, window, |_, a| tints[a]));
        }
    }
    outline(&mut canvas, picture, window, boundary);
    canvas
}

/// Each pixel in the colour of its triangle and the vertex whose dual cell it lies in.
fn field(picture: &MeshPicture, window: &Window, color: impl Fn(usize, usize) -> Option<Rgb>) -> Bitmap {
    let size = window.size().map(|length| length * FINE);
    let mut pixels = vec![[0; 4]; size[0] * size[1]];
    for (t, corners) in picture.mesh.triangles().iter().enumerate() {
        let points = picture.mesh.corners(t).map(|p| raster::on_grid(window.at(p).map(|x| x * FINE as f64)));
        let colors = corners.map(|a| color(t, a));
        raster::triangle(points, size, |column, row, weights| {
            if let Some([red, green, blue]) = colors[raster::nearest_corner(weights)] {
                pixels[row * size[0] + column] = [red, green, blue, 255];
            }
        });
    }
    Bitmap { size, pixels }
}

/// Between the vertices in contact and the others: through the middles of the edges that join them.
fn rim(canvas: &mut Canvas, picture: &MeshPicture, window: &Window) {
    let Some(contact) = picture.contact else { return };
    for corners in picture.mesh.triangles() {
        let sides = [[0, 1], [1, 2], [2, 0]].map(|side| side.map(|k| corners[k]));
        let crossed = sides.into_iter().filter(|&[a, b]| contact[a] != contact[b]);
        let middle = |[a, b]: [usize; 2]| {
            let [p, q] = [a, b].map(|a| window.at(picture.mesh.points()[a]));
            [0, 1].map(|k| (p[k] + q[k]) / 2.0)
        };
        let middles: Vec<[f64; 2]> = crossed.map(middle).collect();
        if let [from, to] = middles[..] {
            canvas.line([from, to], RIM_WIDTH, RIM);
        }
    }
}

fn outline(canvas: &mut Canvas, picture: &MeshPicture, window: &Window, boundary: &[[usize; 2]]) {
    for &edge in boundary {
        let ends = edge.map(|a| picture.mesh.points()[a]);
        if window.extent(ends.into_iter()).is_some() {
            canvas.line(ends.map(|p| window.at(p)), 2.5, INK);
        }
    }
}

/// The cells of the dual mesh as areas; each is star-shaped around its vertex.
fn tints(canvas: &mut Canvas, picture: &MeshPicture, window: &Window) {
    let dual = picture.dual;
    for (k, &a) in dual.vertices().iter().enumerate() {
        let corners = dual.cell(k).iter().map(|&corner| dual.points()[corner]);
        if window.extent(corners.clone()).is_none() {
            continue;
        }
        let vertex = window.at(picture.mesh.points()[a]);
        canvas.star(vertex, corners.map(|corner| window.at(corner)).collect(), tint(picture, a));
    }
}

/// The colour of the dual cell of a vertex.
fn tint(picture: &MeshPicture, vertex: usize) -> Rgb {
    let touching = picture.contact.is_some_and(|contact| contact[vertex]);
    if touching { DUAL_CONTACT } else { DUAL_CELL }
}

fn is_distinct([width, height]: [f64; 2]) -> bool {
    width.min(height) >= SMALLEST[0] && width.max(height) >= SMALLEST[1]
}

fn triangulation(canvas: &mut Canvas, picture: &MeshPicture, window: &Window, width: f64) {
    for t in 0..picture.mesh.triangles().len() {
        let corners = picture.mesh.corners(t);
        if window.extent(corners.into_iter()).is_some_and(is_distinct) {
            let [a, b, c] = corners.map(|corner| window.at(corner));
            for ends in [[a, b], [b, c], [c, a]] {
                canvas.line(ends, width, TRIANGULATION);
            }
        }
    }
}

fn dual_mesh(canvas: &mut Canvas, picture: &MeshPicture, window: &Window, line: f64) {
    let dual = picture.dual;
    for (k, &a) in dual.vertices().iter().enumerate() {
        let corners = dual.cell(k).iter().map(|&corner| dual.points()[corner]);
        let Some([width, height]) = window.extent(corners.clone()) else { continue };
        if !is_distinct([width, height]) {
            continue;
        }
        for (from, to) in corners.clone().zip(corners.cycle().skip(1)) {
            canvas.line([window.at(from), window.at(to)], line, DUAL);
        }
        if width.min(height) >= DOTTED {
            canvas.dot(window.at(picture.mesh.points()[a]), 1.1 * line, INK);
        }
    }
}
