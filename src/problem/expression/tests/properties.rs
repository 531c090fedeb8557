//! Random formulas, printed and read back, and random text.

use proptest::prelude::*;

use super::{Expression, parsed, same, sin};

/// A formula as a tree, with its own evaluation and two ways to print it.
#[derive(Debug, Clone)]
enum Tree {
    Number(f64),
    X,
    Y,
    Prefix(&'static str, Box<Tree>),
    Infix(&'static str, Box<[Tree; 2]>),
    Call(&'static str, Vec<Tree>),
}

/// Operators by rank, loosest first.
const RANKS: [&[&str]; 8] = [
    &["or", "||"],
    &["and", "&&"],
    &["not ", "!"],
    &["<", "<=", ">", ">=", "==", "!="],
    &["+", "-"],
    &["*", "/"],
    &["negative"],
    &["^"],
];
const NEGATIVE: &str = "negative";
const SIGN_RANK: usize = 6;
const POWER_RANK: usize = 7;

fn rank(operator: &str) -> usize {
    RANKS.iter().position(|operators| operators.contains(&operator)).expect("an operator of the table")
}

fn truth(value: f64) -> Option<bool> {
    (!value.is_nan()).then_some(value != 0.0)
}

fn number(truth: Option<bool>) -> f64 {
    truth.map_or(f64::NAN, f64::from)
}

impl Tree {
    fn is_constant(&self) -> bool {
        match self {
            Self::Number(_) => true,
            Self::X | Self::Y => false,
            Self::Prefix(_, a) => a.is_constant(),
            Self::Infix(_, sides) => sides.iter().all(Self::is_constant),
            Self::Call(_, arguments) => arguments.iter().all(Self::is_constant),
        }
    }

    fn value(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::X => x,
            Self::Y => y,
            Self::Prefix(NEGATIVE, a) => -a.value(x, y),
            Self::Prefix(_, a) => number(truth(a.value(x, y)).map(|holds| !holds)),
            Self::Infix(operator, sides) => {
                let [a, b] = [sides[0].value(x, y), sides[1].value(x, y)];
                infix(operator, a, b, sides[1].is_constant())
            }
            Self::Call(name, arguments) => {
                let values: Vec<f64> = arguments.iter().map(|argument| argument.value(x, y)).collect();
                call(name, &values)
            }
        }
    }

    /// With parentheses round every operation.
    fn print_full(&self) -> String {
        match self {
            Self::Prefix(NEGATIVE, a) => format!("(-{})", a.print_full()),
            Self::Prefix(word, a) => format!("({word}{})", a.print_full()),
            Self::Infix(operator, sides) => {
                format!("({} {operator} {})", sides[0].print_full(), sides[1].print_full())
            }
            _ => self.print_leaf(Self::print_full),
        }
    }

    /// With parentheses only where the tree would be another one without them.
    fn print_minimal(&self, least_rank: usize) -> String {
        let (own_rank, text) = match self {
            Self::Prefix(NEGATIVE, a) => (SIGN_RANK, format!("-{}", a.print_minimal(SIGN_RANK))),
            Self::Prefix(word, a) => (rank(word), format!("{word}{}", a.print_minimal(rank(word)))),
            Self::Infix(operator, sides) => {
                let own = rank(operator);
                let (left, right) = match own {
                    3 => (own + 1, own + 1),
                    POWER_RANK => (own + 1, SIGN_RANK),
                    _ => (own, own + 1),
                };
                (
                    own,
                    format!("{} {operator} {}", sides[0].print_minimal(left), sides[1].print_minimal(right)),
                )
            }
            _ => return self.print_leaf(|argument| argument.print_minimal(0)),
        };
        if own_rank < least_rank { format!("({text})") } else { text }
    }

    fn print_leaf(&self, print: impl Fn(&Self) -> String) -> String {
        match self {
            Self::Number(value) => format!("{value:?}"),
            Self::X => "x".to_string(),
            Self::Y => "y".to_string(),
            Self::Call(name, arguments) => {
                format!("{name}({})", arguments.iter().map(print).collect::<Vec<_>>().join(", "))
            }
            Self::Prefix(..) | Self::Infix(..) => unreachable!("operators are printed by the callers"),
        }
    }
}

fn infix(operator: &str, a: f64, b: f64, b_is_constant: bool) -> f64 {
    let compare = |holds: bool| if a.is_nan() || b.is_nan() { f64::NAN } else { f64::from(holds) };
    match operator {
        "or" | "||" => number(match (truth(a), truth(b)) {
            (Some(true), _) | (_, Some(true)) => Some(true),
            (Some(false), Some(false)) => Some(false),
            _ => None,
        }),
        "and" | "&&" => number(match (truth(a), truth(b)) {
            (Some(false), _) | (_, Some(false)) => Some(false),
            (Some(true), Some(true)) => Some(true),
            _ => None,
        }),
        "<" => compare(a < b),
        "<=" => compare(a <= b),
        ">" => compare(a > b),
        ">=" => compare(a >= b),
        "==" => compare(a == b),
        "!=" => compare(a != b),
        "+" => a + b,
        "-" => a - b,
        "*" => a * b,
        "/" => a / b,
        "^" if b_is_constant && b.fract() == 0.0 && (2.0..=8.0).contains(&b) => {
            (1..b as usize).fold(a, |power, _| power * a)
        }
        "^" => a.powf(b),
        _ => unreachable!("no operator {operator}"),
    }
}

fn call(name: &str, values: &[f64]) -> f64 {
    let extreme = |better: fn(f64, f64) -> bool| {
        values
            .iter()
            .copied()
            .reduce(|a, b| if a.is_nan() || better(a, b) { a } else { b })
            .expect("arguments")
    };
    match name {
        "sin" => sin(values[0]),
        "sqrt" => values[0].sqrt(),
        "abs" => values[0].abs(),
        "atan2" => values[0].atan2(values[1]),
        "min" => extreme(|a, b| a < b),
        "max" => extreme(|a, b| a > b),
        "if" => truth(values[0]).map_or(f64::NAN, |holds| if holds { values[1] } else { values[2] }),
        _ => unreachable!("no function {name}"),
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    let numbers = prop_oneof![Just(0.0), Just(2.0), Just(3.0), Just(0.5), 0.0..1e3f64, Just(1e-300)];
    let leaf = prop_oneof![numbers.prop_map(Tree::Number), Just(Tree::X), Just(Tree::Y)];
    leaf.prop_recursive(6, 60, 4, |inner| {
        let prefixes = prop::sample::select(vec![NEGATIVE, NEGATIVE, "not ", "!"]);
        let infixes: Vec<&str> =
            RANKS.concat().into_iter().filter(|text| ![NEGATIVE, "not ", "!"].contains(text)).collect();
        let calls = prop::sample::select(vec![("sin", 1), ("sqrt", 1), ("abs", 1), ("atan2", 2), ("if", 3)]);
        let extremes = prop::sample::select(vec!["min", "max"]);
        let arguments = prop::collection::vec(inner.clone(), 3);
        prop_oneof![
            2 => (prefixes, inner.clone()).prop_map(|(word, a)| Tree::Prefix(word, Box::new(a))),
            6 => (prop::sample::select(infixes), inner.clone(), inner.clone())
                .prop_map(|(operator, a, b)| Tree::Infix(operator, Box::new([a, b]))),
            2 => (calls, arguments).prop_map(|((name, count), mut arguments)| {
                arguments.truncate(count);
                Tree::Call(name, arguments)
            }),
            1 => (extremes, prop::collection::vec(inner, 2..5))
                .prop_map(|(name, arguments)| Tree::Call(name, arguments)),
        ]
    })
}

/// Text made of pieces of the language, so that much of it is nearly right.
fn soup() -> impl Strategy<Value = String> {
    let pieces = vec![
        "x", "y", "pi", "1", "2.5", ".", "e", "1e", " ", "(", ")", ",", "+", "-", "*", "/", "^", "<", "<=",
        "==", "=", "!", "not ", "and ", "or ", "&&", "|", "sin", "sin(", "min(", "if(", "else", "log",
        "\u{e9}", "\u{b2}", "\n",
    ];
    prop::collection::vec(prop::sample::select(pieces), 0..40).prop_map(|pieces| pieces.concat())
}

/// Reading ends, in a value at a point and in a block or in one line with a column inside of the source.
fn read_safely(source: &str) {
    match Expression::parse(source) {
        Ok(expression) => {
            let mut values = [0.0; 130];
            expression.eval_many(&[0.25; 130], &[-3.0; 130], &mut values);
            assert!(values.iter().all(|&value| same(value, expression.eval(0.25, -3.0))), "{source}");
        }
        Err(error) => {
            let message = error.to_string();
            assert!(!message.contains('\n') && message.len() < 200, "{message}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_printed_tree_has_the_value_of_the_tree(tree in tree(), x in -3.0..3.0f64, y in -3.0..3.0f64) {
        let value = tree.value(x, y);
        for source in [tree.print_full(), tree.print_minimal(0)] {
            let parsed = parsed(&source).eval(x, y);
            prop_assert!(same(parsed, value), "{source} at ({x}, {y}): {parsed}, not {value}");
        }
    }

    #[test]
    fn pieces_of_the_language_are_read_safely(source in soup()) {
        read_safely(&source);
    }

    #[test]
    fn any_text_is_read_safely(source in any::<String>()) {
        read_safely(&source);
    }
}

/// The negative test: with parentheses left out where they matter, the values differ.
#[test]
fn a_tree_without_its_parentheses_is_another() {
    let sum = Tree::Infix("+", Box::new([Tree::X, Tree::Y]));
    let product = Tree::Infix("*", Box::new([sum, Tree::Number(2.0)]));
    let bare = product.print_minimal(0).replace(['(', ')'], "");
    assert!(!same(parsed(&bare).eval(1.0, 4.0), product.value(1.0, 4.0)), "{bare}");
}
