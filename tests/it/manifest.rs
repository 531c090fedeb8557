//! What the manifest promises: nothing of ours runs while it builds, and no target holds unsafe code.

use std::path::Path;

use toml::Table;

/// What is wrong with a manifest beside which there are these files.
fn complaints(manifest: &str, files: &[String]) -> Vec<&'static str> {
    let manifest: Table = manifest.parse().expect("a manifest is TOML");
    let package = manifest["package"].as_table().expect("a manifest has a package");
    let level = manifest.get("lints").and_then(|lints| lints.get("rust")?.get("unsafe_code")?.as_str());
    let faults = [
        (package.contains_key("build") || files.iter().any(|file| file == "build.rs"), "a build script"),
        (level != Some("forbid"), "unsafe code is not forbidden"),
    ];
    faults.into_iter().filter_map(|(is_there, fault)| is_there.then_some(fault)).collect()
}

#[test]
fn nothing_of_ours_runs_while_it_builds_and_unsafe_code_is_forbidden() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let manifest = std::fs::read_to_string(root.join("Cargo.toml")).expect("it is there");
    let entries = std::fs::read_dir(root).expect("it is a folder");
    let name = |entry: std::io::Result<std::fs::DirEntry>| entry.expect("readable").file_name();
    let files: Vec<String> = entries.map(|entry| name(entry).to_string_lossy().into_owned()).collect();
    assert!(files.contains(&"Cargo.toml".into()));
    assert!(complaints(&manifest, &files).is_empty(), "{:?}", complaints(&manifest, &files));

    let with_script = manifest.replace("[package]", "[package]\nbuild = \"make.rs\"");
    assert_eq!(complaints(&with_script, &files), ["a build script"]);
    assert_eq!(complaints(&manifest, &["build.rs".into()]), ["a build script"]);
    let lenient = manifest.replace("unsafe_code = \"forbid\"", "unsafe_code = \"deny\"");
    assert_eq!(complaints(&lenient, &files), ["unsafe code is not forbidden"]);
}
