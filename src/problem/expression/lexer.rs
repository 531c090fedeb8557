//! Cuts a source into numbers, names and symbols.

use super::error::ExpressionError;
use super::program::Instruction;
use crate::text::excerpt;

/// How tightly an operator binds, loosest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Precedence {
    Or,
    And,
    Not,
    Comparison,
    Sum,
    Product,
    Sign,
    Power,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Token {
    Number(f64),
    Name,
    /// Between two values; `+` and `-` also before one.
    Operator(Precedence, Instruction),
    Not,
    Open,
    Close,
    Comma,
    End,
}

/// A token, its text and the column where it begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lexeme<'a> {
    pub(super) token: Token,
    pub(super) text: &'a str,
    pub(super) column: usize,
}

impl Lexeme<'_> {
    /// The text for an error message.
    pub(super) fn shown(&self) -> String {
        excerpt(self.text)
    }
}

/// What a symbol means, or what to write in its place; a symbol comes before those that it begins with.
const SYMBOLS: [(&str, Result<Token, &str>); 37] = [
    ("(", Ok(Token::Open)),
    (")", Ok(Token::Close)),
    (",", Ok(Token::Comma)),
    ("+", Ok(Token::Operator(Precedence::Sum, Instruction::Add))),
    ("-", Ok(Token::Operator(Precedence::Sum, Instruction::Subtract))),
    ("**", Err("^")),
    ("*", Ok(Token::Operator(Precedence::Product, Instruction::Multiply))),
    ("/", Ok(Token::Operator(Precedence::Product, Instruction::Divide))),
    ("^", Ok(Token::Operator(Precedence::Power, Instruction::Power))),
    ("<=", Ok(Token::Operator(Precedence::Comparison, Instruction::LessEqual))),
    ("<>", Err("!=")),
    ("<", Ok(Token::Operator(Precedence::Comparison, Instruction::Less))),
    (">=", Ok(Token::Operator(Precedence::Comparison, Instruction::GreaterEqual))),
    (">", Ok(Token::Operator(Precedence::Comparison, Instruction::Greater))),
    ("==", Ok(Token::Operator(Precedence::Comparison, Instruction::Equal))),
    ("=<", Err("<=")),
    ("=>", Err(">=")),
    ("=", Err("==")),
    ("!=", Ok(Token::Operator(Precedence::Comparison, Instruction::NotEqual))),
    ("!", Ok(Token::Not)),
    ("&&", Ok(Token::Operator(Precedence::And, Instruction::And))),
    ("&", Err("&&")),
    ("||", Ok(Token::Operator(Precedence::Or, Instruction::Or))),
    ("|", Err("abs(...)")),
    ("[", Err("(")),
    ("]", Err(")")),
    ("{", Err("(")),
    ("}", Err(")")),
    ("\u{2212}", Err("-")),
    ("\u{d7}", Err("*")),
    ("\u{b7}", Err("*")),
    ("\u{2264}", Err("<=")),
    ("\u{2265}", Err(">=")),
    ("\u{2260}", Err("!=")),
    ("\u{b2}", Err("^2")),
    ("\u{b3}", Err("^3")),
    ("\u{3c0}", Err("pi")),
];

/// Reads lexemes one after the other, for ever `End` after the last.
pub(super) struct Lexer<'a> {
    rest: &'a str,
    column: usize,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(source: &'a str) -> Self {
        Self { rest: source, column: 1 }
    }

    pub(super) fn next(&mut self) -> Result<Lexeme<'a>, ExpressionError> {
        let trimmed = self.rest.trim_start();
        self.column += self.rest[..self.rest.len() - trimmed.len()].chars().count();
        self.rest = trimmed;
        match self.rest.chars().next() {
            None => Ok(self.take(0, Token::End)),
            Some('0'..='9' | '.') => self.number(),
            Some('a'..='z' | 'A'..='Z' | '_') => Ok(self.name()),
            Some(character) => self.symbol(character),
        }
    }

    /// Consumes `bytes` bytes, all ASCII.
    fn take(&mut self, bytes: usize, token: Token) -> Lexeme<'a> {
        let (text, rest) = self.rest.split_at(bytes);
        let lexeme = Lexeme { token, text, column: self.column };
        self.rest = rest;
        self.column += bytes;
        lexeme
    }

    fn number(&mut self) -> Result<Lexeme<'a>, ExpressionError> {
        let Some(text) = number_prefix(self.rest) else {
            let end = self.rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '.');
            let text = excerpt(&self.rest[..end.unwrap_or(self.rest.len())]);
            return Err(ExpressionError::MalformedNumber { text, column: self.column });
        };
        let value: f64 = text.parse().expect("digits with a point and an exponent are a number");
        if !value.is_finite() {
            return Err(ExpressionError::NumberOutOfRange { text: excerpt(text), column: self.column });
        }
        Ok(self.take(text.len(), Token::Number(value)))
    }

    fn name(&mut self) -> Lexeme<'a> {
        let end = self.rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(self.rest.len());
        let token = match &self.rest[..end] {
            "and" => Token::Operator(Precedence::And, Instruction::And),
            "or" => Token::Operator(Precedence::Or, Instruction::Or),
            "not" => Token::Not,
            _ => Token::Name,
        };
        self.take(end, token)
    }

    fn symbol(&mut self, character: char) -> Result<Lexeme<'a>, ExpressionError> {
        let column = self.column;
        match SYMBOLS.into_iter().find(|(symbol, _)| self.rest.starts_with(symbol)) {
            Some((symbol, Ok(token))) => Ok(self.take(symbol.len(), token)),
            Some(("|", Err(_))) => Err(ExpressionError::Bar { column }),
            Some((symbol, Err(instead))) => Err(ExpressionError::ForeignSymbol { symbol, instead, column }),
            None => Err(ExpressionError::UnknownCharacter { character, column }),
        }
    }
}

/// The number at the start of `text`; none when it is malformed.
///
/// An `e` opens an exponent unless letters follow: `2exp(x)` is a number and a name, an error for the parser.
fn number_prefix(text: &str) -> Option<&str> {
    let bytes = text.as_bytes();
    let is_digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    let after_digits = |from: usize| (from..).find(|&at| !is_digit(at)).unwrap_or(from);
    let mut end = after_digits(0);
    let mut digits = end;
    if bytes.get(end) == Some(&b'.') {
        let fraction = end + 1;
        end = after_digits(fraction);
        digits += end - fraction;
    }
    if let Some(b'e' | b'E') = bytes.get(end) {
        let exponent = end + 1 + usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        if is_digit(exponent) {
            end = after_digits(exponent);
        } else if !bytes.get(end + 1).is_some_and(u8::is_ascii_alphabetic) {
            return None;
        }
    }
    (digits > 0 && bytes.get(end) != Some(&b'.')).then(|| &text[..end])
}
