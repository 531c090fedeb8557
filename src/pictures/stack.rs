//! The picture of a stack of membranes between obstacles: the section A–A, lambda along it, and maps of the gaps.
//!
//! The section shows all layers from the ceiling to the floor. Those that are closer to each other than their lines are wide are
//! drawn side by side; a dark seam joins them where they touch. Below it lambda is drawn for each gap with contact, and in the
//! maps lambda on the dual cells `D_a` of the contact region, each gap with an axis of its own.

mod layout;
mod maps;
mod picture;
mod scene;
mod section;
mod section_plot;
mod spread;
mod strips;
mod walls;

pub use super::plan::PictureError;
pub use picture::{GapPicture, StackPicture, WIDTH};

use super::drawing::canvas::{Canvas, FINE};
use super::drawing::encode::Drawing;
use super::drawing::heading::heading;
use super::plan::Cells;
use layout::Layout;
use scene::Scene;
use section::{Section, cut};
use section_plot::SectionPlot;

/// Draws the picture, [`WIDTH`] pixels wide and as high as its gaps need, the same for the same data.
///
/// # Errors
/// See [`PictureError`]; every finite solution on a mesh with at least one triangle can be drawn.
pub fn render(picture: &StackPicture) -> Result<Drawing, PictureError> {
    let scene = Scene::new(picture)?;
    let layout = Layout::new(&scene);
    let cells: Vec<Cells> =
        layout.maps.iter().enumerate().map(|(map, &frame)| scene.cells(map, frame)).collect();
    let section = Section::new(&scene, cut(&scene, &cells), layout.section.width as usize * FINE);
    let mut canvas = Canvas::new(layout.size);
    heading(&mut canvas, picture.title);
    SectionPlot::new(&scene, &section, layout.section).draw(&mut canvas);
    strips::draw(&mut canvas, &scene, &section, &layout.strips);
    maps::draw(&mut canvas, &scene, &cells, &section.cut, &layout);
    Ok(Drawing::new(canvas))
}

#[cfg(test)]
mod tests;
