//! What happens in one gap: the contact and its force per area.

use super::domain::Domain;
use crate::pictures::drawing::axis::Axis;
use crate::pictures::drawing::color::{CONTACT_BAND, FREE, Rgb, force};

/// Lambda and the contact in a gap, over vertices.
pub(crate) struct Action<'a> {
    lambda: &'a [f64],
    contact: &'a [bool],
    /// The greatest lambda, at least zero.
    pub(crate) greatest: f64,
    /// The axis of lambda, zero included.
    pub(crate) axis: Axis,
    /// The area of the dual cells `D_a` in contact over that of the domain: each vertex has a third of its triangles.
    pub(crate) share: f64,
    /// Whether any vertex of a triangle is in contact.
    pub(crate) touching: bool,
    /// Whether lambda differs from zero anywhere in the contact region.
    pub(crate) pressed: bool,
}

impl<'a> Action<'a> {
    /// That of values that are checked.
    pub(crate) fn new(domain: &Domain, lambda: &'a [f64], contact: &'a [bool]) -> Self {
        let touching = || domain.used().iter().copied().filter(|&v| contact[v]);
        Action {
            lambda,
            contact,
            greatest: touching().map(|v| lambda[v]).fold(0.0, f64::max),
            axis: Axis::over(touching().map(|v| lambda[v]), true),
            share: domain.share(contact),
            touching: touching().next().is_some(),
            pressed: touching().any(|v| lambda[v] != 0.0),
        }
    }

    pub(crate) fn lambda(&self, vertex: usize) -> f64 {
        self.lambda[vertex]
    }

    pub(crate) fn in_contact(&self, vertex: usize) -> bool {
        self.contact[vertex]
    }

    /// Lambda where the layers touch.
    pub(crate) fn in_contact_lambda(&self, vertex: usize) -> Option<f64> {
        self.contact[vertex].then(|| self.lambda[vertex])
    }

    /// The colour of the dual cell of a vertex.
    pub(crate) fn color(&self, vertex: usize) -> Rgb {
        match self.in_contact_lambda(vertex) {
            None => FREE,
            Some(lambda) if self.pressed => force(self.axis.place(lambda)),
            Some(_) => CONTACT_BAND,
        }
    }

    /// The share of the contact in words.
    pub(crate) fn percentage(&self) -> String {
        match 100.0 * self.share {
            percent if percent >= 0.1 => format!("{percent:.1} %"),
            _ => "less than 0.1 %".to_owned(),
        }
    }
}
