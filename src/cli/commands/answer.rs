//! An answer to the exported program, from any other solver, before our certificate.

use std::io::{self, BufReader};
use std::path::Path;

use crate::action::{ContactSolution, Rejected, Residuals, certify};
use crate::cli::args::CheckArguments;
use crate::cli::failure::Failure;
use crate::cli::run::files::{Part, SUMMARY};
use crate::cli::run::folder::{Claim, Folder};
use crate::cli::run::input::{self, Input};
use crate::cli::run::setup::Setup;
use crate::cli::run::watch::Watch;
use crate::discretization::Discretization;
use crate::output::{Seconds, Summary};
use crate::qp::{
    Answer, BackendError, QpBackend, QpOptions, QpProblem, QpSolution, Status, qp_of, read_answer,
};
use crate::solver::{Candidate, ContactSolver, QpSolver, SolverOptions, Statistics};

/// What stands for the backend, whose name nobody has told us.
pub(super) const NAME: &str = "answer";

/// An answer from elsewhere, certified or not.
pub(super) struct Verdict {
    pub(super) result: Result<ContactSolution, Box<Rejected>>,
    /// What would help one that is not.
    pub(super) remedy: &'static str,
}

/// Reads an answer and has it certified; the verdict goes also into a folder, if one is named.
pub(super) fn judge(
    setup: &Setup,
    d: &Discretization,
    file: &Path,
    arguments: &CheckArguments,
    seconds: Seconds,
    watch: &Watch,
) -> Result<Verdict, Failure> {
    let answer = read(setup, file, [d.unknowns(), d.rows()])?;
    let tolerance = setup.case.solver.tolerance.or_default();
    let certified =
        |answer: &Answer| certify(d, Candidate::from_answer(d, answer.clone(), statistics()), tolerance);
    let is_right_polished = |answer: &Answer| {
        let options = SolverOptions { tolerance, ..SolverOptions::default() };
        let candidate = QpSolver::new(Given::new(&qp_of(d), answer)).solve(d, &options);
        candidate.is_ok_and(|c| !is_repaired(&c.statistics) && certify(d, c, tolerance).is_ok())
    };
    let result = certified(&answer);
    let remedy = if result.is_ok() { "" } else { remedy(&answer, &certified, &is_right_polished) };
    let summary = || {
        let result = result.as_ref().map_err(|rejected| rejected.as_ref());
        Summary::new(&setup.case.title, d, tolerance, result, seconds, None)
    };
    write(setup, arguments, watch, summary)?;
    Ok(Verdict { result, remedy })
}

/// Reads an answer with so many variables and constraints.
fn read(setup: &Setup, file: &Path, [variables, constraints]: [usize; 2]) -> Result<Answer, Failure> {
    let refused = |error: &dyn std::fmt::Display| Failure::Input(format!("{}: {error}", file.display()));
    let opened = input::open(file, Input::Arrays, setup.memory).map_err(|error| match error.kind() {
        io::ErrorKind::OutOfMemory => refused(&error),
        _ => refused(&format!("{error}; name a readable file, written by numpy.savez")),
    })?;
    read_answer(BufReader::new(opened), variables, constraints).map_err(|error| refused(&error))
}

/// Writes the verdict, if a folder is named for it.
fn write(
    setup: &Setup,
    arguments: &CheckArguments,
    watch: &Watch,
    summary: impl FnOnce() -> Summary,
) -> Result<(), Failure> {
    let Some(folder) = &arguments.out else { return Ok(()) };
    let claim = Claim {
        case: &setup.id,
        part: Part::Solution,
        settings: NAME.into(),
        overwrite: arguments.overwrite,
        says: "nothing there was changed",
    };
    let folder = Folder::claim(folder, &claim, watch)?;
    let summary = summary().with_unused_groups(&setup.groups);
    let mut results = folder.results(Part::Solution);
    results.write(SUMMARY, |out| summary.write(out))?;
    results.publish()
}

fn statistics() -> Statistics {
    Statistics::of(NAME, Status::Unknown)
}

/// A polish that finds another contact set has solved the problem anew.
fn is_repaired(statistics: &Statistics) -> bool {
    statistics.polish.is_none_or(|report| report.repairs > 0)
}

/// What would make an answer certify: the multipliers with the other sign, the polish, both; else accuracy.
fn remedy(
    answer: &Answer,
    certified: &dyn Fn(&Answer) -> Result<ContactSolution, Box<Rejected>>,
    is_right_polished: &dyn Fn(&Answer) -> bool,
) -> &'static str {
    let negative = Answer { y: answer.y.iter().map(|y| -y).collect(), ..answer.clone() };
    // Of one that certifies: zero.
    let residual = |answer: &Answer| match certified(answer) {
        Ok(_) => 0.0,
        Err(rejected) => rejected.residuals.as_ref().map_or(f64::INFINITY, Residuals::beyond_rounding),
    };
    if residual(&negative) == 0.0 {
        "; with -y in place of y it certifies: its multipliers have the other sign"
    } else if residual(answer) <= residual(&negative) && is_right_polished(answer) {
        "; its contact set is right, and polished it certifies: have it solved more accurately"
    } else if is_right_polished(&negative) {
        "; with -y in place of y, and polished, it certifies: change the sign, and have it solved more accurately"
    } else {
        "; have it solved more accurately, or allow more with --tolerance"
    }
}

/// A backend that knows its answer, in the units in which it is asked.
struct Given(Answer);

impl Given {
    fn new(qp: &QpProblem, answer: &Answer) -> Self {
        let scaled = |values: &[f64], scale: f64| values.iter().map(|value| value / scale).collect();
        Self(Answer { x: scaled(&answer.x, qp.primal_scale()), y: scaled(&answer.y, qp.dual_scale()) })
    }
}

impl QpBackend for Given {
    fn name(&self) -> &str {
        NAME
    }

    fn solve(&mut self, _: &QpProblem, _: &QpOptions) -> Result<QpSolution, BackendError> {
        let Answer { x, y } = self.0.clone();
        Ok(QpSolution {
            x,
            y,
            status: Status::Unknown,
            iterations: 0,
            setup_seconds: 0.0,
            solve_seconds: 0.0,
        })
    }
}
