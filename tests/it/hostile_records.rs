//! What may lie in a folder for results in place of the record of its case, `membranes.json`: whatever it is, the results
//! beside it are not put at risk, and the program ends with one line.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tempfile::TempDir;

use super::program::{folder_with_case, run};

const CASE: &str = "case = \"l-shape-free\"\n[mesh]\ncells = 4\n";

/// The longest message: two excerpts of a record, and the words around them.
const LONGEST_MESSAGE: usize = 500;

/// A folder with results of [`CASE`], and its record.
fn solved() -> (TempDir, PathBuf) {
    let folder = folder_with_case(CASE);
    run(folder.path(), "solve case.toml -q").success();
    let record = folder.path().join("out/case/membranes.json");
    (folder, record)
}

/// Why the results are not replaced.
fn refused(folder: &Path) -> String {
    let summary = || fs::read(folder.join("out/case/summary.json")).expect("it is there");
    let before = summary();
    let run = run(folder, "solve case.toml");
    assert_eq!((run.code, run.stderr.lines().count()), (Some(2), 1), "{}", run.stderr);
    assert!(run.stderr.contains("--overwrite") && run.stderr.contains("--out"), "{}", run.stderr);
    assert!(run.stderr.chars().count() <= LONGEST_MESSAGE, "{}", run.stderr);
    assert!(!run.stderr.trim_end().contains(char::is_control), "{:?}", run.stderr);
    assert!(summary() == before);
    run.stderr
}

/// Texts that are no record, made from one.
fn no_records(record: &str) -> Vec<String> {
    let with = |key: &str, value: Value| {
        let mut record: Value = serde_json::from_str(record).expect("a record");
        record[key] = value;
        record.to_string()
    };
    let deep = |open: &str, close: &str| format!("{}1{}", open.repeat(100_000), close.repeat(100_000));
    let last = record.trim_end().len();
    let cut = (0..last).step_by(last / 12).map(|end| record[..end].to_owned());
    let other = ["null", "0", "\"\"", "{}", "[[]]", "\0", "\u{feff}{}", "{\"case\": \"a\", \"case\": \"a\"}"];
    let large = [
        deep("[", "]"),
        deep("{\"settings\":", "}"),
        with("settings", json!({})).replace("{}", &deep("{\"a\":", "}")),
        // Longer than any record, and one that would be one.
        record.to_owned() + &" ".repeat(1 << 20),
    ];
    let wrong_types = [
        with("case", Value::Null),
        with("fingerprint", json!(1)),
        with("settings", json!([1])),
        with("settings", json!({"solution": {"a": 1}})),
        with("settings", json!("solution")),
    ];
    cut.chain(other.map(String::from)).chain(large).chain(wrong_types).collect()
}

#[test]
fn no_text_but_a_record_speaks_for_results() {
    let (folder, path) = solved();
    let record = fs::read_to_string(&path).unwrap();
    for text in no_records(&record) {
        fs::write(&path, &text).unwrap();
        let shown: String = text.chars().take(100).collect();
        let why = refused(folder.path());
        assert!(why.contains("holds summary.json, and no record of its case"), "{shown}: {why}");
    }
    // What a newer version may add to it is no harm.
    let mut newer: Value = serde_json::from_str(&record).unwrap();
    newer["version"] = json!([2]);
    for text in [newer.to_string(), record] {
        fs::write(&path, text).unwrap();
        run(folder.path(), "solve case.toml -q").success();
    }
}

#[test]
fn what_is_shown_of_a_record_is_short_and_one_line() {
    let (folder, path) = solved();
    let record: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    for text in ["a\nb\r\u{1b}[2J", &"\u{1f980}".repeat(5_000)] {
        let mut changed = record.clone();
        changed["settings"]["solution"] = text.into();
        let other = json!({"case": text, "fingerprint": "", "settings": {}});
        for (record, says) in [(changed, "of other settings"), (other, "results of another case")] {
            fs::write(&path, record.to_string()).unwrap();
            let why = refused(folder.path());
            assert!(why.contains(says), "{why}");
        }
    }
}

#[test]
fn a_folder_in_place_of_a_file_is_said() {
    let (folder, path) = solved();
    fs::remove_file(&path).unwrap();
    fs::create_dir(&path).unwrap();
    assert!(refused(folder.path()).contains("no record of its case"));
    // It cannot be replaced, nor can results be.
    let (folder_of_result, _) = solved();
    let summary = folder_of_result.path().join("out/case/summary.json");
    fs::remove_file(&summary).unwrap();
    fs::create_dir(&summary).unwrap();
    for (folder, name) in [(folder, "membranes.json"), (folder_of_result, "summary.json")] {
        let run = run(folder.path(), "solve case.toml --overwrite --refine 1");
        assert_eq!((run.code, run.stderr.lines().count()), (Some(2), 1), "{name}: {}", run.stderr);
        assert!(run.stderr.contains(name) && run.stderr.contains("--out"), "{name}: {}", run.stderr);
    }
}

#[cfg(unix)]
#[test]
fn what_has_no_end_is_not_read() {
    let (folder, path) = solved();
    let remove = || fs::remove_file(&path).unwrap();
    let pipe = || assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success());
    let device = || std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
    let sparse = || fs::File::create(&path).unwrap().set_len(1 << 40).unwrap();
    for make in [&pipe as &dyn Fn(), &device, &sparse] {
        remove();
        make();
        assert!(refused(folder.path()).contains("no record of its case"));
    }
    run(folder.path(), "solve case.toml -q --overwrite").success();
    assert!(fs::read_to_string(&path).unwrap().contains("case.toml"), "the record is a file again");
}

/// The levels that a study goes on from: what is no table of them is made anew.
#[cfg(unix)]
#[test]
fn levels_without_end_are_computed_anew() {
    let folder = folder_with_case("case = \"strip\"\n[mesh]\ncells = 4\n");
    let converge = || run(folder.path(), "converge case.toml -q --levels 2 --no-picture").success();
    converge();
    let path = folder.path().join("out/case/summary.csv");
    let rows = || fs::read_to_string(&path).unwrap().lines().count();
    assert_eq!(rows(), 3);
    let device = || std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
    // Sparse: one cell of a terabyte.
    let sparse = || fs::File::create(&path).unwrap().set_len(1 << 40).unwrap();
    let nonsense = || fs::write(&path, [b"\"".repeat(1 << 20), vec![0xff; 1 << 20]].concat()).unwrap();
    for make in [&device as &dyn Fn(), &sparse, &nonsense] {
        fs::remove_file(&path).unwrap();
        make();
        converge();
        assert_eq!(rows(), 3);
    }
}

/// What a run that was killed may have left is removed; what only has its name is not opened.
#[cfg(unix)]
#[test]
fn a_pipe_that_is_called_unfinished_holds_up_nothing() {
    let (folder, _) = solved();
    let part = |name: &str| folder.path().join("out/case").join(format!(".membranes-{name}.part"));
    fs::write(part("1-a"), "half a file").unwrap();
    fs::create_dir(part("1-b")).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(part("1-c")).status().unwrap().success());
    run(folder.path(), "solve case.toml -q").success();
    assert_eq!(["1-a", "1-b", "1-c"].map(|name| part(name).exists()), [false, true, true]);
}
