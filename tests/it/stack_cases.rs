//! The stacks with known solutions, as the program's user meets them; the rims of contact sets as a file.

use std::fs;

use membrane_contact::problem::{NamedCase, StackCase};
use serde_json::Value;
use tempfile::tempdir;

use crate::program::{files, folder_with_case, lines_too_long, run};

#[test]
fn every_case_is_in_the_table_and_has_its_formulas() {
    let folder = tempdir().unwrap();
    let list = run(folder.path(), "cases").success();
    assert_eq!(lines_too_long(&list), [""; 0]);
    for case in NamedCase::all() {
        let row = |line: &str| {
            line.trim_start().starts_with(&format!("{} ", case.name())) && line.contains(case.letter())
        };
        assert!(list.lines().any(row), "{}: {list}", case.name());
        assert!(list.contains(&format!("\n{} ({})\n", case.name(), case.letter())), "{}", case.name());
        assert!(case.formulas().iter().all(|line| list.contains(line)), "{}", case.name());
    }
}

#[test]
fn every_stack_can_be_printed_solved_checked_and_exported() {
    for case in StackCase::ALL {
        let folder = tempdir().unwrap();
        let printed = run(folder.path(), &format!("cases {case}")).success();
        assert_eq!(lines_too_long(&printed), [""; 0]);
        let coarse = printed.replace("cells = 64", "cells = 8");
        assert_ne!(coarse, printed, "{case}");
        fs::write(folder.path().join("case.toml"), coarse).unwrap();
        let table = run(folder.path(), "solve case.toml").success();
        assert_eq!(lines_too_long(&table), [""; 0]);
        assert!(table.contains("{solution.vtu, rim.vtp, summary.json, membranes.png}"), "{table}");
        let text = fs::read_to_string(folder.path().join("out/case/summary.json")).unwrap();
        let summary: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(summary["certified"], true, "{case}");
        let contacts = summary["contacts"].as_array().unwrap();
        assert!(
            contacts.iter().all(|gap| gap["contact_vertices"].as_u64().unwrap() > 0),
            "{case}: {contacts:?}"
        );
        run(folder.path(), "check case.toml").success();
        run(folder.path(), "export case.toml --format npz --out exported").success();
    }
}

/// The columns of `summary.csv`, as text.
fn columns(text: &str) -> (Vec<&str>, Vec<Vec<&str>>) {
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    (lines.next().unwrap(), lines.collect())
}

#[test]
fn stacks_converge_with_rates_rims_and_shared_sets() {
    let folder = folder_with_case("case = \"ball\"\n[mesh]\ncells = 8\n");
    let table = run(folder.path(), "converge case.toml --levels 4").success();
    assert_eq!(lines_too_long(&table), [""; 0]);
    let words = ["u in H1", "rim", "1 - Jacc", "all levels", "Hausdorff distance"];
    assert!(words.iter().all(|word| table.contains(word)), "{table}");
    assert!(table.contains("index") && !table.contains("lam H-1"), "{table}");
    let text = fs::read_to_string(folder.path().join("out/case/summary.csv")).unwrap();
    let (names, rows) = columns(&text);
    let column = |name: &str| {
        let k = names.iter().position(|other| *other == name).unwrap_or_else(|| panic!("{name}: {names:?}"));
        rows.iter().map(|row| row[k].to_owned()).collect::<Vec<_>>()
    };
    let numbers = |name: &str| column(name).iter().map(|text| text.parse().unwrap()).collect::<Vec<f64>>();
    assert!(column("lambda_dual").iter().all(String::is_empty), "there is none");
    let bounds = numbers("bound").into_iter().zip(numbers("energy"));
    assert!(bounds.into_iter().all(|(bound, error)| error <= bound && bound < 2.5 * error), "{text}");
    let rate = |name: &str| (numbers(name)[1] / numbers(name)[3]).log2() / 2.0;
    assert!((0.9..1.1).contains(&rate("h1")) && (1.6..2.4).contains(&rate("l2")), "{text}");
    let jaccard = numbers("jaccard");
    assert!(jaccard[3] > 0.95 && jaccard[3] < 1.0 && numbers("rim_distance")[3] < numbers("h")[3], "{text}");
    // A run that goes on, and one that has nothing to do, have the same table.
    let more = run(folder.path(), "converge case.toml --levels 5").success();
    let again = run(folder.path(), "converge case.toml --levels 5").success();
    assert_eq!(more, again);
    let levels = fs::read_to_string(folder.path().join("out/case/summary.csv")).unwrap();
    assert!(levels.starts_with(&text) && levels.lines().count() == 6);
}

#[test]
fn pairs_have_the_rim_where_the_exact_one_is_a_curve() {
    for (case, has_rim) in [("disk", true), ("annulus", false)] {
        let folder = folder_with_case(&format!("case = \"{case}\"\n[mesh]\ncells = 8\n"));
        let table = run(folder.path(), "converge case.toml --levels 2").success();
        assert_eq!(lines_too_long(&table), [""; 0]);
        assert_eq!(table.contains("1 - Jacc"), has_rim, "{table}");
        assert!(table.contains("index"), "{table}");
    }
}

#[test]
fn parameters_that_do_not_suit_a_stack_are_refused_in_one_line() {
    let refused = |case: &str, arguments: &str| {
        let folder = folder_with_case(&format!("{case}\n[mesh]\ncells = 4\n"));
        let run = run(folder.path(), arguments);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert_eq!(run.stderr.trim_end().lines().count(), 1, "{run:?}");
        run.stderr
    };
    let of = |parameters: &str, command: &str| {
        refused(&format!("case = \"ball\"\n[parameters]\n{parameters}"), command)
    };
    assert!(of("R = 0.95", "solve case.toml").contains("choose 0 < R < 0.9"));
    assert!(of("r = 0.5", "solve case.toml").contains("the nearest is `R`"));
    let misspelt = refused("case = \"three-disks\"", "solve case.toml");
    assert!(misspelt.contains("nearest is `three-discs`"), "{misspelt}");
}

/// `rim.vtp` belongs to the results: it is replaced with them, and goes where there is no solution.
#[test]
fn the_rim_is_a_file_of_the_solution() {
    let folder = folder_with_case("case = \"three-discs\"\n[mesh]\ncells = 12\n");
    run(folder.path(), "solve case.toml -q").success();
    let path = folder.path().join("out/case/rim.vtp");
    let first = fs::read_to_string(&path).unwrap();
    assert!(first.contains(r#"type="PolyData""#) && first.contains(r#"NumberOfLines="2""#), "{first}");
    let other = folder_with_case("case = \"no-contact\"\n[mesh]\ncells = 4\n");
    let text = fs::read_to_string(other.path().join("case.toml")).unwrap();
    fs::write(folder.path().join("case.toml"), text).unwrap();
    assert_eq!(run(folder.path(), "solve case.toml -q").code, Some(2), "results of another case");
    assert_eq!(fs::read_to_string(&path).unwrap(), first);
    run(folder.path(), "solve case.toml -q --overwrite").success();
    let second = fs::read_to_string(&path).unwrap();
    assert!(second.contains(r#"NumberOfLines="0""#), "{second}");
    assert!(files(&folder.path().join("out/case")).contains(&"rim.vtp".to_owned()));
}
