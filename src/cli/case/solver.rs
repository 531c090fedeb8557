//! `[solver]`: which solver, how accurate, how long.

use std::str::FromStr;

use toml::Value;

use super::section::{Section, as_number};
use crate::cli::failure::Failure;
use crate::qp::TimeLimit;
use crate::study::Tolerance;
use crate::text::{Number, excerpt};

/// The table `[solver]`.
#[derive(Debug, Clone, PartialEq)]
pub struct SolverSettings {
    /// Which solver.
    pub name: SolverName,
    /// Largest relative residual, or one that follows the error bound.
    pub tolerance: Tolerance,
    /// Whether to polish.
    pub polish: bool,
    /// Limit of iterations.
    pub max_iterations: Option<usize>,
    /// Limit of time of each solve.
    pub time_limit: Option<TimeLimit>,
}

/// A solver, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolverName {
    /// The interior-point solver Clarabel.
    Clarabel,
    /// The operator-splitting solver OSQP.
    Osqp,
    /// The active set method.
    ActiveSet,
    /// Multigrid.
    Multigrid,
    /// Whichever built-in solver suits the mesh.
    Auto,
}

impl SolverName {
    /// Every name.
    pub const ALL: [Self; 5] = [Self::Auto, Self::Multigrid, Self::ActiveSet, Self::Clarabel, Self::Osqp];

    /// The name in case files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Clarabel => "clarabel",
            Self::Osqp => "osqp",
            Self::ActiveSet => "active-set",
            Self::Multigrid => "multigrid",
            Self::Auto => "auto",
        }
    }

    /// Whether its answers are polished; the others know their contact set.
    pub fn is_polished(self) -> bool {
        matches!(self, Self::Clarabel | Self::Osqp)
    }

    /// Whether this build contains it.
    pub fn is_built(self) -> bool {
        match self {
            Self::Auto | Self::Multigrid | Self::ActiveSet => true,
            Self::Clarabel => cfg!(feature = "clarabel"),
            Self::Osqp => cfg!(feature = "osqp"),
        }
    }
}

impl FromStr for SolverName {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|solver| solver.as_str() == name);
        match known {
            Some(solver) if solver.is_built() => Ok(solver),
            Some(_) => {
                Err(format!("`{name}` is not in this build: build with `cargo build --features {name}`"))
            }
            None => Err(format!(
                "there is no solver `{}`: choose one of {}",
                excerpt(name),
                Self::ALL.map(Self::as_str).join(", ")
            )),
        }
    }
}

/// `[solver]`.
pub(super) fn solver(top: &mut Section) -> Result<SolverSettings, Failure> {
    let mut section = top.section("solver")?;
    // `backend` in case files, of which there are many.
    let name = match section.text("backend")? {
        None => SolverName::Auto,
        Some(name) => name.parse().map_err(|problem: String| {
            section.error("backend", format!("= \"{}\": {problem}", excerpt(&name)))
        })?,
    };
    let tolerance = match section.take("tolerance") {
        None => Tolerance::Fixed(1e-8),
        Some(value) => tolerance(&value).map_err(|problem| section.error("tolerance", problem))?,
    };
    let time_limit = section.number("time_limit")?.map(TimeLimit::from_seconds).transpose();
    let time_limit = time_limit.map_err(|error| section.error("time_limit", format!("= {error}")))?;
    let settings = SolverSettings {
        name,
        tolerance,
        polish: section.flag("polish")?.unwrap_or(true),
        max_iterations: section.count("max_iterations", 1)?,
        time_limit,
    };
    section.finish()?;
    Ok(settings)
}

/// A number, or "auto".
fn tolerance(value: &Value) -> Result<Tolerance, String> {
    if value.as_str() == Some("auto") {
        return Ok(Tolerance::Auto);
    }
    let number = as_number(value).ok_or("must be a number or \"auto\"")?;
    if number > 0.0 && number < 1.0 {
        Ok(Tolerance::Fixed(number))
    } else {
        Err(format!("= {} is out of range: choose between 0 and 1", Number(number)))
    }
}
