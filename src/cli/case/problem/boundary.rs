//! `height` and `traction`: how a membrane is held on the boundary.

use toml::Value;

use super::field::{ByName, datum, function, names_view};
use crate::cli::case::section::Section;
use crate::cli::failure::Failure;
use crate::problem::{ByCurve, Membrane, Support, TractionError};
use crate::text::{excerpt, meant};

/// The height where nothing holds the membrane.
const FREE: &str = "free";

/// The membrane, held as the keys `height` and `traction` say.
pub(super) fn held(section: &mut Section, membrane: Membrane) -> Result<Membrane, Failure> {
    let height = ByName::read(section, "height", "curve", &support)?;
    let traction = ByName::read(section, "traction", "curve", &function)?;
    let held = membrane.held(by_curve(height), by_curve(traction));
    held.map_err(|error| match &error {
        TractionError::OnHeldCurve { curve } => {
            let remedy = format!("free it by `height = {{ {} = \"{FREE}\" }}`", key_of(curve));
            section.error(&format!("traction.{curve}"), format!("acts on a curve that is held: {remedy}"))
        }
        _ => {
            let remedy = "free one by `height = { name = \"free\" }`, or remove this";
            section.error("traction", format!("{error}: {remedy}"))
        }
    })
}

fn by_curve<T>(values: Option<ByName<T>>) -> ByCurve<T> {
    values.map_or_else(ByCurve::default, |ByName { parts, elsewhere }| ByCurve {
        parts: parts.into_iter().collect(),
        elsewhere,
    })
}

/// A height, or "free".
fn support(value: &Value) -> Result<Support, String> {
    if value.as_str() == Some(FREE) {
        return Ok(Support::Free { traction: 0.0.into() });
    }
    datum(value).map(Support::Fixed).map_err(|problem| match value.as_str() {
        Some(text) if meant(text.trim(), [FREE]).is_some() => {
            format!("= \"{}\" is no height: write \"{FREE}\" where nothing holds the membrane", excerpt(text))
        }
        Some(_) => problem,
        None if names_view(value) => problem,
        None => format!("must be a number, an expression in quotes, or \"{FREE}\""),
    })
}

/// A name as TOML has it for a key.
fn key_of(name: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if !name.is_empty() && name.chars().all(is_bare) {
        excerpt(name)
    } else {
        format!("\"{}\"", excerpt(name))
    }
}
