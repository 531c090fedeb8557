//! Scalar data of the problem: a load `f_i` or the boundary height `g`.

use std::fmt;
use std::sync::Arc;

use super::Expression;
use crate::geometry::Interface;

/// A real function of a point `(x, y)` of the plane: a load (force per area) or a height (length).
///
/// It is made from a number, from an [`Expression`], or from a closure with [`Function::from_fn`].
#[derive(Clone)]
pub enum Function {
    /// The same value everywhere.
    Constant(f64),
    /// A formula in `x` and `y`, parsed once.
    Expression(Expression),
    /// Any Rust function.
    Closure {
        /// The function.
        f: Arc<dyn Fn(f64, f64) -> f64 + Send + Sync>,
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
        Self::Closure { f: Arc::new(f), jumps: jumps.into_iter().collect() }
    }

    /// The curves across which it jumps, as far as it says.
    pub fn jumps(&self) -> &[Interface] {
        match self {
            Self::Closure { jumps, .. } => jumps,
            Self::Constant(_) | Self::Expression(_) => &[],
        }
    }

    /// The value at the point `(x, y)`.
    pub fn eval(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Expression(expression) => expression.eval(x, y),
            Self::Closure { f, .. } => f(x, y),
        }
    }

    /// The values at the points `(x[k], y[k])`, written to `values[k]`: faster than point by point.
    ///
    /// # Panics
    /// When the three slices differ in length.
    pub fn eval_many(&self, x: &[f64], y: &[f64], values: &mut [f64]) {
        assert!(x.len() == values.len() && y.len() == values.len(), "slices of different lengths");
        match self {
            Self::Constant(value) => values.fill(*value),
            Self::Expression(expression) => expression.eval_many(x, y, values),
            Self::Closure { f, .. } => {
                for ((value, &x), &y) in values.iter_mut().zip(x).zip(y) {
                    *value = f(x, y);
                }
            }
        }
    }
}

impl From<f64> for Function {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

impl From<Expression> for Function {
    fn from(expression: Expression) -> Self {
        Self::Expression(expression)
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
