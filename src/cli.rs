//! The program `membranes`: case files and arguments in, files and tables out.
//!
//! Strings are parsed here and nowhere else. Exit codes: 0 certified; 1 ran, but not certified; 2 bad input or usage.

mod adapt;
mod answer;
mod args;
mod bench;
mod case_file;
mod cases;
mod check;
mod converge;
mod export;
mod levels;
mod memory;
mod progress;
mod section;
mod setup;
mod solve;
mod terminal;

pub use case_file::{BackendName, CaseFile, MeshSource, SolverSettings};

use std::process::ExitCode;

use clap::Parser;
use thiserror::Error;

use args::{Arguments, Command};

/// Why a command did not succeed: one line, and an exit code.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Failure {
    /// Bad input or usage, or results that cannot be written.
    #[error("{0}")]
    Input(String),
    /// It ran, but the result is not certified.
    #[error("{0}")]
    NotCertified(String),
}

impl Failure {
    fn exit_code(&self) -> ExitCode {
        match self {
            Self::Input(_) => ExitCode::from(2),
            Self::NotCertified(_) => ExitCode::from(1),
        }
    }
}

/// Runs the program on the arguments of the process.
pub fn main() -> ExitCode {
    let result = match Arguments::try_parse() {
        Ok(arguments) => run(&arguments.command),
        Err(error) if !error.use_stderr() => terminal::print(&error.to_string()),
        Err(error) => Err(Failure::Input(args::one_line(&error))),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            failure.exit_code()
        }
    }
}

fn run(command: &Command) -> Result<(), Failure> {
    match command {
        Command::Solve(arguments) => solve::run(arguments),
        Command::Check(arguments) => check::run(arguments),
        Command::Converge(arguments) => converge::run(arguments),
        Command::Adapt(arguments) => adapt::run(arguments),
        Command::Bench(arguments) => bench::run(arguments),
        Command::Export(arguments) => export::run(arguments),
        Command::Cases(arguments) => cases::run(arguments),
    }
}
