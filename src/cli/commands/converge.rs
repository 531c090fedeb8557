//! `membranes converge`.

use std::path::Path;

use super::solution::left_out_line;
use crate::cli::args::ConvergeArguments;
use crate::cli::failure::Failure;
use crate::cli::run::clock::Clock;
use crate::cli::run::files::{ERRORS, ERRORS_TABLE, Part, RATES};
use crate::cli::run::folder::{Claim, Folder};
use crate::cli::run::levels::{GOES_ON, KEPT, Levels, MEMORY, TIME, failure, settings, too_late};
use crate::cli::run::memory::{Memory, Work};
use crate::cli::run::pictures::Pictures;
use crate::cli::run::progress::Progress;
use crate::cli::run::setup::{Setup, check_refinements, options, solver, too_early};
use crate::cli::run::watch::Watch;
use crate::cli::terminal::{note, print, wrapped};
use crate::estimate::DataWarning;
use crate::pictures::{RatesPicture, Series, render_rates};
use crate::problem::Exact;
use crate::qp::TimeLimit;
use crate::study::{
    ConvergenceStudy, LevelErrors, Measure, StackStudy, StudyError, fitted_rate, markdown, measures, rate,
};
use crate::text::grouped;

/// The slopes to compare with: those of the theory, and that of a discontinuous action in L2.
const SLOPES: [f64; 4] = [0.5, 1.0, 1.5, 2.0];

/// Measures of the picture and the first table: those behind them are of the contact set.
const OF_SET: [&str; 2] = ["rim, Hausdorff", "1 - Jaccard"];

const SET: &str = "rim: Hausdorff distance of the rim of the contact set from the exact one; 1 - Jacc(ard): what the two sets do \
                   not share, of what is in one of them; in several gaps, the worst";

const INDEX: &str = "index: the bound of the error in the energy norm, guaranteed up to the quadrature of the loads, over \
                     that error";

/// Each refinement makes four times as many triangles, and the built-in solvers need time in proportion.
const GROWTH: f64 = 4.0;

pub(crate) fn run(arguments: &ConvergeArguments, watch: &Watch) -> Result<(), Failure> {
    let clock = Clock::new(arguments.time_limit);
    clock.watch(watch, too_early(&arguments.case.path));
    let pictures = Pictures::new(&arguments.pictures, clock);
    let progress = Progress::new(arguments.case.quiet);
    let mut setup = Setup::new(&arguments.case, &progress)?;
    let Some(exact) = setup.case.exact.clone() else {
        let remedy =
            "give `case = \"...\"` in place of the membranes and [domain]; `membranes cases` lists them";
        return Err(Failure::Input(format!("{}: errors need a known solution: {remedy}", setup.name)));
    };
    if let Some(name) = arguments.backend {
        setup.case.solver.name = name;
    }
    let work = Work { pair_norms: matches!(exact, Exact::Pair(_)), ..setup.solving(setup.case.solver.name) };
    setup.check_memory(work)?;
    check_refinements(&setup.name, setup.family.mesh().points().len() as f64, arguments.levels - 1)?;
    // Nobody may find a folder of which the run says that nothing was written.
    clock.check(too_early(&arguments.case.path))?;
    let claim = Claim {
        case: &setup.id,
        part: Part::Converge,
        settings: settings(&setup),
        overwrite: arguments.output.overwrite,
        says: KEPT,
    };
    let folder = Folder::claim(&arguments.output.folder(&arguments.case.path), &claim, watch)?;
    let kept = Levels { folder: &folder, table: ERRORS, picture: RATES };
    let mut levels: Vec<LevelErrors> = kept.so_far();
    if !levels.is_empty() {
        // The last run may have been killed before it wrote the last level here, too.
        write_table(&folder, &levels)?;
    }
    levels.truncate(arguments.levels);

    let title = setup.case.title.clone();
    let mut study = Study::new(exact, &setup)?;
    let settings = &setup.case.solver;
    let name = setup.name.clone();
    clock.watch(watch, move || too_late(&name));
    let budget = Budget {
        levels: arguments.levels,
        clock,
        memory: setup.memory,
        work,
        time_limit: settings.time_limit,
    };
    let stop = add_levels(&setup.name, &mut study, &mut levels, &budget, &kept, &progress)?;
    watch.lift();
    // Also where all levels were there before.
    let warnings = levels.last().map_or_else(|| Ok(Vec::new()), |last| study.into_warnings(last));
    let warnings = warnings.map_err(|error| failure(&setup.name, &error, &setup.node_tags))?;
    let left_out = write_picture(&folder, &title, &levels, &pictures)?;
    let drawn = if left_out.is_empty() { pictures.files(RATES) } else { Vec::new() };
    drop(progress);
    if !arguments.case.quiet {
        let table = table(&title, &levels, &warnings, (folder.path(), &drawn), &left_out);
        print(&(table + &setup.notes))?;
    }
    stop.map_or(Ok(()), |why| {
        let (done, of) = (levels.len(), arguments.levels);
        Err(Failure::NotCertified(format!(
            "{}: stopped after {done} of {of} levels: {why}; {GOES_ON}",
            setup.name
        )))
    })
}

/// The study of a pair or of a stack.
enum Study {
    Pair(Box<ConvergenceStudy>),
    Stack(Box<StackStudy>),
}

impl Study {
    fn new(exact: Exact, setup: &Setup) -> Result<Self, Failure> {
        let (settings, family) = (&setup.case.solver, setup.family.clone());
        let of_error = |error: StudyError| failure(&setup.name, &error, &setup.node_tags);
        match exact {
            Exact::Pair(exact) => {
                let solver = solver(settings.name);
                ConvergenceStudy::new(exact, family, solver, options(settings), settings.tolerance)
                    .map(|study| Self::Pair(Box::new(study)))
                    .map_err(of_error)
            }
            Exact::Stack(exact) => StackStudy::new(exact, family, solver(settings.name), options(settings))
                .map(|study| Self::Stack(Box::new(study)))
                .map_err(of_error),
        }
    }

    fn set_time_limit(&mut self, time_limit: Option<TimeLimit>) {
        match self {
            Self::Pair(study) => study.set_time_limit(time_limit),
            Self::Stack(study) => study.set_time_limit(time_limit),
        }
    }

    fn next_level(&mut self) -> Result<LevelErrors, StudyError> {
        match self {
            Self::Pair(study) => study.next_level(),
            Self::Stack(study) => study.next_level(),
        }
    }

    fn skip_level(&mut self) -> Result<(), StudyError> {
        match self {
            Self::Pair(study) => study.skip_level(),
            Self::Stack(study) => study.skip_level(),
        }
    }

    /// What the bound of the last level may not know.
    fn into_warnings(self, level: &LevelErrors) -> Result<Vec<DataWarning>, StudyError> {
        match self {
            Self::Pair(study) => study.into_warnings(level),
            Self::Stack(study) => study.into_warnings(level),
        }
    }
}

/// What the run may take.
struct Budget {
    levels: usize,
    clock: Clock,
    memory: Memory,
    /// What each level is.
    work: Work,
    /// Seconds of each solve.
    time_limit: Option<TimeLimit>,
}

impl Budget {
    /// Why not to begin the level after `last`, judging from that one.
    fn stop(&self, last: &LevelErrors) -> Option<&'static str> {
        if !self.clock.allows(GROWTH * (last.solve_seconds + last.norm_seconds)) {
            Some(TIME)
        } else if !self.memory.suffices(self.work, GROWTH * last.vertices as f64) {
            Some(MEMORY)
        } else {
            None
        }
    }
}

/// Adds levels to the known ones until there are as many as asked for, or says why there are fewer.
fn add_levels(
    name: &str,
    study: &mut Study,
    levels: &mut Vec<LevelErrors>,
    budget: &Budget,
    kept: &Levels,
    progress: &Progress,
) -> Result<Option<&'static str>, Failure> {
    let known = levels.len();
    if known == budget.levels {
        return Ok(None);
    }
    progress.steps(budget.levels);
    for level in 0..budget.levels {
        progress.stage(format!("level {} of {}", level + 1, budget.levels));
        if let Some(why) = level.checked_sub(1).and_then(|last| budget.stop(&levels[last])) {
            return Ok(Some(why));
        }
        study.set_time_limit(budget.clock.of_solver(budget.time_limit));
        let solved = if level < known {
            study.skip_level()
        } else {
            study.next_level().map(|errors| levels.push(errors))
        };
        match solved {
            Err(error) if budget.clock.has_stopped(&error) => return Ok(Some(TIME)),
            solved => solved.map_err(|error| failure(name, &error, &[]))?,
        }
        if level >= known {
            kept.write(levels)?;
            write_table(kept.folder, levels)?;
        }
        progress.step();
    }
    Ok(None)
}

/// The errors with their rates, as a file.
fn write_table(folder: &Folder, levels: &[LevelErrors]) -> Result<(), Failure> {
    folder.write(ERRORS_TABLE, |out| out.write_all(markdown(levels).as_bytes()))
}

/// The errors against the mesh size, if there is time. What was left out is returned.
fn write_picture(
    folder: &Folder,
    title: &str,
    levels: &[LevelErrors],
    pictures: &Pictures,
) -> Result<Vec<&'static str>, Failure> {
    let h: Vec<f64> = levels.iter().map(|level| level.h).collect();
    let drawn = drawn(levels);
    // What is not known on a level has no point there, as a zero.
    let of_measure =
        |measure: &Measure| levels.iter().map(|level| (measure.of)(level).unwrap_or(0.0)).collect();
    let values: Vec<Vec<f64>> = drawn.iter().map(of_measure).collect();
    let title = title.to_owned();
    let draw = move || {
        let names: Vec<String> = drawn.iter().map(|measure| typeset(measure.name)).collect();
        let series: Vec<Series> =
            names.iter().zip(&values).map(|(name, values)| Series { name, values }).collect();
        let picture = RatesPicture { title: &title, abscissa: "h", h: &h, series: &series, slopes: &SLOPES };
        render_rates(&picture).map_err(|error| error.to_string())
    };
    pictures.write(RATES, draw, |file, bytes| folder.write(file, |out| out.write_all(bytes)))
}

/// The measures in the picture: errors of functions, and of the area.
fn drawn(levels: &[LevelErrors]) -> Vec<Measure> {
    measures(levels).into_iter().filter(|measure| !OF_SET.contains(&measure.name)).collect()
}

/// The name of a measure as a paper has it.
fn typeset(name: &str) -> String {
    name.replace("lambda", "λ").replace("H^-1", "H⁻¹").replace("L2", "L²").replace("H1", "H¹")
}

/// The errors with their rates, for the eye.
fn table(
    title: &str,
    levels: &[LevelErrors],
    warnings: &[DataWarning],
    (folder, drawn): (&Path, &[&str]),
    left_out: &[&str],
) -> String {
    let bounded = levels.iter().any(|level| level.bound.is_some());
    let measures = measures(levels);
    let (of_functions, of_set): (Vec<Measure>, Vec<Measure>) =
        measures.into_iter().partition(|measure| !OF_SET.contains(&measure.name));
    let mut text = wrapped(title, 2) + "\n" + &rows(levels, &of_functions, bounded);
    if !of_set.is_empty() {
        text += "\n";
        text += &rows(levels, &of_set, false);
        text += &note(SET);
    }
    if bounded {
        text += &note(INDEX);
    }
    text += &warning_lines(levels, warnings);
    if !left_out.is_empty() {
        text += &note(&format!("left out: {}", left_out_line(left_out)));
    }
    let files = [&[ERRORS, ERRORS_TABLE], drawn].concat().join(", ");
    text + &note(&format!("files: {}/{{{files}}}", folder.display()))
}

/// Some errors with their rates, and the effectivity of the bound.
fn rows(levels: &[LevelErrors], measures: &[Measure], index: bool) -> String {
    let mut text = String::from("  vertices");
    for measure in measures {
        text += &format!(" {:>8}", shortened(measure.name));
    }
    text += if index { "    index\n" } else { "\n" };
    let rates = |rate: &dyn Fn(Measure) -> Option<f64>| -> String {
        measures.iter().map(|&measure| format!(" {:>8}", rate_text(rate(measure)))).collect()
    };
    for (k, level) in levels.iter().enumerate() {
        text += &format!("{:>10}", grouped(level.vertices));
        for measure in measures {
            let error = (measure.of)(level).map_or_else(|| "-".into(), |error| format!("{error:.2e}"));
            text += &format!(" {error:>8}");
        }
        text += &if index { format!(" {:>8}\n", index_text(level.effectivity())) } else { "\n".into() };
        if k > 0 {
            text += &format!("{:>10}{}\n", "rate", rates(&|measure| rate(measure, &levels[k - 1], level)));
        }
    }
    if levels.len() > 2 {
        text += &format!("{:>10}{}\n", "all levels", rates(&|measure| fitted_rate(measure, levels)));
    }
    text
}

/// The loads of which the bound on the finest mesh may know too little.
fn warning_lines(levels: &[LevelErrors], warnings: &[DataWarning]) -> String {
    let vertices = grouped(levels.last().map_or(0, |last| last.vertices));
    let line = |warning| note(&format!("warning, at the finest level ({vertices} vertices): {warning}"));
    warnings.iter().map(line).collect()
}

fn index_text(index: Option<f64>) -> String {
    match index {
        None => "-".into(),
        Some(index) if index < 1e5 => format!("{index:.2}"),
        Some(index) => format!("{index:.1e}"),
    }
}

fn rate_text(rate: Option<f64>) -> String {
    rate.map_or_else(|| "-".into(), |rate| format!("{rate:.2}"))
}

/// A heading that fits into a column.
fn shortened(name: &str) -> String {
    let name = name.replace("lambda in ", "lam ").replace("H^-1", "H-1").replace("u at nodes", "nodes");
    name.replace("contact area", "area").replace("rim, Hausdorff", "rim").replace("1 - Jaccard", "1 - Jacc")
}
