//! `membranes converge`.

use std::path::Path;

use crate::cli::args::ConvergeArguments;
use crate::cli::case::BackendName;
use crate::cli::failure::Failure;
use crate::cli::run::clock::Clock;
use crate::cli::run::levels::{GOES_ON, KEPT, Levels, MEMORY, TIME, failure, origin};
use crate::cli::run::memory::Memory;
use crate::cli::run::progress::Progress;
use crate::cli::run::setup::{Setup, make_folder, options, solver, write_file};
use crate::cli::run::watch::Watch;
use crate::cli::terminal::{grouped, print};
use crate::pictures::{RatesPicture, Series, render_rates};
use crate::study::{ConvergenceStudy, LevelErrors, MEASURES, fitted_rate, markdown, rate};

const LEVELS: &str = "summary.csv";
const TABLE: &str = "convergence.md";
const PICTURE: &str = "convergence.png";
/// The slopes to compare with: those of the theory, and that of a discontinuous action in L2.
const SLOPES: [f64; 4] = [0.5, 1.0, 1.5, 2.0];
/// What the levels belong to.
const ORIGIN: &str = "converge.toml";

/// Each refinement makes four times as many triangles, and our solvers need time in proportion.
const GROWTH: f64 = 4.0;

pub(crate) fn run(arguments: &ConvergeArguments, watch: &Watch) -> Result<(), Failure> {
    let clock = Clock::new(arguments.time_limit);
    let progress = Progress::new(arguments.case.quiet);
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
    write_picture(&folder, &setup.case.title, &levels)?;
    drop(progress);
    if !arguments.case.quiet {
        print(&table(&setup.case.title, &levels, &folder))?;
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
fn write_picture(folder: &Path, title: &str, levels: &[LevelErrors]) -> Result<(), Failure> {
    let h: Vec<f64> = levels.iter().map(|level| level.h).collect();
    let values: Vec<Vec<f64>> =
        MEASURES.iter().map(|measure| levels.iter().map(measure.of).collect()).collect();
    let series: Vec<Series> =
        MEASURES.iter().zip(&values).map(|(measure, values)| Series { name: measure.name, values }).collect();
    let picture = RatesPicture { title, abscissa: "h", h: &h, series: &series, slopes: &SLOPES };
    let png = render_rates(&picture).map_err(|error| Failure::Input(format!("{PICTURE}: {error}")))?;
    write_file(&folder.join(PICTURE), |out| out.write_all(&png))
}

/// The errors with their rates, for the eye.
fn table(title: &str, levels: &[LevelErrors], folder: &Path) -> String {
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
    text + &format!("  files: {}/{{{LEVELS}, {TABLE}, {PICTURE}}}\n", folder.display())
}

fn rate_text(rate: Option<f64>) -> String {
    rate.map_or_else(|| "-".into(), |rate| format!("{rate:.2}"))
}

/// A heading that fits into a column.
fn shortened(name: &str) -> String {
    let name = name.replace("lambda in ", "lam ").replace("H^-1", "H-1").replace("u at nodes", "nodes");
    name.replace("contact area", "area")
}
