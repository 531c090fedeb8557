//! The problem: a built-in case with its parameters, the pair of `[membranes]`, or the stack of `[[membrane]]`.

mod boundary;
mod field;
mod pair;
mod stack;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use self::pair::pair;
use self::stack::stack;
use super::section::Section;
use crate::cli::failure::Failure;
use crate::problem::{ContactProblem, Exact, NamedCase};
use crate::text::excerpt;

/// `case = "..."` and `[parameters]`.
pub(super) fn exact_case(top: &mut Section) -> Result<Option<Exact>, Failure> {
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
    let case = NamedCase::from_name(&name)
        .map_err(|error| top.error("case", format!("= \"{}\": {error}", excerpt(&name))))?;
    let parameters: BTreeMap<String, f64> = section.all_numbers()?.into_iter().collect();
    case.solution(&parameters).map(Some).map_err(|error| top.table_error(format!("[parameters]: {error}")))
}

/// `[membranes]`, or `[[membrane]]` and `[obstacle]`, or the problem of the built-in case.
pub(super) fn problem(top: &mut Section, exact: Option<&Exact>) -> Result<ContactProblem, Failure> {
    if top.is_list("membranes") {
        return Err(top.error("membranes", "is one table for a pair: write [[membrane]] for one a membrane"));
    }
    let both = top.section("membranes")?;
    let remedy = "write [[membrane]] before each, from the top, or [membranes] for a pair";
    let membranes = top.sections("membrane", remedy)?;
    let obstacle = top.optional_section("obstacle")?;
    let new_form = [("membrane", membranes.is_some()), ("obstacle", obstacle.is_some())];
    let new_form = new_form.into_iter().find_map(|(key, is_there)| is_there.then_some(key));
    let old_form = (!both.is_empty()).then_some("membranes");
    match (exact, old_form, new_form) {
        (Some(exact), None, None) => {
            exact.problem().map_err(|error| top.table_error(format!("[parameters]: {error}")))
        }
        (Some(_), Some(key), _) | (Some(_), None, Some(key)) => {
            Err(top.error(key, "contradicts `case`: remove one of the two"))
        }
        (None, Some(_), None) => pair(both),
        (None, Some(_), Some("membrane")) => {
            Err(top.error("membrane", "contradicts `membranes`: remove one of the two"))
        }
        (None, Some(_), Some(key)) => {
            let remedy = "write the two of [membranes] as [[membrane]], from the top";
            Err(top.error(key, format!("does not go with `membranes`: {remedy}")))
        }
        (None, None, Some(_)) => stack(top, membranes, obstacle),
        (None, None, None) => {
            let remedy =
                "add a table [membranes] with tension, load, height, or [[membrane]], or `case = \"...\"`";
            Err(top
                .misspelt(&["membranes", "membrane", "case"])
                .unwrap_or_else(|| top.table_error(format!("there is no problem: {remedy}"))))
        }
    }
}
