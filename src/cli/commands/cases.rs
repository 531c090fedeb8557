//! `membranes cases`.

use crate::cli::args::CasesArguments;
use crate::cli::failure::Failure;
use crate::cli::terminal::print;
use crate::problem::Case;

pub(crate) fn run(arguments: &CasesArguments) -> Result<(), Failure> {
    let text = match &arguments.name {
        None => list(),
        Some(name) => case_file(Case::from_name(name).map_err(|error| Failure::Input(error.to_string()))?),
    };
    print(&text)
}

/// All cases with their formulas.
fn list() -> String {
    let mut text = String::from("Built-in cases with a known solution. In all of them\n\n");
    text += &indented(Case::NOTATION, "  ");
    for case in Case::ALL {
        text += &format!("\n{} ({})\n  {}\n", case.name(), case.letter(), case.title());
        text += &indented(case.formulas(), "  ");
        let parameters: Vec<String> =
            case.parameters().iter().map(|p| format!("{} = {}", p.name, p.default)).collect();
        text += &format!("  parameters: {}\n", parameters.join(", "));
    }
    text += "\n`membranes cases NAME > CASE.toml` makes a case file of one of them.\n";
    text
}

/// A case as a complete case file.
fn case_file(case: Case) -> String {
    let mut text = format!("# {}\n#\n", case.title());
    text += &indented(Case::NOTATION, "# ");
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
