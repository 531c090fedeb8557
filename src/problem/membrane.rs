//! One membrane of a stack: tension, load, foundation, and how it is held on the boundary.

use super::{Field, Function};

/// A membrane: `-div(mu grad u) + c u = f` and what its neighbours do to it, with a height or a line load on each part of the
/// boundary.
///
/// ```
/// use membrane_contact::problem::Membrane;
///
/// let sheet = Membrane::new(2.0).load(-15.0).height(0.1).free_on("right").traction_on("top", 0.5);
/// assert_eq!(sheet.curves().collect::<Vec<_>>(), ["right", "top"]);
/// ```
#[derive(Debug, Clone)]
pub struct Membrane {
    pub(crate) tension: Field,
    pub(crate) load: Field,
    pub(crate) foundation: Field,
    /// How it is held on each named curve, and on the rest of the boundary.
    pub(crate) parts: Vec<(String, Support)>,
    pub(crate) elsewhere: Support,
    /// Whether its neighbours alone may hold it.
    pub(crate) pressed: bool,
}

/// How a membrane is held on a part of the boundary.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Support {
    /// At a height.
    Fixed(Field),
    /// Not at all.
    Free {
        /// The line load `mu d_n u` there, force per length, positive upwards.
        traction: Function,
    },
}

impl Membrane {
    /// A membrane of this tension (force per length, positive), without a load, fixed at height zero all around.
    pub fn new(tension: impl Into<Field>) -> Self {
        let zero = || Field::from(0.0);
        Self {
            tension: tension.into(),
            load: zero(),
            foundation: zero(),
            parts: Vec::new(),
            elsewhere: Support::Fixed(zero()),
            pressed: false,
        }
    }

    /// The load `f`, force per area, positive upwards.
    pub fn load(mut self, load: impl Into<Field>) -> Self {
        self.load = load.into();
        self
    }

    /// The stiffness `c >= 0` of an elastic foundation at height zero, which pulls with `-c u`: force per volume.
    pub fn foundation(mut self, stiffness: impl Into<Field>) -> Self {
        self.foundation = stiffness.into();
        self
    }

    /// The height on the boundary, but for the curves that have their own data.
    pub fn height(mut self, height: impl Into<Field>) -> Self {
        self.elsewhere = Support::Fixed(height.into());
        self
    }

    /// No support on the boundary, but for the curves that have their own data.
    pub fn free(self) -> Self {
        self.traction(0.0)
    }

    /// No support on the boundary, but a line load (force per length, positive upwards), except on the curves that have their own data.
    pub fn traction(mut self, traction: impl Into<Function>) -> Self {
        self.elsewhere = Support::Free { traction: traction.into() };
        self
    }

    /// It may be held by its neighbours alone: by a membrane or an obstacle that its loads press it against. Without this, a membrane
    /// that neither a height nor a foundation holds is refused.
    pub fn pressed(mut self) -> Self {
        self.pressed = true;
        self
    }

    /// The height on a named curve.
    pub fn height_on(self, curve: impl Into<String>, height: impl Into<Field>) -> Self {
        self.support_on(curve, Support::Fixed(height.into()))
    }

    /// No support on a named curve: also a line of symmetry.
    pub fn free_on(self, curve: impl Into<String>) -> Self {
        self.traction_on(curve, 0.0)
    }

    /// No support on a named curve, but a line load (force per length, positive upwards).
    pub fn traction_on(self, curve: impl Into<String>, traction: impl Into<Function>) -> Self {
        self.support_on(curve, Support::Free { traction: traction.into() })
    }

    /// What was said before of that curve is forgotten.
    fn support_on(mut self, curve: impl Into<String>, support: Support) -> Self {
        let curve = curve.into();
        self.parts.retain(|(name, _)| *name != curve);
        self.parts.push((curve, support));
        self
    }

    /// Whether its neighbours alone may hold it.
    pub fn is_pressed(&self) -> bool {
        self.pressed
    }

    /// The names of the curves that it asks for.
    pub fn curves(&self) -> impl Iterator<Item = &str> {
        self.parts.iter().map(|(name, _)| name.as_str())
    }

    /// The names of the regions that it asks for.
    pub fn regions(&self) -> impl Iterator<Item = &str> {
        [&self.tension, &self.load, &self.foundation].into_iter().flat_map(Field::names)
    }
    /// The names of the data views of the mesh that it asks for.
    pub fn views(&self) -> impl Iterator<Item = &str> {
        let supports = self.parts.iter().map(|(_, support)| support).chain([&self.elsewhere]);
        let heights = supports.filter_map(|support| match support {
            Support::Fixed(height) => Some(height),
            Support::Free { .. } => None,
        });
        [&self.tension, &self.load, &self.foundation].into_iter().chain(heights).flat_map(Field::views)
    }
}
