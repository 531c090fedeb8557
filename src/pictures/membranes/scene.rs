//! The checked data of a picture, with one axis per quantity.

use super::picture::Picture;
use crate::pictures::drawing::axis::Axis;
use crate::pictures::plan::{Action, Domain, PictureError};

/// Membranes closer than this part of the axis of heights touch to the eye.
pub(super) const TOUCHING: f64 = 0.01;

/// What all parts of the picture draw from.
pub(super) struct Scene<'a> {
    picture: &'a Picture<'a>,
    levels: Vec<[f64; 2]>,
    pub(super) domain: Domain<'a>,
    /// What happens between the membranes.
    pub(super) action: Action<'a>,
    /// The axis of `u1` and `u2` together.
    pub(super) height: Axis,
}

impl<'a> Scene<'a> {
    /// Checks the picture's data and finds its ranges.
    pub(super) fn new(picture: &'a Picture<'a>) -> Result<Scene<'a>, PictureError> {
        let domain = Domain::new(picture.points, picture.triangles, picture.ancestry)?;
        domain.check_length("contact", picture.contact.len())?;
        for (name, values) in [("u1", picture.upper), ("u2", picture.lower), ("lambda", picture.lambda)] {
            domain.check_values(name, values)?;
        }
        let both = domain.used().iter().flat_map(|&v| [picture.upper[v], picture.lower[v]]);
        let height = Axis::over(both, false);
        let heights = picture.upper.iter().zip(picture.lower);
        Ok(Scene {
            picture,
            levels: heights.map(|(&u1, &u2)| [height.place(u1), height.place(u2)]).collect(),
            action: Action::new(&domain, picture.lambda, picture.contact),
            domain,
            height,
        })
    }

    /// `u1` and `u2` at a vertex.
    pub(super) fn heights(&self, vertex: usize) -> [f64; 2] {
        [self.picture.upper[vertex], self.picture.lower[vertex]]
    }

    /// The places of `u1` and `u2` at a vertex on the axis of heights.
    pub(super) fn levels(&self, vertex: usize) -> [f64; 2] {
        self.levels[vertex]
    }
}
