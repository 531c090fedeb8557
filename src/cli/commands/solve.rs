//! `membranes solve`.

mod folder;
mod report;

use std::sync::Arc;
use std::time::Instant;

use folder::{claim, reject, too_late};
use report::table;

use super::solution::write_solution;
use crate::action::{PairSolution, Rejected};
use crate::cli::args::SolveArguments;
use crate::cli::case::CaseFile;
use crate::cli::failure::Failure;
use crate::cli::run::clock::Clock;
use crate::cli::run::files::{DUAL, FLUX, MEMBRANES, MESH, Part, RIM, SOLUTION, SUMMARY};
use crate::cli::run::folder::{Folder, Results};
use crate::cli::run::pictures::Pictures;
use crate::cli::run::progress::Progress;
use crate::cli::run::setup::{Setup, options, solver, too_early};
use crate::cli::run::watch::Watch;
use crate::cli::terminal::print;
use crate::discretization::{Discretization, PairDiscretization};
use crate::fem::element_loads;
use crate::flux::{Reconstruction, Reconstructor};
use crate::mesh::{DualMesh, SubTriangulation};
use crate::output::{Seconds, Summary, write_dual_vtu, write_flux_vtu};
use crate::pictures::{MeshPicture, render_mesh};
use crate::study::{AccuracyError, Bounded, solve_bounded};
use crate::text::grouped;

pub(crate) fn run(arguments: &SolveArguments, watch: &Watch) -> Result<(), Failure> {
    let clock = Clock::new(arguments.time_limit);
    clock.watch(watch, too_early(&arguments.case.path));
    let pictures = Pictures::new(&arguments.pictures, clock);
    let progress = Progress::new(arguments.case.quiet);
    let mut setup = Setup::new(&arguments.case, &progress)?;
    override_settings(&mut setup, arguments, &clock);
    setup.check_memory(setup.solving(setup.case.solver.name))?;
    if arguments.dual && setup.case.pair().is_none() {
        return Err(Failure::Input(format!("{}: --dual is for a pair so far: leave it out", setup.name)));
    }
    let (d, seconds) = setup.discretize(&progress)?;
    let folder = claim(&setup, arguments, &clock, watch)?;

    let d = Arc::new(d);
    let result = solve(&setup, &d, seconds, &clock, (&folder, watch), &progress);
    watch.lift();
    match result {
        Ok(bounded) => {
            progress.stage("writing the results");
            let polish = bounded.solution.statistics().polish;
            let summary =
                write_results(&setup, &d, bounded, seconds, (&folder, &clock, &pictures), arguments.dual)?;
            drop(progress);
            if !arguments.case.quiet {
                let unloaded = (1..=d.membranes()).all(|i| d.load(i).iter().all(|&load| load == 0.0));
                let files = files(&pictures, arguments.dual);
                let table = table(&summary, polish, unloaded, folder.path(), files);
                print(&(table + &setup.notes))?;
            }
            Ok(())
        }
        Err(AccuracyError::Rejected(rejected, tolerance)) => {
            let summary = Summary::new(&setup.case.title, &d, tolerance, Err(&rejected), seconds, None)
                .with_unused_groups(&setup.groups);
            Err(reject(&setup.name, &folder, &summary, &rejected))
        }
        Err(error) => Err(Failure::NotCertified(format!("{}: {error}", setup.name))),
    }
}

/// Solves, and bounds the error, in the time that there is.
fn solve(
    setup: &Setup,
    d: &Discretization,
    seconds: Seconds,
    clock: &Clock,
    (folder, watch): (&Folder, &Watch),
    progress: &Progress,
) -> Result<Bounded, AccuracyError> {
    let settings = &setup.case.solver;
    let unknowns = grouped(d.unknowns());
    progress.stage(format!("{} solves for {unknowns} unknowns", settings.name.as_str()));
    let summary = |rejected: &Rejected| {
        let tolerance = settings.tolerance.or_default();
        Summary::new(&setup.case.title, d, tolerance, Err(rejected), seconds, None)
    };
    let give_up = Arc::new(too_late(setup, folder, summary));
    let of_run = Arc::clone(&give_up);
    clock.watch(watch, move || of_run());
    let mut solver = watch.over(solver(settings.name), move || give_up());
    let domain = setup.case.domain();
    solve_bounded(&setup.case.problem, domain, d, &mut *solver, &options(settings), settings.tolerance)
}

/// Writes what is certified: the solution in any case, the rest if there is time.
fn write_results(
    setup: &Setup,
    d: &Arc<Discretization>,
    bounded: Bounded,
    seconds: Seconds,
    (folder, clock, pictures): (&Folder, &Clock, &Pictures),
    dual: bool,
) -> Result<Summary, Failure> {
    let start = Instant::now();
    let title = &setup.case.title;
    let Bounded { solution, bound, tolerance, bound_seconds } = bounded;
    let solution = Arc::new(solution);
    let mut results = folder.results(Part::Solution);
    let mut left_out = Vec::new();
    if let (true, Some(d), Some(solution)) = (dual, d.as_pair(), solution.as_pair()) {
        left_out.extend(write_dual(&mut results, &setup.case, d, solution, (clock, pictures))?);
    }
    let of_bound = bound.as_ref().ok();
    left_out.extend(write_solution(&mut results, &setup.case, (d, &solution), of_bound, pictures)?);
    let output = start.elapsed().as_secs_f64();
    let seconds = Seconds { bound: bound_seconds, output, ..seconds };
    let mut summary = Summary::new(title, d, tolerance, Ok(&solution), seconds, Some(bound.as_ref()))
        .with_unused_groups(&setup.groups);
    summary.left_out = left_out;
    results.write(SUMMARY, |out| summary.write(out))?;
    results.publish()?;
    Ok(summary)
}

/// Arguments come before the case file.
fn override_settings(setup: &mut Setup, arguments: &SolveArguments, clock: &Clock) {
    let settings = &mut setup.case.solver;
    if let Some(name) = arguments.backend {
        settings.name = name;
    }
    if let Some(tolerance) = arguments.tolerance {
        settings.tolerance = tolerance;
    }
    settings.time_limit = clock.of_solver(settings.time_limit);
    settings.polish &= !arguments.no_polish;
}

/// The dual mesh `D_h`, with the action as the piecewise constant that it is, and as Figure 1 of the paper; the fluxes
/// on `S_h`. What there is no time for is returned.
fn write_dual(
    results: &mut Results,
    case: &CaseFile,
    d: &PairDiscretization,
    solution: &PairSolution,
    (clock, pictures): (&Clock, &Pictures),
) -> Result<Vec<&'static str>, Failure> {
    let left_out = |names: &[&'static str]| Ok([names, &pictures.files(MESH)].concat());
    let bad_input = |name: &str, error: &dyn std::fmt::Display| Failure::Input(format!("{name}: {error}"));
    let mesh = d.mesh();
    if !clock.allows(0.0) {
        return left_out(&[DUAL, FLUX]);
    }
    let sub = SubTriangulation::new(mesh).map_err(|error| bad_input(DUAL, &error))?;
    let dual = DualMesh::new(mesh, &sub);
    results.write(DUAL, |out| write_dual_vtu(&dual, solution, out))?;

    if !clock.allows(0.0) {
        return left_out(&[FLUX]);
    }
    let [f1, f2] = case.problem.as_pair().expect("a discretization of the pair belongs to one").load();
    let load = |f| element_loads(mesh, f).map_err(|error| bad_input(FLUX, &error));
    let reconstructor = Reconstructor::new(d, &sub, [load(f1)?, load(f2)?]);
    let fluxes = reconstructor.reconstruct(solution.displacement(), Reconstruction::Full);
    results.write(FLUX, |out| write_flux_vtu(&sub, &fluxes, solution, out))?;

    let (title, mesh, contact) = (case.title.clone(), Arc::clone(mesh), solution.contact().to_vec());
    let draw = move || {
        let picture = MeshPicture { title: &title, mesh: &mesh, dual: &dual, contact: Some(&contact) };
        render_mesh(&picture).map_err(|error| error.to_string())
    };
    pictures.write(MESH, draw, |file, bytes| results.write(file, |out| out.write_all(bytes)))
}

/// What is written if there is time.
fn files(pictures: &Pictures, dual: bool) -> Vec<&'static str> {
    let mut files = vec![SOLUTION, RIM, SUMMARY];
    files.extend(pictures.files(MEMBRANES));
    if dual {
        files.extend([DUAL, FLUX]);
        files.extend(pictures.files(MESH));
    }
    files
}
