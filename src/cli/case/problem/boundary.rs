//! `height` and `traction`: how a membrane is held on the boundary.

use std::collections::BTreeMap;

use toml::Value;

use super::field::{ByName, datum, function, names_view};
use crate::cli::case::section::Section;
use crate::cli::failure::Failure;
use crate::problem::{Membrane, Support};
use crate::text::{excerpt, meant};

/// The height where nothing holds the membrane.
const FREE: &str = "free";

/// The membrane, held as the keys `height` and `traction` say.
pub(super) fn held(section: &mut Section, mut membrane: Membrane) -> Result<Membrane, Failure> {
    let mut supports = Supports::read(section)?;
    supports.pull(section)?;
    membrane.parts = supports.curves.into_iter().collect();
    membrane.elsewhere = supports.elsewhere;
    Ok(membrane)
}

/// How a membrane is held on each curve that is named, and on the rest of the boundary.
struct Supports {
    curves: BTreeMap<String, Support>,
    elsewhere: Support,
}

impl Supports {
    /// What `height` says; what is not named is at height zero.
    fn read(section: &mut Section) -> Result<Self, Failure> {
        let height = ByName::read(section, "height", "curve", &support)?;
        let (curves, elsewhere) = height.map_or_else(Default::default, |by| (by.parts, by.elsewhere));
        Ok(Self { curves, elsewhere: elsewhere.unwrap_or_else(|| Support::Fixed(0.0.into())) })
    }

    /// Adds what `traction` says; a free curve that is not named is not pulled.
    fn pull(&mut self, section: &mut Section) -> Result<(), Failure> {
        let Some(traction) = ByName::read(section, "traction", "curve", &function)? else { return Ok(()) };
        if let Some(everywhere) = traction.elsewhere {
            let unnamed = self.curves.iter_mut().filter(|(name, _)| !traction.parts.contains_key(*name));
            let mut pulled = false;
            for support in unnamed.map(|(_, support)| support).chain([&mut self.elsewhere]) {
                if let Support::Free { traction } = support {
                    *traction = everywhere.clone();
                    pulled = true;
                }
            }
            if !pulled {
                let further = if traction.parts.is_empty() { "" } else { "further " };
                let remedy = "free one by `height = { name = \"free\" }`, or remove this";
                return Err(section.error("traction", format!("finds no {further}free curve: {remedy}")));
            }
        }
        for (name, traction) in traction.parts {
            let support = self.curves.get(&name).unwrap_or(&self.elsewhere);
            if !matches!(support, Support::Free { .. }) {
                let remedy = format!("free it by `height = {{ {} = \"{FREE}\" }}`", key_of(&name));
                return Err(section
                    .error(&format!("traction.{name}"), format!("acts on a curve that is held: {remedy}")));
            }
            self.curves.insert(name, Support::Free { traction });
        }
        Ok(())
    }
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
