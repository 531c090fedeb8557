//! The checked mesh of a picture.

use std::borrow::Cow;
use std::sync::Arc;

use super::detail::drawn;
use super::error::PictureError;
use crate::geometry::twice_signed_area;
use crate::mesh::Parents;
use crate::pictures::drawing::axis::Axis;
use crate::pictures::drawing::outline::boundary_edges;

/// Above this the difference of two numbers may overflow.
const LARGEST: f64 = 1e305;

/// The domain in its bounding rectangle, whose sides both have length 1.
pub(crate) struct Domain<'a> {
    triangles: &'a [[usize; 3]],
    drawn: Cow<'a, [[usize; 3]]>,
    /// The vertices of triangles, each once, in ascending order.
    used: Vec<usize>,
    places: Vec<[f64; 2]>,
    /// The axes of x and y, over the vertices of triangles.
    pub(crate) plane: [Axis; 2],
    /// The edges of one triangle only, of those that are drawn.
    pub(crate) boundary: Vec<[usize; 2]>,
}

impl<'a> Domain<'a> {
    /// Checks the mesh. With the refinements that made it, no more triangles are drawn than can be seen.
    pub(crate) fn new(
        points: &[[f64; 2]],
        triangles: &'a [[usize; 3]],
        ancestry: &[Arc<Parents>],
    ) -> Result<Domain<'a>, PictureError> {
        let made = ancestry.last().map_or(points.len(), |parents| parents.ends().len());
        check_length("ancestry", made, points.len())?;
        let used = used_vertices(points.len(), triangles)?;
        check_finite("x", &used, |v| points[v][0])?;
        check_finite("y", &used, |v| points[v][1])?;
        let plane = [0, 1].map(|axis| Axis::over(used.iter().map(|&v| points[v][axis]), false));
        let places = points.iter().map(|&[x, y]| [plane[0].place(x), plane[1].place(y)]).collect();
        let drawn = drawn(triangles, ancestry);
        let boundary = boundary_edges(points.len(), &drawn);
        Ok(Domain { triangles, drawn, used, places, plane, boundary })
    }

    /// All triangles.
    pub(crate) fn triangles(&self) -> &'a [[usize; 3]] {
        self.triangles
    }

    /// The triangles that are drawn: these, or, where they are too many to be seen, larger ones that they are parts of.
    pub(crate) fn drawn(&self) -> &[[usize; 3]] {
        &self.drawn
    }

    /// Whether larger triangles are drawn.
    pub(crate) fn is_simplified(&self) -> bool {
        matches!(self.drawn, Cow::Owned(_))
    }

    /// The vertices of triangles, each once, in ascending order.
    pub(crate) fn used(&self) -> &[usize] {
        &self.used
    }

    /// How many vertices the mesh has, used or not.
    pub(crate) fn vertex_count(&self) -> usize {
        self.places.len()
    }

    /// The place of a vertex in the bounding rectangle of the domain, each coordinate from 0 to 1.
    pub(crate) fn place(&self, vertex: usize) -> [f64; 2] {
        self.places[vertex]
    }

    /// Width over height of the domain, kept between 1 / `most` and `most`.
    pub(crate) fn aspect(&self, most: f64) -> f64 {
        let aspect = self.plane[0].length() / self.plane[1].length();
        aspect.clamp(1.0 / most, most)
    }

    /// How far from a vertex its dual cell reaches at least in the direction of `axis`: a third of the way to the farthest vertex
    /// on the nearer side, less what the slant of its triangles may take.
    pub(crate) fn half_width(&self, vertex: usize, axis: usize) -> f64 {
        const SLANT: f64 = 0.5;
        let around = self.triangles.iter().filter(|corners| corners.contains(&vertex)).flatten();
        let offsets = around.map(|&v| self.places[v][axis] - self.places[vertex][axis]);
        let [below, above] = offsets.fold([0.0f64; 2], |[low, high], x| [low.min(x), high.max(x)]);
        SLANT * above.min(-below) / 3.0
    }

    /// The area of the dual cells of these vertices over that of the domain, which any scale of the axes leaves as it is.
    pub(crate) fn share(&self, contact: &[bool]) -> f64 {
        let sums = self.triangles.iter().fold([0.0; 2], |[domain, sum], corners| {
            let area = twice_signed_area(corners.map(|v| self.places[v])).abs();
            let touching = corners.iter().filter(|&&v| contact[v]).count();
            [domain + area, sum + area * touching as f64 / 3.0]
        });
        sums[1] / sums[0]
    }

    /// One value per vertex.
    pub(crate) fn check_length(&self, name: &str, found: usize) -> Result<(), PictureError> {
        check_length(name, found, self.vertex_count())
    }

    /// One value per vertex, each finite where a triangle uses it.
    pub(crate) fn check_values(&self, name: &str, values: &[f64]) -> Result<(), PictureError> {
        self.check_length(name, values.len())?;
        check_finite(name, &self.used, |v| values[v])
    }
}

fn check_length(name: &str, found: usize, expected: usize) -> Result<(), PictureError> {
    if found == expected {
        Ok(())
    } else {
        Err(PictureError::Length { name: name.to_owned(), found, expected })
    }
}

fn used_vertices(count: usize, triangles: &[[usize; 3]]) -> Result<Vec<usize>, PictureError> {
    if triangles.is_empty() {
        return Err(PictureError::NoTriangles);
    }
    let mut used = vec![false; count];
    for (triangle, &corners) in triangles.iter().enumerate() {
        for vertex in corners {
            *used.get_mut(vertex).ok_or(PictureError::Vertex { triangle, vertex, count })? = true;
        }
    }
    Ok((0..count).filter(|&vertex| used[vertex]).collect())
}

fn check_finite(name: &str, used: &[usize], value: impl Fn(usize) -> f64) -> Result<(), PictureError> {
    let drawable = |value: f64| value.is_finite() && value.abs() < LARGEST;
    match used.iter().find(|&&vertex| !drawable(value(vertex))) {
        Some(&vertex) => {
            Err(PictureError::Value { name: name.to_owned(), vertex, value: value(vertex), limit: LARGEST })
        }
        None => Ok(()),
    }
}
