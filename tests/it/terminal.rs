//! What a terminal of 80 columns shows: lines that fit, counts that can be read, and what the bound rests on.

use std::fs;
use std::path::Path;

use super::program::{folder_with_case, lines_too_long, run};

/// Vertices of the unit square in 102 x 102 cells.
const VERTICES: &str = "10,609";

/// A case with a known solution, on meshes of which one has so many vertices.
const KNOWN: &str = "case = \"strip\"\n\n[mesh]\ncells = 102\n";

/// A load that the quadrature does not see: a peak that is narrower than a triangle.
const BLIND: &str = r#"
[membranes]
tension = [1.0, 3.0]
load = ["-1 - 1000000*exp(-((x - 0.53)^2 + (y - 0.52)^2)/0.000001)", 0]
height = 0.1

[domain]
shape = "square"

[mesh]
cells = 32
"#;

const WARNING: &str = "load f1: two quadrature rules differ by";

const COMMANDS: [&str; 9] =
    ["solve", "check", "converge", "adapt", "bench", "export", "cases", "completions", "man"];

/// A text with single spaces in place of line breaks and indents.
fn on_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The numbers of five digits or more without separators; decimals need none.
fn unseparated(text: &str) -> Vec<&str> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || ".,_".contains(c);
    let whole = |number: &&str| number.len() >= 5 && number.bytes().all(|byte| byte.is_ascii_digit());
    // `10609.` ends a sentence, `0.10609` is a decimal.
    text.split(|c| !is_part(c)).map(|number| number.trim_end_matches(['.', ','])).filter(whole).collect()
}

#[test]
fn counts_are_separated_wherever_they_are_printed() {
    let folder = folder_with_case(KNOWN);
    for arguments in [
        "solve case.toml",
        "check case.toml",
        "adapt case.toml --tolerance 0.5",
        "adapt case.toml --tolerance 1e-4 --max-vertices 12000",
        "converge case.toml --levels 1",
        "bench case.toml --levels 1 --solvers multigrid",
        "adapt case.toml --max-vertices 10000 --out nowhere",
    ] {
        let ran = run(folder.path(), arguments);
        let text = ran.stdout + &ran.stderr;
        assert_eq!(unseparated(&text), [""; 0], "{arguments}: {text}");
        // The residuals of `check` have no vertices beside them, but unknowns.
        let count = if arguments.starts_with("check") { "20,402 unknowns" } else { VERTICES };
        assert!(text.contains(count), "{arguments}: {text}");
    }
    for table in ["convergence.md", "bench.md"] {
        let text = fs::read_to_string(folder.path().join("out/case").join(table)).expect("it is there");
        assert_eq!(unseparated(&text), [""; 0], "{table}: {text}");
        assert!(text.contains(VERTICES), "{table}: {text}");
    }
    let help = run(folder.path(), "adapt --help").success();
    assert_eq!(unseparated(&help), [""; 0]);
    // As it is printed, it can be given.
    run(folder.path(), "adapt case.toml --tolerance 0.5 --max-vertices 1,000,000").success();
}

#[test]
fn a_count_without_separators_would_be_seen() {
    let text = "many unknowns (22201 a membrane), 1000000, 12345. And 12,345 or 0.09026475, 1.33e-2, 9999";
    assert_eq!(unseparated(text), ["22201", "1000000", "12345"]);
}

#[test]
fn warnings_and_files_are_broken_between_words() {
    let long = format!("title = \"{}\"\n{BLIND}", "a title of many words ".repeat(6));
    let folder = folder_with_case(&long);
    for arguments in ["solve case.toml --dual", "adapt case.toml --tolerance 0.3", "check case.toml"] {
        let text = run(folder.path(), arguments).success();
        assert_eq!(lines_too_long(&text), [""; 0], "{arguments}");
        if !arguments.starts_with("check") {
            let words = on_one_line(&text);
            assert!(
                words.contains(WARNING) && words.contains("refine the mesh where the load acts"),
                "{text}"
            );
            assert!(words.contains("membranes.png, ") && words.contains("mesh.png}"), "{text}");
        }
    }
}

#[test]
fn converge_names_the_loads_that_the_quadrature_does_not_see() {
    let case = |c: &str| format!("case = \"no-contact\"\n[parameters]\nc = {c}\n[mesh]\ncells = 4\n");
    let folder = folder_with_case(&case("0"));
    let warning = |vertices: usize| {
        format!(
            "warning, at the finest level ({vertices} vertices): load f2 is zero at all points of the quadrature"
        )
    };
    // The second run measures nothing anew, the third one only shows the first level.
    for (levels, vertices) in [(2, 81), (2, 81), (1, 25), (3, 289)] {
        let text = run(folder.path(), &format!("converge case.toml --levels {levels}")).success();
        let words = on_one_line(&text);
        assert!(words.contains(&warning(vertices)), "{text}");
        assert_eq!((words.matches("warning").count(), lines_too_long(&text)), (1, Vec::new()), "{text}");
    }
    let seen = folder_with_case(&case("0.2"));
    let text = run(seen.path(), "converge case.toml --levels 2").success();
    assert!(!text.contains("warning"), "{text}");
}

#[test]
fn where_there_is_no_error_there_is_no_index() {
    let folder = folder_with_case("case = \"biactive\"\n[parameters]\nc = 0\n[mesh]\ncells = 4\n");
    let text = run(folder.path(), "converge case.toml --levels 1").success();
    assert!(!text.contains("NaN") && text.contains(" -\n"), "{text}");
    let table = fs::read_to_string(folder.path().join("out/case/convergence.md")).expect("it is there");
    assert!(!table.contains("NaN"), "{table}");
}

/// What is left on a terminal of 80 columns: the lines that the program prints there, those on its progress as well.
#[cfg(target_os = "linux")]
fn in_terminal(folder: &Path, arguments: &str) -> Vec<String> {
    let program = assert_cmd::cargo::cargo_bin!("membranes").display();
    let script = format!("stty cols 80 rows 24; '{program}' {arguments}");
    let output = std::process::Command::new("script")
        .args(["-qec", &script, "/dev/null"])
        .env("TERM", "xterm")
        .current_dir(folder)
        .stdin(std::process::Stdio::null())
        .output()
        .expect("there is `script`");
    let text = String::from_utf8_lossy(&output.stdout);
    // What moves the cursor or erases a line ends at its first letter.
    let after_escape =
        |piece: &str| piece.split_once(|c: char| c.is_ascii_alphabetic()).map(|(_, text)| text.to_owned());
    let mut pieces = text.split("\u{1b}[");
    let first = pieces.next().map(str::to_owned);
    let pieces: Vec<String> = first.into_iter().chain(pieces.filter_map(after_escape)).collect();
    pieces.join("\n").split(['\n', '\r']).map(|line| line.trim_end().to_owned()).collect()
}

/// A terminal breaks lines that are too long inside of words; who reads errors by a program wants one line.
#[cfg(target_os = "linux")]
#[test]
fn errors_are_broken_between_words_on_a_terminal_and_nowhere_else() {
    let folder = folder_with_case(KNOWN);
    for arguments in [
        "solve nowhere.toml",
        "solve case.toml --time-limit x",
        "adapt case.toml --tolerance 1e-4 --max-vertices 12000",
        "converge case.toml --levels 0",
    ] {
        let piped = run(folder.path(), arguments).stderr;
        assert_eq!((piped.lines().count(), lines_too_long(&piped).len()), (1, 1), "{piped}");
        let lines = in_terminal(folder.path(), arguments);
        assert_eq!(lines_too_long(&lines.join("\n")), [""; 0], "{arguments}");
        let shown = on_one_line(&lines.join(" "));
        assert!(shown.contains(&on_one_line(&piped)), "{shown}\n{piped}");
    }
}

/// Whether the first "guaranteed" of a page says of what.
fn says_up_to_what(text: &str) -> bool {
    let words = on_one_line(text).to_lowercase();
    let first = words.find("guarantee").map(|at| &words[at..]);
    first.is_none_or(|first| first.starts_with("guaranteed up to the quadrature of the loads"))
}

#[test]
fn guaranteed_is_guaranteed_up_to_the_quadrature_of_the_loads() {
    let folder = folder_with_case(KNOWN);
    let mut pages: Vec<(String, String)> = Vec::new();
    for arguments in COMMANDS.map(|command| format!("{command} --help")).into_iter().chain(
        [
            "--help",
            "man",
            "solve case.toml",
            "adapt case.toml --tolerance 0.5",
            "converge case.toml --levels 1",
        ]
        .map(String::from),
    ) {
        let text = run(folder.path(), &arguments).success();
        pages.push((arguments, text));
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for entry in
        fs::read_dir(root.join("docs")).expect("there is a folder").map(|entry| entry.expect("readable"))
    {
        if entry.path().extension().is_some_and(|ending| ending == "md") {
            pages.push((
                entry.path().display().to_string(),
                fs::read_to_string(entry.path()).expect("readable"),
            ));
        }
    }
    pages.push(("README".into(), fs::read_to_string(root.join("README.md")).expect("readable")));
    for (name, text) in &pages {
        assert!(says_up_to_what(text), "{name}");
    }
    let saying = pages.iter().filter(|(_, text)| text.contains("guaranteed")).count();
    assert!(saying >= 6, "the bound is explained in few places: {saying}");
    assert!(!says_up_to_what("to a guaranteed accuracy"));
    assert!(says_up_to_what("Guaranteed\n  up to the quadrature of the loads; a guaranteed bound"));
}
