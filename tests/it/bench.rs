//! `membranes bench` as its user meets it.

use std::fs;
use std::path::Path;

use membrane_contact::study::comparison::{MEMORY, Row, SKIPPED};
use tempfile::tempdir;

use super::program::{files, lines_too_long, run};

/// What it writes.
const RESULTS: [&str; 4] = ["bench.csv", "bench.md", "bench.png", "membranes.json"];

const HEADER: &str = "problem,n,vertices,solver,origin,threads,status,certified,residual,iterations,setup_seconds,\
                      solve_seconds,certify_seconds,total_seconds,work_unit_seconds,work_units,contact_vertices";

const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

/// A case with a known solution, small.
const KNOWN: &str = "case = \"strip\"\n\n[mesh]\ncells = 4\n";

fn rows(folder: &Path) -> Vec<Row> {
    let text = fs::read_to_string(folder.join("bench.csv")).expect("it is there");
    assert_eq!(text.lines().next(), Some(HEADER));
    csv::Reader::from_reader(text.as_bytes()).deserialize().collect::<Result<_, _>>().expect("rows")
}

#[test]
fn bench_writes_rows_table_and_picture() {
    let folder = tempdir().unwrap();
    let table = run(folder.path(), "bench --sizes 16,8,8 --solvers active-set,active-set").success();
    let results = folder.path().join("out/bench");
    assert_eq!(files(&results), RESULTS);
    assert_eq!(lines_too_long(&table), [""; 0]);
    assert!(table.contains("out/bench/{bench.csv, bench.md, bench.png}"), "{table}");

    let rows = rows(&results);
    let found: Vec<_> = rows.iter().map(|row| (row.n, row.vertices, row.solver.as_str())).collect();
    assert_eq!(found, [(Some(8), 81, "active-set"), (Some(16), 289, "active-set")]);
    for row in &rows {
        assert!(row.certified && row.work_units.is_some_and(|units| units > 0.0), "{row:?}");
        assert_eq!((row.problem.as_str(), row.origin.as_str()), ("square", "rust"));
    }
    let markdown = fs::read_to_string(results.join("bench.md")).unwrap();
    assert!(markdown.contains("| square | 16 | 289 | active-set | rust |"), "{markdown}");
    assert!(fs::read(results.join("bench.png")).unwrap().starts_with(PNG));
}

#[test]
fn every_solver_of_the_build_runs_on_a_case_and_its_refinements() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("plates.toml"), KNOWN).unwrap();
    run(folder.path(), "bench plates.toml --levels 2").success();
    let rows = rows(&folder.path().join("out/plates"));
    let of_level = |level: usize| rows.iter().filter(move |row| row.n == Some(level));
    assert_eq!(of_level(0).count(), of_level(1).count());
    assert!(of_level(0).all(|row| row.vertices == 25) && of_level(1).all(|row| row.vertices == 81));
    for solver in ["clarabel", "active-set"] {
        assert!(rows.iter().any(|row| row.solver == solver && row.certified && row.problem == "plates"));
    }
}

#[test]
fn rows_of_other_files_are_shown_and_old_ones_give_way_to_new_ones() {
    let folder = tempdir().unwrap();
    let other = "square,8.0,81,piqp,qpsolvers,,solved,True,,,,,,0.5,,,";
    let old = "square,8,81,active-set,rust,1,solved,true,,,,,,1e9,,,";
    fs::write(folder.path().join("other.csv"), format!("{HEADER}\n{other}\n{old}\n")).unwrap();
    let bench = "bench --sizes 8 --solvers active-set --merge other.csv --out results";
    let table = run(folder.path(), bench).success();
    assert!(table.contains("piqp (qpsolvers)"), "{table}");
    let names = |rows: &[Row]| rows.iter().map(|row| row.solver.clone()).collect::<Vec<_>>();
    let merged = rows(&folder.path().join("results"));
    assert_eq!(names(&merged), ["active-set", "piqp"]);
    assert!(merged[0].total_seconds.is_some_and(|seconds| seconds < 1e9));

    run(folder.path(), "bench --no-run --merge other.csv --out shown").success();
    let shown = rows(&folder.path().join("shown"));
    assert_eq!(names(&shown), ["piqp", "active-set"]);
    assert_eq!(shown[1].total_seconds, Some(1e9), "nothing was measured");
    assert_eq!(files(&folder.path().join("shown")), RESULTS);
}

#[test]
fn who_runs_out_of_time_is_skipped_and_without_any_solution_it_is_no_success() {
    let folder = tempdir().unwrap();
    let stopped = run(folder.path(), "bench --sizes 8,16 --solvers clarabel --time-limit 1e-9 --out results");
    assert_eq!((stopped.code, stopped.stderr.lines().count()), (Some(1), 1), "{}", stopped.stderr);
    assert!(stopped.stderr.contains("--time-limit"), "{}", stopped.stderr);
    assert!(
        stopped.stdout.contains("no: time_limit") && stopped.stdout.contains("no: skipped"),
        "{}",
        stopped.stdout
    );
    let rows = rows(&folder.path().join("results"));
    assert_eq!((rows.len(), rows[1].status.as_str(), rows[1].certified), (2, SKIPPED, false));
    assert_eq!(files(&folder.path().join("results")), RESULTS, "the rows are kept");
}

/// Beside what the program has before anything, there is memory for 8,500 vertices of multigrid, and for 3,000 of Clarabel.
#[test]
fn who_needs_more_memory_than_there_is_has_a_row_that_says_so() {
    let folder = tempdir().unwrap();
    let bench = |limit: &str| {
        let arguments = format!("bench --sizes 32,64 --solvers multigrid,clarabel --overwrite {limit}");
        let table = run(folder.path(), &arguments).success();
        let rows = rows(&folder.path().join("out/bench"));
        (table, rows.into_iter().map(|row| (row.status, row.certified)).collect::<Vec<_>>())
    };
    let solved = || ("solved".to_owned(), true);
    let (table, limited) = bench("--memory-limit 0.119");
    assert_eq!(limited, [solved(), solved(), solved(), (MEMORY.into(), false)]);
    assert!(table.contains("no: memory_limit"), "{table}");
    assert_eq!(bench("--memory-limit 1").1, [(); 4].map(|()| solved()));
}

#[test]
fn groups_that_are_not_used_are_named() {
    let folder = tempdir().unwrap();
    let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/gmsh");
    for (name, line) in [("two_groups_41.msh", true), ("no_groups_41.msh", false)] {
        fs::copy(mesh.join(name), folder.path().join("plate.msh")).expect("readable");
        let case =
            "[membranes]\ntension = [1, 3]\nload = [-2, 1]\nheight = 0.1\n[domain]\nmesh = \"plate.msh\"\n";
        fs::write(folder.path().join("plates.toml"), case).unwrap();
        let bench = "bench plates.toml --levels 1 --solvers active-set --overwrite";
        let table = run(folder.path(), bench).success();
        assert_eq!(table.contains("\n  physical groups not used: "), line, "{name}: {table}");
    }
}

#[test]
fn bad_arguments_are_one_line_and_nothing_is_written() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("plates.toml"), KNOWN).unwrap();
    fs::write(folder.path().join("other.csv"), "problem,vertices\nsquare,81\n").unwrap();
    let before = files(folder.path());
    for (arguments, words) in [
        ("--solvers simplex", ["simplex", "clarabel"]),
        ("--sizes 8,1", ["--sizes", "at least 2"]),
        ("--sizes 100000", ["--sizes", "choose fewer"]),
        ("--levels 2", ["CASE.toml", "required"]),
        ("plates.toml --sizes 8", ["CASE.toml", "--sizes"]),
        ("plates.toml --levels 0", ["--levels", "at least 1"]),
        ("plates.toml --levels 40", ["plates.toml", "refine less"]),
        ("missing.toml", ["missing.toml", "name an existing file"]),
        ("--time-limit -1", ["--time-limit", "above 0"]),
        ("--sizes 8,128 --memory-limit 0.119", ["GiB of memory", "--memory-limit"]),
        ("plates.toml --levels 9 --memory-limit 0.119", ["GiB of memory", "--memory-limit"]),
        ("--merge other.csv", ["other.csv", "columns of bench.csv"]),
        ("--merge missing.csv", ["missing.csv", "columns of bench.csv"]),
        ("--no-run", ["--merge", "required"]),
    ] {
        let refused = run(folder.path(), &format!("bench {arguments}"));
        assert_eq!(
            (refused.code, refused.stderr.lines().count()),
            (Some(2), 1),
            "{arguments}: {}",
            refused.stderr
        );
        assert_eq!(refused.stdout, "");
        assert!(words.iter().all(|word| refused.stderr.contains(word)), "{arguments}: {}", refused.stderr);
        assert_eq!(files(folder.path()), before, "{arguments}");
    }
}
