//! The program `membranes`: case files and arguments in, files and tables out.
//!
//! Strings are parsed here and nowhere else. Exit codes: 0 certified; 1 ran, but not certified; 2 bad input or usage; 130
//! interrupted; 101 a mistake of ours.

mod adapt;
mod answer;
mod args;
mod bench;
mod case_file;
mod cases;
mod check;
mod clock;
mod converge;
mod export;
mod input;
mod levels;
mod memory;
mod progress;
mod section;
mod setup;
mod solve;
mod terminal;
mod watch;

pub use case_file::{BackendName, CaseFile, MeshSource, SolverSettings};

use std::io::{self, Write};
use std::process::ExitCode;

use clap::Parser;
use thiserror::Error;

use args::{Arguments, Command};
use watch::{Watch, watched};

/// Why a command did not succeed: one line, and an exit code.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Failure {
    /// Bad input or usage, or results that cannot be written.
    #[error("{0}")]
    Input(String),
    /// It ran, but the result is not certified.
    #[error("{0}")]
    NotCertified(String),
    /// Somebody has ended it.
    #[error("{0}")]
    Interrupted(String),
    /// A mistake of ours.
    #[error("internal error: {0}; please report it, together with the case file")]
    Internal(String),
}

impl Failure {
    fn exit_code(&self) -> ExitCode {
        match self {
            Self::Input(_) => ExitCode::from(2),
            Self::NotCertified(_) => ExitCode::from(1),
            // As shells have it: 128 and the number of the signal.
            Self::Interrupted(_) => ExitCode::from(130),
            // As that of a panic.
            Self::Internal(_) => ExitCode::from(101),
        }
    }
}

/// Runs the program on the arguments of the process.
pub fn main() -> ExitCode {
    let result = match Arguments::try_parse() {
        Ok(arguments) => watched(move |watch| run(&arguments.command, watch)),
        Err(error) if !error.use_stderr() => terminal::print(&error.to_string()),
        Err(error) => Err(Failure::Input(args::one_line(&error))),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            // Nobody may be there to read it.
            let _ = writeln!(io::stderr(), "error: {failure}");
            failure.exit_code()
        }
    }
}

fn run(command: &Command, watch: &Watch) -> Result<(), Failure> {
    match command {
        Command::Solve(arguments) => solve::run(arguments, watch),
        Command::Check(arguments) => check::run(arguments, watch),
        Command::Converge(arguments) => converge::run(arguments, watch),
        Command::Adapt(arguments) => adapt::run(arguments, watch),
        Command::Bench(arguments) => bench::run(arguments, watch),
        Command::Export(arguments) => export::run(arguments, watch),
        Command::Cases(arguments) => cases::run(arguments),
    }
}
