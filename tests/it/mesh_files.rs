//! Mesh files as other people's programs write them, and what is no file at all.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::{TempDir, tempdir};

use super::program::run;

const CASE: &str = "\
[membranes]
tension = [1.0, 3.0]
load = [-15.0, 10.0]
height = 0.02
[domain]
mesh = \"plate.msh\"
";

/// Far above what a refusal takes, far below for ever.
const AT_ONCE: Duration = Duration::from_secs(5);

/// Nodes and triangles of the unit square in `n x n` cells; the nodes are numbered from `first`.
pub(super) fn square(n: usize, first: usize) -> (Vec<String>, Vec<[usize; 3]>) {
    let at = |k: usize| k as f64 / n as f64;
    let node = |k: usize| format!("{} {} 0", at(k % (n + 1)), at(k / (n + 1)));
    let cell = |k: usize| {
        let a = first + k / n * (n + 1) + k % n;
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    ((0..(n + 1) * (n + 1)).map(node).collect(), (0..n * n).flat_map(cell).collect())
}

/// The square in MSH 2; physical group 1.
pub(super) fn msh2(version: &str, n: usize, first: usize) -> String {
    let (nodes, triangles) = square(n, first);
    let nodes: String = nodes.iter().zip(first..).map(|(node, k)| format!("{k} {node}\n")).collect();
    let count = triangles.len();
    let triangles: String =
        triangles.iter().zip(1..).map(|([a, b, c], k)| format!("{k} 2 2 1 1 {a} {b} {c}\n")).collect();
    format!(
        "$MeshFormat\n{version} 0 8\n$EndMeshFormat\n$Nodes\n{}\n{nodes}$EndNodes\n$Elements\n{count}\n{triangles}$EndElements\n",
        (n + 1) * (n + 1)
    )
}

/// The square in MSH 4, with these totals at the head of the sections.
pub(super) fn msh4(version: &str, n: usize, totals: [usize; 2]) -> String {
    let (nodes, triangles) = square(n, 1);
    let (count, triangle_count) = (nodes.len(), triangles.len());
    let tags: String = (1..=count).map(|k| format!("{k}\n")).collect();
    let triangles: String =
        triangles.iter().zip(1..).map(|([a, b, c], k)| format!("{k} {a} {b} {c}\n")).collect();
    let [nodes_head, elements_head, nodes] = if version == "4.1" {
        let points: String = nodes.iter().map(|node| format!("{node}\n")).collect();
        [
            format!("1 {} 1 {count}\n2 1 0", totals[0]),
            format!("1 {} 1 {triangle_count}\n2 1", totals[1]),
            tags + &points,
        ]
    } else {
        let lines = nodes.iter().zip(1..).map(|(node, k)| format!("{k} {node}\n")).collect();
        [format!("1 {}\n1 2 0", totals[0]), format!("1 {}\n1 2", totals[1]), lines]
    };
    format!(
        "$MeshFormat\n{version} 0 8\n$EndMeshFormat\n$Nodes\n{nodes_head} {count}\n{nodes}$EndNodes\n$Elements\n{elements_head} 2 {triangle_count}\n{triangles}$EndElements\n"
    )
}

pub(super) fn folder_with(case: &str, mesh: &str) -> TempDir {
    let folder = tempdir().expect("a temporary folder");
    for (name, text) in [("case.toml", case), ("plate.msh", mesh)] {
        fs::write(folder.path().join(name), text).expect("it is writable");
    }
    folder
}

pub(super) fn summary(folder: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join("out/case/summary.json")).unwrap()).unwrap()
}

#[test]
fn every_version_and_what_gmsh_forgives_give_the_same_solution() {
    let meshes = [
        msh2("2.2", 4, 1),
        msh2("2", 4, 1),
        msh2("2.0", 4, 1),
        msh2("2.1", 4, 1),
        msh4("4.1", 4, [25, 32]),
        msh4("4.1", 4, [27, 31]),
        msh4("4.0", 4, [25, 32]),
        msh4("4", 4, [0, 0]),
        format!("$Comments\nmade by hand\n$EndComments\n{}", msh2("2.2", 4, 1)),
        format!("made by hand\n{}the end\n", msh2("2.2", 4, 5000)),
    ];
    let energies = meshes.map(|mesh| {
        let folder = folder_with(CASE, &mesh);
        let run = run(folder.path(), "solve case.toml --quiet");
        assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{mesh}");
        let summary = summary(folder.path());
        assert_eq!(summary["vertices"], 25);
        summary["energy"].as_f64().unwrap()
    });
    assert!(energies.iter().all(|energy| (energy / energies[0] - 1.0).abs() < 1e-9), "{energies:?}");
}

#[test]
fn vertices_in_messages_have_the_numbers_of_the_file() {
    // A vertex given twice, one that is not flat, and a height that is negative at one.
    let plain = msh2("2.2", 4, 5000);
    let twice = plain
        .replace("$Nodes\n25\n", "$Nodes\n26\n")
        .replace("$EndNodes", "6000 0.5 0 0\n$EndNodes")
        .replace("2 2 1 1 5001 5002 5007\n", "2 2 1 1 5001 6000 5007\n");
    assert_ne!(twice, plain);
    let negative = CASE.replace("0.02", "\"0.02 - x*y\"");
    let table = [
        (CASE, twice, "vertices 2, 25 are Gmsh's nodes 5002, 6000"),
        (&negative, plain.clone(), "(vertex 9 is Gmsh's node 5009)"),
    ];
    for (case, mesh, says) in table {
        let folder = folder_with(case, &mesh);
        for command in ["solve case.toml", "adapt case.toml"] {
            let run = run(folder.path(), command);
            assert_eq!(run.code, Some(2), "{run:?}");
            assert!(run.stderr.contains(says) && run.stderr.lines().count() == 1, "{run:?}");
        }
    }
}

#[test]
fn groups_that_are_not_used_are_named() {
    let named = msh2("2.2", 4, 1).replace(
        "$Nodes",
        "$PhysicalNames\n2\n1 3 \"clamped edge\"\n2 1 \"rubber\"\n$EndPhysicalNames\n$Nodes",
    );
    let line = "physical groups not used: clamped edge, rubber\n";
    let folder = folder_with(CASE, &named);
    for command in ["solve case.toml", "check case.toml", "adapt case.toml --out adapted --tolerance 0.9"] {
        let run = run(folder.path(), command);
        assert!(run.stdout.contains(line), "{command}: {run:?}");
    }
    assert_eq!(summary(folder.path())["unused_groups"], serde_json::json!(["clamped edge", "rubber"]));

    let folder = folder_with(CASE, &msh4("4.1", 4, [25, 32]));
    let run = run(folder.path(), "solve case.toml");
    assert!(!run.stdout.contains("physical groups"), "{run:?}");
    assert_eq!(summary(folder.path())["unused_groups"], serde_json::json!([]));
}

#[test]
fn a_file_that_does_not_fit_into_the_memory_is_not_read() {
    let folder = folder_with(CASE, &msh2("2.2", 4, 1));
    let accepted = run(folder.path(), "solve case.toml --memory-limit 0.5");
    assert_eq!(accepted.code, Some(0), "{accepted:?}");
    // Sparse: it takes no space.
    let file = fs::OpenOptions::new().write(true).open(folder.path().join("plate.msh")).unwrap();
    file.set_len(3 << 29).unwrap();
    let refused = run(folder.path(), "solve case.toml --memory-limit 0.5");
    assert_eq!(refused.code, Some(2));
    assert!(
        refused.stderr.contains("takes about 18.00 GiB of memory, and 0.50 are available"),
        "{refused:?}"
    );

    let polygon: String = (0..100_000u64).map(|k| format!("[{k}, {}], ", k * k)).collect();
    let case = CASE.replace("mesh = \"plate.msh\"", &format!("shape = \"polygon\"\nvertices = [{polygon}]"));
    fs::write(folder.path().join("case.toml"), case).unwrap();
    let refused = run(folder.path(), "solve case.toml --memory-limit 0.2");
    assert!(refused.code == Some(2) && refused.stderr.contains("case file: reading"), "{refused:?}");
}

/// Every file that a user names, as a pipe, a device and a folder.
#[cfg(unix)]
#[test]
fn what_is_no_file_is_refused_at_once() {
    let folder = folder_with(CASE, &msh2("2.2", 4, 1));
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("folder")).unwrap();
    assert!(Command::new("mkfifo").arg(path("pipe")).status().unwrap().success());
    std::os::unix::fs::symlink("/dev/zero", path("device")).unwrap();
    for what in ["folder", "pipe", "device"] {
        fs::write(path("no-mesh.toml"), CASE.replace("plate.msh", what)).unwrap();
        let resumed = path("resumed");
        let _ = fs::remove_dir_all(&resumed);
        assert_eq!(run(folder.path(), "adapt case.toml --out resumed --tolerance 0.9").code, Some(0));
        fs::remove_file(resumed.join("checkpoint.npz")).unwrap();
        std::os::unix::fs::symlink(path(what), resumed.join("checkpoint.npz")).unwrap();
        for command in [
            "solve no-mesh.toml".to_owned(),
            format!("solve {what}"),
            format!("check case.toml --answer {what}"),
            format!("bench --no-run --merge {what}"),
            "adapt case.toml --out resumed".to_owned(),
        ] {
            let start = Instant::now();
            let run = run(folder.path(), &command);
            assert!(start.elapsed() < AT_ONCE, "{command}, {what}");
            assert_eq!((run.code, run.stderr.lines().count()), (Some(2), 1), "{command}, {what}: {run:?}");
            assert!(
                run.stderr.contains(&format!("it is a {what}, not a regular file")),
                "{command}: {run:?}"
            );
        }
    }
    assert_eq!(run(folder.path(), "solve case.toml").code, Some(0));
}
