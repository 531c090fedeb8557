//! The levels of a study in the folder for results: a run that is stopped goes on from them.

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::files::Picture;
use super::folder::Folder;
use super::setup::Setup;
use crate::cli::case::SolverSettings;
use crate::cli::failure::Failure;
use crate::formats::read_regular;
use crate::mesh::gmsh_nodes;
use crate::study::{StudyError, Tolerance};

const VERSION: &str = concat!("membranes ", env!("CARGO_PKG_VERSION"));

/// The longest table of levels, bytes: a study has a thousand at most, of less than a thousand bytes each.
const LONGEST_TABLE: u64 = 1 << 24;

/// What an interrupted run has to say of its folder.
pub(crate) const KEPT: &str = "complete levels are kept, and the same command goes on from there";

/// What a run that stops short has to say.
pub(crate) const GOES_ON: &str = "a run with a higher limit goes on from here";

/// Why a run stops short.
pub(crate) const TIME: &str = "the next level would exceed the time limit (--time-limit)";
pub(crate) const MEMORY: &str = "the next level would need more memory than there is (--memory-limit)";

/// What to say when a solver does not come back in time.
pub(crate) fn too_late(name: &str) -> Failure {
    Failure::NotCertified(format!(
        "{name}: the time limit has passed within a level; {KEPT}, given more time (--time-limit)"
    ))
}

/// The levels of a study, a row of a table for each, in a folder that belongs to it.
pub(crate) struct Levels<'a> {
    pub(crate) folder: &'a Folder,
    /// The name of the table.
    pub(crate) table: &'static str,
    /// The picture of them, which goes when there are more.
    pub(crate) picture: Picture,
}

impl Levels<'_> {
    /// The rows that an earlier run has left. A table that cannot be read is made anew.
    pub(crate) fn so_far<T: DeserializeOwned>(&self) -> Vec<T> {
        let path = self.folder.path().join(self.table);
        let Ok(bytes) = read_regular(&path, LONGEST_TABLE) else { return Vec::new() };
        let rows: Result<Vec<T>, _> = csv::Reader::from_reader(bytes.as_slice()).into_deserialize().collect();
        rows.unwrap_or_default()
    }

    /// Writes all rows anew.
    pub(crate) fn write<T: Serialize>(&self, rows: &[T]) -> Result<(), Failure> {
        self.picture.iter().try_for_each(|file| self.folder.remove(file))?;
        self.folder.write(self.table, |out| {
            let mut writer = csv::Writer::from_writer(out);
            rows.iter().try_for_each(|row| writer.serialize(row))?;
            writer.flush()
        })
    }
}

/// What the levels of a run depend on beside the case.
pub(crate) fn settings(setup: &Setup) -> String {
    let SolverSettings { name, tolerance, polish, .. } = &setup.case.solver;
    let tolerance = match tolerance {
        Tolerance::Auto => "auto".into(),
        Tolerance::Fixed(tolerance) => format!("{tolerance:e}"),
    };
    let polish = if *polish { "" } else { ", no polish" };
    let (solver, refinements) = (name.as_str(), setup.refinements());
    format!("{VERSION}, {solver}, tolerance {tolerance}{polish}, first refined {refinements} times")
}

/// Why a study of the case file `name` fails.
/// `node_tags` are Gmsh's numbers of the vertices.
pub(crate) fn failure(name: &str, error: &StudyError, node_tags: &[u64]) -> Failure {
    let vertices = match error {
        StudyError::Discretization(error) => error.vertex().into_iter().collect(),
        StudyError::Mesh(error) => error.vertices(),
        _ => Vec::new(),
    };
    let text = format!("{name}: {error}{}", gmsh_nodes(&vertices, node_tags));
    match error {
        StudyError::Rejected { .. }
        | StudyError::Solver(_)
        | StudyError::Measure(_)
        | StudyError::NoBound(_) => Failure::NotCertified(text),
        _ => Failure::Input(text),
    }
}
