//! The program `membranes`.

use std::process::ExitCode;

fn main() -> ExitCode {
    membrane_contact::cli::main()
}
