//! The levels of a study in the folder for results: a run that is stopped goes on from them.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::setup::write_file;
use crate::cli::args::CaseArguments;
use crate::cli::case::BackendName;
use crate::cli::failure::Failure;
use crate::output::remove;
use crate::study::StudyError;

const VERSION: &str = concat!("membranes ", env!("CARGO_PKG_VERSION"));

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
        "{name}: the time was over within a level; {KEPT}, given more time (--time-limit)"
    ))
}

/// The levels of a study, a row of a table for each, and what they belong to: a run of another case file, solver or first mesh
/// starts anew.
pub(crate) struct Levels<'a> {
    /// The folder.
    pub(crate) folder: &'a Path,
    /// The name of the table.
    pub(crate) table: &'static str,
    /// The name of the file that says what the levels belong to.
    pub(crate) origin: &'static str,
}

impl Levels<'_> {
    /// The rows that an earlier run of the same origin has left; none when it was another one.
    pub(crate) fn so_far<T: DeserializeOwned>(&self, origin: &str) -> Result<Vec<T>, Failure> {
        let table = self.folder.join(self.table);
        let known = std::fs::read_to_string(self.folder.join(self.origin));
        if known.is_ok_and(|text| text == origin)
            && let Ok(mut reader) = csv::Reader::from_path(&table)
        {
            let rows: Result<Vec<T>, _> = reader.deserialize().collect();
            // A table that is not ours, or of another version, is made anew.
            return Ok(rows.unwrap_or_default());
        }
        // Levels of another origin go first: a run that is stopped here must not find them under the new one.
        remove(&table)
            .map_err(|error| Failure::Input(format!("{}: cannot remove: {error}", table.display())))?;
        write_file(&self.folder.join(self.origin), |out| out.write_all(origin.as_bytes()))?;
        Ok(Vec::new())
    }

    /// Writes all rows anew.
    pub(crate) fn write<T: Serialize>(&self, rows: &[T]) -> Result<(), Failure> {
        write_file(&self.folder.join(self.table), |out| {
            let mut writer = csv::Writer::from_writer(out);
            rows.iter().try_for_each(|row| writer.serialize(row))?;
            writer.flush()
        })
    }
}

/// What the levels of a run belong to.
pub(crate) fn origin(case: &CaseArguments, backend: BackendName, text: &str) -> String {
    let backend = backend.as_str();
    format!("# {VERSION}, solved by {backend}, refined {} times first\n{text}", case.refine)
}

/// Why a study of the case file `name` fails.
pub(crate) fn failure(name: &str, error: &StudyError) -> Failure {
    let text = format!("{name}: {error}");
    match error {
        StudyError::Rejected { .. } | StudyError::Solver(_) | StudyError::Measure(_) => {
            Failure::NotCertified(text)
        }
        _ => Failure::Input(text),
    }
}
