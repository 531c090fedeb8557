//! `membranes completions` and `membranes man`: what a shell and `man` know of the program.

use clap::CommandFactory;
use clap_mangen::Man;

use crate::cli::args::{Arguments, CompletionsArguments, ManArguments};
use crate::cli::failure::Failure;
use crate::cli::run::watch::Watch;
use crate::cli::terminal::print;
use crate::output::{prepare_folder, write_atomically};

const PROGRAM: &str = "membranes";

/// Prints the script that completes commands and arguments.
pub(super) fn completions(arguments: &CompletionsArguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), PROGRAM, &mut script);
    print(&String::from_utf8_lossy(&script))
}

/// Prints the page of the program, or writes a page for it and each command.
pub(super) fn man(arguments: &ManArguments, watch: &Watch) -> Result<(), Failure> {
    let mut program = Arguments::command();
    program.build();
    let Some(folder) = &arguments.out else { return print(&page(&program)) };
    let cannot_write = |error: std::io::Error| {
        let folder = folder.display();
        Failure::Input(format!("{folder}: cannot write: {error}; name another folder with --out"))
    };
    prepare_folder(folder).map_err(cannot_write)?;
    watch.folder(folder, "pages that are there are whole");
    let commands = program.get_subcommands().filter(|command| command.get_name() != "help");
    let pages = std::iter::once((PROGRAM.to_owned(), page(&program)))
        .chain(commands.map(|command| (format!("{PROGRAM}-{}", command.get_name()), page(command))));
    for (name, page) in pages {
        write_atomically(&folder.join(format!("{name}.1")), |out| out.write_all(page.as_bytes()))
            .map_err(cannot_write)?;
    }
    Ok(())
}

/// A page in the language of `man`.
fn page(command: &clap::Command) -> String {
    let mut text = Vec::new();
    // Writing to memory cannot fail.
    let _ = Man::new(command.clone()).render(&mut text);
    String::from_utf8_lossy(&text).into_owned()
}
