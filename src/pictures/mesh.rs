//! Figure 1 for any mesh: the triangulation `T_h` and its dual mesh `D_h`.

mod panel;
mod picture;
mod sizes;
mod window;

pub use picture::{MeshPicture, MeshPictureError};

use super::drawing::axis::Axis;
use super::drawing::canvas::{Anchor, Canvas};
use super::drawing::color::{DUAL, DUAL_CELL, DUAL_CONTACT, INK, RIM, Rgb, TRIANGULATION};
use super::drawing::encode::Drawing;
use super::drawing::frame::{Frame, NORMAL, SMALL};
use super::drawing::heading::heading;
use super::drawing::outline::boundary_edges;
use crate::text::grouped_by;
use sizes::Sizes;
use window::Window;

/// The longest sides of a domain that is drawn as a whole, in pixels.
const WHOLE: [f64; 2] = [1500.0, 1300.0];
/// The longest sides of a domain beside its enlarged part.
const OVERVIEW: [f64; 2] = [620.0, 1100.0];
/// The side of the enlarged part.
const ENLARGED: f64 = 1100.0;
/// About how many vertices the enlarged part shows.
const VERTICES: usize = 300;
/// A mesh is drawn as a whole if its vertices are at least this many pixels apart.
const LEGIBLE: f64 = 20.0;

/// Room for labels around a window, in pixels.
const LEFT: usize = 140;
const TOP: usize = 196;
const RIGHT: usize = 50;
const RIGHT_WITH_AXIS: usize = 190;
/// Between the two windows.
const BETWEEN: usize = 120;
const BOTTOM: usize = 100;
/// From a window to the name of its vertical axis.
const AXIS_NAME: f64 = 90.0;
/// The legend needs this width.
const NARROWEST: usize = 1180;

/// Draws a mesh, the same for the same data, as wide and high as the domain needs, at most
/// 2170 x 1596 pixels. A mesh too fine to be seen as a whole is shown with a part enlarged: at the rim of the contact,
/// or in the middle. Linear time, but for sorting the edges.
///
/// # Errors
/// See [`MeshPictureError`].
pub fn render_mesh(picture: &MeshPicture) -> Result<Drawing, MeshPictureError> {
    picture.check()?;
    let whole = Window::whole(picture.mesh, WHOLE);
    let canvas = if whole.spacing >= LEGIBLE || whole.vertices <= VERTICES {
        alone(picture, &whole)
    } else {
        let overview = Window::whole(picture.mesh, OVERVIEW);
        let enlarged = Window::enlarged(picture.mesh, VERTICES, ENLARGED, &contact_rim(picture));
        with_enlarged(picture, &overview, &enlarged, None)
    };
    Ok(Drawing::new(canvas))
}

/// Draws how fine a triangulation is: all of it, each triangle in the colour of its diameter, the rim of the contact, and
/// beside it a part enlarged as by [`render_mesh`], at the rim or where the mesh is finest; the same for the same data.
///
/// # Errors
/// See [`MeshPictureError`].
pub fn render_triangulation(picture: &MeshPicture) -> Result<Drawing, MeshPictureError> {
    picture.check()?;
    let sizes = Sizes::of(picture.mesh);
    let mut around = contact_rim(picture);
    if around.is_empty() {
        around = sizes.finest.iter().map(|&a| picture.mesh.points()[a]).collect();
    }
    let overview = Window::whole(picture.mesh, OVERVIEW);
    let enlarged = Window::enlarged(picture.mesh, VERTICES, ENLARGED, &around);
    Ok(Drawing::new(with_enlarged(picture, &overview, &enlarged, Some(&sizes))))
}

/// The vertices in contact with a neighbour that is not.
fn contact_rim(picture: &MeshPicture) -> Vec<[f64; 2]> {
    let Some(contact) = picture.contact else { return Vec::new() };
    let touching = |corners: &[usize; 3]| corners.iter().filter(|&&a| contact[a]).count();
    let mixed = picture.mesh.triangles().iter().filter(|corners| (1..3).contains(&touching(corners)));
    mixed.flatten().filter(|&&a| contact[a]).map(|&a| picture.mesh.points()[a]).collect()
}

/// The whole domain.
fn alone(picture: &MeshPicture, whole: &Window) -> Canvas {
    let [width, height] = whole.size();
    let size = [(LEFT + width + RIGHT).max(NARROWEST), TOP + height + BOTTOM];
    let mut canvas = Canvas::new(size);
    heading(&mut canvas, picture.title);
    legend(&mut canvas, picture, None);
    let corner = [LEFT + (size[0] - LEFT - RIGHT - width) / 2, TOP];
    let boundary = boundary_edges(picture.mesh.points().len(), picture.mesh.triangles());
    let frame = place(&mut canvas, panel::meshes(picture, whole, &boundary), whole, corner);
    left_axis(&mut canvas, frame, whole);
    canvas
}

/// The domain, in the colours of `sizes` or of the contact, and right of it the enlarged part.
fn with_enlarged(
    picture: &MeshPicture,
    overview: &Window,
    enlarged: &Window,
    sizes: Option<&Sizes>,
) -> Canvas {
    let [[width, height], [side, _]] = [overview.size(), enlarged.size()];
    let size = [LEFT + width + BETWEEN + side + RIGHT_WITH_AXIS, TOP + side + BOTTOM];
    let mut canvas = Canvas::new(size);
    heading(&mut canvas, picture.title);
    legend(&mut canvas, picture, sizes);
    let boundary = boundary_edges(picture.mesh.points().len(), picture.mesh.triangles());
    let corner = [LEFT, TOP + (side - height) / 2];
    let domain = panel::domain(picture, overview, &boundary, sizes);
    let left = place(&mut canvas, domain, overview, corner);
    let corner = [LEFT + width + BETWEEN, TOP];
    let right = place(&mut canvas, panel::meshes(picture, enlarged, &boundary), enlarged, corner);
    left_axis(&mut canvas, left, overview);
    right_axis(&mut canvas, right, enlarged);
    mark(&mut canvas, left, overview, right, enlarged);
    let caption = |text: String, frame: Frame, canvas: &mut Canvas| {
        canvas.text(&text, [frame.left, frame.top - 22.0], SMALL, INK, Anchor::Left);
    };
    caption(format!("the domain, {} vertices", grouped(overview.vertices)), left, &mut canvas);
    caption(format!("enlarged, {} vertices", grouped(enlarged.vertices)), right, &mut canvas);
    canvas
}

/// Puts a drawn window on the canvas, with its horizontal axis: its frame.
fn place(canvas: &mut Canvas, drawn: Canvas, window: &Window, corner: [usize; 2]) -> Frame {
    canvas.paste(drawn, corner);
    let [[left, top], [width, height]] = [corner, window.size()].map(|pair| pair.map(|x| x as f64));
    let frame = Frame { left, top, width, height };
    let [x, _] = window.axes();
    frame.outline(canvas);
    frame.bottom_axis(canvas, &x);
    let below = [left + width / 2.0, frame.bottom() + 62.0];
    canvas.text(&format!("x{}", x.suffix()), below, NORMAL, INK, Anchor::Middle);
    frame
}

fn left_axis(canvas: &mut Canvas, frame: Frame, window: &Window) {
    let [_, y] = window.axes();
    frame.left_axis(canvas, &y, tick_count(frame));
    name_of_y(canvas, &y, [frame.left - AXIS_NAME, frame.top + frame.height / 2.0], Anchor::Right);
}

fn right_axis(canvas: &mut Canvas, frame: Frame, window: &Window) {
    let [_, y] = window.axes();
    frame.right_axis(canvas, &y, tick_count(frame));
    name_of_y(canvas, &y, [frame.right() + AXIS_NAME, frame.top + frame.height / 2.0], Anchor::Left);
}

fn tick_count(frame: Frame) -> usize {
    (frame.height / 120.0).clamp(1.0, 8.0) as usize
}

/// The name of the vertical axis beside its labels, its power of ten below.
fn name_of_y(canvas: &mut Canvas, y: &Axis, [left, top]: [f64; 2], anchor: Anchor) {
    canvas.text("y", [left, top], NORMAL, INK, anchor);
    canvas.text(&y.power(), [left, top + 1.2 * NORMAL], SMALL, INK, anchor);
}

/// Shows in the overview what is enlarged.
fn mark(canvas: &mut Canvas, left: Frame, overview: &Window, right: Frame, enlarged: &Window) {
    const LEAST: f64 = 6.0;
    let [low, high] = enlarged.corners().map(|corner| {
        let [x, y] = overview.at(corner);
        [(left.left + x).clamp(left.left, left.right()), (left.top + y).clamp(left.top, left.bottom())]
    });
    let more = [0, 1].map(|axis| ((LEAST - (high[axis] - low[axis]).abs()) / 2.0).max(0.0));
    let [west, east] = [low[0] - more[0], high[0] + more[0]];
    let [north, south] = [high[1] - more[1], low[1] + more[1]];
    let corners = [[west, south], [east, south], [east, north], [west, north], [west, south]];
    for ends in corners.windows(2) {
        canvas.line([ends[0], ends[1]], 2.5, DUAL);
    }
    for ends in [[[east, north], [right.left, right.top]], [[east, south], [right.left, right.bottom()]]] {
        canvas.dashed(ends, 1.5, DUAL);
    }
}

/// What the lines and tints mean, below the title.
fn legend(canvas: &mut Canvas, picture: &MeshPicture, sizes: Option<&Sizes>) {
    const SAMPLE: f64 = 44.0;
    const GAP: f64 = 14.0;
    const APART: f64 = 44.0;
    let y = 132.0;
    let mut x = LEFT as f64;
    let name = |canvas: &mut Canvas, from: f64, text: &str| {
        canvas.text(text, [from + SAMPLE + GAP, y], SMALL, INK, Anchor::Left);
        from + SAMPLE + GAP + canvas.width(text, SMALL) + APART
    };
    let line = |canvas: &mut Canvas, x: f64, width: f64, color: Rgb| {
        canvas.line([[x, y], [x + SAMPLE, y]], width, color);
    };
    line(canvas, x, 1.5 * panel::THIN, TRIANGULATION);
    x = name(canvas, x, &format!("Tₕ: {} triangles", grouped(picture.mesh.triangles().len())));
    canvas.fill([[x, y - 14.0], [x + SAMPLE, y + 14.0]], DUAL_CELL);
    line(canvas, x, panel::STRONG, DUAL);
    x = name(canvas, x, &format!("Dₕ: {} dual cells", grouped(picture.dual.vertices().len())));
    if let Some(contact) = picture.contact {
        canvas.fill([[x, y - 14.0], [x + SAMPLE, y + 14.0]], DUAL_CONTACT);
        let count = picture.dual.vertices().iter().filter(|&&a| contact[a]).count();
        x = name(canvas, x, &format!("in contact: {}", grouped(count)));
    }
    if let Some(sizes) = sizes {
        if picture.contact.is_some() {
            line(canvas, x, panel::RIM_WIDTH, RIM);
            x = name(canvas, x, "rim of the contact");
        }
        sizes.bar(canvas, [x, y]);
    }
}

/// A number in groups of three digits, apart by thin spaces.
fn grouped(number: usize) -> String {
    grouped_by("\u{2009}", number)
}

#[cfg(test)]
mod tests;
