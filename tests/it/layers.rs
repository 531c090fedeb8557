//! The direction of the arrows: a module uses only those before it.

use std::path::{Path, PathBuf};

/// The way of the data.
const LAYERS: [&str; 18] = [
    "text",
    "numeric",
    "geometry",
    "problem",
    "formats",
    "mesh",
    "fem",
    "discretization",
    "qp",
    "multigrid",
    "solver",
    "action",
    "flux",
    "estimate",
    "study",
    "output",
    "pictures",
    "cli",
];

/// The layers that a source text names after `crate::` outside of its comments and its unit tests.
fn layers_used(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text);
    let code: String = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    code.split("crate::")
        .skip(1)
        .map(|rest| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect())
        .collect()
}

/// The arrows that run back from a file of `layer`.
fn backward_arrows(layer: &str, text: &str) -> Vec<String> {
    let rank = |name: &str| LAYERS.iter().position(|layer| *layer == name);
    let own =
        rank(layer).unwrap_or_else(|| panic!("`{layer}` is a module, but no layer: add it to the list"));
    layers_used(text).into_iter().filter(|used| rank(used).is_none_or(|used| used > own)).collect()
}

fn source_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("readable").path());
    paths.flat_map(|path| if path.is_dir() { source_files(&path) } else { vec![path] }).collect()
}

#[test]
fn no_arrow_runs_back() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = 0;
    for path in source_files(&source) {
        let relative = path.strip_prefix(&source).expect("below src").with_extension("");
        let names: Vec<String> = relative.iter().map(|name| name.to_string_lossy().into_owned()).collect();
        let is_test = names.iter().any(|name| name == "tests");
        if is_test || names == ["lib"] || names == ["main"] {
            continue;
        }
        files += 1;
        let arrows = backward_arrows(&names[0], &std::fs::read_to_string(&path).expect("readable"));
        assert!(arrows.is_empty(), "{} uses {arrows:?}, which come later", path.display());
    }
    assert!(files > 50, "the test has read {files} files");
}

#[test]
fn an_arrow_that_runs_back_is_seen() {
    let text = "use crate::mesh::Mesh;\n// crate::cli\nuse crate::solver::Candidate;\nfn f() { crate::unheard::of() }";
    assert_eq!(backward_arrows("fem", text), ["solver", "unheard"]);
    assert!(backward_arrows("cli", "use crate::solver::Candidate;").is_empty());
}
