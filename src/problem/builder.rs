//! The paper's pair as a problem.

use super::pair::Pair;
use super::{ContactProblem, Function, Membrane, ProblemError};

impl ContactProblem {
    /// The paper's pair, which starts from unit tensions, no loads, and both membranes fixed at height zero.
    pub fn builder() -> ContactProblemBuilder {
        ContactProblemBuilder::default()
    }

    /// The paper's pair: tensions `mu1`, `mu2`, loads `f1`, `f2`, and the height `g` at which membrane 1 is fixed.
    ///
    /// # Errors
    /// As [`ContactProblemBuilder::build`].
    pub fn pair<F: Into<Function>>(
        [mu1, mu2]: [f64; 2],
        [f1, f2]: [F; 2],
        g: impl Into<Function>,
    ) -> Result<Self, ProblemError> {
        Self::builder().tension(mu1, mu2).load(f1, f2).height(g).build()
    }
}

/// Collects the data of the paper's pair.
#[derive(Debug, Clone)]
pub struct ContactProblemBuilder(Pair);

impl Default for ContactProblemBuilder {
    fn default() -> Self {
        Self(Pair { tension: [1.0; 2], load: [0.0.into(), 0.0.into()], height: 0.0.into() })
    }
}

impl ContactProblemBuilder {
    /// The tensions `mu1`, `mu2` (force per length).
    pub fn tension(mut self, mu1: f64, mu2: f64) -> Self {
        self.0.tension = [mu1, mu2];
        self
    }

    /// The loads `f1`, `f2` (force per area, positive upwards).
    pub fn load(mut self, f1: impl Into<Function>, f2: impl Into<Function>) -> Self {
        self.0.load = [f1.into(), f2.into()];
        self
    }

    /// The height `g` of membrane 1 on the boundary.
    pub fn height(mut self, g: impl Into<Function>) -> Self {
        self.0.height = g.into();
        self
    }

    /// Checks what can be checked without a mesh.
    ///
    /// # Errors
    /// A tension that is not positive and finite, a constant load that is not finite, a constant height that is
    /// negative or not finite. Functions of the point are checked where they are evaluated, by
    /// [`PairDiscretization::new`](crate::discretization::PairDiscretization::new).
    pub fn build(self) -> Result<ContactProblem, ProblemError> {
        let Pair { tension: [mu1, mu2], load: [f1, f2], height } = self.0;
        if let Function::Constant(value) = height
            && !(value >= 0.0 && value.is_finite())
        {
            return Err(ProblemError::Height { value });
        }
        let upper = Membrane::new(mu1).load(f1).height(height);
        let lower = Membrane::new(mu2).load(f2);
        ContactProblem::stack().membrane(upper).membrane(lower).build()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_data_build_and_each_invalid_datum_is_named() {
        let valid = || ContactProblem::builder().tension(1.0, 3.0).load(-1.0, 2.0).height(0.5);
        assert!(valid().build().is_ok());
        for mu in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                valid().tension(1.0, mu).build(),
                Err(ProblemError::Tension { membrane: 2, .. })
            ));
        }
        for f in [f64::NAN, f64::NEG_INFINITY] {
            assert!(matches!(valid().load(f, 0.0).build(), Err(ProblemError::Load { membrane: 1, .. })));
        }
        for g in [-1e-9, f64::NAN, f64::INFINITY] {
            assert!(matches!(valid().height(g).build(), Err(ProblemError::Height { .. })));
        }
    }

    #[test]
    fn two_membranes_are_the_pair_only_with_its_data() {
        let lower = || Membrane::new(3.0).load(10.0);
        let build = |upper: Membrane, lower: Membrane| {
            ContactProblem::stack().membrane(upper).membrane(lower).build().unwrap()
        };
        let problem = build(Membrane::new(1.0).load(-15.0).height(0.1), lower());
        let pair = problem.as_pair().expect("the paper's pair");
        assert_eq!((pair.tension(), format!("{:?}", pair.height())), ([1.0, 3.0], "0.1".into()));
        let others = [
            (Membrane::new(Function::from_fn(|x, _| x)), lower()),
            (Membrane::new(1.0).foundation(1.0), lower()),
            (Membrane::new(1.0).height(1.0), lower().height(0.5)),
            (Membrane::new(1.0).free_on("left"), lower()),
            (Membrane::new(1.0), lower().free()),
        ];
        for (upper, lower) in others {
            assert!(build(upper, lower).as_pair().is_none());
        }
    }
}
