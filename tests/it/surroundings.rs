//! Hostile surroundings: runs that are killed, interrupted or out of time; disks that are full or read-only; too little memory.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant, SystemTime};

use serde_json::Value;
use tempfile::{TempDir, tempdir};

use super::program::{Run, command, files, folder_with_case, run};
use super::random::Random;
use super::timeless::timeless;

/// A case with a known solution, whose corner needs a fine mesh.
const CASE: &str = "case = \"l-shape-free\"\n[mesh]\ncells = 4\n";

/// Commands whose results are the same whenever they are complete, and how long they take at most, milliseconds.
const COMMANDS: [(&str, u64); 3] = [
    ("converge case.toml -q --levels 4", 1500),
    ("adapt case.toml -q --tolerance 0.05", 2500),
    ("solve case.toml -q --dual --refine 3", 2500),
];

/// Runs that are killed before one is left to end.
const KILLS: usize = 5;

/// What an end that is asked for may take.
const AT_ONCE: Duration = Duration::from_secs(1);

/// What anything may take on top on a machine that has other work to do. What does not end by itself here takes minutes;
/// `docs/reliability.md` has the figures of a quiet machine.
const BUSY: Duration = Duration::from_secs(10);

fn start(folder: &Path, arguments: &str) -> Child {
    command(folder, arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts")
}

fn end(child: Child) -> Run {
    Run::from(child.wait_with_output().expect("it ends"))
}

/// Whether a file is as it should be to its last byte.
fn is_whole(name: &str, bytes: &[u8]) -> bool {
    let text = || std::str::from_utf8(bytes).unwrap_or_default();
    match name.rsplit_once('.').map_or("", |(_, ending)| ending) {
        "json" => serde_json::from_slice::<Value>(bytes).is_ok(),
        "vtu" | "vtp" => text().trim_end().ends_with("</VTKFile>"),
        "png" => bytes.ends_with(b"IEND\xaeB`\x82"),
        "npz" => zip::ZipArchive::new(Cursor::new(bytes)).is_ok(),
        "csv" => {
            let mut rows = text().lines().map(|row| row.matches(',').count());
            let columns = rows.next();
            columns.is_some() && text().ends_with('\n') && rows.all(|row| Some(row) == columns)
        }
        "md" => text().ends_with("|\n"),
        other => panic!("{name}: nobody has said what is whole for {other:?}"),
    }
}

/// The unfinished files that a killed run may leave.
fn is_unfinished(name: &str) -> bool {
    name.starts_with(".membranes-")
}

fn results(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let folder = folder.join("out/case");
    let names = if folder.is_dir() { files(&folder) } else { Vec::new() };
    names.into_iter().map(|name| (name.clone(), fs::read(folder.join(name)).expect("readable"))).collect()
}

/// The files that are not whole.
fn torn(folder: &Path) -> Vec<String> {
    let torn =
        results(folder).into_iter().filter(|(name, bytes)| !is_unfinished(name) && !is_whole(name, bytes));
    torn.map(|(name, _)| name).collect()
}

/// The files of a complete run, but for what the clock says.
fn timeless_results(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let without_times = |(name, bytes)| (String::clone(&name), timeless(&name, bytes));
    results(folder).into_iter().map(without_times).collect()
}

/// Other numbers in each run: the seed is printed, and taken from `MEMBRANES_SEED` if that is set.
fn random() -> Random {
    let clock =
        || SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(1, |time| time.as_nanos() as u64);
    let given = std::env::var("MEMBRANES_SEED").ok().and_then(|seed| seed.parse().ok());
    let seed: u64 = given.unwrap_or_else(clock);
    eprintln!("MEMBRANES_SEED={seed}");
    Random::new(seed)
}

/// Kills runs at random moments, so many of each command, and lets one in `KILLS + 1` end.
fn kill_at_random(rounds: usize) {
    let mut random = random();
    for (arguments, milliseconds) in COMMANDS {
        let undisturbed = folder_with_case(CASE);
        run(undisturbed.path(), arguments).success();
        let expected = timeless_results(undisturbed.path());
        assert!(expected.len() >= 4 && torn(undisturbed.path()).is_empty(), "{arguments}");
        for _ in 0..rounds {
            let folder = folder_with_case(CASE);
            for _ in 0..KILLS {
                let mut child = start(folder.path(), arguments);
                sleep(Duration::from_millis(random.between(0.0, milliseconds as f64) as u64));
                child.kill().expect("it is there, or has ended");
                end(child);
                assert_eq!(torn(folder.path()), [""; 0], "{arguments}");
            }
            run(folder.path(), arguments).success();
            let found = timeless_results(folder.path());
            assert_eq!(found.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>(), "{arguments}");
            for (name, bytes) in &expected {
                assert!(&found[name] == bytes, "{arguments}: {name} is another one");
            }
        }
    }
}

#[test]
fn a_killed_run_leaves_whole_files_and_goes_on_to_the_same_bytes() {
    kill_at_random(1);
}

#[test]
#[ignore = "a hundred kills take minutes"]
fn a_hundred_killed_runs_leave_whole_files_and_go_on_to_the_same_bytes() {
    kill_at_random(7);
}

#[test]
fn a_table_that_a_killed_run_has_left_behind_is_written_again() {
    let folder = folder_with_case(CASE);
    let converge = "converge case.toml -q --levels 2 --no-picture";
    run(folder.path(), converge).success();
    let table = folder.path().join("out/case/convergence.md");
    let whole = fs::read(&table).unwrap();
    // As if it had been killed before the last level was in it.
    fs::write(&table, &whole[..whole.len() / 2]).unwrap();
    run(folder.path(), converge).success();
    assert_eq!(fs::read(&table).unwrap(), whole);
}

#[test]
fn what_is_torn_or_another_one_would_be_seen() {
    let folder = folder_with_case(CASE);
    for (arguments, _) in COMMANDS {
        run(folder.path(), arguments).success();
    }
    let whole = results(folder.path());
    for (name, bytes) in &whole {
        assert!(is_whole(name, bytes) && !is_whole(name, &bytes[..bytes.len() / 2]), "{name}");
    }
    let other = folder_with_case(&CASE.replace("cells = 4", "cells = 5"));
    run(other.path(), COMMANDS[2].0).success();
    assert!(
        timeless_results(folder.path())["solution.vtu"] != timeless_results(other.path())["solution.vtu"]
    );
}

/// Waits until `condition` holds.
fn wait_for(condition: impl Fn() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(start.elapsed() < Duration::from_secs(60), "it does not come");
        sleep(Duration::from_millis(5));
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_at_once_and_keeps_what_is_done() {
    let rows = |folder: &Path| {
        fs::read_to_string(folder.join("out/case/adapt.csv")).map_or(0, |table| table.lines().count())
    };
    let folder = folder_with_case(CASE);
    let child = start(folder.path(), "adapt case.toml -q --tolerance 1e-6");
    wait_for(|| rows(folder.path()) > 5);
    let asked = Instant::now();
    let status =
        Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("there is `kill`");
    assert!(status.success());
    let interrupted = end(child);
    assert!(asked.elapsed() < AT_ONCE + BUSY, "{:?}", asked.elapsed());
    assert_eq!(interrupted.code, Some(130), "{}", interrupted.stderr);
    assert!(interrupted.stderr.contains("the same command goes on from there"), "{}", interrupted.stderr);
    assert_eq!(interrupted.stderr.lines().count(), 1);
    assert!(rows(folder.path()) > 5);
    assert!(results(folder.path()).keys().all(|name| !is_unfinished(name)), "nothing unfinished is left");
    assert_eq!(torn(folder.path()), [""; 0]);
    // It goes on from there: the rows, with their seconds, stay, but for the last one if it came before its checkpoint.
    let kept = fs::read_to_string(folder.path().join("out/case/adapt.csv")).unwrap();
    let (kept, _) = kept.trim_end().rsplit_once('\n').expect("rows");
    run(folder.path(), "adapt case.toml -q --tolerance 0.2").success();
    let table = fs::read_to_string(folder.path().join("out/case/adapt.csv")).unwrap();
    assert!(table.starts_with(kept));
}

/// Both membranes over a square of so many cells.
fn square(cells: usize) -> String {
    format!(
        "[membranes]\ntension = [1, 1]\nload = [-10, \"30*sin(4*pi*x)*sin(3*pi*y)\"]\nheight = 0.05\n[domain]\nshape = \"square\"\n[mesh]\ncells = {cells}\n"
    )
}

#[test]
fn a_time_limit_holds_whatever_the_solver_does() {
    let summary = |folder: &TempDir| -> Value {
        serde_json::from_slice(&results(folder.path())["summary.json"]).expect("JSON")
    };
    // The negative test: with time enough, it is solved.
    let solved = folder_with_case(&square(512));
    run(solved.path(), "solve case.toml -q --backend multigrid --time-limit 600").success();
    assert!(results(solved.path()).contains_key("solution.vtu"));
    // How long that takes on this machine sets the limits: each solver needs about twenty times its own at least. Active-set takes ten
    // times as long as multigrid, interior points and splitting hundreds of times.
    let multigrid = summary(&solved)["seconds"]["solve"].as_f64().expect("seconds");
    let folder = folder_with_case(&square(512));
    let mut solvers =
        vec![("multigrid", multigrid / 20.0), ("active-set", multigrid / 2.0), ("clarabel", 5.0 * multigrid)];
    if cfg!(feature = "osqp") {
        solvers.push(("osqp", 5.0 * multigrid));
    }
    for (solver, limit) in solvers {
        let begin = Instant::now();
        // In the case file it is the limit of the solve alone.
        let limited = format!("{}[solver]\ntime_limit = {limit}\n", square(512));
        fs::write(folder.path().join("case.toml"), limited).unwrap();
        let stopped = run(folder.path(), &format!("solve case.toml --backend {solver}"));
        let seconds = begin.elapsed().as_secs_f64();
        assert_eq!(stopped.code, Some(1), "{solver}: {}", stopped.stderr);
        for word in ["does not certify", "time_limit", "more"] {
            assert!(stopped.stderr.contains(word), "{solver}: {}", stopped.stderr);
        }
        assert_eq!(stopped.stderr.lines().count(), 1);
        assert_eq!(
            results(folder.path()).into_keys().collect::<Vec<_>>(),
            ["membranes.json", "summary.json"],
            "{solver}"
        );
        let summary = summary(&folder);
        assert_eq!(
            (&summary["status"], &summary["certified"]),
            (&"time_limit".into(), &false.into()),
            "{solver}"
        );
        let before = ["mesh", "assembly"].map(|name| summary["seconds"][name].as_f64().expect(name));
        assert!(seconds - before[0] - before[1] < 1.1 * limit + BUSY.as_secs_f64(), "{solver}: {seconds} s");
    }
}

#[test]
fn a_time_limit_of_the_command_covers_what_comes_before_the_solve() {
    let folder = folder_with_case(&square(64));
    for command in ["solve", "adapt"] {
        let stopped = run(folder.path(), &format!("{command} case.toml --time-limit 1e-6"));
        assert_eq!((stopped.code, stopped.stderr.lines().count()), (Some(1), 1), "{}", stopped.stderr);
        assert!(
            stopped.stderr.contains("before the first solve, and nothing was written"),
            "{}",
            stopped.stderr
        );
        assert_eq!(files(folder.path()), ["case.toml"]);
    }
    run(folder.path(), "solve case.toml -q --time-limit 1e19").success();
    let summary: Value = serde_json::from_slice(&results(folder.path())["summary.json"]).expect("JSON");
    assert_eq!(summary["left_out"], serde_json::json!([]));
}

#[test]
fn studies_stop_in_time_and_go_on_with_more() {
    let folder = folder_with_case(CASE);
    for (arguments, table) in [
        ("converge case.toml -q --levels 9", "summary.csv"),
        ("adapt case.toml -q --tolerance 1e-5", "adapt.csv"),
    ] {
        let begin = Instant::now();
        let stopped = run(folder.path(), &format!("{arguments} --time-limit 2"));
        let seconds = begin.elapsed();
        assert!(seconds < Duration::from_millis(2200) + BUSY, "{arguments}: {seconds:?}");
        assert_eq!(stopped.code, Some(1), "{}", stopped.stderr);
        for word in ["stopped", "--time-limit", "goes on from here"] {
            assert!(stopped.stderr.contains(word), "{}", stopped.stderr);
        }
        assert!(results(folder.path()).contains_key(table), "{arguments}");
        assert_eq!(torn(folder.path()), [""; 0]);
    }
    run(folder.path(), "converge case.toml -q --levels 3 --time-limit 600").success();
}

#[test]
fn what_does_not_fit_into_memory_is_refused_before_it_is_begun() {
    let folder = folder_with_case(&square(16));
    for arguments in ["solve", "check", "converge", "adapt", "export --format npz"] {
        // 1.6e7 vertices: made in vain, they would take seconds.
        let case = if arguments == "converge" { CASE.into() } else { square(16) };
        fs::write(folder.path().join("case.toml"), case).unwrap();
        let refused = run(folder.path(), &format!("{arguments} case.toml --refine 8 --memory-limit 1"));
        assert_eq!(refused.code, Some(2), "{arguments}: {}", refused.stderr);
        for word in ["GiB of memory, and 1.00 are available", "coarser mesh", "--memory-limit"] {
            assert!(refused.stderr.contains(word), "{arguments}: {}", refused.stderr);
        }
        assert_eq!(refused.stderr.lines().count(), 1);
        assert_eq!(files(folder.path()), ["case.toml"], "{arguments}");
    }
    // A solver that needs more is refused sooner, and the other one named.
    let factoring = run(folder.path(), "solve case.toml --refine 5 --memory-limit 1 --backend clarabel");
    assert!(factoring.stderr.contains("or the solver multigrid"), "{}", factoring.stderr);
    run(folder.path(), "solve case.toml -q --refine 5 --memory-limit 1 --backend multigrid").success();
    // The norms of the error need ten times as much as the solution that they measure.
    fs::write(folder.path().join("case.toml"), "case = \"strip\"\n[mesh]\ncells = 64\n").unwrap();
    let stopped = run(folder.path(), "converge case.toml -q --levels 3 --memory-limit 0.25 --overwrite");
    assert_eq!(stopped.code, Some(1), "{}", stopped.stderr);
    assert!(stopped.stderr.contains("stopped after 1 of 3 levels: the next level"), "{}", stopped.stderr);
    run(folder.path(), "solve case.toml -q --refine 2 --memory-limit 0.25 --no-picture").success();
    let refused = run(folder.path(), "converge case.toml --refine 2 --memory-limit 0.25");
    assert!(refused.stderr.contains("GiB of memory, and 0.25 are available"), "{}", refused.stderr);
}

/// Runs where no file may become longer than so many KiB: what a full disk does to a run.
#[cfg(unix)]
fn on_a_small_disk(folder: &Path, kibibytes: usize, arguments: &str) -> Run {
    let program = assert_cmd::cargo::cargo_bin!("membranes").display();
    let script = format!("trap '' XFSZ; ulimit -f {kibibytes}; exec '{program}' {arguments}");
    let output = Command::new("bash").args(["-c", &script]).current_dir(folder).output();
    Run::from(output.expect("there is `bash`"))
}

#[cfg(unix)]
#[test]
fn a_full_disk_loses_nothing_that_was_there() {
    for arguments in [
        "solve case.toml -q --dual",
        "adapt case.toml -q --tolerance 0.1",
        "export case.toml -q --format mtx --refine 2",
    ] {
        let folder = folder_with_case(CASE);
        run(folder.path(), arguments).success();
        let before = results(folder.path());
        assert!(before.len() >= 3, "{arguments}");
        // Of another mesh where the folder allows it: levels and programs of another one are refused.
        let further = if arguments.starts_with("solve") { " --refine 1" } else { "" };
        let finer = arguments.replace("0.1", "0.05") + further;
        let failed = on_a_small_disk(folder.path(), 4, &finer);
        assert_eq!(failed.code, Some(2), "{arguments}: {}", failed.stderr);
        assert!(
            failed.stderr.contains("cannot write") && failed.stderr.lines().count() == 1,
            "{}",
            failed.stderr
        );
        let after = results(folder.path());
        let lost: Vec<_> = before.iter().filter(|(name, bytes)| after.get(*name) != Some(bytes)).collect();
        // Levels are added to those that were there; the picture of them goes then.
        let levels = |name: &str| name.starts_with("adapt.") || name == "checkpoint.npz";
        assert!(lost.iter().all(|(name, _)| levels(name)), "{arguments}: {:?}", after.keys());
        assert!(after.keys().all(|name| !is_unfinished(name)), "{arguments}");
        assert_eq!(on_a_small_disk(folder.path(), 1 << 20, &finer).code, Some(0), "{arguments}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_in_which_nothing_can_be_written_is_refused_before_the_solve() {
    let folder = folder_with_case(&square(16));
    for arguments in ["solve", "adapt", "export --format qps"] {
        // Not even the administrator may make a file there.
        let refused = run(folder.path(), &format!("{arguments} case.toml --out /sys --refine 5"));
        assert_eq!(refused.code, Some(2), "{}", refused.stderr);
        let line = "error: /sys: cannot write: permission denied; name another folder with --out\n";
        assert_eq!(refused.stderr, line);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_error_that_nobody_can_read_keeps_its_exit_code() {
    let folder = tempdir().unwrap();
    let full = fs::File::options().write(true).open("/dev/full").expect("Linux has it");
    let output = command(folder.path(), "solve nowhere.toml").stderr(full).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
}
