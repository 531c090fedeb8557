//! The picture `membranes.png`: both membranes, the contact region and lambda.
//!
//! Three parts share their colours and the line A–A: an oblique view with membrane 1 cut open along A–A, a map
//! of lambda on the dual cells `D_a` of the contact region, and the section A–A.

mod layer;
mod map;
mod picture;
mod scene;
mod section;
mod section_plot;
mod surfaces;
mod view;

pub use super::plan::PictureError;
pub use picture::{Picture, SIZE};

use super::drawing::canvas::{Canvas, FINE};
use super::drawing::encode::Drawing;
use super::drawing::frame::Frame;
use super::drawing::heading::heading;
use super::plan::Cut;
use crate::parallel::join;
use map::Map;
use scene::Scene;
use section::{Section, cut_through};
use section_plot::SectionPlot;

/// Where the parts of the picture lie.
const VIEW: Frame = Frame { left: 20.0, top: 84.0, width: 1010.0, height: 720.0 };
const MAP: Frame = Frame { left: 1110.0, top: 220.0, width: 480.0, height: 500.0 };
const MEMBRANES: Frame = Frame { left: 240.0, top: 884.0, width: 1520.0, height: 250.0 };
const FORCE: Frame = Frame { left: 240.0, top: 1154.0, width: 1520.0, height: 96.0 };

/// Draws the picture, of [`SIZE`] pixels, the same for the same data.
///
/// # Errors
/// See [`PictureError`]; every finite solution on a mesh with at least one triangle can be drawn.
pub fn render(picture: &Picture) -> Result<Drawing, PictureError> {
    let scene = Scene::new(picture)?;
    let map = Map::new(&scene, MAP);
    let cut = cut(&scene, &map);
    let section = Section::new(&scene, cut, MEMBRANES.width as usize * FINE);
    let on_canvas = |draw: &dyn Fn(&mut Canvas)| {
        let mut canvas = Canvas::new(SIZE);
        draw(&mut canvas);
        canvas
    };
    let view = |canvas: &mut Canvas| {
        heading(canvas, picture.title);
        surfaces::draw(canvas, &scene, &section, VIEW);
    };
    let plans = |canvas: &mut Canvas| {
        map.draw(canvas, &scene, &cut);
        SectionPlot::new(&scene, &section, [MEMBRANES, FORCE]).draw(canvas);
    };
    let (mut canvas, plans) = join(|| on_canvas(&view), || on_canvas(&plans));
    canvas.lay(plans);
    Ok(Drawing::new(canvas))
}

/// The line A-A.
fn cut(scene: &Scene, map: &Map) -> Cut {
    let action = &scene.action;
    cut_through(scene, |axis| map.profile(axis, |vertex| !action.touching || action.in_contact(vertex)))
}

#[cfg(test)]
mod tests;
