//! `[[membrane]]` and `[obstacle]`: membranes from the top, between obstacles.

use super::boundary::held;
use super::field::field;
use crate::cli::case::section::Section;
use crate::cli::failure::Failure;
use crate::problem::{ContactProblem, Membrane, ProblemError};

/// The stack of `[[membrane]]` and `[obstacle]`, of which at least one is there.
pub(super) fn stack(
    top: &Section,
    membranes: Option<Vec<Section>>,
    obstacle: Option<Section>,
) -> Result<ContactProblem, Failure> {
    let Some(membranes) = membranes else {
        let problem = "is there, but no membrane: add [[membrane]]";
        return Err(top.misspelt(&["membrane"]).unwrap_or_else(|| top.error("obstacle", problem)));
    };
    let mut stack = ContactProblem::stack();
    for section in membranes {
        stack = stack.membrane(membrane(section)?);
    }
    if let Some(mut section) = obstacle {
        if section.is_empty() {
            let problem = "is empty: add `floor = ...` or `ceiling = ...`, or remove it";
            return Err(top.error("obstacle", problem));
        }
        if let Some(floor) = field(&mut section, "floor")? {
            stack = stack.floor(floor);
        }
        if let Some(ceiling) = field(&mut section, "ceiling")? {
            stack = stack.ceiling(ceiling);
        }
        section.finish()?;
    }
    stack.build().map_err(|error| top.table_error(format!("{}: {error}", table_of(&error))))
}

/// One `[[membrane]]`.
fn membrane(mut section: Section) -> Result<Membrane, Failure> {
    let remedy = "add `tension = ...`, a number, a formula, or one of these for each region";
    let tension = field(&mut section, "tension")?.ok_or_else(|| section.missing("tension", remedy))?;
    let mut membrane = Membrane::new(tension);
    if let Some(load) = field(&mut section, "load")? {
        membrane = membrane.load(load);
    }
    if let Some(stiffness) = field(&mut section, "foundation")? {
        membrane = membrane.foundation(stiffness);
    }
    membrane = held(&mut section, membrane)?;
    if section.flag("pressed")? == Some(true) {
        membrane = membrane.pressed();
    }
    section.finish()?;
    Ok(membrane)
}

/// The table that an error is about.
fn table_of(error: &ProblemError) -> String {
    match *error {
        ProblemError::Tension { membrane, .. }
        | ProblemError::Load { membrane, .. }
        | ProblemError::Foundation { membrane, .. }
        | ProblemError::NotFinite { membrane: Some(membrane), .. } => format!("membrane[{membrane}]"),
        ProblemError::NotFinite { membrane: None, .. } => "[obstacle]".into(),
        ProblemError::NoMembrane | ProblemError::Height { .. } => "[[membrane]]".into(),
    }
}
