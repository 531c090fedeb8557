//! `membranes adapt`.

use std::io::{self, BufReader};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use super::solution::{A_SOLUTION, left_out_line, write_solution};
use crate::action::ContactSolution;
use crate::cli::args::AdaptArguments;
use crate::cli::case::CaseFile;
use crate::cli::failure::Failure;
use crate::cli::run::clock::Clock;
use crate::cli::run::files::{CHECKPOINT, HISTORY, LEVELS, MEMBRANES, MESH, Part, RIM, SOLUTION, SUMMARY};
use crate::cli::run::folder::{Claim, Folder};
use crate::cli::run::input::{self, Input};
use crate::cli::run::levels::{GOES_ON, KEPT, Levels, MEMORY, TIME, failure, settings, too_late};
use crate::cli::run::memory::{Memory, Work};
use crate::cli::run::pictures::{Begun, Pictures};
use crate::cli::run::progress::Progress;
use crate::cli::run::setup::{Setup, options, solver, too_early};
use crate::cli::run::watch::Watch;
use crate::cli::terminal::{note, print, wrapped};
use crate::discretization::IntegrationRule;
use crate::estimate::DataWarning;
use crate::mesh::{DualMesh, Mesh, MeshError, SubTriangulation};
use crate::output::{Seconds, Summary, read_checkpoint, write_checkpoint};
use crate::pictures::{MeshPicture, RatesPicture, Series, render_rates, render_triangulation};
use crate::problem::Exact;
use crate::study::{AdaptiveLevel, AdaptiveStudy, StudyError, exponent};
use crate::text::grouped;

/// The slope of the best possible rate: the error falls like the root of the number of vertices.
const OPTIMAL: [f64; 1] = [-0.5];

/// How much larger the next mesh is taken to be while only one is known.
const GROWTH: f64 = 2.0;

/// The solution of the last level, the ancestry of the mesh and its bisections come on top of what a solve needs: 2292 bytes a
/// vertex at 1.3 million in place of 890.
const MORE_MEMORY: f64 = 2.6;

/// Seconds that writing the results takes: two pictures, and what grows with the mesh.
const WRITING: f64 = 1.0;
const WRITING_PER_VERTEX: f64 = 4e-6;

/// What the bound of the table is.
const GUARANTEED: &str =
    "bound: of the error in the energy norm, guaranteed up to the quadrature of the loads";

/// And of another stack than the pair.
const OF_STACK: &str = "bound: of the error in the energy norm, guaranteed up to the quadrature of the data, on the polygon of the mesh";

/// Why a run ends.
enum Stop {
    Reached,
    Vertices,
    Time,
    Memory,
    TooSmall(MeshError),
}

pub(crate) fn run(arguments: &AdaptArguments, watch: &Watch) -> Result<(), Failure> {
    let clock = Clock::new(arguments.time_limit);
    clock.watch(watch, too_early(&arguments.case.path));
    let pictures = Pictures::new(&arguments.pictures, clock);
    let progress = Progress::new(arguments.case.quiet);
    let mut setup = Setup::new(&arguments.case, &progress)?;
    if let Some(name) = arguments.backend {
        setup.case.solver.name = name;
    }
    if setup.case.integration != IntegrationRule::Quadrature {
        let problem =
            "`integration` = \"vertices\" leaves the error without a bound that meshes could follow";
        return Err(Failure::Input(format!(
            "{}: {problem}: leave it out, or use `membranes solve`",
            setup.name
        )));
    }
    setup.check_memory(setup.solving(setup.case.solver.name))?;
    check_first_mesh(&setup, arguments.max_vertices)?;
    // Nobody may find a folder of which the run says that nothing was written.
    clock.check(too_early(&arguments.case.path))?;
    let folder = claim(arguments, &setup, watch)?;
    let kept = Levels { folder: &folder, table: LEVELS, picture: HISTORY };
    let mut levels: Vec<AdaptiveLevel> = kept.so_far();
    progress.stage("going on from the last level");
    let (mut study, known) = resumed(&setup, &folder, levels.len())?;
    levels.truncate(known);

    let budget = Budget::new(arguments, clock, &setup);
    let name = setup.name.clone();
    clock.watch(watch, move || too_late(&name));
    let mut seconds = levels.last().map_or(0.0, |last| last.solve_seconds + last.bound_seconds);
    let stop = loop {
        if let Some(stop) = budget.stop(&levels, seconds) {
            break stop;
        }
        let start = Instant::now();
        progress.stage(stage(&levels));
        study.set_time_limit(clock.of_solver(setup.case.solver.time_limit));
        match study.next_level() {
            Ok(level) => levels.push(level),
            Err(StudyError::Mesh(error @ MeshError::TooSmall { .. })) => break Stop::TooSmall(error),
            Err(error) if clock.has_stopped(&error) => break Stop::Time,
            Err(error) => return Err(failure(&setup.name, &error, &setup.node_tags)),
        }
        kept.write(&levels)?;
        if let Some(checkpoint) = study.checkpoint() {
            folder.write(CHECKPOINT, |out| write_checkpoint(&checkpoint, out))?;
        }
        seconds = start.elapsed().as_secs_f64();
    };
    watch.lift();
    progress.stage("writing the results");
    if study.solution().is_none() {
        (study, _) = resumed(&setup, &folder, levels.len())?;
    }
    let left_out = write_results(&folder, &setup, &study, &levels, &pictures)?;
    drop(progress);
    if !arguments.case.quiet {
        let warnings = study.solution().map_or(&[][..], |(_, bound)| &bound.warnings);
        let mut files = files(&pictures);
        files.retain(|name| !left_out.contains(name));
        let guaranteed = if setup.case.pair().is_some() { GUARANTEED } else { OF_STACK };
        let of_files = (folder.path(), files.as_slice());
        let table = table(&setup.case.title, &levels, (guaranteed, warnings), of_files, &left_out);
        print(&(table + &setup.notes))?;
    }
    verdict(&setup.name, arguments, &stop, &levels)
}

/// Refuses a budget that the first mesh exceeds already.
fn check_first_mesh(setup: &Setup, most: usize) -> Result<(), Failure> {
    let first = setup.family.mesh().points().len();
    if first <= most {
        return Ok(());
    }
    let [first, most] = [first, most].map(grouped);
    let problem = format!("the first mesh has {first} vertices, above --max-vertices {most}");
    Err(Failure::Input(format!("{}: {problem}: allow more, or make it coarser", setup.name)))
}

/// The folder: levels of other settings stay, and the solution of `solve` for the same case gives way to a better one.
fn claim(arguments: &AdaptArguments, setup: &Setup, watch: &Watch) -> Result<Folder, Failure> {
    let path = arguments.output.folder(&arguments.case.path);
    let claim = |part, settings| Claim {
        case: &setup.id,
        part,
        settings,
        overwrite: arguments.output.overwrite,
        says: KEPT,
    };
    Folder::claim(&path, &claim(Part::Adapt, settings(setup)), watch)?;
    Folder::claim(&path, &claim(Part::Solution, A_SOLUTION.into()), watch)
}

fn study(setup: &Setup) -> AdaptiveStudy {
    let CaseFile { problem, exact, solver: settings, .. } = &setup.case;
    AdaptiveStudy::new(
        problem.clone(),
        setup.case.domain().cloned(),
        exact.as_ref().and_then(Exact::pair).cloned(),
        setup.family.mesh().clone(),
        solver(settings.name),
        options(settings),
        settings.tolerance,
    )
}

/// The study at the last of `levels` known levels that its checkpoint belongs to, and how many levels that are.
fn resumed(setup: &Setup, folder: &Folder, levels: usize) -> Result<(AdaptiveStudy, usize), Failure> {
    let mut study = study(setup);
    let path = folder.path().join(CHECKPOINT);
    let file = match input::open(&path, Input::Arrays, setup.memory) {
        Ok(file) => file,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok((study, 0)),
        Err(error) => {
            let remedy = "remove it, or name another folder with --out";
            return Err(Failure::Input(format!("{}: {error}; {remedy}", path.display())));
        }
    };
    // With a checkpoint that is broken or of other levels, the run starts anew.
    let Ok(checkpoint) = read_checkpoint(BufReader::new(file)) else { return Ok((study, 0)) };
    let known = checkpoint.marked.len() + 1;
    let fits = known <= levels
        && study.resume(checkpoint).map_err(|error| failure(&setup.name, &error, &setup.node_tags))?;
    Ok((study, if fits { known } else { 0 }))
}

/// What the run may take.
struct Budget {
    tolerance: f64,
    vertices: f64,
    memory: Memory,
    work: Work,
    clock: Clock,
}

impl Budget {
    fn new(arguments: &AdaptArguments, clock: Clock, setup: &Setup) -> Self {
        Self {
            tolerance: arguments.tolerance,
            vertices: arguments.max_vertices as f64,
            memory: setup.memory,
            work: setup.solving(setup.case.solver.name),
            clock,
        }
    }

    /// Whether to stop, judging from how the levels have grown and how many seconds the last one has taken.
    fn stop(&self, levels: &[AdaptiveLevel], seconds: f64) -> Option<Stop> {
        let last = levels.last()?;
        if last.relative_bound.is_some_and(|relative| relative <= self.tolerance) {
            return Some(Stop::Reached);
        }
        let growth = match levels {
            [.., before, last] => last.vertices as f64 / before.vertices as f64,
            _ => GROWTH,
        };
        let vertices = growth * last.vertices as f64;
        let seconds = growth * seconds + WRITING + WRITING_PER_VERTEX * vertices;
        if vertices > self.vertices {
            Some(Stop::Vertices)
        } else if !self.memory.suffices(self.work, MORE_MEMORY * vertices) {
            Some(Stop::Memory)
        } else if !self.clock.allows(seconds) {
            Some(Stop::Time)
        } else {
            None
        }
    }
}

fn stage(levels: &[AdaptiveLevel]) -> String {
    match levels.last() {
        None => "level 0".into(),
        Some(last) => {
            let vertices = grouped(last.vertices);
            let bound = percent(last.relative_bound);
            format!("level {}, after a bound of {bound} on {vertices} vertices", levels.len())
        }
    }
}

fn percent(relative: Option<f64>) -> String {
    relative.map_or_else(|| "-".into(), |relative| format!("{:.2} %", 100.0 * relative))
}

/// The solution on the last mesh as `membranes solve` writes it, that mesh and the errors as pictures, if there is time. What
/// was left out is returned.
fn write_results(
    folder: &Folder,
    setup: &Setup,
    study: &AdaptiveStudy,
    levels: &[AdaptiveLevel],
    pictures: &Pictures,
) -> Result<Vec<&'static str>, Failure> {
    let case = &setup.case;
    let (Some((solution, bound)), Some(d), Some(last)) =
        (study.solution(), study.discretization(), levels.last())
    else {
        return Ok(Vec::new());
    };
    let mut results = folder.results(Part::Solution);
    let shared = Arc::new(solution.clone());
    let others = [
        begin_mesh(&case.title, study.mesh(), solution, pictures),
        begin_history(&case.title, levels, pictures),
    ];
    let mut left_out = write_solution(&mut results, case, (d, &shared), Some(bound), pictures)?;
    for picture in others {
        left_out.extend(picture.write(|file, bytes| results.write(file, |out| out.write_all(bytes)))?);
    }
    let seconds = Seconds { bound: last.bound_seconds, ..Seconds::default() };
    let mut summary = Summary::new(&case.title, d, last.tolerance, Ok(solution), seconds, Some(Ok(bound)))
        .with_unused_groups(&setup.groups);
    summary.left_out.clone_from(&left_out);
    results.write(SUMMARY, |out| summary.write(out))?;
    results.publish()?;
    Ok(left_out)
}

/// Begins to draw the last mesh with its contact set.
fn begin_mesh(title: &str, mesh: &Arc<Mesh>, solution: &ContactSolution, pictures: &Pictures) -> Begun {
    // A vertex of several gaps touches where one of them is closed.
    let mut contact = vec![false; mesh.points().len()];
    for gap in solution.gaps() {
        contact.iter_mut().zip(gap.contact).for_each(|(any, touches)| *any |= touches);
    }
    let (title, mesh) = (title.to_owned(), Arc::clone(mesh));
    let draw = move || {
        let sub = SubTriangulation::new(&mesh).map_err(|error| error.to_string())?;
        let dual = DualMesh::new(&mesh, &sub);
        let picture = MeshPicture { title: &title, mesh: &mesh, dual: &dual, contact: Some(&contact) };
        render_triangulation(&picture).map_err(|error| error.to_string())
    };
    pictures.begin(MESH, draw)
}

/// Begins to draw the bound, the error and the estimator of all levels.
fn begin_history(title: &str, levels: &[AdaptiveLevel], pictures: &Pictures) -> Begun {
    let (title, levels) = (title.to_owned(), levels.to_vec());
    let draw = move || {
        let bounds = values(&levels, |level| Some(level.bound));
        let errors = values(&levels, |level| level.energy_error);
        let estimates = values(&levels, |level| level.residual_estimator);
        let mut series =
            vec![Series { name: "bound", values: &bounds }, Series { name: "true error", values: &errors }];
        // There is one for pairs only.
        if estimates.iter().any(|value| value.is_finite()) {
            series.push(Series { name: "residual estimator", values: &estimates });
        }
        let picture = render_rates(&RatesPicture {
            title: &title,
            abscissa: "vertices",
            h: &levels.iter().map(|level| level.vertices as f64).collect::<Vec<_>>(),
            series: &series,
            slopes: &OPTIMAL,
        });
        picture.map_err(|error| error.to_string())
    };
    pictures.begin(HISTORY, draw)
}

/// What is not known cannot be drawn.
fn values(levels: &[AdaptiveLevel], of: impl Fn(&AdaptiveLevel) -> Option<f64>) -> Vec<f64> {
    levels.iter().map(|level| of(level).unwrap_or(f64::NAN)).collect()
}

/// What is written if there is time.
fn files(pictures: &Pictures) -> Vec<&'static str> {
    let [membranes, history, mesh] = [MEMBRANES, HISTORY, MESH].map(|picture| pictures.files(picture));
    [vec![SOLUTION, RIM, SUMMARY], membranes, vec![LEVELS], history, mesh].concat()
}

/// The history for the eye.
fn table(
    title: &str,
    levels: &[AdaptiveLevel],
    (guaranteed, warnings): (&str, &[DataWarning]),
    (folder, files): (&Path, &[&str]),
    left_out: &[&str],
) -> String {
    let mut text = wrapped(title, 2);
    text += "\n  vertices    h min     bound  relative  effectivity  iterations  seconds\n";
    for level in levels {
        let effectivity = level.effectivity().map_or_else(|| "-".into(), |index| format!("{index:.2}"));
        text += &format!(
            "{:>10} {:>8.1e} {:>9.2e} {:>9} {effectivity:>12} {:>11} {:>8.2}\n",
            grouped(level.vertices),
            level.h_min,
            level.bound,
            percent(level.relative_bound),
            grouped(level.iterations),
            level.solve_seconds + level.bound_seconds,
        );
    }
    // The first meshes may be too coarse to see anything of the solution.
    let later = &levels[levels.len() / 2..];
    if let Some(slope) = exponent(later.iter().map(|level| [level.vertices as f64, level.bound])) {
        text += &note(&format!("the bound falls like vertices^{slope:.2} (later half; -0.50 is the best)"));
    }
    text += &note(guaranteed);
    warnings.iter().for_each(|warning| text += &note(&format!("warning: {warning}")));
    if !left_out.is_empty() {
        text += &note(&format!("left out: {}", left_out_line(left_out)));
    }
    let files = files.join(", ");
    text + &note(&format!("files: {}/{{{files}}}", folder.display()))
}

fn verdict(
    name: &str,
    arguments: &AdaptArguments,
    stop: &Stop,
    levels: &[AdaptiveLevel],
) -> Result<(), Failure> {
    let why = match stop {
        Stop::Reached => return Ok(()),
        Stop::Vertices => {
            format!(
                "the next mesh would have more than {} vertices (--max-vertices)",
                grouped(arguments.max_vertices)
            )
        }
        Stop::Time => TIME.into(),
        Stop::Memory => MEMORY.into(),
        Stop::TooSmall(error) => error.to_string(),
    };
    let relative = percent(levels.last().and_then(|level| level.relative_bound));
    let goal = percent(Some(arguments.tolerance));
    Err(Failure::NotCertified(format!(
        "{name}: stopped with a relative error of at most {relative}, above {goal}: {why}; {GOES_ON}"
    )))
}
