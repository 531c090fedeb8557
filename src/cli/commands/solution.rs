//! A solution as files: of `solve`, and of the last level of `adapt`.

use std::sync::Arc;

use crate::action::PairSolution;
use crate::cli::failure::Failure;
use crate::cli::run::files::{MEMBRANES, SOLUTION};
use crate::cli::run::folder::Results;
use crate::cli::run::pictures::Pictures;
use crate::discretization::PairDiscretization;
use crate::estimate::ErrorBound;
use crate::output::write_vtu;
use crate::pictures::membranes::{Picture, render};

/// The settings of a folder that holds one. Another mesh, solver, or tolerance for the same case takes the place of the one before.
pub(super) const A_SOLUTION: &str = "a solution";

/// Writes `solution.vtu`, and the picture of the membranes if there is time. What was left out is returned.
pub(super) fn write_solution(
    results: &mut Results,
    title: &str,
    d: &PairDiscretization,
    solution: &PairSolution,
    bound: &ErrorBound,
    pictures: &Pictures,
) -> Result<Vec<&'static str>, Failure> {
    results.write(SOLUTION, |out| write_vtu(d.mesh(), solution, bound, out))?;
    let (title, mesh, solution) = (title.to_owned(), Arc::clone(d.mesh()), solution.clone());
    let draw = move || {
        let picture = Picture::of(&title, &mesh, &solution);
        render(&picture).map_err(|error| error.to_string())
    };
    pictures.write(MEMBRANES, draw, |file, bytes| results.write(file, |out| out.write_all(bytes)))
}

/// What to say of files that were left out.
pub(super) fn left_out_line(names: &[&str]) -> String {
    if names.is_empty() {
        String::new()
    } else {
        format!("{}: no time was left (--time-limit)", names.join(", "))
    }
}
