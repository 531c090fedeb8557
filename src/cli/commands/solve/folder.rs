//! The folder of a solve: how it is claimed, and what it gets when there is no solution.

use crate::action::Rejected;
use crate::cli::args::SolveArguments;
use crate::cli::commands::solution::A_SOLUTION;
use crate::cli::failure::Failure;
use crate::cli::run::clock::Clock;
use crate::cli::run::files::{Part, SUMMARY};
use crate::cli::run::folder::{Claim, Folder};
use crate::cli::run::setup::{Setup, too_early};
use crate::cli::run::watch::Watch;
use crate::output::Summary;
use crate::qp::{Status, TimeLimit};
use crate::solver::Statistics;

/// What an interrupted run has to say.
const UNTOUCHED: &str = "nothing there was changed";

/// Writes the summary of a run without a solution, and says why there is none. What an earlier run left is not the solution of
/// this one, and goes.
pub(super) fn reject(name: &str, folder: &Folder, summary: &Summary, rejected: &Rejected) -> Failure {
    let mut results = folder.results(Part::Solution);
    let written = results.write(SUMMARY, |out| summary.write(out)).and_then(|()| results.publish());
    if let Err(failure) = written {
        return failure;
    }
    let (status, remedy) = (rejected.statistics.status.as_str(), rejected.remedy());
    Failure::NotCertified(format!("{name}: {rejected} (status {status}); {remedy}"))
}

/// The folder for the results, once it is certain that there is time for a solve.
pub(super) fn claim(
    setup: &Setup,
    arguments: &SolveArguments,
    clock: &Clock,
    watch: &Watch,
) -> Result<Folder, Failure> {
    // Nobody may find a folder of which the run says that nothing was written.
    clock.check(too_early(&arguments.case.path))?;
    let claim = Claim {
        case: &setup.id,
        part: Part::Solution,
        settings: A_SOLUTION.into(),
        overwrite: arguments.output.overwrite,
        says: UNTOUCHED,
    };
    Folder::claim(&arguments.output.folder(&arguments.case.path), &claim, watch)
}

/// What to do when the solver, or what comes after it, does not come back in time; `summary` is that of a run without a result.
pub(super) fn too_late(
    setup: &Setup,
    folder: &Folder,
    summary: impl FnOnce(&Rejected) -> Summary,
) -> impl Fn() -> Failure + Send + Sync + 'static {
    let settings = &setup.case.solver;
    let statistics = Statistics {
        solve_seconds: settings.time_limit.map_or(0.0, TimeLimit::seconds),
        ..Statistics::of(settings.name.as_str(), Status::TimeLimit)
    };
    let rejected = Rejected::without_result(statistics);
    let summary = summary(&rejected).with_unused_groups(&setup.groups);
    let (name, folder) = (setup.name.clone(), folder.clone());
    move || reject(&name, &folder, &summary, &rejected)
}
