//! A folder for results knows the case that made it.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use super::bad_input::MESH;
use super::program::{files, folder_with_case, run};

const CASE: &str = "case = \"l-shape-free\"\n[mesh]\ncells = 4\n";

fn write(folder: &Path, case: &str) {
    fs::write(folder.join("case.toml"), case).expect("it is writable");
}

fn results(folder: &TempDir) -> Vec<String> {
    files(&folder.path().join("out/case"))
}

/// Runs what has to be refused without touching a file, and returns why.
fn refused(folder: &TempDir, arguments: &str) -> String {
    let contents = || -> Vec<_> {
        let names = results(folder).into_iter();
        names
            .map(|name| (fs::read(folder.path().join("out/case").join(&name)).expect("readable"), name))
            .collect()
    };
    let before = contents();
    let run = run(folder.path(), arguments);
    assert_eq!((run.code, run.stderr.lines().count()), (Some(2), 1), "{arguments}: {}", run.stderr);
    assert!(run.stderr.contains("--overwrite") && run.stderr.contains("--out"), "{}", run.stderr);
    assert!(contents() == before, "{arguments}");
    run.stderr
}

#[test]
fn files_of_an_earlier_solution_go_with_it_and_those_of_others_stay() {
    let folder = folder_with_case(CASE);
    run(folder.path(), "solve case.toml -q --dual").success();
    fs::write(folder.path().join("out/case/notes.txt"), "").unwrap();
    run(folder.path(), "solve case.toml -q --refine 1").success();
    let expected =
        ["membranes.json", "membranes.png", "notes.txt", "rim.vtp", "solution.vtu", "summary.json"];
    assert_eq!(results(&folder), expected);
}

#[test]
fn another_case_is_refused_by_every_command_and_told_to_takes_the_place_of_all() {
    let folder = folder_with_case(CASE);
    for command in [
        "adapt case.toml -q --tolerance 0.2",
        "converge case.toml -q --levels 2",
        "export case.toml -q --format npz",
    ] {
        run(folder.path(), command).success();
    }
    run(folder.path(), "bench case.toml -q --levels 1 --solvers active-set").success();
    fs::write(folder.path().join("out/case/notes.txt"), "").unwrap();
    write(folder.path(), &CASE.replace('4', "5"));
    for command in ["solve", "adapt", "converge", "bench", "export --format qps"] {
        let why = refused(&folder, &format!("{command} case.toml"));
        assert!(why.contains("out/case: holds results of an earlier version of case.toml"), "{why}");
    }
    // So is a case of the same name elsewhere.
    fs::create_dir(folder.path().join("below")).unwrap();
    write(&folder.path().join("below"), &CASE.replace('4', "6"));
    assert!(refused(&folder, "solve below/case.toml").contains("another case, case.toml"));

    run(folder.path(), "solve case.toml -q --overwrite").success();
    let expected =
        ["membranes.json", "membranes.png", "notes.txt", "rim.vtp", "solution.vtu", "summary.json"];
    assert_eq!(results(&folder), expected, "what the program has not written stays");
    run(folder.path(), "solve case.toml -q").success();
}

#[test]
fn the_same_case_goes_on_whatever_is_said_around_it() {
    let folder = folder_with_case(CASE);
    run(folder.path(), "adapt case.toml -q --tolerance 0.2").success();
    let table = || fs::read_to_string(folder.path().join("out/case/adapt.csv")).unwrap();
    let before = table();
    let around = format!("# a remark\ntitle = \"another\"\n{CASE}[solver]\ntime_limit = 60\n");
    write(folder.path(), &around);
    // A solve takes the place of the solution, and not of the study, which puts its own back.
    run(folder.path(), "solve case.toml -q").success();
    assert!(!results(&folder).contains(&"mesh.png".into()), "it shows another mesh");
    assert_eq!(table(), before);
    run(folder.path(), "adapt case.toml -q --tolerance 0.2").success();
    assert_eq!(table(), before);
    assert!(results(&folder).contains(&"mesh.png".into()));
    // Levels of other settings are another study.
    for other in ["--refine 1", "--backend clarabel"] {
        let why = refused(&folder, &format!("adapt case.toml {other}"));
        assert!(why.contains("holds adapt.csv of other settings"), "{why}");
    }
    run(folder.path(), "adapt case.toml -q --tolerance 0.2 --refine 1 --overwrite").success();
    assert_ne!(table(), before);
}

#[test]
fn the_contents_of_the_mesh_file_belong_to_the_case() {
    let folder =
        folder_with_case("[membranes]\ntension = [1, 3]\nload = [-15, 10]\n[domain]\nmesh = \"plate.msh\"\n");
    let mesh = |text: &str| fs::write(folder.path().join("plate.msh"), text).unwrap();
    mesh(MESH);
    run(folder.path(), "solve case.toml -q").success();
    run(folder.path(), "solve case.toml -q").success();
    mesh(&MESH.replace("5 0.5 0.5 0", "5 0.5 0.6 0"));
    refused(&folder, "solve case.toml");
    run(folder.path(), "solve case.toml -q --overwrite").success();
}

#[test]
fn what_no_record_speaks_for_is_not_put_at_risk() {
    let folder = folder_with_case(CASE);
    run(folder.path(), "solve case.toml -q").success();
    let record = folder.path().join("out/case/membranes.json");
    for broken in [None, Some("{"), Some("[]")] {
        match broken {
            None => fs::remove_file(&record).unwrap(),
            Some(text) => fs::write(&record, text).unwrap(),
        }
        assert!(
            refused(&folder, "solve case.toml").contains("holds summary.json, and no record of its case")
        );
    }
    run(folder.path(), "solve case.toml -q --overwrite").success();
    let record: Value = serde_json::from_slice(&fs::read(record).unwrap()).unwrap();
    assert_eq!(record["case"], "case.toml");
    // Files that the program does not write are in nobody's way.
    fs::create_dir(folder.path().join("new")).unwrap();
    fs::write(folder.path().join("new/notes.txt"), "").unwrap();
    run(folder.path(), "solve case.toml -q --out new").success();
}

#[test]
fn programs_of_two_meshes_do_not_lie_in_one_folder() {
    let folder = folder_with_case(CASE);
    run(folder.path(), "export case.toml -q --format npz").success();
    run(folder.path(), "export case.toml -q --format mtx").success();
    assert!(
        refused(&folder, "export case.toml --refine 1 --format qps")
            .contains("holds problem.npz of other settings")
    );
    run(folder.path(), "export case.toml -q --refine 1 --format qps --overwrite").success();
    assert_eq!(results(&folder), ["membranes.json", "problem.qps"]);
}
