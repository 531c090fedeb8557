//! Stacks of membranes between obstacles, as the program's user poses them.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::{TempDir, tempdir};

use crate::program::run;

/// A mesh with the curves `clamped`, `free`, `top` and the regions `rubber`, `steel`.
fn mesh() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/gmsh/materials_41_ascii.msh")
}

/// A folder with the case file `case.toml` and the mesh `plate.msh`, which has data views where the case asks for some.
fn folder_with(case: &str) -> TempDir {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("case.toml"), case).unwrap();
    let mut file = fs::read_to_string(mesh()).unwrap();
    if case.contains("view =") {
        file += &(view("pressure", "-15") + &view("ground", "-0.05"));
    }
    fs::write(folder.path().join("plate.msh"), file).unwrap();
    folder
}

/// A data view with one value at all nodes of the mesh.
fn view(name: &str, value: &str) -> String {
    let values: String = (1..=14).map(|node| format!("{node} {value}\n")).collect();
    format!("$NodeData\n1\n\"{name}\"\n1\n0\n3\n0\n1\n14\n{values}$EndNodeData\n")
}

/// The summary of a case that is certified.
fn solved(case: &str) -> (TempDir, Value) {
    let folder = folder_with(case);
    run(folder.path(), "solve case.toml --quiet").success();
    let text = fs::read_to_string(folder.path().join("out/case/summary.json")).unwrap();
    (folder, serde_json::from_str(&text).unwrap())
}

fn energy(case: &str) -> f64 {
    solved(case).1["energy"].as_f64().unwrap()
}

const MATERIALS: &str = r#"
membrane = [
    { tension = { rubber = 1, steel = 3 }, load = -15, height = { clamped = 0.1, free = "free", elsewhere = 0.1 } },
    { tension = 3, load = "5*x", height = { free = "free" } },
]
domain = { mesh = "plate.msh" }
"#;

#[test]
fn groups_of_a_mesh_file_are_what_their_names_say() {
    let of = |from: &str, to: &str| energy(&MATERIALS.replace(from, to));
    let expected = energy(MATERIALS);
    assert!(expected.is_finite());
    // Each name counts.
    for (from, to) in [
        ("steel = 3", "steel = 4"),
        ("height = { free = \"free\" }", "height = 0"),
        (
            "clamped = 0.1, free = \"free\", elsewhere = 0.1",
            "clamped = 0.2, free = \"free\", elsewhere = 0.2",
        ),
    ] {
        assert!((of(from, to) - expected).abs() > 1e-3, "{from}");
    }
    // The same with `elsewhere` in place of a name.
    let same = of("{ rubber = 1, steel = 3 }", "{ rubber = 1, elsewhere = 3 }");
    assert_eq!(same, expected);
}

#[test]
fn a_misspelt_group_is_an_error_that_lists_those_there_are() {
    let regions = "its regions are `rubber`, `steel`";
    let curves = "its curves are `clamped`, `free`, `top`";
    for (from, to, words) in [
        ("rubber", "ruber", ["the region `ruber`", regions]),
        ("clamped", "clampd", ["the curve `clampd`", curves]),
        ("steel = 3", "clamped = 3", ["the region `clamped`", regions]),
        (
            "height = { free = \"free\" }",
            "height = { free = \"free\", top = 0, clamped = \"free\" }",
            ["twice", "overlap at"],
        ),
    ] {
        let folder = folder_with(&MATERIALS.replace(from, to));
        for command in ["solve", "check", "export --format npz"] {
            let refused = run(folder.path(), &format!("{command} case.toml"));
            assert_eq!((refused.code, refused.stderr.lines().count()), (Some(2), 1), "{refused:?}");
            assert!(words.iter().all(|words| refused.stderr.contains(words)), "{}", refused.stderr);
        }
        assert!(!folder.path().join("out").exists());
    }
}

#[test]
fn a_group_that_no_datum_mentions_is_named() {
    let unused = |case: &str| {
        let folder = folder_with(case);
        run(folder.path(), "solve case.toml").success()
    };
    let table = unused(MATERIALS);
    assert!(table.contains("physical groups not used: top, curves 7, all of it\n"), "{table}");
    let table = unused(&MATERIALS.replace("{ rubber = 1, steel = 3 }", "1"));
    assert!(
        table.contains("physical groups not used: top, curves 7, rubber, steel, and 1 more\n"),
        "{table}"
    );
}

#[test]
fn what_cannot_be_posed_says_why() {
    let sheet = |height: &str| format!("{{ tension = 1, height = {height} }}");
    let square = "domain = { shape = \"square\" }\nmesh = { cells = 4 }\n";
    let case =
        |membranes: &[String], rest: &str| format!("membrane = [{}]\n{rest}{square}", membranes.join(", "));
    for (case, words) in [
        (case(&[sheet("\"free\"")], ""), "nothing holds membrane 1"),
        (
            case(&[sheet("0"), sheet("0.1")], "obstacle = { floor = -1 }\n"),
            "membrane 1 is at 0 and membrane 2 above it at 0.1",
        ),
        (
            case(&[sheet("0")], "obstacle = { floor = 0.1 }\n"),
            "membrane 1 is at 0 and the floor above it at 0.1",
        ),
        (case(&[sheet("0")], "obstacle = { floor = \"x - 1.5\", ceiling = \"-x\" }\n"), "put them in order"),
        (case(&[sheet("{ left = 0.5 }")], ""), "the height of membrane 1 jumps at vertex"),
        (case(&["{ tension = \"x - 0.5\" }".into()], ""), "tension mu1 is -"),
        (case(&["{ tension = 1, foundation = \"x - 0.5\" }".into()], ""), "foundation c1 is -"),
        (case(&["{ tension = 1, load = \"1/(x - x)\" }".into()], ""), "load f1 is"),
    ] {
        let folder = folder_with(&case);
        let refused = run(folder.path(), "solve case.toml");
        assert_eq!((refused.code, refused.stderr.lines().count()), (Some(2), 1), "{case}: {refused:?}");
        assert!(refused.stderr.contains(words), "{case}: {}", refused.stderr);
    }
    // A foundation holds a membrane that is free all around.
    let held = case(&["{ tension = 1, height = \"free\", foundation = 1, load = 2 }".into()], "");
    let (_, summary) = solved(&held);
    assert!((summary["energy"].as_f64().unwrap() + 2.0).abs() < 1e-9, "u = 2, J = -1/2 int f u");
    assert_eq!(summary["contacts"], serde_json::json!([]));
}

#[test]
fn commands_for_a_pair_say_so() {
    let folder = folder_with(MATERIALS);
    for command in ["converge case.toml", "bench case.toml", "solve case.toml --dual"] {
        let refused = run(folder.path(), command);
        assert_eq!((refused.code, refused.stderr.lines().count()), (Some(2), 1), "{command}: {refused:?}");
    }
}

#[test]
fn each_membrane_counts_for_the_memory() {
    let many = |n: usize| {
        let membranes = vec!["{ tension = 1 }"; n].join(", ");
        folder_with(&format!(
            "membrane = [{membranes}]\ndomain = {{ shape = \"square\" }}\nmesh = {{ cells = 16 }}\n"
        ))
    };
    let limited = |n: usize| run(many(n).path(), "solve case.toml --memory-limit 0.2");
    assert_eq!(limited(3).code, Some(0));
    let refused = limited(1000);
    assert_eq!(refused.code, Some(2));
    assert!(refused.stderr.contains("about 289 vertices of 1,000 membranes need"), "{}", refused.stderr);
}

#[test]
fn one_gap_has_the_names_of_the_pair_and_several_are_a_list() {
    let (folder, one) = solved(
        "membrane = [{ tension = 1, load = -20 }]\nobstacle = { floor = -0.2 }\ndomain = { shape = \"square\" }\nmesh = { cells = 16 }\n",
    );
    let count = one["contact_vertices"].as_u64().unwrap();
    assert!(count > 20 && one["contacts"][0]["contact_vertices"] == count && one["membranes"] == 1);
    assert!(one["error_bound"].as_f64().unwrap() > 0.0 && one["no_error_bound"].is_null());
    assert!(one["force_imbalance"].as_f64().unwrap() < 1e-12);
    let file = fs::read_to_string(folder.path().join("out/case/solution.vtu")).unwrap();
    assert!(
        ["u1", "gap", "lambda", "force", "contact", "floor"]
            .iter()
            .all(|name| file.contains(&format!("Name=\"{name}\"")))
    );
    let (folder, two) =
        solved(&MATERIALS.replace("domain", "obstacle = { floor = -1, ceiling = 1 }\ndomain"));
    assert!(two["contact_vertices"].is_null());
    let gaps: Vec<u64> =
        two["contacts"].as_array().unwrap().iter().map(|gap| gap["gap"].as_u64().unwrap()).collect();
    assert_eq!(gaps, [0, 1, 2]);
    let file = fs::read_to_string(folder.path().join("out/case/solution.vtu")).unwrap();
    let names = ["u2", "gap_0", "lambda_1", "contact_2", "ceiling", "floor", "curve clamped", "region steel"];
    assert!(names.iter().all(|name| file.contains(&format!("Name=\"{name}\""))));
}

#[test]
fn every_solver_certifies_and_an_answer_from_elsewhere_is_judged() {
    let folder = folder_with(MATERIALS);
    let table = run(folder.path(), "check case.toml").success();
    assert!(table.contains("active-") && table.contains("multigrid"), "{table}");
    run(folder.path(), "export case.toml --format npz").success();
    assert!(folder.path().join("out/case/problem.npz").is_file());
}

/// The case files of the page are whole, and each is solved.
#[test]
fn what_the_page_shows_in_five_lines_is_solved() {
    let page = include_str!("../../docs/case_file.md");
    let recipes = page.split("## In five lines").nth(1).unwrap();
    let blocks: Vec<&str> =
        recipes.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert_eq!(blocks.len(), 10);
    for block in blocks {
        assert!(block.lines().count() <= 5, "{block}");
        let (_, summary) = solved(block);
        assert_eq!(summary["certified"], true, "{block}");
        // In each of them something touches; the paper's pair has no list of gaps.
        let touches = |of: &Value| of["contact_vertices"].as_u64().unwrap() > 0;
        let gaps = summary["contacts"].as_array();
        assert!(gaps.map_or_else(|| touches(&summary), |gaps| gaps.iter().all(touches)), "{block}");
    }
}

/// The lines for Rust are those of an example that is compiled and run.
#[test]
fn what_the_page_shows_of_rust_is_run() {
    let page = include_str!("../../docs/case_file.md");
    let block = page.split("```rust\n").nth(1).unwrap().split("```").next().unwrap();
    let source = include_str!("../../src/discretization/stack.rs");
    assert_eq!(block.lines().count(), 4);
    assert!(block.lines().all(|line| source.contains(&format!("/// {line}\n"))), "{block}");
}

/// The published values that the examples name.
#[test]
fn the_examples_have_the_published_values() {
    let example = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name);
        fs::read_to_string(path).unwrap()
    };
    let near = |found: f64, printed: f64| (found - printed).abs() < 0.5000001e-5;
    assert!(near(energy(&example("torsion.toml")), -0.41611));
    assert!(near(energy(&example("bearing.toml")), -0.18005));
    // By quadrature it is another one.
    assert!(!near(energy(&example("bearing.toml").replace("\"vertices\"", "\"quadrature\"")), -0.18005));
    assert_eq!(solved(&example("ball.toml")).1["contact_vertices"], 29);
    for name in ["dam.toml", "stack.toml"] {
        assert_eq!(solved(&example(name)).1["certified"], true);
    }
}

/// A bound where there is one, and the reason where there is none; with it, adaptive meshes.
#[test]
fn the_error_is_bounded_and_meshes_follow_it() {
    let floor = |rest: &str| {
        format!(
            "{rest}membrane = [{{ tension = 1, load = -20, height = {{ right = \"free\" }} }}]\nobstacle = {{ floor = \"-0.2+0.1*x*y\" }}\ndomain = {{ shape = \"square\" }}\nmesh = {{ cells = 16 }}\n"
        )
    };
    let (_, bounded) = solved(&floor(""));
    assert!(bounded["relative_error_bound"].as_f64().unwrap() < 1.0);
    let (folder, unknown) = solved(&floor("integration = \"vertices\"\n"));
    assert!(unknown["error_bound"].is_null());
    assert!(unknown["no_error_bound"].as_str().unwrap().contains("at vertices"), "{unknown}");
    let refused = run(folder.path(), "adapt case.toml --tolerance 0.1");
    assert_eq!(refused.code, Some(2));
    assert!(refused.stderr.contains("`integration` = \"vertices\""), "{}", refused.stderr);
    let soft = floor("").replace("tension = 1", "tension = 1, foundation = \"x\"");
    let folder = folder_with(&soft);
    let refused = run(folder.path(), "adapt case.toml --tolerance 0.1");
    assert_eq!(refused.code, Some(1));
    assert!(refused.stderr.contains("there is no bound of the error"), "{}", refused.stderr);

    let folder = folder_with(&floor(""));
    let coarse = run(folder.path(), "adapt case.toml --tolerance 0.6");
    assert_eq!(coarse.code, Some(0), "{}", coarse.stderr);
    // The same folder, a smaller tolerance: it goes on from the last level.
    let fine = run(folder.path(), "adapt case.toml --tolerance 0.1");
    assert_eq!(fine.code, Some(0), "{}", fine.stderr);
    let levels = fs::read_to_string(folder.path().join("out/case/adapt.csv")).unwrap();
    let bounds: Vec<f64> =
        levels.lines().skip(1).map(|row| row.split(',').nth(7).unwrap().parse().unwrap()).collect();
    assert!(bounds.len() > 4 && *bounds.last().unwrap() <= 0.1 && bounds[0] > 0.1, "{bounds:?}");
    let summary = fs::read_to_string(folder.path().join("out/case/summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["relative_error_bound"].as_f64().unwrap(), *bounds.last().unwrap());
}
