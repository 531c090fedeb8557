//! A solution as files: of `solve`, and of the last level of `adapt`.

use std::sync::Arc;

use crate::action::{ContactSolution, Rim};
use crate::cli::case::{CaseFile, MeshSource};
use crate::cli::failure::Failure;
use crate::cli::run::files::{MEMBRANES, RIM, SOLUTION};
use crate::cli::run::folder::Results;
use crate::cli::run::pictures::Pictures;
use crate::discretization::Discretization;
use crate::estimate::ErrorBound;
use crate::mesh::Mesh;
use crate::output::{write_rim_vtp, write_stack_vtu, write_vtu};
use crate::parallel::join;
use crate::pictures::Drawing;
use crate::pictures::membranes::{self, Picture};
use crate::pictures::stack::{self, StackPicture};

/// The settings of a folder that holds one. Another mesh, solver, or tolerance for the same case takes the place of the one before.
pub(super) const A_SOLUTION: &str = "a solution";

/// Writes `solution.vtu`, `rim.vtp`, and the picture of the membranes, drawn meanwhile, if there is time. What was left out is
/// returned.
pub(super) fn write_solution(
    results: &mut Results,
    case: &CaseFile,
    (d, solution): (&Arc<Discretization>, &Arc<ContactSolution>),
    bound: Option<&ErrorBound>,
    pictures: &Pictures,
) -> Result<Vec<&'static str>, Failure> {
    let picture = pictures.begin(MEMBRANES, {
        let (title, d, solution) = (case.title.clone(), Arc::clone(d), Arc::clone(solution));
        move || draw(&title, &d, &solution)
    });
    // The names of a mesh file are its author's; those of generators are known.
    let groups = matches!(case.mesh, MeshSource::File(_));
    let write = || match (&**d, &**solution) {
        (Discretization::Stack(d), ContactSolution::Stack(solution)) => {
            results.write(SOLUTION, |out| write_stack_vtu(d, solution, bound, groups, out))
        }
        (d, ContactSolution::Pair(solution)) => {
            let bound = bound.expect("a pair has a bound");
            results.write(SOLUTION, |out| write_vtu(d.mesh(), solution, bound, out))
        }
        _ => unreachable!("the solution is one of its discretization"),
    };
    let (written, rims) = join(write, || rims(d.mesh(), solution));
    written?;
    results.write(RIM, |out| write_rim_vtp(rims.iter().map(|(gap, rim)| (*gap, rim)), out))?;
    picture.write(|file, bytes| results.write(file, |out| out.write_all(bytes)))
}

/// The rims of all gaps, with their numbers.
fn rims(mesh: &Mesh, solution: &ContactSolution) -> Vec<(usize, Rim)> {
    match solution {
        ContactSolution::Pair(solution) => vec![(1, Rim::new(mesh, &solution.gap(), solution.contact()))],
        ContactSolution::Stack(solution) => {
            let gaps = solution.gaps().iter();
            gaps.map(|gap| (gap.number, Rim::new(mesh, &gap.gap, &gap.contact))).collect()
        }
    }
}

fn draw(title: &str, d: &Discretization, solution: &ContactSolution) -> Result<Drawing, String> {
    match (d, solution) {
        (Discretization::Stack(d), ContactSolution::Stack(solution)) => {
            stack::render(&StackPicture::of(title, d, solution)).map_err(|error| error.to_string())
        }
        (d, ContactSolution::Pair(solution)) => {
            membranes::render(&Picture::of(title, d.mesh(), solution)).map_err(|error| error.to_string())
        }
        _ => unreachable!("the solution is one of its discretization"),
    }
}

/// What to say of files that were left out.
pub(super) fn left_out_line(names: &[&str]) -> String {
    if names.is_empty() {
        String::new()
    } else {
        format!("{}: no time was left (--time-limit)", names.join(", "))
    }
}
