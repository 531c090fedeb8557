//! One window onto the triangulation and its dual mesh.

use super::MeshPicture;
use super::window::Window;
use crate::pictures::drawing::canvas::Canvas;
use crate::pictures::drawing::color::{DUAL, DUAL_CELL, DUAL_CONTACT, INK, TRIANGULATION};

/// Lines of triangles and cells with a shorter or longer side of fewer pixels would run together: they are shown by their
/// tint only.
const SMALLEST: [f64; 2] = [4.0, 9.0];
/// Cells with a shorter side of at least this many pixels have a dot at their vertex.
const DOTTED: f64 = 22.0;
/// At this distance of the vertices in pixels the lines have their full width.
const ROOMY: f64 = 50.0;

/// Width in pixels of the lines of a mesh that is shown as a whole.
const HAIRLINE: f64 = 0.6;

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

/// The domain and its contact region without the meshes.
pub(super) fn domain(picture: &MeshPicture, window: &Window, boundary: &[[usize; 2]]) -> Canvas {
    let mut canvas = Canvas::new(window.size());
    tints(&mut canvas, picture, window);
    outline(&mut canvas, picture, window, boundary);
    canvas
}

/// All triangles in the thinnest lines, over the contact region.
pub(super) fn all_triangles(picture: &MeshPicture, window: &Window, boundary: &[[usize; 2]]) -> Canvas {
    let mut canvas = Canvas::new(window.size());
    tints(&mut canvas, picture, window);
    for t in 0..picture.mesh.triangles().len() {
        let [a, b, c] = picture.mesh.corners(t).map(|corner| window.at(corner));
        for ends in [[a, b], [b, c], [c, a]] {
            canvas.line(ends, HAIRLINE, INK);
        }
    }
    outline(&mut canvas, picture, window, boundary);
    canvas
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
        let touching = picture.contact.is_some_and(|contact| contact[a]);
        let color = if touching { DUAL_CONTACT } else { DUAL_CELL };
        let vertex = window.at(picture.mesh.points()[a]);
        for (from, to) in corners.clone().zip(corners.cycle().skip(1)) {
            canvas.triangle([vertex, window.at(from), window.at(to)], color);
        }
    }
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
