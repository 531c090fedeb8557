//! Answers from elsewhere before our certificate: `membranes check --answer`.

use std::fs;
use std::io::Write;
use std::path::Path;

use membrane_contact::cli::CaseFile;
use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::{Pattern, rectangle};
use membrane_contact::qp::{Clarabel, QpBackend, QpOptions, contact_qp};
use npyz::WriterBuilder;
use serde_json::Value;
use tempfile::TempDir;
use zip::write::SimpleFileOptions;

use super::program::{Run, files, folder_with_case, run};

const CELLS: usize = 6;

/// What the interior-point method reaches on this small program, and what it does not.
const REACHED: &str = "1e-7";
const TOO_MUCH: &str = "1e-15";

const CASE: &str = r#"
[membranes]
tension = [1.0, 3.0]
load = [-15.0, "10*sin(pi*x)"]
height = "0.1 + 0.05*x"

[domain]
shape = "square"

[mesh]
cells = 6
"#;

/// What a user of another solver has: the exported program's solution `(x, y)`, by a backend without polish.
fn solved_elsewhere() -> (Vec<f64>, Vec<f64>) {
    let case = CaseFile::parse("case.toml", CASE, Path::new("case.toml")).expect("a valid case");
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [CELLS, CELLS], Pattern::Right).expect("a mesh");
    let d = PairDiscretization::new(&case.problem, mesh.clone()).expect("valid data");
    let options = QpOptions { tolerance: 1e-12, ..QpOptions::default() };
    let solution = Clarabel.solve(&contact_qp(&d), &options).expect("it runs");
    (solution.x, solution.y)
}

fn write_answer(path: &Path, x: &[f64], y: &[f64]) {
    let mut zip = zip::ZipWriter::new(fs::File::create(path).expect("writable"));
    for (name, values) in [("x.npy", x), ("y.npy", y)] {
        zip.start_file(name, SimpleFileOptions::default()).expect("writable");
        let mut array = npyz::WriteOptions::new()
            .default_dtype()
            .shape(&[values.len() as u64])
            .writer(&mut zip)
            .begin_nd()
            .expect("writable");
        array.extend(values.iter().copied()).expect("writable");
        array.finish().expect("writable");
    }
    zip.finish().expect("writable").flush().expect("writable");
}

fn folder_with(x: &[f64], y: &[f64]) -> TempDir {
    let folder = folder_with_case(CASE);
    write_answer(&folder.path().join("answer.npz"), x, y);
    folder
}

fn judge(folder: &Path, further: &str) -> Run {
    run(folder, &format!("check case.toml --answer answer.npz {further}"))
}

fn summary(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("verdict/summary.json")).expect("it is there");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn a_good_answer_is_certified_and_shown_like_a_backend() {
    let (x, y) = solved_elsewhere();
    let folder = folder_with(&x, &y);
    let good = judge(folder.path(), &format!("--tolerance {REACHED} --out verdict"));
    assert_eq!((good.code, good.stderr.as_str()), (Some(0), ""), "{}", good.stdout);
    let row = |name: &str| {
        let line = good.stdout.lines().find(|line| line.trim_start().starts_with(name));
        line.unwrap_or_else(|| panic!("no row {name}: {}", good.stdout))
            .split_whitespace()
            .collect::<Vec<_>>()
    };
    assert_eq!(row("answer"), ["answer"]);
    assert_eq!(row("certified"), ["certified", "yes"]);
    assert_eq!(row("stationarity").len(), 2);
    let summary = summary(folder.path());
    assert_eq!((&summary["backend"], &summary["status"]), (&"answer".into(), &"unknown".into()));
    assert_eq!((&summary["certified"], &summary["tolerance"]), (&true.into(), &1e-7.into()));
    assert!(summary["contact_vertices"].as_u64().is_some_and(|count| count > 0));
    assert_eq!(files(&folder.path().join("verdict")), ["membranes.json", "summary.json"]);

    let quiet = judge(folder.path(), &format!("--tolerance {REACHED} --quiet"));
    assert_eq!((quiet.code, quiet.stdout.as_str()), (Some(0), ""));
}

#[test]
fn the_tolerance_of_the_case_file_counts_unless_another_is_named() {
    let (x, y) = solved_elsewhere();
    let folder = folder_with(&x, &y);
    let strict = format!("{CASE}\n[solver]\ntolerance = {TOO_MUCH}\n");
    fs::write(folder.path().join("case.toml"), strict).expect("writable");
    assert_eq!(judge(folder.path(), "").code, Some(1));
    assert_eq!(judge(folder.path(), &format!("--tolerance {REACHED}")).code, Some(0));
    // It is the same without an answer.
    assert_eq!(run(folder.path(), &format!("check case.toml --tolerance {REACHED} --quiet")).code, Some(0));
}

#[test]
fn a_wrong_answer_is_shown_but_not_certified() {
    let (x, y) = solved_elsewhere();
    let negated: Vec<f64> = y.iter().map(|y| -y).collect();
    let (mut moved, middle, zero) = (x.clone(), x.len() / 4, vec![0.0; x.len()]);
    let z = vec![0.0; y.len()];
    moved[middle] += 1e-6;
    for (x, y, says, remedy) in [
        (&x, &negated, "stationarity", "with -y in place of y it certifies"),
        (&moved, &y, "action_mismatch", "polished it certifies"),
        (&moved, &negated, "stationarity", "with -y in place of y, and polished"),
        (&zero, &z, "stationarity", "allow more with --tolerance"),
    ] {
        let folder = folder_with(x, y);
        let wrong = judge(folder.path(), &format!("--tolerance {REACHED} --out verdict"));
        assert_eq!(wrong.code, Some(1), "{}", wrong.stdout);
        assert_eq!(wrong.stderr.lines().count(), 1, "{}", wrong.stderr);
        for word in ["error: case.toml: answer does not certify", says, remedy] {
            assert!(wrong.stderr.contains(word), "{word}: {}", wrong.stderr);
        }
        let rows: Vec<&str> = wrong.stdout.lines().filter(|line| line.contains("certified")).collect();
        assert!(rows.len() == 1 && rows[0].ends_with(" no"), "{}", wrong.stdout);
        let summary = summary(folder.path());
        assert_eq!(summary["certified"], false);
        assert!(summary["residuals"][says].as_f64().expect("a number") > 1e-7);
        assert!(summary["contact_vertices"].is_null());
    }
}

#[test]
fn what_is_no_answer_is_refused_in_one_line() {
    let (x, y) = solved_elsewhere();
    let mut poisoned = x.clone();
    poisoned[3] = f64::NAN;
    let unknowns = (CELLS - 1) * (CELLS - 1);
    let refusals = [
        (&x[1..], &y[..], format!("`x` has the shape ({},)", 2 * unknowns - 1)),
        (&x[..], &x[..], format!("`y` has the shape ({},)", 2 * unknowns)),
        (&poisoned[..], &y[..], "`x` holds NaN (entry 3)".into()),
    ];
    let refused = |folder: &Path, says: &str| {
        let before = files(folder);
        let run = judge(folder, "--out verdict");
        assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""), "{says}");
        assert!(run.stderr.starts_with("error: answer.npz: ") && run.stderr.contains(says), "{}", run.stderr);
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
        assert_eq!(files(folder), before, "nothing is written");
    };
    for (x, y, says) in refusals {
        refused(folder_with(x, y).path(), &says);
    }
    let folder = folder_with(&x, &y);
    fs::write(folder.path().join("answer.npz"), "x = [1, 2, 3]\n").expect("writable");
    refused(folder.path(), "no numpy archive");
    fs::remove_file(folder.path().join("answer.npz")).expect("it was there");
    refused(folder.path(), "name a readable file");
}

#[test]
fn a_folder_for_the_verdict_needs_an_answer() {
    let (x, y) = solved_elsewhere();
    let folder = folder_with(&x, &y);
    let run = run(folder.path(), "check case.toml --out verdict");
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("--answer"), "{}", run.stderr);
    assert!(!folder.path().join("verdict").exists());
}
