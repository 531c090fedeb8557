//! The same input makes the same bytes, in every run and with any number of threads.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::program::{Run, command, files, folder_with_case};
use super::timeless::timeless;

/// Files by name, without what they say about time.
type Files = BTreeMap<String, Vec<u8>>;

/// A case file and what is run on it.
struct Work {
    case: &'static str,
    arguments: &'static [&'static str],
}

/// More vertices than the active set method is chosen for, and more than parallel loops leave in one piece.
const SQUARE: Work = Work {
    case: r#"
[membranes]
tension = [1.0, 3.0]
load = [-15.0, "10*sin(pi*x)"]
height = "0.1 + 0.05*x"

[domain]
shape = "square"

[mesh]
cells = 150
"#,
    arguments: &[
        "solve case.toml --out auto --dual",
        "solve case.toml --out active-set --backend active-set",
        "export case.toml --out export --format npz",
        "export case.toml --out export --format qps",
        "export case.toml --out export --format mtx",
    ],
};

/// The generator of unstructured meshes, levels that are algebraic, and a load that varies.
const HOLES: Work = Work {
    case: r#"
[membranes]
tension = [1.0, 3.0]
load = ["-15*(1 + x*y)", 10.0]
height = 0.02

[domain]
shape = "polygon"
vertices = [[0, 0], [2, 0], [2, 1], [1, 1.5], [0, 1]]
holes = [[[0.5, 0.3], [0.8, 0.3], [0.65, 0.6]], [[1.2, 0.4], [1.6, 0.4], [1.6, 0.7], [1.2, 0.7]]]

[mesh]
size = 0.012
"#,
    arguments: &["solve case.toml --out auto --dual", "export case.toml --out export --format npz"],
};

/// Refined again and again, uniformly and where the error is.
const LEVELS: Work = Work {
    case: r#"
case = "circle"

[mesh]
cells = 32
"#,
    arguments: &[
        "converge case.toml --out converge --levels 3",
        "adapt case.toml --out adapt --tolerance 0.03 --max-vertices 20000",
    ],
};

/// All files that the work leaves with this number of threads.
fn results(work: &Work, case: &str, threads: usize) -> Files {
    let folder = folder_with_case(case);
    for arguments in work.arguments {
        let mut command = command(folder.path(), arguments);
        let run =
            Run::from(command.env("RAYON_NUM_THREADS", threads.to_string()).output().expect("it starts"));
        assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{arguments}");
    }
    files(folder.path())
        .into_iter()
        .filter(|name| !name.ends_with('/'))
        .map(|name| read(folder.path(), name))
        .collect()
}

fn read(folder: &Path, name: String) -> (String, Vec<u8>) {
    let bytes = fs::read(folder.join(&name)).expect("it is readable");
    let bytes = timeless(&name, bytes);
    (name, bytes)
}

/// The files that are not the same, or are only on one side.
fn differing<'f>(first: &'f Files, second: &'f Files) -> Vec<&'f str> {
    let names = first.keys().chain(second.keys().filter(|name| !first.contains_key(*name)));
    names.filter(|name| first.get(*name) != second.get(*name)).map(String::as_str).collect()
}

/// Asserts that the files are the same with each number of threads; returns them.
#[track_caller]
fn same_with(work: &Work, threads: &[usize]) -> Files {
    let one = results(work, work.case, 1);
    for &threads in threads {
        let other = results(work, work.case, threads);
        assert_eq!(differing(&one, &other), [""; 0], "1 thread and {threads}");
    }
    one
}

#[test]
fn a_square_solved_and_exported() {
    let files = same_with(&SQUARE, &[4]);
    assert!(files.len() >= 6 + 3 + 6, "all files are there: {:?}", files.keys());
}

#[test]
fn an_unstructured_mesh_with_holes() {
    same_with(&HOLES, &[4]);
}

#[test]
fn levels_of_both_kinds() {
    let files = same_with(&LEVELS, &[4]);
    assert!(
        files.contains_key("adapt/checkpoint.npz") && files.contains_key("converge/summary.csv"),
        "{:?}",
        files.keys()
    );
}

#[test]
#[ignore = "long: `bash tests/long.sh`"]
fn a_square_with_70_000_vertices_with_every_number_of_threads() {
    let finer = SQUARE.case.replace("cells = 150", "cells = 264");
    same_with(&Work { case: finer.leak(), ..SQUARE }, &[2, 4]);
}

#[test]
#[ignore = "long: `bash tests/long.sh`"]
fn holes_and_levels_with_every_number_of_threads_and_again() {
    same_with(&HOLES, &[1, 2, 3, 4]);
    same_with(&LEVELS, &[1, 2, 3, 4]);
}

/// The negative test: another load is seen in every file that depends on it, and in no other.
#[test]
fn another_load_is_seen() {
    let work = Work {
        arguments: &["solve case.toml --out solve", "export case.toml --out export --format mtx"],
        ..HOLES
    };
    let case = work.case.replace("0.012", "0.1");
    let [first, second] =
        [case.clone(), case.replace("-15*", "-15.000001*")].map(|case| results(&work, &case, 1));
    let expected = ["case.toml", "export/problem_q.mtx", "solve/solution.vtu", "solve/summary.json"];
    let seen = differing(&first, &second);
    assert!(expected.iter().all(|name| seen.contains(name)), "{seen:?}");
    assert!(!seen.contains(&"export/problem_P.mtx"), "{seen:?}");
}
