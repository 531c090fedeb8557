//! Turns lexemes into a postfix program, by Dijkstra's shunting-yard: operators wait on a heap-allocated
//! stack until their operands are complete. Nothing recurses, so no source can overflow the call stack,
//! and each lexeme is handled once.

use std::f64::consts::PI;

use super::error::ExpressionError;
use super::lexer::{Lexeme, Lexer, Precedence, Token};
use super::program::{Builder, Instruction, Program};
use crate::text::meant;

/// How many arguments a function takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Arguments {
    One,
    Two,
    Three,
    TwoOrMore,
}

impl Arguments {
    fn admit(self, count: usize) -> bool {
        match self {
            Self::One => count == 1,
            Self::Two => count == 2,
            Self::Three => count == 3,
            Self::TwoOrMore => count >= 2,
        }
    }

    fn describe(self) -> &'static str {
        match self {
            Self::One => "1",
            Self::Two => "2",
            Self::Three => "3",
            Self::TwoOrMore => "2 or more",
        }
    }
}

type Function = (&'static str, Arguments, Instruction);

const FUNCTIONS: [Function; 17] = [
    ("sin", Arguments::One, Instruction::Sin),
    ("cos", Arguments::One, Instruction::Cos),
    ("tan", Arguments::One, Instruction::Tan),
    ("asin", Arguments::One, Instruction::Asin),
    ("acos", Arguments::One, Instruction::Acos),
    ("atan", Arguments::One, Instruction::Atan),
    ("sinh", Arguments::One, Instruction::Sinh),
    ("cosh", Arguments::One, Instruction::Cosh),
    ("tanh", Arguments::One, Instruction::Tanh),
    ("exp", Arguments::One, Instruction::Exp),
    ("ln", Arguments::One, Instruction::Ln),
    ("sqrt", Arguments::One, Instruction::Sqrt),
    ("abs", Arguments::One, Instruction::Abs),
    ("atan2", Arguments::Two, Instruction::Atan2),
    ("min", Arguments::TwoOrMore, Instruction::Min),
    ("max", Arguments::TwoOrMore, Instruction::Max),
    ("if", Arguments::Three, Instruction::If),
];

const VALUES: [(&str, Instruction); 3] =
    [("x", Instruction::X), ("y", Instruction::Y), ("pi", Instruction::Number(PI))];

/// What waits for the values to its right.
enum Pending {
    /// An operator; its left operand, where it has one, is already in the program.
    Operation { precedence: Precedence, instruction: Instruction },
    /// An opening parenthesis, of a group or of a call.
    Open { column: usize, call: Option<Call> },
}

/// A call whose arguments are being read.
struct Call {
    function: Function,
    column: usize,
    complete: usize,
}

/// The program of a source that is not empty.
pub(super) fn parse(source: &str) -> Result<Program, ExpressionError> {
    let mut parser = Parser { lexer: Lexer::new(source), program: Builder::default(), pending: Vec::new() };
    loop {
        let last = parser.value()?;
        if !parser.operator(last)? {
            return Ok(parser.program.finish());
        }
    }
}

struct Parser<'a> {
    lexer: Lexer<'a>,
    program: Builder,
    pending: Vec<Pending>,
}

impl<'a> Parser<'a> {
    /// Reads up to a number or a variable, over what may stand before it; returns that lexeme.
    fn value(&mut self) -> Result<Lexeme<'a>, ExpressionError> {
        loop {
            let lexeme = self.lexer.next()?;
            let column = lexeme.column;
            match lexeme.token {
                Token::Number(value) => {
                    self.emit(Instruction::Number(value), column)?;
                    return Ok(lexeme);
                }
                Token::Name => {
                    if let Some(&(_, value)) = VALUES.iter().find(|(name, _)| *name == lexeme.text) {
                        self.emit(value, column)?;
                        return Ok(lexeme);
                    }
                    self.open_call(lexeme)?;
                }
                Token::Open => self.pending.push(Pending::Open { column, call: None }),
                Token::Operator(_, Instruction::Add) => {}
                Token::Operator(_, Instruction::Subtract) => {
                    self.pending.push(Pending::Operation {
                        precedence: Precedence::Sign,
                        instruction: Instruction::Negate,
                    });
                }
                Token::Not => self.negation(lexeme)?,
                Token::Operator(..) | Token::Close | Token::Comma | Token::End => {
                    return Err(self.missing_value(lexeme));
                }
            }
        }
    }

    /// Reads what follows a value that ends with `last`, up to the next operator or comma.
    ///
    /// Returns false at the end of the source.
    fn operator(&mut self, mut last: Lexeme<'a>) -> Result<bool, ExpressionError> {
        loop {
            let lexeme = self.lexer.next()?;
            let column = lexeme.column;
            match lexeme.token {
                Token::Operator(precedence, instruction) => {
                    self.binary(precedence, instruction, column)?;
                    return Ok(true);
                }
                Token::Comma => {
                    self.complete_operations(Precedence::Or, column)?;
                    self.complete_argument(column)?;
                    return Ok(true);
                }
                Token::Close => self.close(column)?,
                Token::End => {
                    self.complete_operations(Precedence::Or, column)?;
                    return match self.pending.last() {
                        Some(&Pending::Open { column, .. }) => Err(ExpressionError::Unclosed { column }),
                        _ => Ok(false),
                    };
                }
                Token::Number(_) | Token::Name | Token::Open | Token::Not => {
                    return Err(missing_operator(last, lexeme));
                }
            }
            last = lexeme;
        }
    }

    fn emit(&mut self, instruction: Instruction, column: usize) -> Result<(), ExpressionError> {
        if self.program.push(instruction) { Ok(()) } else { Err(ExpressionError::TooDeep { column }) }
    }

    /// Emits the operators since the last opening parenthesis that bind at least as tightly as `precedence`.
    fn complete_operations(&mut self, precedence: Precedence, column: usize) -> Result<(), ExpressionError> {
        while let Some(&Pending::Operation { precedence: waiting, instruction }) = self.pending.last()
            && waiting >= precedence
        {
            self.pending.pop();
            self.emit(instruction, column)?;
        }
        Ok(())
    }

    fn binary(
        &mut self,
        precedence: Precedence,
        instruction: Instruction,
        column: usize,
    ) -> Result<(), ExpressionError> {
        // Powers wait for each other, because they group to the right.
        if precedence != Precedence::Power {
            let tighter = if precedence == Precedence::Comparison { Precedence::Sum } else { precedence };
            self.complete_operations(tighter, column)?;
        }
        if precedence == Precedence::Comparison
            && matches!(
                self.pending.last(),
                Some(Pending::Operation { precedence: Precedence::Comparison, .. })
            )
        {
            return Err(ExpressionError::ChainedComparison { column });
        }
        self.pending.push(Pending::Operation { precedence, instruction });
        Ok(())
    }

    fn negation(&mut self, lexeme: Lexeme<'_>) -> Result<(), ExpressionError> {
        match self.pending.last() {
            Some(Pending::Operation { precedence, .. }) if *precedence > Precedence::Not => {
                Err(ExpressionError::MisplacedNot { text: lexeme.shown(), column: lexeme.column })
            }
            _ => {
                self.pending
                    .push(Pending::Operation { precedence: Precedence::Not, instruction: Instruction::Not });
                Ok(())
            }
        }
    }

    fn open_call(&mut self, name: Lexeme<'_>) -> Result<(), ExpressionError> {
        let column = name.column;
        let Some(&function) = FUNCTIONS.iter().find(|(known, ..)| *known == name.text) else {
            return Err(ExpressionError::UnknownName {
                name: name.shown(),
                column,
                remedy: remedy(name.text),
            });
        };
        let open = self.lexer.next()?;
        if open.token != Token::Open {
            return Err(ExpressionError::MissingArguments { name: function.0, column });
        }
        let call = Some(Call { function, column, complete: 0 });
        self.pending.push(Pending::Open { column: open.column, call });
        Ok(())
    }

    /// Counts an argument of the innermost call; `min` and `max` take theirs in pairs as they come.
    fn complete_argument(&mut self, column: usize) -> Result<(), ExpressionError> {
        let Some(Pending::Open { call: Some(call), .. }) = self.pending.last_mut() else {
            return Err(ExpressionError::StrayComma { column });
        };
        call.complete += 1;
        let (_, arguments, instruction) = call.function;
        if arguments == Arguments::TwoOrMore && call.complete >= 2 {
            self.emit(instruction, column)?;
        }
        Ok(())
    }

    fn close(&mut self, column: usize) -> Result<(), ExpressionError> {
        self.complete_operations(Precedence::Or, column)?;
        match self.pending.last() {
            None | Some(Pending::Operation { .. }) => return Err(ExpressionError::Unopened { column }),
            Some(Pending::Open { call: Some(_), .. }) => self.complete_argument(column)?,
            Some(Pending::Open { call: None, .. }) => {}
        }
        let Some(Pending::Open { call: Some(call), .. }) = self.pending.pop() else { return Ok(()) };
        let (_, arguments, instruction) = call.function;
        if !arguments.admit(call.complete) {
            return Err(argument_count(&call));
        }
        if arguments == Arguments::TwoOrMore { Ok(()) } else { self.emit(instruction, column) }
    }

    fn missing_value(&self, found: Lexeme<'_>) -> ExpressionError {
        match (found.token, self.pending.last()) {
            (Token::Close, Some(Pending::Open { call: Some(call), .. })) if call.complete == 0 => {
                argument_count(call)
            }
            (Token::Close, None) => ExpressionError::Unopened { column: found.column },
            (Token::End, _) => {
                ExpressionError::MissingValue { next: "the end".to_string(), column: found.column }
            }
            _ => ExpressionError::MissingValue { next: format!("`{}`", found.text), column: found.column },
        }
    }
}

fn argument_count(call: &Call) -> ExpressionError {
    let (name, arguments, _) = call.function;
    ExpressionError::ArgumentCount {
        name,
        column: call.column,
        found: call.complete,
        expected: arguments.describe(),
    }
}

fn missing_operator(left: Lexeme<'_>, right: Lexeme<'_>) -> ExpressionError {
    let column = right.column;
    match (right.token, right.text) {
        (Token::Not, text) => ExpressionError::MisplacedNot { text: text.to_string(), column },
        (_, "if" | "else") => ExpressionError::InfixConditional { word: right.shown(), column },
        _ => ExpressionError::MissingOperator { left: left.shown(), right: right.shown(), column },
    }
}

/// What the author of an unknown name may have meant.
fn remedy(name: &str) -> String {
    match name {
        "log" => "the natural logarithm is `ln`".to_string(),
        "log10" => "write `ln(...)/ln(10)`".to_string(),
        "log2" => "write `ln(...)/ln(2)`".to_string(),
        "pow" => "write `a^b`".to_string(),
        "e" => "write `exp(1)`".to_string(),
        "sgn" | "sign" | "signum" => "write `if(a > 0, 1, if(a < 0, -1, 0))`".to_string(),
        "step" | "heaviside" | "Heaviside" => "write `if(a < 0, 0, 1)`".to_string(),
        "fabs" => "write `abs(a)`".to_string(),
        "sqr" | "square" => "write `a^2`".to_string(),
        "cbrt" => "write `a^(1/3)`, where a is not negative".to_string(),
        "hypot" => "write `sqrt(a^2 + b^2)`".to_string(),
        "cot" => "write `1/tan(a)`".to_string(),
        "sec" => "write `1/cos(a)`".to_string(),
        "csc" => "write `1/sin(a)`".to_string(),
        "asinh" | "arcsinh" => "write `ln(a + sqrt(a^2 + 1))`".to_string(),
        "acosh" | "arccosh" => "write `ln(a + sqrt(a^2 - 1))`".to_string(),
        "atanh" | "arctanh" => "write `ln((1 + a)/(1 - a))/2`".to_string(),
        "where" | "ifelse" | "iif" | "piecewise" => "write `if(condition, a, b)`".to_string(),
        "floor" | "ceil" | "round" | "mod" => {
            "there are no such steps: write them by `if(condition, a, b)`".to_string()
        }
        "true" | "True" => "write `1`".to_string(),
        "false" | "False" => "write `0`".to_string(),
        "xy" => "for a product write `x*y`".to_string(),
        _ => match known_name(name) {
            Some(known) => format!("did you mean `{known}`?"),
            None => "the variables are `x` and `y`".to_string(),
        },
    }
}

/// The known name that was meant.
fn known_name(name: &str) -> Option<&'static str> {
    let functions = FUNCTIONS.iter().map(|(known, ..)| *known);
    let values = VALUES.iter().map(|(known, _)| *known);
    let words = ["and", "or", "not"];
    meant(name, functions.chain(values).chain(words))
}
