//! The physical groups of a Gmsh file: names and numbers that the author of the geometry gave to parts of it.

use std::collections::BTreeMap;
use std::fmt;

use super::elements::{Label, Stray};
use super::error::GmshError;
use super::scanner::Scanner;

/// Points, curves or surfaces that belong together.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct PhysicalGroup {
    /// 0 for points, 1 for curves, 2 for surfaces, 3 for volumes.
    pub dimension: u8,
    /// Its number, different from those of the other groups of this dimension.
    pub tag: u32,
    /// Its name, if it has one.
    pub name: Option<Box<str>>,
}

impl PhysicalGroup {
    /// What tells it from the others.
    fn key(&self) -> (u8, u32) {
        (self.dimension, self.tag)
    }

    /// Bytes of what it is called.
    pub(crate) fn name_length(&self) -> usize {
        match &self.name {
            Some(name) => name.len(),
            None => KINDS[usize::from(self.dimension)].len() + 1 + self.tag.max(1).ilog10() as usize + 1,
        }
    }
}

/// What groups without a name consist of, by dimension.
const KINDS: [&str; 4] = ["points", "curves", "surfaces", "volumes"];

/// The name, else what the group consists of and its number.
impl fmt::Display for PhysicalGroup {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.name {
            Some(name) => write!(f, "{name}"),
            None => write!(f, "{} {}", KINDS[usize::from(self.dimension)], self.tag),
        }
    }
}

/// Which triangles and lines belong to which of the groups of a file.
///
/// A *part* is what belongs to the same groups: those of an entity of the geometry (MSH 4) or one group (MSH 2). Some
/// triangles and lines are in several parts, others in none.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct GroupMembers {
    /// The groups of all parts, as indices, one part after the other.
    pub carried: Vec<u32>,
    /// Where in `carried` the groups of each part end. Shape: parts.
    pub ends: Vec<u32>,
    /// Triangles, as indices, and a part to which each belongs.
    pub triangles: Vec<(u32, u32)>,
    /// The ends of lines, as indices of nodes, and a part to which each belongs.
    pub lines: Vec<([u32; 2], u32)>,
}

impl GroupMembers {
    /// The groups of each part, as indices.
    pub fn parts(&self) -> impl Iterator<Item = &[u32]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.carried[start as usize..end as usize])
    }
}

/// What the sections of a file say about its groups.
#[derive(Default)]
pub(super) struct Groups {
    /// Dimension and tag of each group that a part of the geometry or an element belongs to.
    /// In any order, some again and again.
    members: Vec<(u8, u32)>,
    /// The names by dimension (MSH 2.0 has none) and tag.
    names: BTreeMap<(Option<u8>, u32), Box<str>>,
    /// The curves and surfaces of the geometry that belong to groups.
    entities: Vec<Entity>,
    /// The tags of the groups of all of them.
    tags: Vec<u32>,
    /// Whether elements are labelled by their group (MSH 2), not by their entity.
    label_elements: bool,
}

/// A curve or surface of the geometry, which elements name by their label.
struct Entity {
    dimension: u8,
    label: Label,
    /// Where its groups begin and end among those of all.
    start: u32,
    end: u32,
}

impl Entity {
    fn key(&self) -> (u8, Label) {
        (self.dimension, self.label)
    }
}

impl Groups {
    /// Something of this dimension belongs to the group `tag`; 0 is no group, and the sign tells an orientation.
    pub(super) fn add(&mut self, dimension: u8, tag: i32) {
        let group = (dimension, tag.unsigned_abs());
        if tag != 0 && self.members.last() != Some(&group) {
            self.members.push(group);
        }
    }

    /// An entity of the geometry belongs to the groups `tags`, as in [`Groups::add`].
    pub(super) fn add_entity(&mut self, dimension: u8, entity: i32, tags: &[i32]) {
        let start = self.tags.len() as u32;
        for &tag in tags.iter().filter(|&&tag| tag != 0) {
            self.add(dimension, tag);
            self.tags.push(tag.unsigned_abs());
        }
        let end = self.tags.len() as u32;
        if matches!(dimension, 1 | 2) && start < end {
            self.entities.push(Entity { dimension, label: entity as Label, start, end });
        }
    }

    /// The labels of elements are groups, not entities.
    pub(super) fn label_elements(&mut self) {
        self.label_elements = true;
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
            let name = scanner.quoted();
            if !name.is_empty() {
                self.names.insert((dimension, tag.unsigned_abs()), name.into());
            }
        }
        Ok(())
    }

    /// All groups that have members or a name, by dimension and tag, and their members among elements with `labels`.
    ///
    /// # Errors
    /// [`GmshError::UnknownNode`]: a line of a group has a node that is not there.
    pub(super) fn of_elements(
        mut self,
        scanner: &Scanner,
        labels: Vec<(u32, Label)>,
        lines: Vec<([u32; 2], Label)>,
        strays: &[Stray],
    ) -> Result<(Vec<PhysicalGroup>, GroupMembers), GmshError> {
        let (entities, tags) = (std::mem::take(&mut self.entities), std::mem::take(&mut self.tags));
        let label_elements = self.label_elements;
        let groups = self.into_groups();
        let (keys, mut members) = if label_elements {
            parts_of_groups(&groups)
        } else {
            parts_of_entities(entities, &tags, &groups)
        };
        let part =
            |dimension: u8, label: Label| keys.binary_search(&(dimension, label)).ok().map(|k| k as u32);
        if let Some(stray) = strays.iter().find(|stray| part(1, stray.label).is_some()) {
            let &Stray { at, element, node, .. } = stray;
            return Err(GmshError::UnknownNode { place: scanner.place_of(at), shape: "line", element, node });
        }
        members.triangles = labels.into_iter().filter_map(|(t, label)| Some((t, part(2, label)?))).collect();
        members.lines = lines.into_iter().filter_map(|(ends, label)| Some((ends, part(1, label)?))).collect();
        Ok((groups, members))
    }

    /// All groups that have members or a name, by dimension and tag.
    fn into_groups(self) -> Vec<PhysicalGroup> {
        let Self { mut members, names, .. } = self;
        members.extend(names.keys().filter_map(|&(dimension, tag)| Some((dimension?, tag))));
        members.sort_unstable();
        members.dedup();
        let name = |dimension: u8, tag: u32| {
            names.get(&(Some(dimension), tag)).or_else(|| names.get(&(None, tag))).cloned()
        };
        let group =
            |&(dimension, tag): &(u8, u32)| PhysicalGroup { dimension, tag, name: name(dimension, tag) };
        members.iter().map(group).collect()
    }
}

/// Dimension and label of each part, in increasing order.
type Keys = Vec<(u8, Label)>;

/// A part for each group, still without members.
fn parts_of_groups(groups: &[PhysicalGroup]) -> (Keys, GroupMembers) {
    let n = groups.len() as u32;
    let members =
        GroupMembers { carried: (0..n).collect(), ends: (1..=n).collect(), ..GroupMembers::default() };
    (groups.iter().map(|group| (group.dimension, group.tag)).collect(), members)
}

/// A part for each entity, still without members; `tags` are those of the groups of all entities.
fn parts_of_entities(
    mut entities: Vec<Entity>,
    tags: &[u32],
    groups: &[PhysicalGroup],
) -> (Keys, GroupMembers) {
    let group = |dimension: u8, tag: u32| {
        let found = groups.binary_search_by_key(&(dimension, tag), PhysicalGroup::key);
        found.expect("the groups of entities were added") as u32
    };
    entities.sort_unstable_by_key(Entity::key);
    let (mut keys, mut members) = (Keys::new(), GroupMembers::default());
    let tags = |entity: &Entity| &tags[entity.start as usize..entity.end as usize];
    // An entity may be given twice, as in a file that repeats the mesh before each view.
    for same in entities.chunk_by(|one, other| one.key() == other.key()) {
        let others = same[1..].iter().filter(|entity| tags(entity) != tags(&same[0]));
        for entity in same[..1].iter().chain(others) {
            members.carried.extend(tags(entity).iter().map(|&tag| group(entity.dimension, tag)));
        }
        members.ends.push(members.carried.len() as u32);
        keys.push(same[0].key());
    }
    (keys, members)
}

/// Reads a dimension as text.
fn read_dimension(scanner: &mut Scanner) -> Result<u8, GmshError> {
    const EXPECTED: &str = "a dimension from 0 to 3";
    let found = scanner.word(EXPECTED)?;
    found.parse().ok().filter(|dimension| *dimension <= 3).ok_or_else(|| scanner.unexpected(EXPECTED, found))
}
