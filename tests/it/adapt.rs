//! Adaptive refinement: the rates in the library, the program as its user meets it.

use std::fs;
use std::path::Path;

use membrane_contact::mesh::{MeshFamily, MeshSize, Pattern, generate};
use membrane_contact::problem::Case;
use membrane_contact::solver::{Auto, SolverOptions};
use membrane_contact::study::{
    AdaptiveLevel, AdaptiveStudy, ConvergenceStudy, LevelErrors, Tolerance, exponent,
};
use serde_json::Value;
use tempfile::TempDir;

use crate::common::exact;
use crate::program::{Run, folder_with_case, lines_too_long, run};

/// How far the slope over a few levels may be from the best one, `-1/2`.
const SLOPE: f64 = 0.06;

/// Uniform refinement of an L-shape is worse than the best slope by the singularity: `-1/3`, or on its way to it.
const WORSE: f64 = 0.08;

/// The bound over the error on the L-shape.
const EFFECTIVITY: f64 = 1.8;

/// Vertices to which the studies go.
const VERTICES: usize = 12_000;

fn first_mesh(case: Case) -> membrane_contact::mesh::Mesh {
    let size = MeshSize::Cells { cells: 8, pattern: Pattern::Right };
    generate(&exact(case, &[]).domain(), size).expect("the mesh can be made")
}

fn adaptive(case: Case) -> Vec<AdaptiveLevel> {
    let exact = exact(case, &[]);
    let mut study = AdaptiveStudy::new(
        exact.problem().expect("valid data"),
        Some(exact.domain()),
        Some(exact),
        first_mesh(case),
        Box::new(Auto),
        SolverOptions::default(),
        Tolerance::Fixed(1e-8),
    );
    let mut levels = Vec::new();
    while study.mesh().points().len() < VERTICES {
        levels.push(study.next_level().expect("certified and bounded"));
    }
    levels
}

fn uniform(case: Case) -> Vec<LevelErrors> {
    let family = MeshFamily::polygonal(first_mesh(case));
    let solver = Box::new(Auto);
    let options = SolverOptions::default();
    let mut study =
        ConvergenceStudy::new(exact(case, &[]), family, solver, options, Tolerance::Auto).unwrap();
    (0..4).map(|_| study.next_level().expect("certified and bounded")).collect()
}

/// The slope of the later half of the levels, past the coarse meshes that do not see the solution.
fn slope(levels: &[[f64; 2]]) -> f64 {
    exponent(levels[levels.len() / 2..].iter().copied()).expect("several levels")
}

#[test]
fn adaptive_meshes_reach_the_best_rate_on_l_shapes_where_uniform_ones_do_not() {
    for case in [Case::LShape, Case::LShapeFree] {
        let levels = adaptive(case);
        let errors: Vec<f64> = levels.iter().map(|level| level.energy_error.expect("it is known")).collect();
        for (level, &error) in levels.iter().zip(&errors) {
            let effectivity = level.effectivity().expect("it is known");
            assert!(effectivity >= 1.0, "{case}: {level:?}");
            // The first meshes do not resolve the load.
            assert!(level.vertices < 1000 || effectivity <= EFFECTIVITY, "{case}: {level:?}");
            assert!(level.min_angle >= 45.0 - 1e-9, "bisections of right triangles are similar ones");
            assert_eq!(effectivity, level.bound / error);
        }
        let vertices = |k: usize| levels[k].vertices as f64;
        let bounds: Vec<_> = (0..levels.len()).map(|k| [vertices(k), levels[k].bound]).collect();
        let errors: Vec<_> = (0..levels.len()).map(|k| [vertices(k), errors[k]]).collect();
        assert!(slope(&bounds) < -0.5 + SLOPE && slope(&errors) < -0.5 + SLOPE, "{case}: {}", slope(&errors));
    }
    let uniform = uniform(Case::LShapeFree);
    let errors: Vec<_> = uniform.iter().map(|level| [level.vertices as f64, level.energy]).collect();
    assert!(slope(&errors) > -0.5 + WORSE, "{}", slope(&errors));
}

#[test]
fn the_bound_is_sharp_on_smooth_data() {
    for level in &uniform(Case::Biactive)[2..] {
        let effectivity = level.effectivity().expect("there is an error");
        assert!((1.0..=1.35).contains(&effectivity), "{effectivity}");
    }
}

/// An L-shape without contact: the corner needs a fine mesh.
const CASE: &str = "case = \"l-shape-free\"\n[mesh]\ncells = 4\n";

/// Runs on `case.toml` in a new folder.
fn in_folder(case: &str, arguments: &[&str]) -> (TempDir, Vec<Run>) {
    let folder = folder_with_case(case);
    let runs = arguments.iter().map(|arguments| run(folder.path(), arguments)).collect();
    (folder, runs)
}

fn levels_of(folder: &Path) -> usize {
    fs::read_to_string(folder.join("out/case/adapt.csv")).expect("a table").lines().count() - 1
}

#[test]
fn adapt_reaches_the_accuracy_and_writes_what_it_says() {
    let (folder, runs) = in_folder(CASE, &["adapt case.toml --tolerance 0.1"]);
    let [run] = <[Run; 1]>::try_from(runs).unwrap();
    let text = run.success();
    assert!(text.contains("effectivity") && text.contains("the bound falls like vertices^-0."), "{text}");
    assert_eq!(lines_too_long(&text), [""; 0]);
    let results = folder.path().join("out/case");
    for name in ["solution.vtu", "membranes.png", "mesh.png", "adapt.png", "adapt.csv", "checkpoint.npz"] {
        assert!(results.join(name).is_file(), "{name}");
    }
    let summary: Value =
        serde_json::from_str(&fs::read_to_string(results.join("summary.json")).unwrap()).unwrap();
    let [bound, relative, norm] = ["error_bound", "relative_error_bound", "energy_norm"]
        .map(|name| summary[name].as_f64().unwrap_or_else(|| panic!("{name}")));
    assert!(relative <= 0.1 && relative > 0.01, "{relative}");
    assert!((relative - bound / (norm - bound)).abs() < 1e-12);
    let parts = ["flux", "oscillation", "contact", "boundary", "algebraic"];
    let sum: f64 = parts.iter().map(|&name| summary["error_parts"][name].as_f64().expect(name)).sum();
    assert!(bound <= sum, "{bound} {sum}");
}

#[test]
fn adapt_says_why_it_stops_short_and_keeps_what_it_has() {
    for (limit, why) in [
        ("--max-vertices 300", "more than 300 vertices"),
        ("--time-limit 1", "time limit"),
        ("--memory-limit 0.113", "more memory"),
    ] {
        let (folder, runs) = in_folder(CASE, &[&format!("adapt case.toml --tolerance 0.001 {limit}")]);
        assert_eq!(runs[0].code, Some(1), "{limit}");
        assert!(runs[0].stderr.contains(why), "{limit}: {}", runs[0].stderr);
        assert_eq!(runs[0].stderr.lines().count(), 1);
        assert!(folder.path().join("out/case/summary.json").is_file(), "{limit}");
    }
}

#[test]
fn a_stopped_run_goes_on_to_the_same_bytes() {
    let whole = "adapt case.toml -q --tolerance 0.08";
    let (at_once, _) = in_folder(CASE, &[whole]);
    let (in_parts, runs) = in_folder(CASE, &["adapt case.toml -q --max-vertices 150", whole]);
    assert_eq!((runs[0].code, runs[1].code), (Some(1), Some(0)), "{runs:?}");
    assert_eq!(levels_of(at_once.path()), levels_of(in_parts.path()));
    for name in ["solution.vtu", "checkpoint.npz", "membranes.png", "mesh.png", "adapt.png"] {
        let bytes = |folder: &Path| fs::read(folder.join("out/case").join(name)).unwrap();
        assert!(bytes(at_once.path()) == bytes(in_parts.path()), "{name}");
    }
    // The levels of the first part are not computed again: their times are as they were.
    let rows = |folder: &Path| fs::read_to_string(folder.join("out/case/adapt.csv")).unwrap();
    let before = rows(in_parts.path());
    run(in_parts.path(), "adapt case.toml -q --tolerance 0.05").success();
    assert!(rows(in_parts.path()).starts_with(&before), "rows are added");

    // Another case starts anew where it is told to, and so does one whose checkpoint is broken.
    fs::write(in_parts.path().join("case.toml"), CASE.replace('4', "3")).unwrap();
    let refused = run(in_parts.path(), "adapt case.toml -q --tolerance 0.2");
    assert_eq!(refused.code, Some(2), "{}", refused.stderr);
    assert_eq!(rows(in_parts.path()).lines().next(), before.lines().next());
    run(in_parts.path(), "adapt case.toml -q --tolerance 0.2 --overwrite").success();
    assert!(!rows(in_parts.path()).starts_with(&before));
    let solution = fs::read(at_once.path().join("out/case/solution.vtu")).unwrap();
    fs::write(at_once.path().join("out/case/checkpoint.npz"), b"PK").unwrap();
    run(at_once.path(), whole).success();
    assert_eq!(fs::read(at_once.path().join("out/case/solution.vtu")).unwrap(), solution);
}

#[test]
fn a_tolerance_that_follows_the_error_is_no_tighter_than_it_needs_to_be() {
    let case = "case = \"circle\"\n[mesh]\ncells = 64\n[solver]\ntolerance = \"auto\"\n";
    let (folder, runs) = in_folder(
        case,
        &[
            "solve case.toml",
            "solve case.toml --tolerance 1e-9 --out tight",
            "solve case.toml --tolerance autox",
        ],
    );
    let summary = |name: &str| -> Value {
        let text = fs::read_to_string(folder.path().join(name).join("summary.json")).unwrap();
        serde_json::from_str(&text).unwrap()
    };
    let (auto, tight) = (summary("out/case"), summary("tight"));
    let [loose, exact] = [&auto, &tight].map(|summary| summary["error_bound"].as_f64().unwrap());
    assert!((loose / exact - 1.0).abs() < 0.05, "{loose} {exact}");
    assert!(auto["tolerance"].as_f64() > Some(1e-8) && auto["certified"] == true);
    assert!(runs[2].code == Some(2) && runs[2].stderr.contains("or auto"), "{:?}", runs[2]);
}
