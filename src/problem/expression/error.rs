//! Why a source is no expression.

use thiserror::Error;

use super::program::MAX_DEPTH;
use crate::text::grouped;

/// Longest source in bytes: far above any formula, low enough that reading one never takes noticeable time.
pub(super) const MAX_BYTES: usize = 1 << 16;

/// Why a source is no [`Expression`](super::Expression). Columns count the characters of the source from 1.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ExpressionError {
    /// Nothing but white space.
    #[error("the expression is empty; write a formula in x and y, such as `1 + x*y`")]
    Empty,
    /// More bytes than a source may have.
    #[error("the expression has {} bytes, the limit is {}; shorten it", grouped(*bytes), grouped(MAX_BYTES))]
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
    /// A single bar, of an absolute value or half of an `or`.
    #[error(
        "`|` at column {column} has no meaning here; write `abs(...)` for an absolute value, `||` for or"
    )]
    Bar {
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
