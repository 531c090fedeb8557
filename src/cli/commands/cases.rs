//! `membranes cases`.

use crate::cli::args::CasesArguments;
use crate::cli::failure::Failure;
use crate::cli::terminal::print;
use crate::problem::{Case, NamedCase, StackCase};

pub(crate) fn run(arguments: &CasesArguments) -> Result<(), Failure> {
    let text = match &arguments.name {
        None => list(),
        Some(name) => {
            case_file(NamedCase::from_name(name).map_err(|error| Failure::Input(error.to_string()))?)
        }
    };
    print(&text)
}

/// Columns of the names in the table of all cases: the longest has 14 letters.
const NAMES: usize = 15;

/// Columns of the titles there: what is left of 80.
const TITLES: usize = 80 - 2 - NAMES - 5;

/// A table of all cases, then each with its formulas.
fn list() -> String {
    let mut text = String::from("Built-in cases with a known solution.\n\n");
    NamedCase::all().for_each(|case| text += &row(case));
    let pairs = ("Pairs. In all of them", Case::NOTATION, Case::ALL.map(NamedCase::Pair).to_vec());
    let stacks =
        ("Stacks. In all of them", StackCase::NOTATION, StackCase::ALL.map(NamedCase::Stack).to_vec());
    for (heading, notation, cases) in [pairs, stacks] {
        text += &format!("\n{heading}\n\n{}", indented(notation, "  "));
        cases.into_iter().for_each(|case| text += &entry(case));
    }
    text += "\n`membranes cases NAME > CASE.toml` makes a case file of one of them.\n";
    text
}

/// A case in the table: name, number, title.
fn row(case: NamedCase) -> String {
    let mut row = format!("  {:NAMES$}{:5}", case.name(), case.letter());
    let mut column = 0;
    for (k, word) in case.title().split(' ').enumerate() {
        if column + 1 + word.len() > TITLES {
            row += &format!("\n{:width$}", "", width = 2 + NAMES + 5);
            column = 0;
        } else if k > 0 {
            row.push(' ');
            column += 1;
        }
        row += word;
        column += word.len();
    }
    row + "\n"
}

/// A case with its formulas.
fn entry(case: NamedCase) -> String {
    let mut text = format!("\n{} ({})\n  {}\n", case.name(), case.letter(), case.title());
    text += &indented(case.formulas(), "  ");
    let mut line = String::from("  parameters:");
    for (k, p) in case.parameters().iter().enumerate() {
        let end = if k + 1 < case.parameters().len() { "," } else { "" };
        let word = format!(" {} = {}{end}", p.name, p.default);
        if line.len() + word.len() > 80 {
            text += &line;
            text.push('\n');
            line = String::from("    ");
        }
        line += &word;
    }
    text + &line + "\n"
}

/// A case as a complete case file.
fn case_file(case: NamedCase) -> String {
    let mut text = format!("# {}\n#\n", case.title());
    text += &indented(case.notation(), "# ");
    text += "#\n";
    text += &indented(case.formulas(), "# ");
    text += &format!("\ncase = \"{}\"\n\n[parameters]\n", case.name());
    for parameter in case.parameters() {
        let value = format!("{} = {:?}", parameter.name, parameter.default);
        text += &format!("{value:16} # {}: {}\n", parameter.meaning, parameter.condition());
    }
    text += "\n[mesh]\ncells = 64          # or size = 0.02 for an unstructured mesh\n";
    text += "refine = 0\n\n[solver]\nbackend = \"auto\"\ntolerance = 1e-8\n";
    text
}

fn indented(lines: &[&str], indent: &str) -> String {
    lines.iter().map(|line| format!("{indent}{line}\n")).collect()
}
