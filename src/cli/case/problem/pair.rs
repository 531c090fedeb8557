//! `[membranes]`: the paper's pair.

use toml::Value;

use super::field;
use crate::cli::case::section::{Section, as_number};
use crate::cli::failure::Failure;
use crate::problem::{ContactProblem, Function};

/// The pair of `[membranes]`.
pub(super) fn pair(mut section: Section) -> Result<ContactProblem, Failure> {
    let [mu1, mu2] =
        for_each(&mut section, "tension", &|value| as_number(value).ok_or("must be a number".into()))?
            .ok_or_else(|| section.missing("tension", "add `tension = [mu1, mu2]`"))?;
    let [f1, f2] = for_each(&mut section, "load", &function)?
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

/// A number or an expression. Data views are for the longer form.
fn function(value: &Value) -> Result<Function, String> {
    if field::names_view(value) {
        return Err(
            "is a data view, which no datum of [membranes] can be: write [[membrane]] for each".into()
        );
    }
    field::function(value)
}

/// Two values, one for each membrane.
fn for_each<T>(
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
