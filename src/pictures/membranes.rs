//! The picture `membranes.png`: both membranes, the contact region and lambda.
//!
//! Three parts share their colours and the line A–A: an oblique view with membrane 1 cut open along A–A, a map
//! of lambda on the dual cells `D_a` of the contact region, and the section A–A.

mod layer;
mod map;
mod scene;
mod section;
mod section_plot;
mod surfaces;
mod view;

use super::drawing::heading::heading;
use super::drawing::{axis, canvas, color, frame, outline, raster};
use crate::action::ContactSolution;
use crate::mesh::Mesh;
use canvas::{Canvas, FINE};
use frame::Frame;
use map::Map;
use scene::Scene;
use section::{Cut, Section};
use section_plot::SectionPlot;

/// Width and height of the picture in pixels.
pub const SIZE: [usize; 2] = [1800, 1330];

/// Where the parts of the picture lie.
const VIEW: Frame = Frame { left: 20.0, top: 84.0, width: 1010.0, height: 720.0 };
const MAP: Frame = Frame { left: 1110.0, top: 220.0, width: 480.0, height: 500.0 };
const MEMBRANES: Frame = Frame { left: 240.0, top: 884.0, width: 1520.0, height: 250.0 };
const FORCE: Frame = Frame { left: 240.0, top: 1154.0, width: 1520.0, height: 96.0 };

/// A discrete solution to be drawn, one value per vertex.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// The heading; what does not fit into two lines is cut off.
    pub title: &'a str,
    /// The vertices; those that no triangle uses are ignored.
    pub points: &'a [[f64; 2]],
    /// The triangles, as indices into `points`.
    pub triangles: &'a [[usize; 3]],
    /// Membrane 1, `u1`.
    pub upper: &'a [f64],
    /// Membrane 2, `u2`.
    pub lower: &'a [f64],
    /// The action `lambda_a`, constant on the dual cell of each vertex, zero on the boundary.
    pub lambda: &'a [f64],
    /// Whether the membranes touch at the vertex.
    pub contact: &'a [bool],
}

impl<'a> Picture<'a> {
    /// That of a solution on its mesh.
    pub fn of(title: &'a str, mesh: &'a Mesh, solution: &'a ContactSolution) -> Self {
        let [upper, lower] = solution.displacement();
        Self {
            title,
            points: mesh.points(),
            triangles: mesh.triangles(),
            upper,
            lower,
            lambda: solution.lambda(),
            contact: solution.contact(),
        }
    }
}

/// Why no picture could be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The mesh is empty.
    #[error("picture: the mesh has no triangles; pass at least one")]
    NoTriangles,
    /// A triangle refers to a vertex that does not exist.
    #[error(
        "picture: triangle {triangle} has vertex {vertex}, but there are {count} vertices; number them from 0"
    )]
    Vertex {
        /// The triangle.
        triangle: usize,
        /// Its vertex.
        vertex: usize,
        /// The number of vertices.
        count: usize,
    },
    /// A slice has the wrong length.
    #[error("picture: {name} has {found} values for {expected} vertices; pass one per vertex")]
    Length {
        /// The quantity.
        name: &'static str,
        /// How many values it has.
        found: usize,
        /// The number of vertices.
        expected: usize,
    },
    /// A value cannot be drawn.
    #[error("picture: {name} = {value} at vertex {vertex}; pass finite values below {limit:e} in magnitude")]
    Value {
        /// The quantity.
        name: &'static str,
        /// The vertex.
        vertex: usize,
        /// The value.
        value: f64,
        /// The greatest magnitude that can be drawn.
        limit: f64,
    },
    /// The image could not be encoded.
    #[error("picture: cannot encode the image: {0}; free memory and run again")]
    Encoding(#[from] png::EncodingError),
}

/// Draws the picture: the bytes of a PNG file of [`SIZE`] pixels, the same for the same data.
///
/// # Errors
/// See [`PictureError`]; every finite solution on a mesh with at least one triangle can be drawn.
pub fn render(picture: &Picture) -> Result<Vec<u8>, PictureError> {
    let scene = Scene::new(picture)?;
    let map = Map::new(&scene, MAP);
    let cut = Cut::through(&scene, &map);
    let section = Section::new(&scene, cut, MEMBRANES.width as usize * FINE);
    let mut canvas = Canvas::new(SIZE);
    heading(&mut canvas, picture.title);
    surfaces::draw(&mut canvas, &scene, &section, VIEW);
    map.draw(&mut canvas, &scene, &cut);
    SectionPlot::new(&scene, &section, [MEMBRANES, FORCE]).draw(&mut canvas);
    Ok(canvas.encode()?)
}

#[cfg(test)]
mod tests;
