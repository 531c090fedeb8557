//! The data views of a Gmsh file, `$NodeData` and `$ElementData`: numbers at nodes or on elements, under a name.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

use super::error::GmshError;
use super::note::GmshNote;
use super::scanner::{Encoding, Scanner};
use crate::text::Number;

/// A data view: numbers at nodes or on triangles, under a name.
#[derive(Debug, Clone, PartialEq)]
pub struct GmshView {
    /// Its name, different from those of the other views.
    pub name: String,
    /// What it says, or why that is of no use.
    pub data: Result<ViewData, ViewFault>,
}

impl GmshView {
    /// The note that values were left out.
    pub(super) fn left_out(&self) -> Option<GmshNote> {
        let values = self.data.as_ref().map_or(0, |data| data.left_out);
        (values > 0).then(|| GmshNote::ValuesLeftOut { view: self.name.clone(), values })
    }
}

/// What a view says.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewData {
    /// Where the values are.
    pub place: ViewPlace,
    /// Vertices or triangles, as indices, each once, in increasing order, and their values, which are finite. Both halves of a
    /// quadrangle have its value.
    pub values: Vec<(u32, f64)>,
    /// How many values belong to nodes or elements that are not in the mesh, such as points and lines, and were left out.
    pub left_out: usize,
}

/// Where the values of a view are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ViewPlace {
    /// At vertices: linear between them.
    Vertices,
    /// On triangles: constant on each.
    Triangles,
}

/// Why a view is of no use as a datum: its name is followed by these words.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ViewFault {
    /// A vector or a tensor.
    Components {
        /// How many numbers it has in each place.
        components: i32,
    },
    /// Several time steps.
    Steps {
        /// Two of them.
        steps: [i32; 2],
    },
    /// `$NodeData` and `$ElementData` of one name.
    TwoPlaces,
    /// `$ElementNodeData`.
    ElementNodes,
    /// A value that is infinite or no number.
    NotFinite {
        /// Tag of the node or element.
        tag: u64,
        /// The value.
        value: f64,
    },
    /// Two values for one node or element.
    Contradiction {
        /// Its tag.
        tag: u64,
        /// The two values.
        values: [f64; 2],
    },
}

impl fmt::Display for ViewFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Components { components } => {
                write!(f, "has {components} components: save one number for each node or element")
            }
            Self::Steps { steps: [first, other] } => {
                write!(
                    f,
                    "has several time steps, {first} and {other} among them: save one, or name them differently"
                )
            }
            Self::TwoPlaces => write!(f, "is given at nodes and on elements: name the two differently"),
            Self::ElementNodes => {
                write!(
                    f,
                    "has values for each corner of each element ($ElementNodeData): save it as $NodeData"
                )
            }
            Self::NotFinite { tag, value } => {
                write!(f, "is {value} at Gmsh's number {tag}: it must be finite")
            }
            Self::Contradiction { tag, values: [first, other] } => {
                write!(
                    f,
                    "is {} and {} at Gmsh's number {tag}: save one value",
                    Number(*first),
                    Number(*other)
                )
            }
        }
    }
}

/// The views as they stand in the file.
#[derive(Default)]
pub(super) struct Views(BTreeMap<String, View>);

/// A view under way.
struct View {
    place: ViewPlace,
    step: i32,
    fault: Option<ViewFault>,
    /// Tags and values.
    entries: Vec<(u64, f64)>,
}

/// What a section of data says before the data.
struct Head {
    name: String,
    step: i32,
    components: i32,
    entries: usize,
}

/// The fewest bytes of a record with one value: `1 0` and the end of a line.
const SHORTEST: usize = 4;

impl Views {
    /// Reads `$NodeData` or `$ElementData`. Several sections of one name and one time step are one view, as of the parts of a
    /// partition.
    pub(super) fn read(&mut self, scanner: &mut Scanner, place: ViewPlace) -> Result<(), GmshError> {
        let head = read_head(scanner)?;
        let view = self.0.entry(head.name).or_insert_with(|| View {
            place,
            step: head.step,
            fault: None,
            entries: Vec::new(),
        });
        view.blame(head.components != 1, ViewFault::Components { components: head.components });
        view.blame(head.step != view.step, ViewFault::Steps { steps: [view.step, head.step] });
        view.blame(place != view.place, ViewFault::TwoPlaces);
        if view.fault.is_none() {
            // What is declared may not be there.
            view.entries.reserve(head.entries.min(scanner.left() / SHORTEST));
        }
        for _ in 0..head.entries {
            let tag = read_tag(scanner)?;
            for component in 0..head.components {
                let value = scanner.double("a value of a view")?;
                if component == 0 {
                    view.add(tag, value);
                }
            }
            scanner.end_record()?;
        }
        Ok(())
    }

    /// Reads the head of `$ElementNodeData`, which is of no use, and skips the rest.
    pub(super) fn skip_element_nodes(&mut self, scanner: &mut Scanner) -> Result<(), GmshError> {
        let Head { name, step, .. } = read_head(scanner)?;
        let none = || View { place: ViewPlace::Triangles, step, fault: None, entries: Vec::new() };
        self.0.entry(name).or_insert_with(none).blame(true, ViewFault::ElementNodes);
        scanner.skip_section()
    }

    pub(super) fn are_on_elements(&self) -> bool {
        self.0.values().any(|view| view.place == ViewPlace::Triangles && view.fault.is_none())
    }

    /// The views by name, on the vertices and triangles that have the tags of their nodes and elements.
    pub(super) fn on_mesh(
        self,
        vertex: impl Fn(u64) -> Option<u32>,
        triangles: impl Fn(u64) -> Range<u32>,
    ) -> Vec<GmshView> {
        let at = |place: ViewPlace, tag: u64| match place {
            ViewPlace::Vertices => vertex(tag).map_or(0..0, |a| a..a + 1),
            ViewPlace::Triangles => triangles(tag),
        };
        let finish = |(name, view): (String, View)| {
            let data = match view.fault {
                Some(fault) => Err(fault),
                None => values(view.place, view.entries, |tag| at(view.place, tag)),
            };
            GmshView { name, data }
        };
        self.0.into_iter().map(finish).collect()
    }
}

impl View {
    fn blame(&mut self, is_at_fault: bool, fault: ViewFault) {
        if is_at_fault && self.fault.is_none() {
            self.fault = Some(fault);
            self.entries = Vec::new();
        }
    }

    fn add(&mut self, tag: u64, value: f64) {
        if self.fault.is_none() {
            self.entries.push((tag, value));
        }
    }
}

/// The values at the vertices or triangles that have these tags.
fn values(
    place: ViewPlace,
    mut entries: Vec<(u64, f64)>,
    at: impl Fn(u64) -> Range<u32>,
) -> Result<ViewData, ViewFault> {
    // Gmsh has values of what it does not save, in MSH 2 all of them with the tag 0.
    let all = entries.len();
    entries.retain(|&(tag, _)| !at(tag).is_empty());
    let left_out = all - entries.len();
    if let Some(&(tag, value)) = entries.iter().find(|(_, value)| !value.is_finite()) {
        return Err(ViewFault::NotFinite { tag, value });
    }
    // A stable sort: of two values of one tag, the first one of the file is named first.
    entries.sort_by_key(|(tag, _)| *tag);
    let twice = |pair: &&[(u64, f64)]| pair[0].0 == pair[1].0 && pair[0].1 != pair[1].1;
    if let Some(pair) = entries.windows(2).find(twice) {
        return Err(ViewFault::Contradiction { tag: pair[0].0, values: [pair[0].1, pair[1].1] });
    }
    entries.dedup_by_key(|(tag, _)| *tag);
    let found: usize = entries.iter().map(|&(tag, _)| at(tag).len()).sum();
    let mut values = Vec::with_capacity(found);
    for &(tag, value) in &entries {
        values.extend(at(tag).map(|k| (k, value)));
    }
    values.sort_by_key(|(k, _)| *k);
    // Two tags of one triangle: that of a surface in two groups, in MSH 2.
    if let Some(pair) = values.windows(2).find(|pair| pair[0].0 == pair[1].0 && pair[0].1 != pair[1].1) {
        let tag = entries.iter().find(|&&(tag, _)| at(tag).contains(&pair[0].0)).map_or(0, |entry| entry.0);
        return Err(ViewFault::Contradiction { tag, values: [pair[0].1, pair[1].1] });
    }
    values.dedup_by_key(|(k, _)| *k);
    Ok(ViewData { place, values, left_out })
}

/// Tags are text in an ASCII file, in a binary one an `int` in every version.
fn read_tag(scanner: &mut Scanner) -> Result<u64, GmshError> {
    const EXPECTED: &str = "the tag of a value";
    if scanner.encoding() == Encoding::Ascii {
        return scanner.size(EXPECTED);
    }
    let tag = scanner.int(EXPECTED)?;
    u64::try_from(tag).map_err(|_| scanner.unexpected(EXPECTED, &tag.to_string()))
}

/// Reads the strings, real numbers and whole numbers at the head of a section of data, text in binary files too. The first
/// string is the name; the whole numbers are the time step, the number of components, that of the entries, and more.
fn read_head(scanner: &mut Scanner) -> Result<Head, GmshError> {
    let strings = read_count(scanner, "texts of a view")?;
    scanner.end_line()?;
    let mut name = None;
    for _ in 0..strings {
        scanner.skip_lines();
        let text = scanner.quoted();
        name.get_or_insert(text);
    }
    for _ in 0..read_count(scanner, "real numbers of a view")? {
        scanner.skip_lines();
        scanner.text_number::<f64>("a real number of a view")?;
    }
    let mut numbers = [0; 3];
    let count = read_count(scanner, "whole numbers of a view")?;
    if count < numbers.len() {
        let expected = "three whole numbers of a view: time step, number of components, number of values";
        return Err(scanner.unexpected(expected, &count.to_string()));
    }
    for k in 0..count {
        scanner.skip_lines();
        let number: i64 = scanner.text_number("a whole number of a view")?;
        if let Some(kept) = numbers.get_mut(k) {
            *kept = number;
        }
    }
    let [step, components, entries] = numbers;
    let entries = scanner.count(entries, "values of a view")?;
    scanner.end_line()?;
    let [step, components] = [step, components].map(|n| n.clamp(i32::MIN.into(), i32::MAX.into()) as i32);
    Ok(Head { name: name.unwrap_or_default(), step, components, entries })
}

fn read_count(scanner: &mut Scanner, of: &'static str) -> Result<usize, GmshError> {
    scanner.skip_lines();
    let declared: u64 = scanner.text_number("a count")?;
    scanner.count(declared, of)
}
