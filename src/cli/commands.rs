//! The commands, a file each.

mod adapt;
mod answer;
mod bench;
mod cases;
mod check;
mod converge;
mod export;
mod shell;
mod solution;
mod solve;

use super::args::Command;
use super::failure::Failure;
use super::run::watch::Watch;

/// Runs a command.
pub(super) fn run(command: &Command, watch: &Watch) -> Result<(), Failure> {
    match command {
        Command::Solve(arguments) => solve::run(arguments, watch),
        Command::Check(arguments) => check::run(arguments, watch),
        Command::Converge(arguments) => converge::run(arguments, watch),
        Command::Adapt(arguments) => adapt::run(arguments, watch),
        Command::Bench(arguments) => bench::run(arguments, watch),
        Command::Export(arguments) => export::run(arguments, watch),
        Command::Cases(arguments) => cases::run(arguments),
        Command::Completions(arguments) => shell::completions(arguments),
        Command::Man(arguments) => shell::man(arguments, watch),
    }
}
