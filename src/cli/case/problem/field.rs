//! Data as case files have them.

use toml::Value;

use crate::cli::case::section::as_number;
use crate::problem::{Expression, Function};

/// A number or an expression.
pub(super) fn function(value: &Value) -> Result<Function, String> {
    match value {
        Value::String(source) => Expression::parse(source)
            .map(Function::from)
            .map_err(|error| format!("is no expression: {error}")),
        _ => as_number(value)
            .map(Function::Constant)
            .ok_or("must be a number or an expression in quotes".into()),
    }
}
