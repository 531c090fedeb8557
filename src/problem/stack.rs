//! Any number of membranes between obstacles.

use std::collections::HashSet;

use super::pair::Pair;
use super::{Field, Function, Membrane, ProblemError, Support};

/// Membranes from the top, and the obstacles above and below them. Valid once built, then immutable.
///
/// ```
/// use membrane_contact::problem::{ContactProblem, Membrane};
///
/// // The paper's pair.
/// let pair = ContactProblem::pair([1.0, 3.0], [-15.0, 10.0], 0.1)?;
/// assert_eq!(pair.as_pair().map(|pair| pair.tension()), Some([1.0, 3.0]));
/// // A membrane over a floor.
/// let sheet = Membrane::new(1.0).load(-10.0);
/// let obstacle = ContactProblem::obstacle(sheet.clone(), -0.3)?;
/// // Three membranes over it.
/// let stack = ContactProblem::stack()
///     .membrane(sheet.clone().height(0.2))
///     .membrane(sheet.clone().height(0.1))
///     .membrane(sheet)
///     .floor(-0.3)
///     .build()?;
/// assert_eq!([&pair, &obstacle, &stack].map(|problem| problem.membranes().len()), [2, 1, 3]);
/// # Ok::<(), membrane_contact::problem::ProblemError>(())
/// ```
#[derive(Debug, Clone)]
pub struct ContactProblem {
    membranes: Vec<Membrane>,
    ceiling: Option<Field>,
    floor: Option<Field>,
    /// The same as the paper's pair, where it is one.
    pair: Option<Pair>,
}

impl ContactProblem {
    /// One membrane over a floor: the classical obstacle problem.
    ///
    /// # Errors
    /// As [`StackBuilder::build`].
    pub fn obstacle(membrane: Membrane, floor: impl Into<Field>) -> Result<Self, ProblemError> {
        Self::stack().membrane(membrane).floor(floor).build()
    }

    /// Any number of membranes, added from the top.
    pub fn stack() -> StackBuilder {
        StackBuilder::default()
    }

    /// The membranes from the top.
    pub fn membranes(&self) -> &[Membrane] {
        &self.membranes
    }

    /// What no membrane is above.
    pub fn ceiling(&self) -> Option<&Field> {
        self.ceiling.as_ref()
    }

    /// What no membrane is below.
    pub fn floor(&self) -> Option<&Field> {
        self.floor.as_ref()
    }

    /// The data of the paper's pair, where it is one: two membranes without obstacles and foundations, of constant tensions,
    /// under loads that are one function each, fixed all around at `g >= 0` and at 0.
    pub fn as_pair(&self) -> Option<&Pair> {
        self.pair.as_ref()
    }

    /// The names of the regions that its data ask for, each once.
    pub fn regions(&self) -> Vec<&str> {
        let obstacles = [&self.ceiling, &self.floor].into_iter().flatten().flat_map(Field::names);
        each_once(self.membranes.iter().flat_map(Membrane::regions).chain(obstacles))
    }

    /// The names of the data views of the mesh that its data ask for, each once.
    pub fn views(&self) -> Vec<&str> {
        let obstacles = [&self.ceiling, &self.floor].into_iter().flatten().flat_map(Field::views);
        each_once(self.membranes.iter().flat_map(Membrane::views).chain(obstacles))
    }

    /// The names of the curves that its data ask for, each once.
    pub fn curves(&self) -> Vec<&str> {
        each_once(self.membranes.iter().flat_map(Membrane::curves))
    }
}

/// In the order in which they come first.
fn each_once<'n>(names: impl Iterator<Item = &'n str>) -> Vec<&'n str> {
    let mut seen = HashSet::new();
    names.filter(|name| seen.insert(*name)).collect()
}

/// Collects membranes from the top, and obstacles.
#[derive(Debug, Clone, Default)]
pub struct StackBuilder {
    membranes: Vec<Membrane>,
    ceiling: Option<Field>,
    floor: Option<Field>,
}

impl StackBuilder {
    /// A further membrane, below those that there are.
    pub fn membrane(mut self, membrane: Membrane) -> Self {
        self.membranes.push(membrane);
        self
    }

    /// What no membrane is above.
    pub fn ceiling(mut self, height: impl Into<Field>) -> Self {
        self.ceiling = Some(height.into());
        self
    }

    /// What no membrane is below.
    pub fn floor(mut self, height: impl Into<Field>) -> Self {
        self.floor = Some(height.into());
        self
    }

    /// Checks what can be checked without a mesh.
    ///
    /// # Errors
    /// No membrane; a tension that is not positive, a foundation that is negative, any number that is not finite. What is
    /// known on a mesh only (functions, regions, curves, the order of heights and obstacles) is checked by
    /// [`PairDiscretization::new`](crate::discretization::PairDiscretization::new).
    pub fn build(self) -> Result<ContactProblem, ProblemError> {
        let Self { membranes, ceiling, floor } = self;
        if membranes.is_empty() {
            return Err(ProblemError::NoMembrane);
        }
        for (k, membrane) in membranes.iter().enumerate() {
            check(k + 1, membrane)?;
        }
        for (name, obstacle) in [("the ceiling", &ceiling), ("the floor", &floor)] {
            if let Some(value) = obstacle.iter().flat_map(|field| field.numbers()).find(|v| !v.is_finite()) {
                return Err(ProblemError::NotFinite { membrane: None, datum: name.into(), value });
            }
        }
        let pair = match membranes.as_slice() {
            [upper, lower] if ceiling.is_none() && floor.is_none() => Pair::of([upper, lower]),
            _ => None,
        };
        Ok(ContactProblem { membranes, ceiling, floor, pair })
    }
}

/// The numbers of membrane `i`.
fn check(i: usize, membrane: &Membrane) -> Result<(), ProblemError> {
    let outside = |field: &Field, is_allowed: fn(f64) -> bool| {
        field.numbers().into_iter().find(|&value| !(value.is_finite() && is_allowed(value)))
    };
    if let Some(value) = outside(&membrane.tension, |mu| mu > 0.0) {
        return Err(ProblemError::Tension { membrane: i, value });
    }
    if let Some(value) = outside(&membrane.load, |_| true) {
        return Err(ProblemError::Load { membrane: i, value });
    }
    if let Some(value) = outside(&membrane.foundation, |c| c >= 0.0) {
        return Err(ProblemError::Foundation { membrane: i, value });
    }
    for support in membrane.parts.iter().map(|(_, support)| support).chain([&membrane.elsewhere]) {
        let (datum, value) = match support {
            Support::Fixed(height) => ("height g", outside(height, |_| true)),
            Support::Free { traction: Function::Constant(value) } if !value.is_finite() => {
                ("line load t", Some(*value))
            }
            Support::Free { .. } => continue,
        };
        if let Some(value) = value {
            return Err(ProblemError::NotFinite { membrane: Some(i), datum: format!("{datum}{i}"), value });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(membrane: Membrane) -> String {
        let valid = Membrane::new(1.0);
        ContactProblem::stack().membrane(valid).membrane(membrane).build().unwrap_err().to_string()
    }

    #[test]
    fn each_invalid_number_is_named_with_its_membrane() {
        let valid = || Membrane::new(1.0);
        let refused = [
            (Membrane::new(Field::by_region([("a", 1.0), ("b", 0.0)])), "tension mu2 is 0"),
            (valid().load(Field::PerVertex([1.0, f64::NAN].into())), "load f2 is NaN"),
            (valid().foundation(-1.0), "foundation c2 is -1"),
            (valid().height(f64::INFINITY), "height g2 is inf"),
            (valid().height_on("rim", f64::NAN), "height g2 is NaN"),
            (valid().traction_on("rim", f64::NAN), "line load t2 is NaN"),
        ];
        for (membrane, words) in refused {
            let message = refusal(membrane);
            assert!(message.starts_with(words), "{message}");
        }
        let floor = ContactProblem::obstacle(valid(), f64::NAN).unwrap_err();
        assert_eq!(floor.to_string(), "the floor is NaN: give a finite number");
        assert_eq!(ContactProblem::stack().build().unwrap_err(), ProblemError::NoMembrane);
    }

    #[test]
    fn names_are_those_of_all_data() {
        let steel = Field::by_region([("steel", 2.0)]).elsewhere(1.0);
        let problem = ContactProblem::stack()
            .membrane(Membrane::new(steel.clone()).free_on("rim"))
            .membrane(
                Membrane::new(1.0).load(Field::by_region([("patch", -1.0)]).elsewhere(0.0)).free_on("rim"),
            )
            .floor(steel)
            .build()
            .unwrap();
        assert_eq!((problem.regions(), problem.curves()), (vec!["steel", "patch"], vec!["rim"]));
        assert!(problem.views().is_empty());
    }

    #[test]
    fn views_are_those_of_all_data() {
        let view = Field::view;
        let upper =
            Membrane::new(view("t")).load(Field::by_region([("patch", view("f"))]).elsewhere(view("t")));
        let lower = Membrane::new(1.0).foundation(view("c")).height_on("rim", view("g")).height(view("h"));
        let stack =
            ContactProblem::stack().membrane(upper).membrane(lower).ceiling(view("top")).floor(view("f"));
        assert_eq!(stack.build().unwrap().views(), ["t", "f", "c", "g", "h", "top"]);
    }
}
