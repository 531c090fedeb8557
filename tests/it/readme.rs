//! What the README shows is what the program prints.

use std::path::Path;
use std::process::Command;

use membrane_contact::cli::CaseFile;

/// Lines whose numbers depend on the machine: times, and residuals at the level of rounding.
const MACHINE: [&str; 3] = ["seconds", "polish", "certified"];

/// The block after a command of the README.
fn shown_after<'t>(readme: &'t str, command: &str) -> Vec<&'t str> {
    let start = readme.find(command).expect("the README shows the command");
    readme[start..].lines().skip(1).take_while(|line| !line.starts_with("```")).collect()
}

/// A line as far as it is the same on every machine.
fn comparable(line: &str) -> &str {
    let name = line.split_whitespace().next().unwrap_or("");
    if MACHINE.contains(&name) { name } else { line }
}

#[test]
fn the_first_command_prints_what_the_readme_shows() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = std::fs::read_to_string(root.join("README.md")).expect("readable");
    let shown = shown_after(&readme, "$ cargo run --release -- solve examples/plate.toml");

    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::create_dir(folder.path().join("examples")).expect("writable");
    for name in ["plate.toml", "plate.msh"] {
        std::fs::copy(root.join("examples").join(name), folder.path().join("examples").join(name))
            .expect("copied");
    }
    let run = Command::new(assert_cmd::cargo::cargo_bin!("membranes"))
        .args(["solve", "examples/plate.toml"])
        .current_dir(folder.path())
        .output()
        .expect("it runs");
    assert!(run.status.success());
    let printed = String::from_utf8(run.stdout).expect("text");
    let printed: Vec<&str> = printed.lines().map(comparable).collect();
    assert_eq!(printed, shown.iter().copied().map(comparable).collect::<Vec<_>>());
}

#[test]
fn the_case_file_that_the_readme_shows_is_valid() {
    let readme = include_str!("../../README.md");
    let block = shown_after(readme, "```toml").join("\n");
    let parse = |text: &str| CaseFile::parse("readme.toml", text, Path::new("readme.toml"));
    assert!(parse(&block).is_ok(), "{:?}", parse(&block).err());
    assert!(parse(&block.replace("tension", "tensions")).is_err());
}

#[test]
fn the_case_file_that_the_documentation_shows_has_every_key() {
    let page = include_str!("../../docs/case_file.md");
    let block = shown_after(page, "```toml").join("\n");
    let parse = |text: &str| CaseFile::parse("page.toml", text, Path::new("page.toml"));
    assert!(parse(&block).is_ok(), "{:?}", parse(&block).err());
    // The first table is that of the case file.
    let table = page.split("| key | what it is |").nth(1).and_then(|rest| rest.split("\n\n").next()).unwrap();
    let keys = table.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next());
    let keys: Vec<&str> = keys.collect();
    assert_eq!(keys, ["tension", "load", "foundation", "height", "traction", "pressed", "floor", "ceiling"]);
    for key in keys {
        assert!(parse(&block.replace(key, "unknown")).is_err(), "{key}");
    }
}

#[test]
fn a_changed_figure_would_be_seen() {
    assert_ne!(comparable("  energy       1.59318267"), comparable("  energy       1.59318268"));
    assert_eq!(comparable("  seconds      mesh 0.00"), comparable("  seconds      mesh 1.00"));
    assert_eq!(shown_after("a\n$ run\nx\ny\n```\nz", "$ run"), ["x", "y"]);
}
