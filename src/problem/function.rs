//! Scalar data of the problem: a load `f_i` or the boundary height `g`.

use std::error::Error;
use std::fmt;
use std::sync::Arc;

use thiserror::Error;

use super::Expression;
use crate::geometry::Interface;
use crate::text::Number;

/// Writes the values at the points `(x[k], y[k])` to `values[k]`, or says why it cannot.
type Evaluate = dyn Fn(&[f64], &[f64], &mut [f64]) -> Result<(), EvaluationError> + Send + Sync;

/// A real function of a point `(x, y)` of the plane: a load (force per area) or a height (length).
///
/// It is made from a number, from an [`Expression`], or from a closure with [`Function::from_fn`].
#[derive(Clone)]
#[non_exhaustive]
pub enum Function {
    /// The same value everywhere.
    Constant(f64),
    /// A formula in `x` and `y`, parsed once.
    Expression(Expression),
    /// Any Rust function, of many points at a time.
    Closure {
        /// The function: the coordinates `x`, `y` of the points, and where their values go.
        f: Arc<Evaluate>,
        /// The curves across which it jumps: integrals are cut along them.
        jumps: Arc<[Interface]>,
    },
}

impl Function {
    /// Wraps a closure `(x, y) -> value`.
    pub fn from_fn(f: impl Fn(f64, f64) -> f64 + Send + Sync + 'static) -> Self {
        Self::piecewise(f, [])
    }

    /// Wraps a closure that jumps across some curves: integrals follow them. Without that, the quadrature moves a jump by
    /// up to a tenth of the mesh size.
    pub fn piecewise(
        f: impl Fn(f64, f64) -> f64 + Send + Sync + 'static,
        jumps: impl IntoIterator<Item = Interface>,
    ) -> Self {
        let at_each = move |x: &[f64], y: &[f64], values: &mut [f64]| {
            for ((value, &x), &y) in values.iter_mut().zip(x).zip(y) {
                *value = f(x, y);
            }
            Ok(())
        };
        Self::Closure { f: Arc::new(at_each), jumps: jumps.into_iter().collect() }
    }

    /// Wraps a closure that may fail, such as a call into another language: `f(x, y, values)` writes the values at the
    /// points `(x[k], y[k])` to `values[k]`. It is called for some thousand points at a time, from several threads.
    ///
    /// ```
    /// use membrane_contact::problem::Function;
    ///
    /// let table = Function::try_from_fn(|x, _, values| {
    ///     if x.iter().any(|&x| x > 1.0) {
    ///         return Err("the table ends at x = 1");
    ///     }
    ///     values.copy_from_slice(x);
    ///     Ok(())
    /// });
    /// assert_eq!(table.eval(0.5, 0.0)?, 0.5);
    /// assert_eq!(table.eval(2.0, 0.0).unwrap_err().to_string(), "cannot be evaluated: the table ends at x = 1");
    /// # Ok::<(), membrane_contact::problem::EvaluationError>(())
    /// ```
    pub fn try_from_fn<E: Into<Box<dyn Error + Send + Sync>>>(
        f: impl Fn(&[f64], &[f64], &mut [f64]) -> Result<(), E> + Send + Sync + 'static,
    ) -> Self {
        let f = move |x: &[f64], y: &[f64], values: &mut [f64]| {
            f(x, y, values).map_err(|error| EvaluationError::Failed(Arc::from(error.into())))
        };
        Self::Closure { f: Arc::new(f), jumps: Arc::new([]) }
    }

    /// The curves across which it jumps, as far as it says.
    pub fn jumps(&self) -> &[Interface] {
        match self {
            Self::Closure { jumps, .. } => jumps,
            Self::Constant(_) | Self::Expression(_) => &[],
        }
    }

    /// The value at the point `(x, y)`.
    ///
    /// # Errors
    /// As [`Function::eval_many`].
    pub fn eval(&self, x: f64, y: f64) -> Result<f64, EvaluationError> {
        let mut value = [0.0];
        self.eval_many(&[x], &[y], &mut value)?;
        Ok(value[0])
    }

    /// The values at the points `(x[k], y[k])`, written to `values[k]`: faster than point by point.
    ///
    /// # Errors
    /// [`EvaluationError`] when the function fails, or a value is NaN or infinite: the first such point is named.
    ///
    /// # Panics
    /// When the three slices differ in length.
    pub fn eval_many(&self, x: &[f64], y: &[f64], values: &mut [f64]) -> Result<(), EvaluationError> {
        assert!(x.len() == values.len() && y.len() == values.len(), "slices of different lengths");
        match self {
            Self::Constant(value) => values.fill(*value),
            Self::Expression(expression) => expression.eval_many(x, y, values),
            Self::Closure { f, .. } => f(x, y, values)?,
        }
        match values.iter().position(|value| !value.is_finite()) {
            Some(k) => Err(EvaluationError::NotFinite { point: [x[k], y[k]], value: values[k] }),
            None => Ok(()),
        }
    }
}

/// A function has no value at a point where it is needed.
#[derive(Debug, Clone, Error)]
#[non_exhaustive]
pub enum EvaluationError {
    /// The value is no number to compute with.
    #[error("is {} at the point ({}, {})", Number(*value), Number(point[0]), Number(point[1]))]
    NotFinite {
        /// Where.
        point: [f64; 2],
        /// NaN or an infinity.
        value: f64,
    },
    /// The function failed, for a reason of its own.
    #[error("cannot be evaluated: {0}")]
    Failed(#[source] Arc<dyn Error + Send + Sync>),
}

/// Two errors are equal when they say the same.
impl PartialEq for EvaluationError {
    fn eq(&self, other: &Self) -> bool {
        self.to_string() == other.to_string()
    }
}

impl From<f64> for Function {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

impl From<Expression> for Function {
    /// A formula without `x` and `y` is a constant.
    fn from(expression: Expression) -> Self {
        expression.constant().map_or(Self::Expression(expression), Self::Constant)
    }
}

impl fmt::Debug for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(value) => write!(f, "{value}"),
            Self::Expression(expression) => write!(f, "{expression}"),
            Self::Closure { .. } => f.write_str("<closure>"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A function of each kind with the value `1 / x`.
    fn reciprocals() -> [Function; 3] {
        let many = |x: &[f64], _: &[f64], values: &mut [f64]| -> Result<(), EvaluationError> {
            values.iter_mut().zip(x).for_each(|(value, x)| *value = 1.0 / x);
            Ok(())
        };
        let formula: Expression = "1/x".parse().unwrap();
        [formula.into(), Function::from_fn(|x, _| 1.0 / x), Function::try_from_fn(many)]
    }

    #[test]
    fn every_kind_gives_values_and_names_the_first_that_is_not_finite() {
        for f in reciprocals() {
            let mut values = [0.0; 3];
            assert_eq!(f.eval_many(&[1.0, 2.0, 4.0], &[0.0; 3], &mut values), Ok(()));
            assert_eq!((values, f.eval(8.0, 0.0).unwrap()), ([1.0, 0.5, 0.25], 0.125));
            let error = f.eval_many(&[1.0, 0.0, -0.0], &[3.0, 4.0, 5.0], &mut values).unwrap_err();
            assert_eq!(error.to_string(), "is inf at the point (0, 4)", "{f:?}");
            assert!(f.eval(0.0, 0.0).is_err());
        }
        assert!(Function::Constant(f64::NAN).eval(0.0, 0.0).is_err());
    }

    #[test]
    fn a_formula_without_coordinates_is_a_constant() {
        let of = |text: &str| Function::from(text.parse::<Expression>().unwrap());
        assert!(matches!(of("-3*(2 + 1)"), Function::Constant(-9.0)));
        assert!(matches!(of("-3*(2 + x)"), Function::Expression(_)));
    }

    #[test]
    fn the_reason_of_a_failure_is_kept() {
        #[derive(Debug, Error, PartialEq)]
        #[error("exception {0}")]
        struct Exception(u8);
        let f = Function::try_from_fn(|_, _, _| Err(Exception(7)));
        let EvaluationError::Failed(reason) = f.eval(0.0, 0.0).unwrap_err() else { panic!("it failed") };
        assert_eq!(reason.downcast_ref::<Exception>(), Some(&Exception(7)));
    }
}
