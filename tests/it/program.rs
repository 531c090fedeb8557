//! The program `membranes` as its user meets it.

use std::fs;
use std::io;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use membrane_contact::problem::Case;
use serde_json::Value;
use tempfile::{TempDir, tempdir};

/// Columns of a terminal that nobody has made wider.
const COLUMNS: usize = 80;

/// Vertices of the unit square in 4 x 4 cells: all, and those with unknowns.
const VERTICES: u64 = 5 * 5;
const INTERIOR: u64 = 3 * 3;

/// `J` at `u1 = 0.1 + 0.05 x`, `u2 = 0`, which is admissible: the minimum lies below.
const UNLOADED_ENERGY: f64 = 0.5 * 0.05 * 0.05 + 2.0 * 0.125;

/// What `solve` writes: the record of the case, and the results.
const RESULTS: [&str; 5] = ["membranes.json", "membranes.png", "rim.vtp", "solution.vtu", "summary.json"];

/// Two membranes on the unit square, partly in contact.
const CASE: &str = r#"
[membranes]
tension = [1.0, 3.0]
load = [-2.0, "10*sin(pi*x)"]
height = "0.1 + 0.05*x"

[domain]
shape = "square"

[mesh]
cells = 4
"#;

/// A folder with the case file `plates.toml`.
fn folder_with(case: &str) -> TempDir {
    let folder = tempdir().expect("a temporary folder");
    fs::write(folder.path().join("plates.toml"), case).expect("it is writable");
    folder
}

/// A new folder with the file `case.toml`.
pub fn folder_with_case(case: &str) -> TempDir {
    let folder = tempdir().expect("a temporary folder");
    fs::write(folder.path().join("case.toml"), case).expect("it is writable");
    folder
}

/// The program, to be run in `folder` with these arguments.
pub fn command(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("membranes"));
    command.current_dir(folder).args(arguments.split_whitespace()).stdin(Stdio::null());
    command
}

/// Runs the program in `folder`.
pub fn run(folder: &Path, arguments: &str) -> Run {
    Run::from(command(folder, arguments).output().expect("the program starts"))
}

/// What is left of a run.
#[derive(Debug)]
pub struct Run {
    /// The exit code; `None` when a signal ended it.
    pub code: Option<i32>,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("the program writes UTF-8");
        Self { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }
}

impl Run {
    /// The standard output of a run that succeeded without a word on standard error.
    pub fn success(self) -> String {
        assert_eq!((self.code, self.stderr.as_str()), (Some(0), ""), "{}", self.stdout);
        self.stdout
    }
}

/// The files in `folder` and below, sorted.
pub fn files(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder is there") {
        let path = entry.expect("it is readable").path();
        let name = path.file_name().expect("an entry has a name").to_string_lossy().into_owned();
        if path.is_dir() {
            found.push(format!("{name}/"));
            found.extend(files(&path).into_iter().map(|below| format!("{name}/{below}")));
        } else {
            found.push(name);
        }
    }
    found.sort();
    found
}

fn summary(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("summary.json")).expect("there is a summary");
    serde_json::from_str(&text).expect("it is JSON")
}

/// Lines that do not fit the terminal.
pub fn lines_too_long(text: &str) -> Vec<&str> {
    text.lines().filter(|line| line.chars().count() > COLUMNS).collect()
}

#[test]
fn help_names_every_command_and_fits_the_terminal() {
    let folder = tempdir().unwrap();
    let help = run(folder.path(), "--help").success();
    for command in ["solve", "check", "converge", "adapt", "bench", "export", "cases", "completions", "man"] {
        assert!(help.contains(&format!("\n  {command} ")), "{command}: {help}");
        let of_command = run(folder.path(), &format!("{command} --help")).success();
        assert!(of_command.contains(&format!("Usage: membranes {command}")), "{of_command}");
        assert_eq!(lines_too_long(&of_command), [""; 0]);
    }
    assert_eq!(lines_too_long(&help), [""; 0]);
    assert_eq!(lines_too_long(&"x".repeat(COLUMNS + 1)).len(), 1);
    let version = run(folder.path(), "--version").success();
    assert_eq!(version, format!("membranes {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn shells_and_man_know_every_command_and_what_it_takes() {
    let folder = tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = run(folder.path(), &format!("completions {shell}")).success();
        assert!(["adapt", "max-vertices", "overwrite"].iter().all(|word| script.contains(word)), "{shell}");
    }
    assert_eq!(run(folder.path(), "completions cmd").code, Some(2));
    let page = run(folder.path(), "man").success();
    assert!(page.contains(".TH membranes") && page.contains("membranes\\-solve(1)"), "{page}");
    run(folder.path(), "man --out pages").success();
    let pages = files(&folder.path().join("pages"));
    assert!(
        pages.contains(&"membranes.1".into()) && pages.contains(&"membranes-adapt.1".into()),
        "{pages:?}"
    );
    let solve = fs::read_to_string(folder.path().join("pages/membranes-solve.1")).unwrap();
    assert!(solve.contains("time\\-limit"), "{solve}");
}

#[test]
fn membranes_at_rest_are_not_to_be_refined() {
    let folder = folder_with(&CASE.replace("-2.0, \"10*sin(pi*x)\"", "0, 0").replace("0.1 + 0.05*x", "0.1"));
    let table = run(folder.path(), "solve plates.toml").success();
    assert!(table.contains("(no load: rounding)") && !table.contains("refine"), "{table}");
}

#[test]
fn cases_are_listed_with_their_formulas_and_parameters() {
    let folder = tempdir().unwrap();
    let list = run(folder.path(), "cases").success();
    assert_eq!(lines_too_long(&list), [""; 0]);
    for case in Case::ALL {
        assert!(list.contains(&format!("\n{} ({})\n", case.name(), case.letter())), "{case}");
        assert!(case.formulas().iter().all(|line| list.contains(line)), "{case}");
        assert!(case.parameters().iter().all(|parameter| list.contains(parameter.name)), "{case}");
    }
}

#[test]
fn every_case_can_be_printed_and_solved() {
    for case in Case::ALL {
        let folder = tempdir().unwrap();
        let printed = run(folder.path(), &format!("cases {case}")).success();
        assert_eq!(lines_too_long(&printed), [""; 0]);
        let coarse = printed.replace("cells = 64", "cells = 8");
        assert_ne!(coarse, printed, "{case}");
        fs::write(folder.path().join("plates.toml"), coarse).unwrap();
        let table = run(folder.path(), "solve plates.toml").success();
        assert_eq!(lines_too_long(&table), [""; 0]);
        let summary = summary(&folder.path().join("out/plates"));
        assert_eq!(summary["certified"], true, "{case}");
        // No contact and full contact are what the names say.
        let (contact, interior) = (&summary["contact_vertices"], summary["unknowns"].as_u64().unwrap() / 2);
        match case {
            Case::NoContact | Case::LShapeFree => assert_eq!(contact, 0, "{case}"),
            Case::FullContact | Case::Biactive => assert_eq!(contact, interior, "{case}"),
            _ => assert!((1..interior).contains(&contact.as_u64().unwrap()), "{case}: {contact}"),
        }
    }
}

#[test]
fn solve_writes_four_files_where_it_is_told() {
    let folder = folder_with(CASE);
    let table = run(folder.path(), "solve plates.toml").success();
    let expected = ["out/", "out/plates/"].map(String::from).into_iter();
    let expected = expected.chain(RESULTS.map(|name| format!("out/plates/{name}")));
    assert_eq!(files(folder.path()), expected.chain(["plates.toml".into()]).collect::<Vec<_>>());
    assert!(table.contains("out/plates/{solution.vtu, rim.vtp, summary.json, membranes.png}"), "{table}");
    assert_eq!(lines_too_long(&table), [""; 0]);

    run(folder.path(), "solve plates.toml --out a/b/c").success();
    assert_eq!(files(&folder.path().join("a/b/c")), RESULTS);
}

#[test]
fn the_summary_keeps_its_contract() {
    let folder = folder_with(CASE);
    run(folder.path(), "solve plates.toml --out results").success();
    let summary = summary(&folder.path().join("results"));
    assert_eq!(summary["title"], "plates");
    assert_eq!(summary["backend"], "active-set");
    assert!(summary["choice"].as_str().is_some_and(|choice| choice.contains("few unknowns")));
    assert_eq!(summary["status"], "solved");
    assert_eq!(summary["certified"], true);
    assert_eq!(summary["vertices"], VERTICES);
    assert_eq!(summary["triangles"], 2 * 4 * 4);
    assert_eq!(summary["unknowns"], 2 * INTERIOR);
    assert!(summary["iterations"].as_u64().is_some_and(|count| count > 0));
    assert!(summary["energy"].as_f64().is_some_and(|energy| energy < UNLOADED_ENERGY));
    let contact = summary["contact_vertices"].as_u64().expect("a count");
    assert!((1..INTERIOR).contains(&contact), "{contact}");
    let area = summary["contact_area"].as_f64().expect("an area");
    // Each inner vertex of this mesh has the same dual cell, of the area of a cell of the grid.
    assert!((area - contact as f64 / 16.0).abs() < 1e-12, "{area}");
    assert!(summary["total_force"].as_f64().is_some_and(|force| force > 0.0));
    let tolerance = summary["tolerance"].as_f64().expect("a tolerance");
    let residuals =
        ["stationarity", "primal", "dual_sign", "complementarity", "action_mismatch", "dual_mismatch"];
    for name in residuals {
        let residual = summary["residuals"][name].as_f64().expect(name);
        assert!((0.0..=tolerance).contains(&residual), "{name} {residual}");
    }
    for name in ["mesh", "assembly", "setup", "solve", "bound", "output"] {
        assert!(summary["seconds"][name].as_f64().is_some_and(|seconds| seconds >= 0.0), "{name}");
    }
}

#[test]
fn arguments_come_before_the_case_file() {
    let folder = folder_with(CASE);
    let arguments = "--refine 1 --tolerance 1e-5 --no-polish --backend clarabel --out results";
    run(folder.path(), &format!("solve plates.toml {arguments}")).success();
    let changed = summary(&folder.path().join("results"));
    assert_eq!(changed["vertices"], 9 * 9);
    assert_eq!(changed["tolerance"], 1e-5);
    assert!(changed["polish"].is_null());

    run(folder.path(), "solve plates.toml --backend clarabel --out results").success();
    let as_in_file = summary(&folder.path().join("results"));
    assert_eq!(as_in_file["vertices"], VERTICES);
    assert_eq!(as_in_file["tolerance"], 1e-8);
    assert!(as_in_file["polish"].is_object());
    assert!(as_in_file["choice"].is_null(), "it was named");
}

#[test]
fn quiet_is_quiet() {
    let folder = folder_with(CASE);
    for command in ["solve plates.toml", "check plates.toml", "export plates.toml --format mtx"] {
        assert_ne!(run(folder.path(), command).success(), "", "{command}");
        assert_eq!(run(folder.path(), &format!("{command} --quiet")).success(), "", "{command}");
    }
}

#[test]
fn a_reader_that_goes_away_is_no_error_but_a_full_disk_is() {
    let folder = tempdir().unwrap();
    let (reader, writer) = io::pipe().unwrap();
    drop(reader);
    let output = command(folder.path(), "cases").stdout(writer).output().unwrap();
    Run::from(output).success();

    if let Ok(full) = fs::File::options().write(true).open("/dev/full") {
        let run = Run::from(command(folder.path(), "cases").stdout(full).output().unwrap());
        assert_eq!(run.code, Some(2));
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    }
}

#[test]
fn what_is_not_certified_leaves_no_solution() {
    let folder = folder_with(CASE);
    run(folder.path(), "solve plates.toml --out results").success();
    let results = folder.path().join("results");
    fs::write(results.join("notes.txt"), "the user's own").unwrap();

    let stopped = format!("{CASE}\n[solver]\nmax_iterations = 1\npolish = false\n");
    fs::write(folder.path().join("plates.toml"), stopped).unwrap();
    let run = run(folder.path(), "solve plates.toml --out results");
    assert_eq!((run.code, run.stdout.as_str()), (Some(1), ""));
    assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    for word in ["error: plates.toml: ", "does not certify", "iteration_limit", "allow more iterations"] {
        assert!(run.stderr.contains(word), "{word}: {}", run.stderr);
    }
    assert_eq!(
        files(&results),
        ["membranes.json", "notes.txt", "summary.json"],
        "the earlier solution is not this run's"
    );
    let summary = summary(&results);
    assert_eq!(summary["certified"], false);
    assert_eq!(summary["status"], "iteration_limit");
    assert_eq!(summary["iterations"], 1);
    assert!(summary["residuals"]["stationarity"].as_f64().unwrap() > summary["tolerance"].as_f64().unwrap());
    for name in ["energy", "contact_vertices", "contact_area", "total_force"] {
        assert!(summary[name].is_null(), "{name}: {}", summary[name]);
    }
}

#[test]
fn the_same_case_gives_the_same_bytes() {
    let folder = folder_with(CASE);
    let solved = |case: &str, out: &str| {
        fs::write(folder.path().join("plates.toml"), case).unwrap();
        run(folder.path(), &format!("solve plates.toml --out {out}")).success();
        ["solution.vtu", "membranes.png"].map(|name| fs::read(folder.path().join(out).join(name)).unwrap())
    };
    let first = solved(CASE, "first");
    assert!(first == solved(CASE, "second"));
    let [vtu, png] = solved(&CASE.replace("-2.0", "-2.1"), "third");
    assert!(vtu != first[0] && png != first[1], "another load is seen in both files");
}

#[test]
fn export_writes_each_format() {
    let folder = folder_with(CASE);
    let formats: [(&str, &[&str], &[u8]); 3] = [
        ("qps", &["problem.qps"], b"NAME"),
        ("npz", &["problem.npz"], b"PK"),
        (
            "mtx",
            &["problem_A.mtx", "problem_P.mtx", "problem_b.mtx", "problem_c.mtx", "problem_q.mtx"],
            b"%%MatrixMarket matrix ",
        ),
    ];
    for (format, names, magic) in formats {
        let told = run(folder.path(), &format!("export plates.toml --format {format} --out {format}"));
        let told = told.success();
        let written: Vec<String> = files(&folder.path().join(format));
        assert_eq!(written, [&["membranes.json"], names].concat());
        for name in names {
            assert!(told.contains(&format!("{format}/{name}\n")), "{told}");
            assert!(fs::read(folder.path().join(format).join(name)).unwrap().starts_with(magic), "{name}");
        }
    }
}

#[test]
fn check_shows_every_backend_side_by_side_and_writes_nothing() {
    let folder = folder_with(CASE);
    let table = run(folder.path(), "check plates.toml").success();
    assert_eq!(lines_too_long(&table), [""; 0]);
    let row = |name: &str| -> Vec<&str> {
        let line = table.lines().find(|line| line.trim_start().starts_with(name));
        line.unwrap_or_else(|| panic!("no row {name}: {table}")).split_whitespace().collect()
    };
    let names = row("multigrid");
    assert_eq!(names.iter().filter(|&&name| name == "clarabel").count(), 2);
    let of_osqp = names.iter().filter(|&&name| name == "osqp").count();
    assert_eq!(of_osqp, if cfg!(feature = "osqp") { 2 } else { 0 });
    for name in ["stationarity", "complementarity", "action_mismatch", "certified", "energy"] {
        assert_eq!(row(name).len(), 1 + names.len(), "{table}");
    }
    assert_eq!(row("certified")[1], "yes", "the first solver is certified");
    assert_eq!(files(folder.path()), ["plates.toml"]);
}

#[test]
fn the_dual_mesh_is_written_when_asked_for() {
    let folder = folder_with(CASE);
    let table = run(folder.path(), "solve plates.toml --out results --dual").success();
    let words = table.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("membranes.png, dual.vtu, flux.vtu, mesh.png}"), "{table}");
    let mut expected = RESULTS.to_vec();
    expected.extend(["dual.vtu", "flux.vtu", "mesh.png"]);
    expected.sort_unstable();
    assert_eq!(files(&folder.path().join("results")), expected);
}

/// A case with a known solution, small.
const KNOWN: &str = "case = \"strip\"\n\n[mesh]\ncells = 4\n\n[solver]\nbackend = \"active-set\"\n";

#[test]
fn converge_goes_on_from_the_levels_that_are_there() {
    let folder = folder_with(KNOWN);
    let levels = |text: &str| text.lines().skip(1).map(str::to_owned).collect::<Vec<_>>();
    let converge = |count: usize| {
        let arguments = format!("converge plates.toml --levels {count} --out results");
        let table = run(folder.path(), &arguments).success();
        assert_eq!(lines_too_long(&table), [""; 0]);
        levels(&fs::read_to_string(folder.path().join("results/summary.csv")).expect("it is there"))
    };
    let first = converge(2);
    let more = converge(3);
    assert_eq!((first.len(), more.len()), (2, 3));
    // The seconds in the rows tell that the first levels were kept, not computed again.
    assert_eq!(more[..2], first);
    let expected = ["convergence.md", "convergence.png", "membranes.json", "summary.csv"];
    assert_eq!(files(&folder.path().join("results")), expected);

    fs::write(folder.path().join("plates.toml"), KNOWN.replace("cells = 4", "cells = 5")).expect("writable");
    let refused = run(folder.path(), "converge plates.toml --levels 2 --out results");
    assert_eq!(refused.code, Some(2), "another case does not take their place");
    let told = run(folder.path(), "converge plates.toml --levels 2 --out results --overwrite -q");
    told.success();
    let other = levels(&fs::read_to_string(folder.path().join("results/summary.csv")).expect("it is there"));
    assert_eq!(other.len(), 2, "another case starts anew");
    assert_ne!(other[0], first[0]);
}

#[test]
fn converge_needs_a_known_solution() {
    let folder = folder_with(CASE);
    let refused = run(folder.path(), "converge plates.toml --out results");
    assert_eq!(refused.code, Some(2));
    assert!(refused.stderr.contains("case = "), "{}", refused.stderr);
    assert!(!folder.path().join("results").exists());
}

#[test]
fn a_mesh_file_lies_beside_the_case_file() {
    let folder = tempdir().unwrap();
    let below = folder.path().join("below");
    fs::create_dir(&below).unwrap();
    let case = CASE.replace("shape = \"square\"", "mesh = \"plate.msh\"").replace("cells = 4", "refine = 1");
    fs::write(below.join("plates.toml"), case).unwrap();
    fs::write(below.join("plate.msh"), super::bad_input::MESH).unwrap();
    run(folder.path(), "solve below/plates.toml --out results").success();
    // 6 vertices in triangles and 1 in none; refined, one more for each of the 11 edges.
    assert_eq!(summary(&folder.path().join("results"))["vertices"], 7 + 11);
    assert_eq!(run(&below, "solve plates.toml").code, Some(0));
    assert_eq!(files(&below.join("out/plates")), RESULTS);
}
