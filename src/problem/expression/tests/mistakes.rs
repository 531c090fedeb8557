//! Every error, its message and the remedy that it names; sources made to do harm.

use super::super::{ExpressionError, MAX_BYTES};
use super::{parsed, refused};

/// A wrong source, its message, and the source with the remedy taken.
#[test]
fn every_mistake_has_its_message_and_its_remedy() {
    let cases = [
        ("", "the expression is empty; write a formula in x and y, such as `1 + x*y`", "1 + x*y"),
        (" \n", "the expression is empty; write a formula in x and y, such as `1 + x*y`", "1 + x*y"),
        ("2 # x", "unexpected character '#' at column 3; remove it", "2"),
        ("x + \u{e9}", "unexpected character '\u{e9}' at column 5; remove it", "x"),
        ("x\u{1f642}", "unexpected character '\u{1f642}' at column 2; remove it", "x"),
        ("x\u{7}", "unexpected character '\\u{7}' at column 2; remove it", "x"),
        ("\u{2003}\u{2003}@", "unexpected character '@' at column 3; remove it", "1"),
        ("x ** 2", "`**` at column 3 has no meaning here; write `^`", "x ^ 2"),
        ("x = 2", "`=` at column 3 has no meaning here; write `==`", "x == 2"),
        ("x & y", "`&` at column 3 has no meaning here; write `&&`", "x && y"),
        ("2\u{b7}x", "`\u{b7}` at column 2 has no meaning here; write `*`", "2*x"),
        ("[x]", "`[` at column 1 has no meaning here; write `(`", "(x)"),
        ("2*1e", "malformed number `1e` at column 3; write it like `2`, `0.5` or `1e-3`", "2*1e0"),
        ("1e+x", "malformed number `1e` at column 1; write it like `2`, `0.5` or `1e-3`", "1e+2"),
        ("1.2.3", "malformed number `1.2.3` at column 1; write it like `2`, `0.5` or `1e-3`", "1.23"),
        (".", "malformed number `.` at column 1; write it like `2`, `0.5` or `1e-3`", "0.5"),
        (
            "x+1e999",
            "the number `1e999` at column 3 is out of range; the largest is about 1.79e308",
            "x+1e308",
        ),
        ("2*sni(x)", "unknown name `sni` at column 3; did you mean `sin`?", "2*sin(x)"),
        ("PI", "unknown name `PI` at column 1; did you mean `pi`?", "pi"),
        ("arctan(x)", "unknown name `arctan` at column 1; did you mean `atan`?", "atan(x)"),
        ("log(x)", "unknown name `log` at column 1; the natural logarithm is `ln`", "ln(x)"),
        ("pow(x, 2)", "unknown name `pow` at column 1; write `a^b`", "x^2"),
        (
            "|x|",
            "`|` at column 1 has no meaning here; write `abs(...)` for an absolute value, `||` for or",
            "abs(x)",
        ),
        (
            "x > 0 | y > 0",
            "`|` at column 7 has no meaning here; write `abs(...)` for an absolute value, `||` for or",
            "x > 0 || y > 0",
        ),
        (
            "sgn(x)",
            "unknown name `sgn` at column 1; write `if(a > 0, 1, if(a < 0, -1, 0))`",
            "if(x > 0, 1, if(x < 0, -1, 0))",
        ),
        ("step(x)", "unknown name `step` at column 1; write `if(a < 0, 0, 1)`", "if(x < 0, 0, 1)"),
        ("fabs(x)", "unknown name `fabs` at column 1; write `abs(a)`", "abs(x)"),
        ("sqr(x)", "unknown name `sqr` at column 1; write `a^2`", "x^2"),
        ("z", "unknown name `z` at column 1; the variables are `x` and `y`", "y"),
        ("bus", "unknown name `bus` at column 1; the variables are `x` and `y`", "y"),
        ("2x", "an operator is missing between `2` and `x` at column 2; for a product write `2*x`", "2*x"),
        (
            "2exp(x)",
            "an operator is missing between `2` and `exp` at column 2; for a product write `2*exp`",
            "2*exp(x)",
        ),
        (
            "(x)(y)",
            "an operator is missing between `)` and `(` at column 4; for a product write `)*(`",
            "(x)*(y)",
        ),
        (
            "x(y)",
            "an operator is missing between `x` and `(` at column 2; for a product write `x*(`",
            "x*(y)",
        ),
        ("1 2", "an operator is missing between `1` and `2` at column 3; for a product write `1*2`", "1*2"),
        (
            "1 +",
            "a value is missing before the end at column 4; put a number, `x`, `y` or a call there",
            "1 +x",
        ),
        (
            "1 * / 2",
            "a value is missing before `/` at column 5; put a number, `x`, `y` or a call there",
            "1 * x/ 2",
        ),
        ("()", "a value is missing before `)` at column 2; put a number, `x`, `y` or a call there", "(x)"),
        (
            "max(1,)",
            "a value is missing before `)` at column 7; put a number, `x`, `y` or a call there",
            "max(1,x)",
        ),
        (
            "and x",
            "a value is missing before `and` at column 1; put a number, `x`, `y` or a call there",
            "y and x",
        ),
        (
            "0 < x < 1",
            "the comparison at column 7 follows another one; join two with `and`, as in `0 < x and x < 1`",
            "0 < x and x < 1",
        ),
        (
            "x == not y",
            "`not` at column 6 is not at the start of a condition; write `(not ...)` or `and not ...`",
            "x == (not y)",
        ),
        (
            "x !y",
            "`!` at column 3 is not at the start of a condition; write `(not ...)` or `and not ...`",
            "x and !y",
        ),
        (
            "1 if x < 0 else 2",
            "`if` at column 3 stands between values; write `if(condition, a, b)`",
            "if(x < 0, 1, 2)",
        ),
        ("if x < 0", "the function `if` at column 1 has no arguments; write `if(...)`", "if(x < 0, 1, 2)"),
        ("sin x", "the function `sin` at column 1 has no arguments; write `sin(...)`", "sin(x)"),
        ("2*sin()", "`sin` at column 3 has 0 argument(s); give it 1", "2*sin(x)"),
        ("sin(x, y)", "`sin` at column 1 has 2 argument(s); give it 1", "sin(x)"),
        ("atan2(x)", "`atan2` at column 1 has 1 argument(s); give it 2", "atan2(x, y)"),
        ("if(x, 1)", "`if` at column 1 has 2 argument(s); give it 3", "if(x, 1, 2)"),
        ("max(x)", "`max` at column 1 has 1 argument(s); give it 2 or more", "max(x, y)"),
        ("1,5*x", "the comma at column 2 separates no arguments; write a decimal point as `.`", "1.5*x"),
        (
            "max(1, (2, 3))",
            "the comma at column 10 separates no arguments; write a decimal point as `.`",
            "max(1, 2.3)",
        ),
        ("2*((x + 1)", "the parenthesis `(` at column 3 is not closed; add `)`", "2*((x + 1))"),
        ("sin(x", "the parenthesis `(` at column 4 is not closed; add `)`", "sin(x)"),
        ("x + 1)", "the parenthesis `)` at column 6 closes nothing; remove it or add `(` before it", "x + 1"),
        (")", "the parenthesis `)` at column 1 closes nothing; remove it or add `(` before it", "(1)"),
    ];
    for (wrong, message, right) in cases {
        assert_eq!(refused(wrong).to_string(), message, "{wrong}");
        parsed(right);
    }
}

#[test]
fn hostile_sources_end_in_a_short_line() {
    let pieces = [
        "(", ")", "-", "+", "2^", "!", "not ", "sin(", "if(1,", "max(1,", "x+(", "-x^", "if(", "1+",
        "0<x and ", "1,", "x", "x ", ".", "9", "1e", "1.", "=", "\u{e9}", " ", "x<", "(x)", "a",
    ];
    for piece in pieces {
        for count in [100_000, MAX_BYTES / piece.len()] {
            let message = refused(&piece.repeat(count)).to_string();
            assert!(message.len() < 200 && !message.contains('\n'), "{piece}: {message}");
        }
    }
    let bytes = MAX_BYTES + 1;
    assert_eq!(refused(&"1".repeat(bytes)), ExpressionError::TooLong { bytes });
}
