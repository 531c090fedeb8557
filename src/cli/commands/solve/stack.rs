//! `membranes solve` for another stack than the paper's pair.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use super::folder::{claim, reject, too_late};
use super::report::{certified_line, mesh_line, polish_line, solver_line};
use crate::action::{Rejected, StackSolution, certify_stack};
use crate::cli::args::SolveArguments;
use crate::cli::case::MeshSource;
use crate::cli::commands::solution::left_out_line;
use crate::cli::failure::Failure;
use crate::cli::run::clock::Clock;
use crate::cli::run::files::{MEMBRANES, Part, SOLUTION, SUMMARY};
use crate::cli::run::folder::Folder;
use crate::cli::run::pictures::Pictures;
use crate::cli::run::progress::Progress;
use crate::cli::run::setup::{Setup, options, stack_solver};
use crate::cli::run::watch::Watch;
use crate::cli::terminal::{fields, fixed, print, wrapped};
use crate::discretization::StackDiscretization;
use crate::output::{ContactSummary, Seconds, Summary, write_stack_vtu};
use crate::pictures::stack::{StackPicture, render};
use crate::solver::PolishReport;
use crate::text::grouped;

pub(super) fn run(
    setup: &Setup,
    arguments: &SolveArguments,
    (clock, watch, pictures): (&Clock, &Watch, &Pictures),
    progress: Progress,
) -> Result<(), Failure> {
    let settings = &setup.case.solver;
    let solver = stack_solver(settings.name, &setup.case.problem)
        .map_err(|error| Failure::Input(format!("{}: {error}", setup.name)))?;
    if arguments.dual {
        return Err(Failure::Input(format!("{}: --dual is for a pair so far: leave it out", setup.name)));
    }
    let (d, seconds) = setup.discretize_stack(&progress)?;
    let folder = claim(setup, arguments, clock, watch)?;
    progress.stage(format!("{} solves for {} unknowns", settings.name.as_str(), grouped(d.unknowns())));
    let give_up = Arc::new(too_late(setup, &folder, |rejected| summary(setup, &d, Err(rejected), seconds)));
    let of_run = Arc::clone(&give_up);
    clock.watch(watch, move || of_run());
    let mut solver = watch.over_stack(solver, move || give_up());
    let candidate = solver
        .solve_stack(&d, &options(settings))
        .map_err(|error| Failure::NotCertified(format!("{}: {error}", setup.name)))?;
    watch.lift();
    let tolerance = settings.tolerance.or_default();
    let solution = certify_stack(&d, candidate, tolerance).map_err(|rejected| {
        let summary = summary(setup, &d, Err(&rejected), seconds);
        reject(&setup.name, &folder, &summary, &rejected)
    })?;
    progress.stage("writing the results");
    let (d, solution) = (Arc::new(d), Arc::new(solution));
    let summary = write_results(setup, &d, &solution, seconds, (&folder, pictures))?;
    drop(progress);
    if !arguments.case.quiet {
        let table = table(&summary, solution.statistics().polish, folder.path(), pictures);
        print(&(table + &setup.notes))?;
    }
    Ok(())
}

fn summary(
    setup: &Setup,
    d: &StackDiscretization,
    result: Result<&StackSolution, &Rejected>,
    seconds: Seconds,
) -> Summary {
    let tolerance = setup.case.solver.tolerance.or_default();
    Summary::of_stack(&setup.case.title, d, tolerance, result, seconds).with_unused_groups(&setup.groups)
}

fn write_results(
    setup: &Setup,
    d: &Arc<StackDiscretization>,
    solution: &Arc<StackSolution>,
    seconds: Seconds,
    (folder, pictures): (&Folder, &Pictures),
) -> Result<Summary, Failure> {
    let start = Instant::now();
    let mut results = folder.results(Part::Solution);
    // The names of a mesh file are its author's; those of generators are known.
    let groups = matches!(setup.case.mesh, MeshSource::File(_));
    results.write(SOLUTION, |out| write_stack_vtu(d, solution, groups, out))?;
    let (title, of_picture, drawn) = (setup.case.title.clone(), Arc::clone(d), Arc::clone(solution));
    let draw = move || {
        let picture = StackPicture::of(&title, &of_picture, &drawn);
        render(&picture).map_err(|error| error.to_string())
    };
    let left_out =
        pictures.write(MEMBRANES, draw, |file, bytes| results.write(file, |out| out.write_all(bytes)))?;
    let seconds = Seconds { output: start.elapsed().as_secs_f64(), ..seconds };
    let summary = Summary { left_out, ..summary(setup, d, Ok(solution), seconds) };
    results.write(SUMMARY, |out| summary.write(out))?;
    results.publish()?;
    Ok(summary)
}

/// The summary for the eye.
fn table(summary: &Summary, polish: Option<PolishReport>, folder: &Path, pictures: &Pictures) -> String {
    let mut files = [vec![SOLUTION, SUMMARY], pictures.files(MEMBRANES)].concat();
    files.retain(|name| !summary.left_out.contains(name));
    let seconds = &summary.seconds;
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| fixed(value, 8));
    let contacts = summary.contacts.as_deref().unwrap_or_default();
    let several = contacts.len() > 1;
    let contact = |contact: &ContactSummary| {
        let gap = if several { format!("gap {}: ", contact.gap) } else { String::new() };
        format!(
            "{gap}{} vertices, area {}, total force {}",
            grouped(contact.contact_vertices),
            fixed(contact.contact_area, 6),
            fixed(contact.total_force, 8)
        )
    };
    let reactions: Vec<String> =
        summary.reactions.iter().flatten().map(|&reaction| fixed(reaction, 6)).collect();
    let rows = [
        ("mesh", mesh_line(summary)),
        ("membranes", format!("{}, {} unknowns", summary.membranes.unwrap_or(0), grouped(summary.unknowns))),
        ("solver", solver_line(summary)),
        ("chosen", summary.choice.clone().unwrap_or_default()),
        ("polish", polish.map_or_else(String::new, polish_line)),
        ("certified", certified_line(summary)),
        ("error", summary.no_error_bound.unwrap_or_default().into()),
        ("energy", number(summary.energy)),
        ("contact", contacts.iter().map(contact).collect::<Vec<_>>().join("\n")),
        ("supports", reactions.join(", ")),
        (
            "all forces",
            summary.force_imbalance.map_or_else(String::new, |left| format!("balanced up to {left:.1e}")),
        ),
        (
            "seconds",
            format!(
                "mesh {:.2}, assembly {:.2}, solve {:.2}, output {:.2}",
                seconds.mesh,
                seconds.assembly,
                seconds.setup + seconds.solve,
                seconds.output
            ),
        ),
        ("left out", left_out_line(&summary.left_out)),
        ("files", format!("{}/{{{}}}", folder.display(), files.join(", "))),
    ];
    format!("{}\n{}", wrapped(&summary.title, 2), fields(&rows))
}
