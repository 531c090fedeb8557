//! What is to be told of a mesh file: what was done to it, and what it has that a run does not use.

use std::collections::HashSet;
use std::fmt;

use crate::cli::terminal::{COLUMNS, note};
use crate::formats::gmsh::{GmshNote, PhysicalGroup};
use crate::mesh::Views;
use crate::problem::ContactProblem;
use crate::text::{excerpt, grouped};

/// What is to be told of a mesh file, in lines for the terminal.
pub(super) struct FileNotes {
    notes: Vec<GmshNote>,
    /// The physical groups that no datum mentions.
    pub(super) unused_groups: Vec<PhysicalGroup>,
    /// The data views that no datum is.
    unused_views: Vec<String>,
}

impl FileNotes {
    /// What to tell of a file with these groups and views to whoever poses `problem` on it.
    pub(super) fn new(
        mut groups: Vec<PhysicalGroup>,
        views: &Views,
        mut notes: Vec<GmshNote>,
        problem: &ContactProblem,
    ) -> Self {
        let [curves, regions, used] =
            [problem.curves(), problem.regions(), problem.views()].map(HashSet::<&str>::from_iter);
        let is_mentioned = |group: &PhysicalGroup| match group.dimension {
            1 => curves.contains(group.to_string().as_str()),
            2 => regions.contains(group.to_string().as_str()),
            _ => false,
        };
        groups.retain(|group| !is_mentioned(group));
        // What is missing in a view that is not used is of no interest.
        notes.retain(|note| match note {
            GmshNote::ValuesLeftOut { view, .. } => used.contains(view.as_str()),
            _ => true,
        });
        let unused_views = views.names().filter(|name| !used.contains(name)).map(str::to_owned).collect();
        Self { notes, unused_groups: groups, unused_views }
    }
}

impl fmt::Display for FileNotes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.notes.iter().try_for_each(|told| f.write_str(&note(&told.to_string())))?;
        f.write_str(&unused("physical groups", &self.unused_groups))?;
        f.write_str(&unused("data views", &self.unused_views))
    }
}

/// What a run does not use, in one line; nothing where there is nothing.
fn unused<N: fmt::Display>(what: &str, names: &[N]) -> String {
    /// Names are left out where the line would become wider than 80 columns.
    const WIDEST: usize = COLUMNS - ", and 1,000 more".len();
    let mut line = format!("  {what} not used:");
    for (k, name) in names.iter().enumerate() {
        let name = excerpt(&name.to_string());
        if k > 0 && line.chars().count() + 2 + name.chars().count() > WIDEST {
            return format!("{line}, and {} more\n", grouped(names.len() - k));
        }
        line += if k > 0 { ", " } else { " " };
        line += &name;
    }
    if names.is_empty() { String::new() } else { line + "\n" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Pattern, ViewPlace, rectangle};
    use crate::problem::{Field, Membrane};

    #[test]
    fn groups_that_are_not_used_are_one_line_of_80_columns() {
        let group =
            |tag: u32| PhysicalGroup { dimension: 1, tag, name: (tag < 3).then(|| "an\nedge".into()) };
        let line =
            |tags: std::ops::Range<u32>| unused("physical groups", &tags.map(group).collect::<Vec<_>>());
        assert_eq!(line(0..0), "");
        assert_eq!(line(2..4), "  physical groups not used: an\\nedge, curves 3\n");
        let many = line(3..1003);
        assert_eq!(many, "  physical groups not used: curves 3, curves 4, curves 5, and 997 more\n");
        assert!(many.len() <= 81);
    }

    #[test]
    fn what_is_not_used_is_told_and_what_is_used_is_not() {
        let mesh = rectangle([0.0; 2], [1.0; 2], [1; 2], Pattern::Right).unwrap();
        let mesh = mesh.with_view("load", ViewPlace::Vertices, [1.0; 4]).unwrap();
        let mesh = mesh.with_view("spare", ViewPlace::Triangles, [1.0; 2]).unwrap();
        let problem = ContactProblem::obstacle(Membrane::new(1.0).load(Field::view("load")), -1.0).unwrap();
        let left_out = |view: &str| GmshNote::ValuesLeftOut { view: view.into(), values: 3 };
        let notes = vec![GmshNote::Quadrangles { quadrangles: 2 }, left_out("load"), left_out("spare")];
        let told = FileNotes::new(vec![], mesh.views(), notes, &problem).to_string();
        assert_eq!(
            told,
            "  quadrangles, cut in two along the shorter diagonal: 2\n  values of the view `load` at what is no vertex or triangle of the mesh, left\n    out: 3\n  data views not used: spare\n"
        );
    }
}
