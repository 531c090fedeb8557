//! The program `membranes`: case files and arguments in, files and tables out.
//!
//! Strings are parsed here and nowhere else. Exit codes: 0 certified; 1 ran, but not certified; 2 bad input or usage; 130
//! interrupted; 101 internal error.

mod args;
mod case;
mod commands;
mod failure;
mod run;
mod terminal;

pub use case::{CaseFile, MeshSource, SolverName, SolverSettings};
pub use failure::Failure;

use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

use clap::Parser;

use args::Arguments;
use run::watch::watched;

/// Runs the program on the arguments of the process.
pub fn main() -> ExitCode {
    run(std::env::args_os()).into()
}

/// Runs the program on these arguments, of which the first is its own name, and returns the exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let command = arguments.get(1).map(|command| command.to_string_lossy().into_owned());
    let result = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => watched(move |watch| commands::run(&arguments.command, watch)),
        Err(error) if !error.use_stderr() => terminal::print(&error.to_string()),
        Err(error) => Err(Failure::Input(args::one_line(&error, command.as_deref()))),
    };
    match result {
        Ok(()) => 0,
        Err(failure) => {
            let message = format!("error: {failure}");
            // One line for who reads it by a program; a terminal would break it inside of words.
            let message = if io::stderr().is_terminal() { terminal::wrapped(&message, 2) } else { message };
            // Nobody may be there to read it.
            let _ = writeln!(io::stderr(), "{message}");
            failure.exit_code()
        }
    }
}
