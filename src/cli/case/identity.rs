//! What makes two case files the same case.

use std::fmt::Write as _;
use std::io::{self, Read};
use std::path::Path;

use toml::{Table, Value};

use super::mesh::MeshSource;
use crate::formats::open_regular;

/// A case, by which its results are known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct CaseId {
    /// The case file, as it was named.
    pub(crate) name: String,
    /// Of the problem, the domain and the mesh, up to refinement.
    pub(crate) fingerprint: String,
}

impl CaseId {
    /// Of the text of a case file, and of the mesh file that it names.
    pub(crate) fn new(name: &str, text: &str, source: &MeshSource) -> Self {
        let mut hash = Fnv::default();
        hash.add(essence(text).as_bytes());
        if let MeshSource::File(path) = source {
            // What cannot be read twice is known by its name.
            if hash.add_file(path).is_err() {
                hash.add(path.to_string_lossy().as_bytes());
            }
        }
        Self { name: name.into(), fingerprint: format!("{:016x}", hash.0) }
    }

    /// Of the built-in family of problems.
    pub(crate) fn built_in(name: &str) -> Self {
        Self { name: name.into(), fingerprint: name.into() }
    }
}

/// The case file without what leaves the case the same: comments, layout, title, solver, refinements, the place of a mesh file.
fn essence(text: &str) -> String {
    let mut table: Table = text.parse().unwrap_or_default();
    table.remove("title");
    table.remove("solver");
    for (section, key) in [("mesh", "refine"), ("domain", "mesh")] {
        if let Some(Value::Table(section)) = table.get_mut(section) {
            section.remove(key);
        }
    }
    table.retain(|_, value| !value.as_table().is_some_and(Table::is_empty));
    let mut out = String::new();
    write_value(&mut out, &Value::Table(table));
    out
}

/// Keys in their order; whole numbers as the numbers that they are.
fn write_value(out: &mut String, value: &Value) {
    // Writing to a string cannot fail.
    let _ = match value {
        Value::Table(table) => {
            out.push('{');
            for (key, value) in table {
                let _ = write!(out, "{key:?}=");
                write_value(out, value);
                out.push(',');
            }
            write!(out, "}}")
        }
        Value::Array(values) => {
            out.push('[');
            for value in values {
                write_value(out, value);
                out.push(',');
            }
            write!(out, "]")
        }
        Value::Integer(number) => write!(out, "{:?}", *number as f64),
        Value::Float(number) => write!(out, "{number:?}"),
        Value::String(text) => write!(out, "{text:?}"),
        other => write!(out, "{other}"),
    };
}

/// The hash FNV-1a of 64 bits: the same in every version of every compiler. It guards against mistakes, not against forgery.
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    fn add(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn add_file(&mut self, path: &Path) -> io::Result<()> {
        let mut file = open_regular(path)?;
        let mut buffer = vec![0; 1 << 16];
        loop {
            match file.read(&mut buffer)? {
                0 => return Ok(()),
                length => self.add(&buffer[..length]),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    const CASE: &str = "title = \"a\"\n[membranes]\ntension = [1, 3.0]\nload = [\"x\", 2]\n[domain]\nmesh = \"a.msh\"\n[mesh]\nrefine = 1\n[solver]\ntolerance = 1e-8\n";

    #[test]
    fn what_leaves_the_case_the_same_leaves_its_essence_the_same() {
        for (from, to) in [
            ("\"a\"\n", "\"b\" # another\n\n"),
            ("[1, 3.0]", "[ 1.0,3 ]"),
            ("refine = 1", "refine = 2"),
            ("[mesh]\nrefine = 1\n", ""),
            ("[solver]\ntolerance = 1e-8\n", ""),
            ("a.msh", "elsewhere/b.msh"),
        ] {
            assert!(CASE.contains(from));
            assert_eq!(essence(&CASE.replace(from, to)), essence(CASE), "{from}");
        }
        for (from, to) in
            [("3.0", "3.1"), ("\"x\"", "\"y\""), ("2]", "-2]"), ("refine", "cells"), ("load", "lead")]
        {
            assert_ne!(essence(&CASE.replace(from, to)), essence(CASE), "{from}");
        }
    }

    #[test]
    fn the_contents_of_a_mesh_file_count() {
        let folder = tempfile::tempdir().unwrap();
        let id = |name: &str| {
            CaseId::new("case.toml", CASE, &MeshSource::File(folder.path().join(name))).fingerprint
        };
        for (name, contents) in [("a", "1 2"), ("same", "1 2"), ("other", "1 3")] {
            std::fs::write(folder.path().join(name), contents).unwrap();
        }
        assert_eq!(id("a"), id("same"));
        assert_ne!(id("a"), id("other"));
        assert_ne!(
            id("missing"),
            CaseId::new("", CASE, &MeshSource::File(PathBuf::from("gone"))).fingerprint
        );
    }

    #[test]
    fn the_hash_is_the_published_one() {
        let mut hash = Fnv::default();
        hash.add(b"foobar");
        assert_eq!(hash.0, 0x8594_4171_f739_67e8);
    }
}
