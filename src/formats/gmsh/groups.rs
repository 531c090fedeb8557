//! The physical groups of a Gmsh file: names and numbers that the author of the geometry gave to parts of it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use super::error::GmshError;
use super::scanner::Scanner;

/// Points, curves or surfaces that belong together.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct PhysicalGroup {
    /// 0 for points, 1 for curves, 2 for surfaces, 3 for volumes.
    pub dimension: u8,
    /// Its number, different from those of the other groups of this dimension.
    pub tag: u64,
    /// Its name, if it has one.
    pub name: Option<String>,
}

/// The name, else what the group consists of and its number.
impl fmt::Display for PhysicalGroup {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of = ["points", "curves", "surfaces", "volumes"];
        match &self.name {
            Some(name) => write!(f, "{name}"),
            None => write!(f, "{} {}", of[usize::from(self.dimension)], self.tag),
        }
    }
}

/// What the sections of a file say about its groups.
#[derive(Default)]
pub(super) struct Groups {
    /// Dimension and tag of each group that a part of the geometry or an element belongs to.
    members: BTreeSet<(u8, u64)>,
    /// The names by dimension (MSH 2.0 has none) and tag.
    names: BTreeMap<(Option<u8>, u64), String>,
}

impl Groups {
    /// Something of this dimension belongs to the group `tag`; 0 is no group, and the sign tells an orientation.
    pub(super) fn add(&mut self, dimension: u8, tag: i32) {
        if tag != 0 {
            self.members.insert((dimension, u64::from(tag.unsigned_abs())));
        }
    }

    /// Reads `$PhysicalNames`, which is text in binary files too: `dimension tag "name"` for each, or `tag "name"`.
    pub(super) fn read_names(
        &mut self,
        scanner: &mut Scanner,
        with_dimensions: bool,
    ) -> Result<(), GmshError> {
        let declared: u64 = scanner.text_number("a number of names")?;
        let declared = scanner.count(declared, "names")?;
        scanner.end_line()?;
        for _ in 0..declared {
            scanner.skip_blank();
            let dimension = if with_dimensions { Some(read_dimension(scanner)?) } else { None };
            let tag: i32 = scanner.text_number("the tag of a physical group")?;
            // As Gmsh has it: what stands between the first quotation mark and the next one, or the end of the line.
            let line = String::from_utf8_lossy(scanner.rest_of_line());
            let name = line.split('"').nth(1).unwrap_or("").trim_end_matches('\r');
            if !name.is_empty() {
                self.names.insert((dimension, u64::from(tag.unsigned_abs())), name.into());
            }
        }
        Ok(())
    }

    /// All groups that have members or a name, by dimension and tag.
    pub(super) fn into_groups(self) -> Vec<PhysicalGroup> {
        let Self { mut members, names } = self;
        members.extend(names.keys().filter_map(|&(dimension, tag)| Some((dimension?, tag))));
        let name = |dimension: u8, tag: u64| {
            names.get(&(Some(dimension), tag)).or_else(|| names.get(&(None, tag))).cloned()
        };
        let group =
            |&(dimension, tag): &(u8, u64)| PhysicalGroup { dimension, tag, name: name(dimension, tag) };
        members.iter().map(group).collect()
    }
}

/// Reads a dimension as text.
fn read_dimension(scanner: &mut Scanner) -> Result<u8, GmshError> {
    const EXPECTED: &str = "a dimension from 0 to 3";
    let found = scanner.word(EXPECTED)?;
    found.parse().ok().filter(|dimension| *dimension <= 3).ok_or_else(|| scanner.unexpected(EXPECTED, found))
}
