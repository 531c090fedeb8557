//! Formulas in `x` and `y`, as they stand in a case file: parsed once, evaluated at many points.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

mod lexer;
mod parser;
mod program;
#[cfg(test)]
mod tests;

use program::{MAX_DEPTH, Program};

/// Longest source in bytes: far above any formula, low enough that reading one never takes noticeable time.
const MAX_BYTES: usize = 1 << 16;

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

/// Why a source is no [`Expression`]. Columns count the characters of the source from 1.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ExpressionError {
    /// Nothing but white space.
    #[error("the expression is empty; write a formula in x and y, such as `1 + x*y`")]
    Empty,
    /// More bytes than a source may have.
    #[error("the expression has {bytes} bytes, the limit is {MAX_BYTES}; shorten it")]
    TooLong {
        /// Length of the source in bytes.
        bytes: usize,
    },
    /// More intermediate values than the evaluation may hold.
    #[error("nested too deeply at column {column}: over {MAX_DEPTH} intermediate values; simplify it")]
    TooDeep {
        /// Where the limit was passed.
        column: usize,
    },
    /// A character without a meaning.
    #[error("unexpected character {character:?} at column {column}; remove it")]
    UnknownCharacter {
        /// The character.
        character: char,
        /// Where it stands.
        column: usize,
    },
    /// Another language's symbol.
    #[error("`{symbol}` at column {column} has no meaning here; write `{instead}`")]
    ForeignSymbol {
        /// What was found.
        symbol: &'static str,
        /// What means the same here.
        instead: &'static str,
        /// Where it stands.
        column: usize,
    },
    /// Two decimal points, or an exponent without digits.
    #[error("malformed number `{text}` at column {column}; write it like `2`, `0.5` or `1e-3`")]
    MalformedNumber {
        /// The number as written.
        text: String,
        /// Where it begins.
        column: usize,
    },
    /// A number beyond the largest `f64`.
    #[error("the number `{text}` at column {column} is out of range; the largest is about 1.79e308")]
    NumberOutOfRange {
        /// The number as written.
        text: String,
        /// Where it begins.
        column: usize,
    },
    /// A name that is no variable, constant, function or word operator.
    #[error("unknown name `{name}` at column {column}; {remedy}")]
    UnknownName {
        /// The name.
        name: String,
        /// Where it begins.
        column: usize,
        /// What may have been meant.
        remedy: String,
    },
    /// Two values side by side.
    #[error(
        "an operator is missing between `{left}` and `{right}` at column {column}; \
         for a product write `{left}*{right}`"
    )]
    MissingOperator {
        /// What stands on the left.
        left: String,
        /// What stands on the right.
        right: String,
        /// Where the right one begins.
        column: usize,
    },
    /// No value where one has to stand.
    #[error("a value is missing before {next} at column {column}; put a number, `x`, `y` or a call there")]
    MissingValue {
        /// What stands there instead.
        next: String,
        /// Where it stands.
        column: usize,
    },
    /// `a < b < c`.
    #[error(
        "the comparison at column {column} follows another one; \
         join two with `and`, as in `0 < x and x < 1`"
    )]
    ChainedComparison {
        /// Where the second comparison sign stands.
        column: usize,
    },
    /// `not` or `!` after a value, or as an operand of something that binds tighter.
    #[error(
        "`{text}` at column {column} is not at the start of a condition; write `(not ...)` or `and not ...`"
    )]
    MisplacedNot {
        /// `not` or `!`.
        text: String,
        /// Where it stands.
        column: usize,
    },
    /// `a if c else b`.
    #[error("`{word}` at column {column} stands between values; write `if(condition, a, b)`")]
    InfixConditional {
        /// `if` or `else`.
        word: String,
        /// Where it stands.
        column: usize,
    },
    /// A function's name without parentheses after it.
    #[error("the function `{name}` at column {column} has no arguments; write `{name}(...)`")]
    MissingArguments {
        /// The function.
        name: &'static str,
        /// Where its name begins.
        column: usize,
    },
    /// A call with too few or too many arguments.
    #[error("`{name}` at column {column} has {found} argument(s); give it {expected}")]
    ArgumentCount {
        /// The function.
        name: &'static str,
        /// Where its name begins.
        column: usize,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: &'static str,
    },
    /// A comma outside of a function's arguments.
    #[error("the comma at column {column} separates no arguments; write a decimal point as `.`")]
    StrayComma {
        /// Where it stands.
        column: usize,
    },
    /// `(` without `)`.
    #[error("the parenthesis `(` at column {column} is not closed; add `)`")]
    Unclosed {
        /// Where it stands.
        column: usize,
    },
    /// `)` without `(`.
    #[error("the parenthesis `)` at column {column} closes nothing; remove it or add `(` before it")]
    Unopened {
        /// Where it stands.
        column: usize,
    },
}
