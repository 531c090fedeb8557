//! The postfix program of a formula: built with constants folded, run on one point or on a lane of points.

use super::elementary::{cosines, exponentials, sines};

/// Most values that a program may hold at once: bounds the memory of an evaluation.
pub(super) const MAX_DEPTH: usize = 200;

/// Depth up to which [`Program::eval`] uses a short stack: clearing a long one costs more than most formulas.
const SHORT_DEPTH: usize = 12;

/// Points that one instruction handles at a time in [`Program::eval_many`]: enough to make the dispatch
/// negligible, few enough that a usual stack stays in the first cache.
const LANES: usize = 128;

/// Largest constant exponent that is multiplied out: seven products, off by less than four units in the last place.
const MAX_PRODUCT_EXPONENT: u8 = 8;

/// One step on the stack of values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Instruction {
    X,
    Y,
    Number(f64),
    Negate,
    Not,
    IntegerPower(u8),
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Sqrt,
    Abs,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
    Atan2,
    Min,
    Max,
    If,
}

impl Instruction {
    /// How many values it takes from the stack; it always leaves one.
    fn operands(self) -> usize {
        use Instruction::*;
        match self {
            X | Y | Number(_) => 0,
            Negate | Not | IntegerPower(_) | Sin | Cos | Tan | Asin | Acos | Atan | Sinh | Cosh | Tanh
            | Exp | Ln | Sqrt | Abs => 1,
            Add | Subtract | Multiply | Divide | Power | Less | LessEqual | Greater | GreaterEqual
            | Equal | NotEqual | And | Or | Atan2 | Min | Max => 2,
            If => 3,
        }
    }

    /// Executes the step at `L` points. The only definition of every operation: folding, `eval` and
    /// `eval_many` all come here, so they agree.
    #[inline(always)]
    fn apply<const L: usize>(self, x: &[f64; L], y: &[f64; L], stack: &mut Stack<'_, L>) {
        use Instruction::*;
        match self {
            X => stack.push(x),
            Y => stack.push(y),
            Number(value) => stack.push(&[value; L]),
            Negate => stack.unary(|a| -a),
            Not => stack.unary(not),
            IntegerPower(2) => stack.unary(|a| a * a),
            IntegerPower(3) => stack.unary(|a| a * a * a),
            IntegerPower(n) => stack.unary(|a| (1..n).fold(a, |power, _| power * a)),
            Sin => sines(stack.top()),
            Cos => cosines(stack.top()),
            Tan => stack.unary(f64::tan),
            Asin => stack.unary(f64::asin),
            Acos => stack.unary(f64::acos),
            Atan => stack.unary(f64::atan),
            Sinh => stack.unary(f64::sinh),
            Cosh => stack.unary(f64::cosh),
            Tanh => stack.unary(f64::tanh),
            Exp => exponentials(stack.top()),
            Ln => stack.unary(f64::ln),
            Sqrt => stack.unary(f64::sqrt),
            Abs => stack.unary(f64::abs),
            Add => stack.binary(|a, b| a + b),
            Subtract => stack.binary(|a, b| a - b),
            Multiply => stack.binary(|a, b| a * b),
            Divide => stack.binary(|a, b| a / b),
            Power => stack.binary(f64::powf),
            Less => stack.binary(|a, b| compared(a, b, a < b)),
            LessEqual => stack.binary(|a, b| compared(a, b, a <= b)),
            Greater => stack.binary(|a, b| compared(a, b, a > b)),
            GreaterEqual => stack.binary(|a, b| compared(a, b, a >= b)),
            Equal => stack.binary(|a, b| compared(a, b, a == b)),
            NotEqual => stack.binary(|a, b| compared(a, b, a != b)),
            And => stack.binary(and),
            Or => stack.binary(or),
            Atan2 => stack.binary(f64::atan2),
            Min => stack.binary(|a, b| if a < b || a.is_nan() { a } else { b }),
            Max => stack.binary(|a, b| if a > b || a.is_nan() { a } else { b }),
            If => stack.ternary(choose),
        }
    }
}

fn compared(a: f64, b: f64, holds: bool) -> f64 {
    if a.is_nan() | b.is_nan() { f64::NAN } else { f64::from(holds) }
}

fn not(a: f64) -> f64 {
    if a.is_nan() { a } else { f64::from(a == 0.0) }
}

/// Conjunction with NaN as "unknown": false as soon as one side is.
fn and(a: f64, b: f64) -> f64 {
    let one_fails = (a == 0.0) | (b == 0.0);
    if one_fails { 0.0 } else { compared(a, b, true) }
}

/// Disjunction with NaN as "unknown": true as soon as one side is.
fn or(a: f64, b: f64) -> f64 {
    not(and(not(a), not(b)))
}

fn choose(condition: f64, a: f64, b: f64) -> f64 {
    if condition.is_nan() {
        condition
    } else if condition != 0.0 {
        a
    } else {
        b
    }
}

/// The values of a running program, each at `L` points.
struct Stack<'a, const L: usize> {
    values: &'a mut [[f64; L]],
    height: usize,
}

impl<const L: usize> Stack<'_, L> {
    #[inline(always)]
    fn push(&mut self, value: &[f64; L]) {
        self.values[self.height] = *value;
        self.height += 1;
    }

    #[inline(always)]
    fn top(&mut self) -> &mut [f64; L] {
        &mut self.values[self.height - 1]
    }

    #[inline(always)]
    fn unary(&mut self, f: impl Fn(f64) -> f64) {
        self.top().iter_mut().for_each(|a| *a = f(*a));
    }

    #[inline(always)]
    fn binary(&mut self, f: impl Fn(f64, f64) -> f64) {
        self.height -= 1;
        let [a, b] = &mut self.values[self.height - 1..=self.height] else { unreachable!("two values") };
        for (a, b) in a.iter_mut().zip(b) {
            *a = f(*a, *b);
        }
    }

    #[inline(always)]
    fn ternary(&mut self, f: impl Fn(f64, f64, f64) -> f64) {
        self.height -= 2;
        let [a, b, c] = &mut self.values[self.height - 1..=self.height + 1] else {
            unreachable!("three values")
        };
        for ((a, b), c) in a.iter_mut().zip(b).zip(c) {
            *a = f(*a, *b, *c);
        }
    }
}

/// Runs complete postfix code; the result is in `values[0]`.
#[inline(always)]
fn run<const L: usize>(code: &[Instruction], x: &[f64; L], y: &[f64; L], values: &mut [[f64; L]]) {
    let mut stack = Stack { values, height: 0 };
    for instruction in code {
        instruction.apply(x, y, &mut stack);
    }
}

/// A finished program: `code` leaves one value and never holds more than `depth`.
#[derive(Debug, Clone)]
pub(super) struct Program {
    code: Vec<Instruction>,
    depth: usize,
}

impl Program {
    /// Its value, when all of it has been folded.
    pub(super) fn constant(&self) -> Option<f64> {
        match self.code[..] {
            [Instruction::Number(value)] => Some(value),
            _ => None,
        }
    }

    pub(super) fn eval(&self, x: f64, y: f64) -> f64 {
        if self.depth <= SHORT_DEPTH {
            self.eval_within::<SHORT_DEPTH>(x, y)
        } else {
            self.eval_within::<MAX_DEPTH>(x, y)
        }
    }

    fn eval_within<const DEPTH: usize>(&self, x: f64, y: f64) -> f64 {
        let mut values = [[0.0]; DEPTH];
        run(&self.code, &[x], &[y], &mut values);
        values[0][0]
    }

    pub(super) fn eval_many(&self, x: &[f64], y: &[f64], out: &mut [f64]) {
        let ((x, x_rest), (y, y_rest)) = (x.as_chunks::<LANES>(), y.as_chunks::<LANES>());
        let (out, out_rest) = out.as_chunks_mut::<LANES>();
        if !out.is_empty() {
            let mut values = vec![[0.0; LANES]; self.depth];
            for ((x, y), out) in x.iter().zip(y).zip(out) {
                run(&self.code, x, y, &mut values);
                *out = values[0];
            }
        }
        for ((&x, &y), out) in x_rest.iter().zip(y_rest).zip(out_rest) {
            *out = self.eval(x, y);
        }
    }
}

/// A program under construction.
#[derive(Default)]
pub(super) struct Builder {
    code: Vec<Instruction>,
    height: usize,
    depth: usize,
}

impl Builder {
    /// Appends an instruction, whose operands the code so far has left on the stack.
    ///
    /// Returns whether the values still fit into [`MAX_DEPTH`].
    #[must_use]
    pub(super) fn push(&mut self, instruction: Instruction) -> bool {
        let instruction = self.with_constant_exponent(instruction);
        let operands = instruction.operands();
        let first_operand = self.code.len() - operands;
        let constant = self.code[first_operand..].iter().all(|code| matches!(code, Instruction::Number(_)));
        self.code.push(instruction);
        self.height = self.height + 1 - operands;
        self.depth = self.depth.max(self.height);
        if operands > 0 && constant {
            let mut values = [[0.0]; 3];
            run(&self.code[first_operand..], &[0.0], &[0.0], &mut values);
            self.code.truncate(first_operand);
            self.code.push(Instruction::Number(values[0][0]));
        }
        self.depth <= MAX_DEPTH
    }

    /// Turns a power whose exponent is a small whole number into products, and takes the exponent away.
    fn with_constant_exponent(&mut self, instruction: Instruction) -> Instruction {
        let (Instruction::Power, Some(&Instruction::Number(exponent))) = (instruction, self.code.last())
        else {
            return instruction;
        };
        let Some(n) = (2..=MAX_PRODUCT_EXPONENT).find(|&n| f64::from(n) == exponent) else {
            return instruction;
        };
        self.code.pop();
        self.height -= 1;
        Instruction::IntegerPower(n)
    }

    pub(super) fn finish(self) -> Program {
        Program { code: self.code, depth: self.depth }
    }
}
