use std::f64::consts::{E, PI};
use std::hint::black_box;

use super::elementary::{cosines, exponentials, sines};
use super::program::MAX_DEPTH;
use super::{Expression, ExpressionError};

mod mistakes;
mod properties;

/// Both signs, zero, whole and broken numbers, outside and inside the domains of `ln`, `sqrt` and `asin`.
const POINTS: [[f64; 2]; 8] = [
    [0.3, 0.7],
    [0.0, 5.0],
    [-0.4, 0.9],
    [0.0, -0.0],
    [2.0, -3.0],
    [1.0, 1.0],
    [-7.25, 0.5],
    [1e200, -1e-200],
];

/// A product of eight factors is off by seven roundings at most, the power function by one.
const POWER_TOLERANCE: f64 = 8.0 * f64::EPSILON / 2.0;

type Native = fn(f64, f64) -> f64;

fn sin(x: f64) -> f64 {
    let mut x = [x];
    sines(&mut x);
    x[0]
}

fn cos(x: f64) -> f64 {
    let mut x = [x];
    cosines(&mut x);
    x[0]
}

fn exp(x: f64) -> f64 {
    let mut x = [x];
    exponentials(&mut x);
    x[0]
}

/// The same number to the last bit, or both NaN.
fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

fn parsed(source: &str) -> Expression {
    Expression::parse(source).unwrap_or_else(|error| panic!("{source}: {error}"))
}

fn refused(source: &str) -> ExpressionError {
    Expression::parse(source).expect_err(source)
}

/// Whether the source and the closure have the same value at every one of [`POINTS`].
fn agree(source: &str, native: Native) -> bool {
    let expression = parsed(source);
    POINTS.iter().all(|&[x, y]| same(expression.eval(x, y), native(black_box(x), black_box(y))))
}

#[test]
fn arithmetic_is_that_of_rust() {
    let cases: [(&str, Native); 20] = [
        ("x", |x, _| x),
        ("y", |_, y| y),
        ("pi", |_, _| PI),
        ("12.5", |_, _| 12.5),
        (".5", |_, _| 0.5),
        ("1.", |_, _| 1.0),
        ("1e-3 + 1.5E+2", |_, _| 1e-3 + 1.5e2),
        ("1.e2", |_, _| 100.0),
        ("x + y", |x, y| x + y),
        ("x - y - 1", |x, y| x - y - 1.0),
        ("x*y*3", |x, y| x * y * 3.0),
        ("x / y / 2", |x, y| x / y / 2.0),
        ("-x", |x, _| -x),
        ("+x", |x, _| x),
        ("--x", |x, _| x),
        ("x - -y", |x, y| x + y),
        ("x*-y", |x, y| x * -y),
        (" \t\n1 +\r\n x ", |x, _| 1.0 + x),
        ("((x))*(y)", |x, y| x * y),
        ("1 - 0.5*(x - 2)*(y + 2)", |x, y| 1.0 - 0.5 * (x - 2.0) * (y + 2.0)),
    ];
    for (source, native) in cases {
        assert!(agree(source, native), "{source}");
    }
    assert!(!agree("x - y - 1", |x, y| x - (y - 1.0)));
    assert!(!agree("0*x", |_, _| 0.0), "-0 is not 0");
}

#[test]
fn functions_are_those_of_rust_and_of_this_crate() {
    let cases: [(&str, Native); 20] = [
        ("sin(pi*x)", |x, _| sin(PI * x)),
        ("cos(x)", |x, _| cos(x)),
        ("tan(x)", |x, _| x.tan()),
        ("asin(x)", |x, _| x.asin()),
        ("acos(x)", |x, _| x.acos()),
        ("atan(x)", |x, _| x.atan()),
        ("atan2(y, x)", |x, y| y.atan2(x)),
        ("sinh(x)", |x, _| x.sinh()),
        ("cosh(x)", |x, _| x.cosh()),
        ("tanh(x)", |x, _| x.tanh()),
        ("exp(x)", |x, _| exp(x)),
        ("ln(x)", |x, _| x.ln()),
        ("sqrt(x)", |x, _| x.sqrt()),
        ("abs(x)", |x, _| x.abs()),
        ("min(x, y)", |x, y| if x < y { x } else { y }),
        ("max(x, y)", |x, y| if x > y { x } else { y }),
        ("min(x, y, 0.5, -2)", |x, y| x.min(y).min(0.5).min(-2.0)),
        ("max(x, y, 0.5, -2)", |x, y| x.max(y).max(0.5).max(-2.0)),
        ("sin (x)", |x, _| sin(x)),
        ("sin(x)*cos(y) + exp(-x^2)", |x, y| sin(x) * cos(y) + exp(-(x * x))),
    ];
    for (source, native) in cases {
        assert!(agree(source, native), "{source}");
    }
    assert!(!agree("atan2(y, x)", |x, y| x.atan2(y)));
    assert!(!agree("min(x, y)", |x, y| x.max(y)));
}

#[test]
fn conditions_are_one_or_zero() {
    let cases: [(&str, Native); 17] = [
        ("x < y", |x, y| f64::from(x < y)),
        ("x <= y", |x, y| f64::from(x <= y)),
        ("x > y", |x, y| f64::from(x > y)),
        ("x >= y", |x, y| f64::from(x >= y)),
        ("x == y", |x, y| f64::from(x == y)),
        ("x != y", |x, y| f64::from(x != y)),
        ("x > 0 and y > 0", |x, y| f64::from(x > 0.0 && y > 0.0)),
        ("x > 0 && y > 0", |x, y| f64::from(x > 0.0 && y > 0.0)),
        ("x > 0 or y > 0", |x, y| f64::from(x > 0.0 || y > 0.0)),
        ("x > 0 || y > 0", |x, y| f64::from(x > 0.0 || y > 0.0)),
        ("not x > 0", |x, _| f64::from(x <= 0.0)),
        ("!(x > 0)", |x, _| f64::from(x <= 0.0)),
        ("x and y", |x, y| f64::from(x != 0.0 && y != 0.0)),
        ("not x", |x, _| f64::from(x == 0.0)),
        ("if(x, 2, 3)", |x, _| if x != 0.0 { 2.0 } else { 3.0 }),
        ("if(x < 0.5, 1 + x*y, -10)", |x, y| if x < 0.5 { 1.0 + x * y } else { -10.0 }),
        ("if(x < 0, if(y < 0, 1, 2), if(y < 0, 3, 4))", |x, y| match (x < 0.0, y < 0.0) {
            (true, true) => 1.0,
            (true, false) => 2.0,
            (false, true) => 3.0,
            (false, false) => 4.0,
        }),
    ];
    for (source, native) in cases {
        assert!(agree(source, native), "{source}");
    }
    assert!(!agree("x <= y", |x, y| f64::from(x < y)));
    assert!(!agree("x and y", |x, y| f64::from(x != 0.0 || y != 0.0)));
}

/// A source, the same with its parentheses, and with the parentheses of another language.
#[test]
fn operators_bind_as_documented() {
    let cases = [
        ("-x^2", "-(x^2)", "(-x)^2"),
        ("2^3^x", "2^(3^x)", "(2^3)^x"),
        ("2^-x*y", "(2^(-x))*y", "2^(-(x*y))"),
        ("2^-x^2", "2^(-(x^2))", "(2^(-x))^2"),
        ("2*-x^2", "2*(-(x^2))", "2*((-x)^2)"),
        ("-x + y", "(-x) + y", "-(x + y)"),
        ("x/y*2", "(x/y)*2", "x/(y*2)"),
        ("x - y + 2", "(x - y) + 2", "x - (y + 2)"),
        ("x + y*2", "x + (y*2)", "(x + y)*2"),
        ("x + 1 < y", "(x + 1) < y", "x + (1 < y)"),
        ("not x < y", "not (x < y)", "(not x) < y"),
        ("!x == y", "!(x == y)", "(!x) == y"),
        ("not x < 0 and y < -1", "(not (x < 0)) and (y < -1)", "not ((x < 0) and (y < -1))"),
        ("x > 0 or y > 0 and x > 3", "(x > 0) or ((y > 0) and (x > 3))", "((x > 0) or (y > 0)) and (x > 3)"),
    ];
    let values = |source| POINTS.map(|[x, y]| parsed(source).eval(x, y).to_bits());
    for (source, right, wrong) in cases {
        assert_eq!(values(source), values(right), "{source}");
        assert_ne!(values(source), values(wrong), "{source}");
    }
    assert_eq!(parsed("2^3^2").eval(0.0, 0.0), 512.0);
    assert_eq!(parsed("2^-3").eval(0.0, 0.0), 0.125);
}

#[test]
fn whole_exponents_are_products() {
    for (exponent, x) in (0..12).flat_map(|n| [0.3, -1.7, 12.25].map(|x| (n, x))) {
        let value = parsed(&format!("x^{exponent}")).eval(x, 0.0);
        let power = x.powf(f64::from(exponent));
        assert!((value - power).abs() <= POWER_TOLERANCE * power.abs(), "{x}^{exponent}");
        assert!((value - x * power).abs() > POWER_TOLERANCE * power.abs(), "{x}^{exponent}");
    }
}

#[test]
fn a_folded_exponent_is_a_whole_exponent() {
    let values = |source| [0.3, 0.7, 1.1, 1.3, 1.7].map(|x| parsed(source).eval(x, 3.0).to_bits());
    assert_eq!(values("x^abs(-3)"), values("x*x*x"));
    assert_ne!(values("x^y"), values("x*x*x"), "the power function rounds once");
}

#[test]
fn what_is_undefined_stays_undefined() {
    let undefined = [
        "x",
        "-x",
        "x + 1",
        "x*0",
        "sin(x)",
        "x < 1",
        "1 >= x",
        "x == x",
        "x != x",
        "not x",
        "x and 1",
        "1 and x",
        "x or 0",
        "0 or x",
        "x and x",
        "min(x, 0)",
        "min(0, x)",
        "max(x, 0)",
        "max(0, x)",
        "if(x, 1, 2)",
        "if(x < 1, 1, 2)",
        "if(1, x, 2)",
        "atan2(x, 1)",
        "x^2",
        "x^0.5",
        "x^9",
        "sqrt(0 - 1)",
        "0/0",
    ];
    for source in undefined {
        assert!(parsed(source).eval(f64::NAN, 0.0).is_nan(), "{source}");
    }
    let defined = [
        ("x and 0", 0.0),
        ("0 and x", 0.0),
        ("x or 1", 1.0),
        ("1 or x", 1.0),
        ("if(1, 2, x)", 2.0),
        ("if(0, x, 2)", 2.0),
    ];
    for (source, value) in defined {
        assert_eq!(parsed(source).eval(f64::NAN, 0.0), value, "{source}");
    }
    let guarded = parsed("x > 0 and ln(x) < 0");
    assert_eq!([-1.0, 0.5, 2.0].map(|x| guarded.eval(x, 0.0)), [0.0, 1.0, 0.0]);
}

#[test]
fn long_and_deep_sources_are_evaluated() {
    let deep = |n: usize| format!("{}x{}", "(".repeat(n), ")".repeat(n));
    assert_eq!(parsed(&deep(30_000)).eval(3.0, 0.0), 3.0);
    assert_eq!(parsed(&format!("{}x", "-".repeat(60_001))).eval(3.0, 0.0), -3.0);
    assert_eq!(parsed(&format!("{}0", "x+".repeat(30_000))).eval(1.0, 0.0), 30_000.0);
    assert_eq!(parsed(&format!("{}0", "x^2+".repeat(1000))).eval(1.0, 0.0), 1000.0);
    assert_eq!(parsed(&format!("max(0{})", ",x".repeat(30_000))).eval(1.0, 0.0), 1.0);
}

#[test]
fn the_number_of_intermediate_values_is_limited() {
    let nested = |values: usize| format!("{}x{}", "(y+".repeat(values - 1), ")".repeat(values - 1));
    let deepest = parsed(&nested(MAX_DEPTH));
    assert_eq!(deepest.eval(3.0, 1.0), 202.0);
    let mut values = [0.0; 1000];
    deepest.eval_many(&[3.0; 1000], &[1.0; 1000], &mut values);
    assert_eq!(values, [202.0; 1000]);
    assert_eq!(refused(&nested(MAX_DEPTH + 1)), ExpressionError::TooDeep { column: 601 });
}

#[test]
fn blocks_have_the_values_of_points() {
    let sources = [
        "1",
        "x",
        "sin(pi*x)*sin(pi*y) + exp(-x^2)",
        "if(x < 0.5, 1 + x*y, -10)",
        "x^3 + y^7 + x^y + x^-2",
        "min(x, y, 0.5) - max(x, y)",
        "x > 0.2 and not y < 0.5 or x == y",
        "sqrt(x - 0.5) < y",
        "atan2(y, x)/tan(y)",
        "1+(2-(3+(4-(5+(6-(7+(8-(9+(10-(11+(12-(13+x*y))))))))))))",
    ];
    for length in [0, 1, 127, 128, 129, 1000] {
        let x: Vec<f64> = (0..length).map(|k| (f64::from(k) * 0.618).fract()).collect();
        let y: Vec<f64> = (0..length).map(|k| (f64::from(k) * 0.414).fract() - 0.1).collect();
        for expression in sources.map(parsed) {
            let mut values = vec![f64::INFINITY; x.len()];
            expression.eval_many(&x, &y, &mut values);
            let matches = |k: usize| same(values[k], expression.eval(x[k], y[k]));
            assert!((0..x.len()).all(matches), "{expression}, {length} points");
        }
    }
    assert!(!same(0.0, -0.0) && !same(1.0, f64::NAN) && !same(1.0, 1.0 + f64::EPSILON));
}

#[test]
#[should_panic(expected = "slices of different lengths")]
fn slices_of_different_lengths_are_a_mistake_of_the_caller() {
    parsed("x").eval_many(&[1.0, 2.0], &[1.0], &mut [0.0; 2]);
}

/// The same formula with constants and with variables that have their values.
#[test]
fn folding_has_the_value_of_evaluation() {
    let cases = [
        ("sin(0.7)/0.3 + 0.7^0.3", "sin(x)/y + x^y"),
        ("exp(-(0.7^2))*tanh(0.3)", "exp(-(x^2))*tanh(y)"),
        ("if(0.7 < 0.3, 0.7, -0.3)", "if(x < y, x, -y)"),
        ("atan2(0.3, 0.7)^5 - ln(0.3)", "atan2(y, x)^5 - ln(y)"),
        ("min(0.7, 0.3)*(0.7 or 0.3)", "min(x, y)*(x or y)"),
    ];
    for (folded, evaluated) in cases {
        let (folded, evaluated) = (parsed(folded), parsed(evaluated));
        assert_eq!(folded.eval(0.0, 0.0).to_bits(), evaluated.eval(0.7, 0.3).to_bits(), "{evaluated}");
        assert_ne!(folded.eval(0.0, 0.0).to_bits(), evaluated.eval(0.71, 0.31).to_bits(), "{evaluated}");
    }
}

#[test]
fn an_expression_is_its_source() {
    let expression: Expression = " x + 1".parse().expect("a formula");
    assert_eq!((expression.source(), expression.to_string().as_str()), (" x + 1", " x + 1"));
    assert_eq!(expression, expression.clone());
    assert_ne!(expression, parsed("x + 1"));
    assert!(same(parsed("ln(exp(1))").eval(0.0, 0.0), E.ln()));
}
