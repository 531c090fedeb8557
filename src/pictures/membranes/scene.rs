//! The checked data of a picture, with one axis per quantity.

use super::picture::{Picture, PictureError};
use crate::geometry::twice_signed_area;
use crate::pictures::drawing::axis::Axis;
use crate::pictures::drawing::outline::boundary_edges;

/// Above this the difference of two numbers may overflow.
const LARGEST: f64 = 1e305;

/// Membranes closer than this part of the axis of heights touch to the eye.
pub(super) const TOUCHING: f64 = 0.01;

/// What all parts of the picture draw from.
pub(super) struct Scene<'a> {
    picture: &'a Picture<'a>,
    places: Vec<[f64; 2]>,
    levels: Vec<[f64; 2]>,
    /// The axes of x and y, over the vertices of triangles.
    pub(super) plane: [Axis; 2],
    /// The axis of `u1` and `u2` together.
    pub(super) height: Axis,
    /// The greatest lambda, at least zero.
    pub(super) greatest: f64,
    /// The axis of lambda, zero included.
    pub(super) force: Axis,
    /// The area of the dual cells `D_a` in contact over that of the domain: each vertex has a third of its triangles.
    pub(super) contact_share: f64,
    /// The edges of one triangle only.
    pub(super) boundary: Vec<[usize; 2]>,
    /// Whether any vertex of a triangle is in contact.
    pub(super) touching: bool,
    /// Whether lambda differs from zero anywhere in the contact region.
    pub(super) pressed: bool,
}

impl<'a> Scene<'a> {
    /// Checks the picture's data and finds its ranges.
    pub(super) fn new(picture: &'a Picture<'a>) -> Result<Scene<'a>, PictureError> {
        let used = used_vertices(picture)?;
        check_values(picture, &used)?;
        let forces = used.iter().filter(|&&v| picture.contact[v]).map(|&v| picture.lambda[v]);
        let plane = [0, 1].map(|axis| Axis::over(used.iter().map(|&v| picture.points[v][axis]), false));
        let height = Axis::over(used.iter().flat_map(|&v| [picture.upper[v], picture.lower[v]]), false);
        let heights = picture.upper.iter().zip(picture.lower);
        let places: Vec<[f64; 2]> =
            picture.points.iter().map(|&[x, y]| [plane[0].place(x), plane[1].place(y)]).collect();
        Ok(Scene {
            picture,
            contact_share: contact_share(picture, &places),
            places,
            levels: heights.map(|(&u1, &u2)| [height.place(u1), height.place(u2)]).collect(),
            plane,
            height,
            greatest: forces.clone().fold(0.0, f64::max),
            force: Axis::over(forces, true),
            boundary: boundary_edges(picture.triangles),
            touching: used.iter().any(|&v| picture.contact[v]),
            pressed: used.iter().any(|&v| picture.contact[v] && picture.lambda[v] != 0.0),
        })
    }

    pub(super) fn triangles(&self) -> &'a [[usize; 3]] {
        self.picture.triangles
    }

    /// How many vertices the mesh has, used or not.
    pub(super) fn vertex_count(&self) -> usize {
        self.picture.points.len()
    }

    /// The place of a vertex in the bounding rectangle of the domain, each coordinate from 0 to 1.
    pub(super) fn place(&self, vertex: usize) -> [f64; 2] {
        self.places[vertex]
    }

    /// `u1` and `u2` at a vertex.
    pub(super) fn heights(&self, vertex: usize) -> [f64; 2] {
        [self.picture.upper[vertex], self.picture.lower[vertex]]
    }

    /// The places of `u1` and `u2` at a vertex on the axis of heights.
    pub(super) fn levels(&self, vertex: usize) -> [f64; 2] {
        self.levels[vertex]
    }

    pub(super) fn lambda(&self, vertex: usize) -> f64 {
        self.picture.lambda[vertex]
    }

    pub(super) fn in_contact(&self, vertex: usize) -> bool {
        self.picture.contact[vertex]
    }

    /// Width over height of the domain, kept between 1 / `most` and `most`.
    pub(super) fn aspect(&self, most: f64) -> f64 {
        let aspect = self.plane[0].length() / self.plane[1].length();
        aspect.clamp(1.0 / most, most)
    }
}

/// The vertices of triangles, each once, in ascending order.
fn used_vertices(picture: &Picture) -> Result<Vec<usize>, PictureError> {
    let count = picture.points.len();
    if picture.triangles.is_empty() {
        return Err(PictureError::NoTriangles);
    }
    let mut used = vec![false; count];
    for (triangle, &corners) in picture.triangles.iter().enumerate() {
        for vertex in corners {
            *used.get_mut(vertex).ok_or(PictureError::Vertex { triangle, vertex, count })? = true;
        }
    }
    Ok((0..count).filter(|&vertex| used[vertex]).collect())
}

/// The area of the dual cells in contact over that of the domain, which any scale of the axes leaves as it is.
fn contact_share(picture: &Picture, places: &[[f64; 2]]) -> f64 {
    let sums = picture.triangles.iter().fold([0.0; 2], |[domain, contact], corners| {
        let area = twice_signed_area(corners.map(|v| places[v])).abs();
        let touching = corners.iter().filter(|&&v| picture.contact[v]).count();
        [domain + area, contact + area * touching as f64 / 3.0]
    });
    sums[1] / sums[0]
}

/// One value per vertex, each finite where a triangle uses it.
fn check_values(picture: &Picture, used: &[usize]) -> Result<(), PictureError> {
    let expected = picture.points.len();
    let check_length = |name, found| {
        if found == expected { Ok(()) } else { Err(PictureError::Length { name, found, expected }) }
    };
    check_length("contact", picture.contact.len())?;
    for (name, values) in [("u1", picture.upper), ("u2", picture.lower), ("lambda", picture.lambda)] {
        check_length(name, values.len())?;
        check_finite(name, used, |vertex| values[vertex])?;
    }
    check_finite("x", used, |vertex| picture.points[vertex][0])?;
    check_finite("y", used, |vertex| picture.points[vertex][1])
}

fn check_finite(
    name: &'static str,
    used: &[usize],
    value: impl Fn(usize) -> f64,
) -> Result<(), PictureError> {
    let drawable = |value: f64| value.is_finite() && value.abs() < LARGEST;
    match used.iter().find(|&&vertex| !drawable(value(vertex))) {
        Some(&vertex) => Err(PictureError::Value { name, vertex, value: value(vertex), limit: LARGEST }),
        None => Ok(()),
    }
}
