//! `membranes solve`.

use std::path::Path;
use std::time::Instant;

use crate::action::{ContactSolution, Rejected};
use crate::cli::args::SolveArguments;
use crate::cli::case::CaseFile;
use crate::cli::failure::Failure;
use crate::cli::run::progress::Progress;
use crate::cli::run::setup::{Results, Setup, make_folder, options, solver};
use crate::cli::run::watch::Watch;
use crate::cli::terminal::{fields, fixed, grouped, print};
use crate::discretization::Discretization;
use crate::estimate::ErrorBound;
use crate::fem::element_loads;
use crate::flux::{Reconstruction, Reconstructor};
use crate::mesh::{DualMesh, SubTriangulation};
use crate::output::{Seconds, Summary, remove, write_dual_vtu, write_flux_vtu, write_vtu};
use crate::pictures::membranes::{Picture, render};
use crate::pictures::{MeshPicture, render_mesh};
use crate::qp::Status;
use crate::solver::{PolishReport, Statistics};
use crate::study::{AccuracyError, Bounded, solve_bounded};

/// The files that hold a solution: present only when it is certified.
pub(crate) const SOLUTION: &str = "solution.vtu";
pub(crate) const PICTURE: &str = "membranes.png";
pub(crate) const SUMMARY: &str = "summary.json";
/// What `--dual` adds.
const DUAL: &str = "dual.vtu";
const MESH_PICTURE: &str = "mesh.png";
const FLUX: &str = "flux.vtu";

/// What an interrupted run has to say.
const UNTOUCHED: &str = "it is as it was";

pub(crate) fn run(arguments: &SolveArguments, watch: &Watch) -> Result<(), Failure> {
    let progress = Progress::new(arguments.case.quiet);
    let mut setup = Setup::new(&arguments.case, &progress)?;
    override_settings(&mut setup, arguments);
    let settings = &setup.case.solver;
    setup.check_memory(settings.backend)?;
    let folder = arguments.case.output_folder(arguments.out.as_ref());
    let (d, seconds) = setup.discretize(&progress)?;
    make_folder(&folder, watch, UNTOUCHED)?;

    progress.stage(format!(
        "{} solves for {} unknowns",
        settings.backend.as_str(),
        grouped(2 * d.interior().len())
    ));
    let options = options(settings);
    let problem = &setup.case.problem;
    let domain = setup.case.domain();
    let mut solver = watch.over(solver(settings.backend), too_late(&setup, &d, &folder, seconds));
    let result = solve_bounded(problem, domain, &d, &mut *solver, &options, settings.tolerance);
    let title = &setup.case.title;

    match result {
        Ok(Bounded { solution, bound, tolerance, bound_seconds }) => {
            progress.stage("writing the results");
            let start = Instant::now();
            let mut results = Results::new(&folder);
            write_solution(&mut results, title, &d, &solution, &bound)?;
            if arguments.dual {
                write_dual(&mut results, &setup.case, &d, &solution)?;
            }
            let output = start.elapsed().as_secs_f64();
            let seconds = Seconds { bound: bound_seconds, output, ..seconds };
            let summary = Summary::new(title, &d, tolerance, Ok(&solution), seconds, Some(&bound));
            results.write(SUMMARY, |out| summary.write(out))?;
            results.publish()?;
            drop(progress);
            if !arguments.case.quiet {
                print(&table(&summary, solution.statistics().polish, &folder, arguments.dual))?;
            }
            Ok(())
        }
        Err(AccuracyError::Rejected(rejected, tolerance)) => {
            let summary = Summary::new(title, &d, tolerance, Err(&rejected), seconds, None);
            Err(reject(&setup.name, &folder, &summary, &rejected))
        }
        Err(error) => Err(Failure::NotCertified(format!("{}: {error}", setup.name))),
    }
}

/// What to do when the solver does not come back in time.
fn too_late(
    setup: &Setup,
    d: &Discretization,
    folder: &Path,
    seconds: Seconds,
) -> impl Fn() -> Failure + Send + Sync + 'static {
    let settings = &setup.case.solver;
    let statistics = Statistics {
        status: Status::TimeLimit,
        solve_seconds: settings.time_limit.unwrap_or_default(),
        ..Statistics::of(settings.backend.as_str())
    };
    let rejected = Rejected::without_result(statistics);
    let tolerance = settings.tolerance.or_default();
    let summary = Summary::new(&setup.case.title, d, tolerance, Err(&rejected), seconds, None);
    let (name, folder) = (setup.name.clone(), folder.to_path_buf());
    move || reject(&name, &folder, &summary, &rejected)
}

/// Writes the summary of a run without a solution, and says why there is none.
fn reject(name: &str, folder: &Path, summary: &Summary, rejected: &Rejected) -> Failure {
    // What an earlier run left is not the solution of this one.
    for file in [SUMMARY, SOLUTION, PICTURE, DUAL, MESH_PICTURE, FLUX] {
        let _ = remove(&folder.join(file));
    }
    let mut results = Results::new(folder);
    let written = results.write(SUMMARY, |out| summary.write(out)).and_then(|()| results.publish());
    if let Err(failure) = written {
        return failure;
    }
    let (status, remedy) = (rejected.statistics.status.as_str(), rejected.remedy());
    Failure::NotCertified(format!("{name}: {rejected} (status {status}); {remedy}"))
}

/// Arguments come before the case file.
fn override_settings(setup: &mut Setup, arguments: &SolveArguments) {
    let settings = &mut setup.case.solver;
    if let Some(backend) = arguments.backend {
        settings.backend = backend;
    }
    if let Some(tolerance) = arguments.tolerance {
        settings.tolerance = tolerance;
    }
    settings.time_limit = arguments.time_limit.or(settings.time_limit);
    settings.polish &= !arguments.no_polish;
}

/// `solution.vtu` and `membranes.png`.
pub(crate) fn write_solution(
    results: &mut Results,
    title: &str,
    d: &Discretization,
    solution: &ContactSolution,
    bound: &ErrorBound,
) -> Result<(), Failure> {
    results.write(SOLUTION, |out| write_vtu(d.mesh(), solution, bound, out))?;
    let picture = Picture::of(title, d.mesh(), solution);
    let png = render(&picture).map_err(|error| Failure::Input(format!("{PICTURE}: {error}")))?;
    results.write(PICTURE, |out| out.write_all(&png))
}

/// The dual mesh `D_h`, with the action as the piecewise constant that it is, and as Figure 1 of the paper; the fluxes
/// on `S_h`.
fn write_dual(
    results: &mut Results,
    case: &CaseFile,
    d: &Discretization,
    solution: &ContactSolution,
) -> Result<(), Failure> {
    let bad_input = |name: &str, error: &dyn std::fmt::Display| Failure::Input(format!("{name}: {error}"));
    let mesh = d.mesh();
    let sub = SubTriangulation::new(mesh).map_err(|error| bad_input(DUAL, &error))?;
    let dual = DualMesh::new(mesh, &sub);
    results.write(DUAL, |out| write_dual_vtu(&dual, solution, out))?;

    let picture = MeshPicture { title: &case.title, mesh, dual: &dual, contact: Some(solution.contact()) };
    let png = render_mesh(&picture).map_err(|error| bad_input(MESH_PICTURE, &error))?;
    results.write(MESH_PICTURE, |out| out.write_all(&png))?;

    let [f1, f2] = case.problem.load();
    let load = |f| element_loads(mesh, f).map_err(|error| bad_input(FLUX, &error));
    let reconstructor = Reconstructor::new(d, &sub, [load(f1)?, load(f2)?]);
    let fluxes = reconstructor.reconstruct(solution.displacement(), Reconstruction::Full);
    results.write(FLUX, |out| write_flux_vtu(&sub, &fluxes, solution, out))
}

/// The summary for the eye.
fn table(summary: &Summary, polish: Option<PolishReport>, folder: &Path, dual: bool) -> String {
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| fixed(value, 8));
    let interior = summary.unknowns / 2;
    let contact = summary.contact_vertices.unwrap_or(0);
    let worst = summary.residuals.as_ref().map_or(f64::NAN, |r| {
        [r.stationarity, r.primal, r.dual_sign, r.complementarity, r.action_mismatch, r.dual_mismatch]
            .into_iter()
            .fold(r.variational_inequality, f64::max)
    });
    let seconds = &summary.seconds;
    let mut files = vec![SOLUTION, SUMMARY, PICTURE];
    if dual {
        files.extend([DUAL, FLUX, MESH_PICTURE]);
    }
    let files = files.join(", ");
    let rows = [
        (
            "mesh",
            format!(
                "{} vertices, {} triangles, least angle {:.1} degrees",
                grouped(summary.vertices),
                grouped(summary.triangles),
                summary.min_angle
            ),
        ),
        ("solver", solver_line(summary)),
        ("chosen", summary.choice.clone().unwrap_or_default()),
        ("polish", polish.map_or_else(String::new, polish_line)),
        (
            "certified",
            format!(
                "largest residual {worst:.1e}{} (tolerance {:.0e})",
                beyond(summary, worst),
                summary.tolerance
            ),
        ),
        ("error", error_line(summary)),
        ("energy", number(summary.energy)),
        (
            "contact",
            format!(
                "{} of {} interior vertices, area {}",
                grouped(contact),
                grouped(interior),
                fixed(summary.contact_area.unwrap_or(0.0), 6)
            ),
        ),
        ("total force", number(summary.total_force)),
        (
            "seconds",
            format!(
                "mesh {:.2}, assembly {:.2}, solve {:.2}, bound {:.2}, output {:.2}",
                seconds.mesh,
                seconds.assembly,
                seconds.setup + seconds.solve,
                seconds.bound,
                seconds.output
            ),
        ),
        ("files", format!("{}/{{{files}}}", folder.display())),
    ];
    let rows: Vec<_> = rows.into_iter().filter(|(_, value)| !value.is_empty()).collect();
    format!("{}\n{}", summary.title, fields(&rows))
}

/// What of a residual that is larger than the tolerance is more than rounding.
fn beyond(summary: &Summary, worst: f64) -> String {
    match summary.residual_beyond_rounding {
        Some(beyond) if worst > summary.tolerance => format!(", {beyond:.1e} beyond rounding"),
        _ => String::new(),
    }
}

fn solver_line(summary: &Summary) -> String {
    let Summary { backend, status, iterations, level_iterations, .. } = summary;
    let levels = level_iterations.len();
    let on_levels = if levels > 1 { format!(" on the finest of {levels} levels") } else { String::new() };
    format!("{backend}: {status} in {iterations} iterations{on_levels}")
}

fn error_line(summary: &Summary) -> String {
    let Some(bound) = summary.error_bound else { return String::new() };
    let relative = match summary.relative_error_bound {
        Some(relative) => format!("{:.2} %, guaranteed", 100.0 * relative),
        None => "over half of it: refine".into(),
    };
    format!("at most {bound:.3e} in the energy norm ({relative})")
}

fn polish_line(polish: PolishReport) -> String {
    let PolishReport { kept, repairs, residual_before, residual_after, .. } = polish;
    let verdict = if kept { "kept" } else { "not kept" };
    let repairs = if repairs == 1 { "1 contact repair".into() } else { format!("{repairs} contact repairs") };
    format!("{verdict}, {repairs}, residual {residual_before:.1e} -> {residual_after:.1e}")
}
