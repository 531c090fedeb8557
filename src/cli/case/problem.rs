//! The problem: a built-in case with its parameters, or `[membranes]`.

use std::collections::BTreeMap;

use toml::Value;

use super::section::{Section, as_number};
use crate::cli::failure::Failure;
use crate::problem::{Case, ContactProblem, ExactSolution, Expression, Function};
use crate::text::excerpt;

/// `case = "..."` and `[parameters]`.
pub(super) fn exact_case(top: &mut Section) -> Result<Option<ExactSolution>, Failure> {
    let name = top.text("case")?;
    let mut section = top.section("parameters")?;
    let Some(name) = name else {
        if !section.is_empty() {
            return Err(
                top.error("parameters", "belongs to a built-in case: add `case = \"...\"` or remove it")
            );
        }
        return Ok(None);
    };
    let case = Case::from_name(&name)
        .map_err(|error| top.error("case", format!("= \"{}\": {error}", excerpt(&name))))?;
    let parameters: BTreeMap<String, f64> = section.all_numbers()?.into_iter().collect();
    case.solution(&parameters).map(Some).map_err(|error| top.table_error(format!("[parameters]: {error}")))
}

/// `[membranes]`, or the problem of the built-in case.
pub(super) fn problem(top: &mut Section, exact: Option<&ExactSolution>) -> Result<ContactProblem, Failure> {
    let mut section = top.section("membranes")?;
    if let Some(exact) = exact {
        if !section.is_empty() {
            return Err(top.error("membranes", "contradicts `case`: remove one of the two"));
        }
        return exact.problem().map_err(|error| top.table_error(format!("[parameters]: {error}")));
    }
    if section.is_empty() {
        let remedy = "add a table [membranes] with tension, load, height, or `case = \"...\"`";
        return Err(top
            .misspelt(&["membranes", "case"])
            .unwrap_or_else(|| top.table_error(format!("there is no problem: {remedy}"))));
    }
    let [mu1, mu2] =
        pair(&mut section, "tension", &|value| as_number(value).ok_or("must be a number".into()))?
            .ok_or_else(|| section.missing("tension", "add `tension = [mu1, mu2]`"))?;
    let [f1, f2] = pair(&mut section, "load", &function)?
        .ok_or_else(|| section.missing("load", "add `load = [f1, f2]`, numbers or expressions in x and y"))?;
    let height = section
        .take("height")
        .map(|value| function(&value).map_err(|problem| section.error("height", problem)))
        .transpose()?
        .unwrap_or(Function::Constant(0.0));
    let problem = ContactProblem::builder().tension(mu1, mu2).load(f1, f2).height(height).build();
    let problem = problem.map_err(|error| section.table_error(format!("[membranes]: {error}")))?;
    section.finish()?;
    Ok(problem)
}

/// Two values, one for each membrane.
fn pair<T>(
    section: &mut Section,
    key: &'static str,
    convert: &dyn Fn(&Value) -> Result<T, String>,
) -> Result<Option<[T; 2]>, Failure> {
    let Some(value) = section.take(key) else { return Ok(None) };
    let Some([first, second]) = value.as_array().map(Vec::as_slice) else {
        return Err(section.error(key, "must have two entries, one for each membrane: [first, second]"));
    };
    let convert = |k: usize, value: &Value| {
        convert(value).map_err(|problem| section.error(&format!("{key}[{k}]"), problem))
    };
    Ok(Some([convert(1, first)?, convert(2, second)?]))
}

/// A number or an expression.
fn function(value: &Value) -> Result<Function, String> {
    match value {
        Value::String(source) => Expression::parse(source)
            .map(Function::from)
            .map_err(|error| format!("is no expression: {error}")),
        _ => as_number(value)
            .map(Function::Constant)
            .ok_or("must be a number or an expression in quotes".into()),
    }
}
