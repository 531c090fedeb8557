//! `membranes converge`.

use std::path::Path;

use super::Failure;
use super::args::ConvergeArguments;
use super::case_file::BackendName;
use super::clock::Clock;
use super::levels::{GOES_ON, KEPT, Levels, MEMORY, TIME, failure, origin};
use super::memory::Memory;
use super::pictures::Pictures;
use super::progress::Progress;
use super::setup::{Setup, make_folder, options, solver, write_file};
use super::terminal::{grouped, print};
use super::watch::Watch;
#[cfg(feature = "pictures")]
use crate::pictures::{RatesPicture, Series, render_rates};
use crate::study::{ConvergenceStudy, LevelErrors, MEASURES, fitted_rate, markdown, rate};

const LEVELS: &str = "summary.csv";
const TABLE: &str = "convergence.md";
/// The name of the picture, without the ending of its format.
const PICTURE: &str = "convergence";
/// The slopes to compare with: those of the theory, and that of a discontinuous action in L2.
#[cfg(feature = "pictures")]
const SLOPES: [f64; 4] = [0.5, 1.0, 1.5, 2.0];
/// What the levels belong to.
const ORIGIN: &str = "converge.toml";

/// Each refinement makes four times as many triangles, and our solvers need time in proportion.
const GROWTH: f64 = 4.0;

pub(super) fn run(arguments: &ConvergeArguments, watch: &Watch) -> Result<(), Failure> {
    let clock = Clock::new(arguments.time_limit);
    let progress = Progress::new(arguments.case.quiet);
    let pictures = Pictures::new(&arguments.pictures)?;
    let mut setup = Setup::new(&arguments.case, &progress)?;
    let Some(exact) = setup.case.exact.take() else {
        let remedy =
            "give `case = \"...\"` in place of [membranes] and [domain]; `membranes cases` lists them";
        return Err(Failure::Input(format!("{}: errors need a known solution: {remedy}", setup.name)));
    };
    if let Some(backend) = arguments.backend {
        setup.case.solver.backend = backend;
    }
    let backend = setup.case.solver.backend;
    setup.check_memory(backend)?;
    let folder = arguments.case.output_folder(arguments.out.as_ref());
    make_folder(&folder, watch, KEPT)?;
    let kept = Levels { folder: &folder, table: LEVELS, origin: ORIGIN };
    let origin = origin(&arguments.case, backend, &setup.text);
    let mut levels: Vec<LevelErrors> = kept.so_far(&origin)?;
    levels.truncate(arguments.levels);

    let settings = &setup.case.solver;
    let solver = solver(backend);
    let mut study = ConvergenceStudy::new(exact, setup.family, solver, options(settings), settings.tolerance)
        .map_err(|error| failure(&setup.name, &error))?;
    clock.watch(watch, &setup.name);
    let limits = Limits {
        levels: arguments.levels,
        clock,
        memory: setup.memory,
        backend,
        time_limit: settings.time_limit,
    };
    let stop = add_levels(&setup.name, &mut study, &mut levels, &limits, &kept, &progress)?;
    watch.lift();
    #[cfg(feature = "pictures")]
    write_picture(&folder, &setup.case.title, &levels, &pictures)?;
    drop(progress);
    if !arguments.case.quiet {
        print(&table(&setup.case.title, &levels, &folder, &pictures))?;
    }
    stop.map_or(Ok(()), |why| {
        let (done, of) = (levels.len(), arguments.levels);
        Err(Failure::NotCertified(format!(
            "{}: stopped after {done} of {of} levels: {why}; {GOES_ON}",
            setup.name
        )))
    })
}

/// What the run may take.
struct Limits {
    levels: usize,
    clock: Clock,
    memory: Memory,
    backend: BackendName,
    /// Seconds of each solve.
    time_limit: Option<f64>,
}

impl Limits {
    /// Why not to begin the level after `last`, judging from that one.
    fn stop(&self, last: &LevelErrors) -> Option<&'static str> {
        if !self.clock.allows(GROWTH * (last.solve_seconds + last.norm_seconds)) {
            Some(TIME)
        } else if !self.memory.suffices(self.backend, GROWTH * last.vertices as f64) {
            Some(MEMORY)
        } else {
            None
        }
    }
}

/// Adds levels to the known ones until there are as many as asked for, or says why there are fewer.
fn add_levels(
    name: &str,
    study: &mut ConvergenceStudy,
    levels: &mut Vec<LevelErrors>,
    limits: &Limits,
    kept: &Levels,
    progress: &Progress,
) -> Result<Option<&'static str>, Failure> {
    let known = levels.len();
    if known == limits.levels {
        return Ok(None);
    }
    progress.steps(limits.levels);
    for level in 0..limits.levels {
        progress.stage(format!("level {} of {}", level + 1, limits.levels));
        if let Some(why) = level.checked_sub(1).and_then(|last| limits.stop(&levels[last])) {
            return Ok(Some(why));
        }
        study.set_time_limit(limits.clock.of_solver(limits.time_limit));
        let solved = if level < known {
            study.skip_level()
        } else {
            study.next_level().map(|errors| levels.push(errors))
        };
        match solved {
            Err(error) if limits.clock.has_stopped(&error) => return Ok(Some(TIME)),
            solved => solved.map_err(|error| failure(name, &error))?,
        }
        if level >= known {
            kept.write(levels)?;
            write_file(&kept.folder.join(TABLE), |out| out.write_all(markdown(levels).as_bytes()))?;
        }
        progress.step();
    }
    Ok(None)
}

/// The errors against the mesh size.
#[cfg(feature = "pictures")]
fn write_picture(
    folder: &Path,
    title: &str,
    levels: &[LevelErrors],
    pictures: &Pictures,
) -> Result<(), Failure> {
    let h: Vec<f64> = levels.iter().map(|level| level.h).collect();
    let values: Vec<Vec<f64>> =
        MEASURES.iter().map(|measure| levels.iter().map(measure.of).collect()).collect();
    let names = MEASURES.map(|measure| typeset(measure.name));
    let series: Vec<Series> =
        names.iter().zip(&values).map(|(name, values)| Series { name, values }).collect();
    let picture = RatesPicture { title, abscissa: "h", h: &h, series: &series, slopes: &SLOPES };
    let draw = || render_rates(&picture).map_err(|error| error.to_string());
    pictures.write(PICTURE, draw, |file, write| write_file(&folder.join(file), write))
}

/// The name of a measure as a paper has it.
#[cfg(feature = "pictures")]
fn typeset(name: &str) -> String {
    name.replace("lambda", "λ").replace("H^-1", "H⁻¹").replace("L2", "L²").replace("H1", "H¹")
}

/// The errors with their rates, for the eye.
fn table(title: &str, levels: &[LevelErrors], folder: &Path, pictures: &Pictures) -> String {
    let mut text = format!("{title}\n  vertices");
    for measure in MEASURES {
        text += &format!(" {:>8}", shortened(measure.name));
    }
    text += " effectiv\n";
    for (k, level) in levels.iter().enumerate() {
        text += &format!("{:>10}", grouped(level.vertices));
        for measure in MEASURES {
            text += &format!(" {:>8.2e}", (measure.of)(level));
        }
        text += &format!(" {:>8.2}\n", level.effectivity());
        if k > 0 {
            text += &format!("{:>10}", "rate");
            for measure in MEASURES {
                text += &format!(" {:>8}", rate_text(rate(measure, &levels[k - 1], level)));
            }
            text.push('\n');
        }
    }
    if levels.len() > 2 {
        text += &format!("{:>10}", "all levels");
        for measure in MEASURES {
            text += &format!(" {:>8}", rate_text(fitted_rate(measure, levels)));
        }
        text.push('\n');
    }
    let mut files = vec![LEVELS.to_owned(), TABLE.to_owned()];
    files.extend(pictures.files(PICTURE));
    text + &format!("  files: {}/{{{}}}\n", folder.display(), files.join(", "))
}

fn rate_text(rate: Option<f64>) -> String {
    rate.map_or_else(|| "-".into(), |rate| format!("{rate:.2}"))
}

/// A heading that fits into a column.
fn shortened(name: &str) -> String {
    let name = name.replace("lambda in ", "lam ").replace("H^-1", "H-1").replace("u at nodes", "nodes");
    name.replace("contact area", "area")
}
