//! An answer to the exported program, from any other solver, before our certificate.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use crate::action::{ContactSolution, Rejected, certify};
use crate::cli::failure::Failure;
use crate::cli::run::setup::{Setup, make_folder, write_file};
use crate::cli::run::watch::Watch;
use crate::discretization::Discretization;
use crate::output::{Seconds, Summary};
use crate::qp::{Status, read_answer};
use crate::solver::{Candidate, Statistics};

/// What stands for the backend, whose name nobody has told us.
pub(crate) const NAME: &str = "answer";

/// What helps an answer that does not certify.
pub(crate) const REMEDY: &str = "; have it solved more accurately, or allow more with --tolerance";

const SUMMARY: &str = "summary.json";

/// Reads an answer and has it certified; the verdict goes also into the folder `out`, if one is named.
pub(crate) fn judge(
    setup: &Setup,
    d: &Discretization,
    file: &Path,
    out: Option<&Path>,
    seconds: Seconds,
    watch: &Watch,
) -> Result<Result<ContactSolution, Box<Rejected>>, Failure> {
    let refused = |error: &dyn std::fmt::Display| Failure::Input(format!("{}: {error}", file.display()));
    let opened = File::open(file)
        .map_err(|error| refused(&format!("{error}; name a readable file, written by numpy.savez")))?;
    let n = d.interior().len();
    let answer = read_answer(BufReader::new(opened), 2 * n, n).map_err(|error| refused(&error))?;
    let statistics = Statistics { status: Status::Unknown, ..Statistics::of(NAME) };
    let tolerance = setup.case.solver.tolerance.or_default();
    let result = certify(d, Candidate::from_answer(d, answer, statistics), tolerance);
    if let Some(folder) = out {
        make_folder(folder, watch, "it is as it was")?;
        let verdict = result.as_ref().map_err(|rejected| rejected.as_ref());
        let summary = Summary::new(&setup.case.title, d, tolerance, verdict, seconds, None);
        write_file(&folder.join(SUMMARY), |out| summary.write(out))?;
    }
    Ok(result)
}
