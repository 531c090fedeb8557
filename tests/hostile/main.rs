//! Hostile input: the corpus of the fuzzers (`fuzz/`) and inputs made to be large, each read within the memory that its
//! length allows. One test reads them all: the memory of two at once could not be told apart.

mod bombs;
mod memory;
mod targets;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use targets::{TARGETS, Target, target};

/// The longest time for one input, far above what any needs: a longer one grows faster than the input.
const LONGEST: Duration = Duration::from_secs(20);

/// The inputs of a target: what the fuzzers began with and what they have found.
fn corpus(name: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders = vec![root.join("tests/hostile/corpus").join(name)];
    if name == "gmsh" {
        folders.push(root.join("tests/data/gmsh"));
    }
    let entries = folders.iter().flat_map(|folder| fs::read_dir(folder).expect("every target has a corpus"));
    entries.map(|entry| entry.expect("readable").path()).collect()
}

#[test]
fn no_input_breaks_a_reader_or_takes_more_memory_than_its_length_allows() {
    let mut complaints = Vec::new();
    for target in &TARGETS {
        let files = corpus(target.name);
        assert!(!files.is_empty(), "{} has a corpus", target.name);
        let files = files.iter().map(|path| (path.display().to_string(), fs::read(path).expect("readable")));
        for (name, bytes) in files.chain(bombs::of(target.name)) {
            let start = Instant::now();
            let taken = memory::run(target, &bytes);
            let seconds = start.elapsed();
            println!("{} bytes in {seconds:.1?}, {taken:?}: {name}", bytes.len());
            complaints.extend(taken.err().map(|complaint| format!("{complaint}: {name}")));
            if seconds > LONGEST {
                complaints.push(format!("{}: {seconds:.0?}: {name}", target.name));
            }
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));

    // A reader that takes what a header declares is caught.
    let glutton = |bytes: &[u8]| drop(vec![0u8; usize::from(bytes[0]) << 20]);
    let glutton = Target { run: glutton, ..*target("gmsh") };
    assert!(memory::run(&glutton, &[0]).is_ok());
    assert!(memory::run(&glutton, &[100]).is_err());
}
