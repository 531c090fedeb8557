//! Formulas in `x` and `y`, as they stand in a case file: parsed once, evaluated at many points.

use std::fmt;
use std::str::FromStr;

mod elementary;
mod error;
mod lexer;
mod parser;
mod program;
#[cfg(test)]
mod tests;

pub use error::ExpressionError;

use error::MAX_BYTES;
use program::Program;

/// A formula in the coordinates `x` and `y`.
///
/// | tightest first | |
/// |---|---|
/// | values | numbers (`2`, `.5`, `1.`, `1e-3`), `x`, `y`, `pi`, calls, parentheses |
/// | `a^b` | to the right: `2^3^2` is `2^(3^2)`; `2^-3` is allowed |
/// | `-a`, `+a` | `-x^2` is `-(x^2)` |
/// | `a*b`, `a/b` | to the left |
/// | `a + b`, `a - b` | to the left |
/// | `a < b`, `<=`, `>`, `>=`, `==`, `!=` | 1 where it holds, else 0; not chained |
/// | `not a`, `!a` | `!x < 1` is `not (x < 1)` |
/// | `a and b`, `a && b` | |
/// | <code>a or b</code>, <code>a &#124;&#124; b</code> | |
///
/// Functions: `sin cos tan asin acos atan sinh cosh tanh exp ln sqrt abs` of one argument, `atan2(y, x)`,
/// `min` and `max` of two or more, and `if(condition, a, b)`, where a condition holds when it is not 0.
///
/// Where a formula is undefined its value is NaN, and no NaN is lost on the way: a comparison with NaN is
/// NaN, as are `min`, `max`, `not` and an `if` on it. Only what decides the result without the NaN drops it:
/// the branch of an `if` that is not taken, `0 and NaN` (0), `1 or NaN` (1), `1^NaN` and `NaN^0` (1).
///
/// A constant exponent from 2 to 8 multiplies instead of calling the power function.
///
/// ```
/// use membrane_contact::problem::Expression;
///
/// let load: Expression = "if(x < 0.5, 10*sin(pi*x), -15)".parse()?;
/// assert_eq!(load.eval(0.75, 0.0), -15.0);
///
/// let error = Expression::parse("10*sni(pi*x)").unwrap_err();
/// assert_eq!(error.to_string(), "unknown name `sni` at column 4; did you mean `sin`?");
/// # Ok::<(), membrane_contact::problem::ExpressionError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Expression {
    source: String,
    program: Program,
}

impl Expression {
    /// Reads a formula.
    ///
    /// # Errors
    /// The first mistake in the source, with its column and a remedy.
    pub fn parse(source: &str) -> Result<Self, ExpressionError> {
        if source.len() > MAX_BYTES {
            return Err(ExpressionError::TooLong { bytes: source.len() });
        }
        if source.trim().is_empty() {
            return Err(ExpressionError::Empty);
        }
        Ok(Self { source: source.to_string(), program: parser::parse(source)? })
    }

    /// The value at the point `(x, y)`.
    pub fn eval(&self, x: f64, y: f64) -> f64 {
        self.program.eval(x, y)
    }

    /// The values at the points `(x[k], y[k])`, written to `out[k]`.
    ///
    /// Each is the value of [`Expression::eval`] to the last bit (where that is NaN: a NaN), in less time.
    ///
    /// # Panics
    /// When the three slices differ in length.
    pub fn eval_many(&self, x: &[f64], y: &[f64], out: &mut [f64]) {
        assert!(x.len() == out.len() && y.len() == out.len(), "slices of different lengths");
        self.program.eval_many(x, y, out);
    }

    /// The value of a formula in which neither `x` nor `y` is left.
    pub(super) fn constant(&self) -> Option<f64> {
        self.program.constant()
    }

    /// The text that was parsed.
    pub fn source(&self) -> &str {
        &self.source
    }
}

impl FromStr for Expression {
    type Err = ExpressionError;

    fn from_str(source: &str) -> Result<Self, ExpressionError> {
        Self::parse(source)
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.source)
    }
}

/// Two expressions are equal when their texts are.
impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.source == other.source
    }
}
