//! The same with the program, as a user meets it: certified, or one line that says what to do, and never a number that is none.

use std::fs;

use serde_json::Value;

use super::outputs::absent_numbers;
use crate::program::{folder_with_case, run};

/// What is written in place of the plates' own lines, and what must come out: nothing where it is certified, else what the
/// message has to say.
type Change = (&'static [(&'static str, &'static str)], &'static [&'static str]);

const PLATES: &str = r#"
[membranes]
tension = [1.0, 3.0]
load = [-15.0, 10.0]
height = 0.1

[domain]
shape = "square"

[mesh]
cells = 4
"#;

const SQUARE: &str = "shape = \"square\"";
const TOUCHING_HOLES: &str = "shape = \"polygon\"\nvertices = [[0, 0], [1, 0], [1, 1], [0, 1]]\n\
    holes = [[[0.2, 0.2], [0.5, 0.5], [0.2, 0.5]], [[0.5, 0.5], [0.8, 0.5], [0.8, 0.8]]]";

const CHANGES: &[Change] = &[
    (&[], &[]),
    (&[("[1.0, 3.0]", "[1.0, 1e12]")], &[]),
    (&[("[1.0, 3.0]", "[1e12, 1.0]")], &[]),
    (&[("[-15.0, 10.0]", "[0, 0]")], &[]),
    (&[("[-15.0, 10.0]", "[0, 0]"), ("0.1", "0")], &[]),
    (&[("height = 0.1", "height = 0")], &[]),
    (&[("height = 0.1", "height = 1e30")], &[]),
    (&[("height = 0.1", "height = 1e300")], &["displacements", "other units"]),
    (&[("[-15.0, 10.0]", "[-1e-300, 1e-300]")], &["forces per area", "other units"]),
    (&[("[-15.0, 10.0]", "[-1e300, 1e300]")], &["forces per area", "other units"]),
    (&[("[-15.0, 10.0]", "[-1e400, 10.0]")], &["line 4, column 9", "overflowed"]),
    (&[("[-15.0, 10.0]", "[\"1e200*sin(1e5*x)\", 10.0]")], &["forces per area", "other units"]),
    (
        &[("height = 0.1", "height = \"if(x == 0.5 and y == 0, -1e-300, 0.1)\"")],
        &["height g is -1e-300 at the boundary vertex", "(0.5, 0)", "max(0, ...)"],
    ),
    (&[(SQUARE, "shape = \"square\"\nside = 1e-9")], &[]),
    (&[(SQUARE, "shape = \"square\"\nside = 1e9")], &[]),
    (&[(SQUARE, "shape = \"square\"\nside = 1e-45")], &["rounding", "scale the domain"]),
    (&[(SQUARE, "shape = \"rectangle\"\nupper = [1, 1e-12]")], &["vertices, more than", "coarser"]),
    (&[(SQUARE, "shape = \"rectangle\"\nupper = [1e3, 1]"), ("cells = 4", "cells = 1")], &[]),
    (&[("cells = 4", "cells = 1")], &[]),
    (&[(SQUARE, "shape = \"disk\"\nradius = 1e-9"), ("cells = 4", "cells = 1")], &[]),
    (
        &[
            (SQUARE, "shape = \"polygon\"\nvertices = [[0, 0], [1, 0], [1, 0.000174]]"),
            ("cells = 4", "size = 0.2"),
        ],
        &[],
    ),
    (&[(SQUARE, TOUCHING_HOLES), ("cells = 4", "size = 0.2")], &["a ring touches", "keep them apart"]),
    (
        &[
            (SQUARE, "shape = \"square\"\nlower = [1e6, 1e6]\nside = 1e-8"),
            ("cells = 4", "cells = 1\nrefine = 9"),
        ],
        &["cannot be divided", "refine less"],
    ),
];

/// What is wrong with the way in which the program takes a change.
fn complaint((replacements, says): &Change) -> Result<(), String> {
    let mut case = PLATES.to_owned();
    for (from, to) in *replacements {
        assert!(case.contains(from), "{from:?} is in the case");
        case = case.replace(from, to);
    }
    let folder = folder_with_case(&case);
    let run = run(folder.path(), "solve case.toml --out results");
    if !says.is_empty() {
        let is_one_line = run.stderr.starts_with("error: case.toml") && run.stderr.lines().count() == 1;
        let is_said =
            says.iter().all(|word| run.stderr.contains(word)) && run.stderr.len() <= super::LONGEST_MESSAGE;
        return if run.code == Some(2) && is_one_line && is_said { Ok(()) } else { Err(format!("{run:?}")) };
    }
    if (run.code, run.stderr.as_str()) != (Some(0), "")
        || run.stdout.contains("NaN")
        || run.stdout.contains("inf")
    {
        return Err(format!("{run:?}"));
    }
    let summary = fs::read(folder.path().join("results/summary.json")).map_err(|error| error.to_string())?;
    let summary: Value = serde_json::from_slice(&summary).map_err(|error| error.to_string())?;
    let beyond = summary["residual_beyond_rounding"].as_f64();
    match absent_numbers(&summary).first() {
        Some(absent) => Err(absent.clone()),
        None if beyond.is_none_or(|beyond| beyond > 1e-8) => Err(format!("{beyond:?} beyond rounding")),
        None => Ok(()),
    }
}

#[test]
fn every_case_file_is_solved_or_refused_as_it_should_be() {
    let complaints: Vec<String> = CHANGES
        .iter()
        .filter_map(|change| complaint(change).err().map(|complaint| format!("{:?}: {complaint}", change.0)))
        .collect();
    assert_eq!(complaints, [""; 0]);
}

/// The negative test: a case that is solved where an error is expected, and one that is refused where none is.
#[test]
fn the_other_outcome_is_seen() {
    assert!(complaint(&(&[], &["other units"])).is_err());
    assert!(complaint(&(&[("height = 0.1", "height = 1e300")], &[])).is_err());
    assert!(complaint(&(&[("height = 0.1", "height = 1e300")], &["another remedy"])).is_err());
}

/// Membranes at rest have no error at all: nothing is refined.
#[test]
fn nothing_is_adapted_where_nothing_moves() {
    let folder = folder_with_case(&PLATES.replace("[-15.0, 10.0]", "[0, 0]").replace("0.1", "0"));
    run(folder.path(), "adapt case.toml --out results").success();
    let table = fs::read_to_string(folder.path().join("results/adapt.csv")).expect("there is a table");
    assert_eq!(table.lines().count(), 2, "a head and one level: {table}");
}
