//! Which pictures are written, and in which formats.

use std::fs;
use std::path::Path;

use tempfile::tempdir;

use crate::program::run;

/// What files of a format begin with.
const FORMATS: [(&str, &[u8]); 3] = [("png", b"\x89PNG"), ("svg", b"<svg "), ("pdf", b"%PDF-")];

/// The commands that write pictures, with the pictures they write.
const COMMANDS: [(&str, &[&str]); 4] = [
    ("solve strip.toml --dual", &["membranes", "mesh"]),
    ("converge strip.toml --levels 2", &["convergence"]),
    ("adapt strip.toml --tolerance 0.3", &["adapt", "membranes", "mesh"]),
    ("bench --sizes 4 --solvers active-set", &["bench"]),
];

/// The files of the folder `out` that are pictures.
fn pictures(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder.join("out")).expect("a folder of results");
    let names = entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned());
    let mut names: Vec<String> = names
        .filter(|name| FORMATS.iter().any(|(format, _)| name.ends_with(&format!(".{format}"))))
        .collect();
    names.sort();
    names
}

#[test]
fn pictures_come_in_the_formats_asked_for_and_take_the_place_of_others() {
    for (command, stems) in COMMANDS {
        let folder = tempdir().unwrap();
        let case = run(folder.path(), "cases strip").success().replace("cells = 64", "cells = 4");
        fs::write(folder.path().join("strip.toml"), case).unwrap();
        let told =
            |more: &str| run(folder.path(), &format!("{command} --out out --overwrite {more}")).success();
        let files = |formats: &[&str]| {
            let of = |stem: &&str| formats.iter().map(|f| format!("{stem}.{f}")).collect::<Vec<_>>();
            stems.iter().flat_map(of).collect::<Vec<String>>()
        };
        let table = told("--pictures pdf,svg,pdf");
        assert_eq!(pictures(folder.path()), files(&["pdf", "svg"]), "{command}");
        assert!(files(&["pdf", "svg"]).iter().all(|file| table.contains(file)), "{table}");
        let table = told("--no-picture");
        assert!(!files(&["png", "svg", "pdf"]).iter().any(|file| table.contains(file)), "{table}");
        told("--pictures png,svg,pdf");
        for (format, start) in FORMATS {
            for file in files(&[format]) {
                assert!(
                    fs::read(folder.path().join("out").join(&file)).unwrap().starts_with(start),
                    "{file}"
                );
            }
        }
    }
}

#[test]
fn without_pictures_none_are_left_of_an_earlier_solution() {
    let folder = tempdir().unwrap();
    let case = run(folder.path(), "cases strip").success();
    fs::write(folder.path().join("strip.toml"), case).unwrap();
    run(folder.path(), "solve strip.toml --out out").success();
    assert_eq!(pictures(folder.path()), ["membranes.png"]);
    run(folder.path(), "solve strip.toml --out out --no-picture").success();
    assert!(pictures(folder.path()).is_empty() && folder.path().join("out/solution.vtu").exists());
}

#[test]
fn a_format_that_is_none_is_refused() {
    let folder = tempdir().unwrap();
    for (arguments, expected) in
        [("solve a.toml --pictures jpg", "jpg"), ("solve a.toml --pictures svg --no-picture", "--no-picture")]
    {
        let run = run(folder.path(), arguments);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.stderr.contains(expected), "{run:?}");
    }
}
