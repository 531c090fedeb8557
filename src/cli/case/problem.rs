//! The problem: a built-in case with its parameters, or `[membranes]`.

mod field;
mod pair;

use std::collections::BTreeMap;

use self::pair::pair;
use super::section::Section;
use crate::cli::failure::Failure;
use crate::problem::{Case, ContactProblem, ExactSolution};
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
    let section = top.section("membranes")?;
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
    pair(section)
}
