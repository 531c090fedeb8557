//! The folder for results, which knows the case that they belong to.
//!
//! What is there of another case is not replaced in silence, nor are the levels of a study that has taken hours by those of
//! other settings: such a folder is refused, unless it may be overwritten.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::files::Part;
use super::watch::Watch;
use crate::cli::case::CaseId;
use crate::cli::failure::Failure;
use crate::formats::read_regular;
use crate::output::{FileSet, WriteSeek, prepare_folder, remove, write_atomically};
use crate::text::beginning;

/// What a folder knows of its case.
const RECORD: &str = "membranes.json";

/// The longest record, bytes: one of a path of 4096, each of them escaped, has less than half of it.
const LONGEST_RECORD: u64 = 1 << 16;

/// Characters of a path or of settings from a record that a message shows.
const SHOWN: usize = 160;

const REMEDY: &str = "name another folder with --out, or replace them with --overwrite";

/// What a command wants of a folder.
pub(crate) struct Claim<'a> {
    pub(crate) case: &'a CaseId,
    pub(crate) part: Part,
    /// What the results depend on beside the case.
    pub(crate) settings: String,
    pub(crate) overwrite: bool,
    /// What an interrupted run has to say of the folder.
    pub(crate) says: &'static str,
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Record {
    /// The case file, as it was named.
    case: String,
    fingerprint: String,
    /// The settings of each part.
    settings: BTreeMap<String, String>,
}

/// What is in the way: these parts, for this reason.
struct Conflict {
    parts: Vec<Part>,
    why: String,
}

/// A folder of results of one case.
#[derive(Debug, Clone)]
pub(crate) struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Makes the folder, or takes it over from an earlier run of the same case. That this cannot be is said before anything is
    /// computed.
    pub(crate) fn claim(path: &Path, claim: &Claim, watch: &Watch) -> Result<Self, Failure> {
        prepare_folder(path).map_err(|error| cannot_write(path, &error))?;
        let folder = Self { path: path.into() };
        let known = folder.record();
        if let Some(Conflict { parts, why }) = folder.conflict(known.as_ref(), claim) {
            if !claim.overwrite {
                return Err(Failure::Input(format!("{}: {why}; {REMEDY}", path.display())));
            }
            parts.iter().flat_map(|part| part.files()).try_for_each(|name| folder.remove(name))?;
        }
        let mut record =
            known.clone().filter(|known| known.fingerprint == claim.case.fingerprint).unwrap_or(Record {
                case: claim.case.name.clone(),
                fingerprint: claim.case.fingerprint.clone(),
                settings: BTreeMap::new(),
            });
        record.settings.insert(claim.part.name().into(), claim.settings.clone());
        if known.as_ref() != Some(&record) {
            folder.write(RECORD, |out| {
                serde_json::to_writer_pretty(&mut *out, &record)?;
                writeln!(out)
            })?;
        }
        watch.folder(path, claim.says);
        Ok(folder)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Whose folder it is. A record that cannot be read is none, nor is what has no end.
    fn record(&self) -> Option<Record> {
        let text = read_regular(&self.path.join(RECORD), LONGEST_RECORD).ok()?;
        serde_json::from_slice(&text).ok()
    }

    /// A file of this part that is there.
    fn holds(&self, part: Part) -> Option<&'static str> {
        part.files().iter().copied().find(|name| self.path.join(name).exists())
    }

    fn conflict(&self, known: Option<&Record>, claim: &Claim) -> Option<Conflict> {
        let parts: Vec<Part> = Part::ALL.into_iter().filter(|&part| self.holds(part).is_some()).collect();
        let first = self.holds(*parts.first()?)?;
        let Some(known) = known else {
            // Of an earlier version, or of somebody else: what cannot be told is not put at risk.
            return Some(Conflict { parts, why: format!("holds {first}, and no record of its case") });
        };
        if known.fingerprint != claim.case.fingerprint {
            let case = shown(&known.case);
            let why = if known.case == claim.case.name {
                format!("holds results of an earlier version of {case}")
            } else {
                format!("holds results of another case, {case}")
            };
            return Some(Conflict { parts, why });
        }
        let part = claim.part;
        let before = known.settings.get(part.name())?;
        let there = self.holds(part).filter(|_| *before != claim.settings)?;
        let [before, now] = [before, &claim.settings].map(|text| shown(text));
        let why = format!("holds {there} of other settings ({before}; now {now})");
        Some(Conflict { parts: vec![part], why })
    }

    /// Removes a file, if it is there.
    pub(crate) fn remove(&self, name: &str) -> Result<(), Failure> {
        let path = self.path.join(name);
        let cannot_remove = |error| {
            format!(
                "{}: cannot remove: {error}; remove it, or name another folder with --out",
                path.display()
            )
        };
        remove(&path).map_err(|error| Failure::Input(cannot_remove(error)))
    }

    /// Writes a file, whole or not at all.
    pub(crate) fn write(
        &self,
        name: &str,
        write: impl FnOnce(&mut (dyn WriteSeek + '_)) -> std::io::Result<()>,
    ) -> Result<(), Failure> {
        let path = self.path.join(name);
        write_atomically(&path, write).map_err(|error| cannot_write(&path, &error))
    }

    /// Results that are to appear together.
    pub(crate) fn results(&self, part: Part) -> Results<'_> {
        Results { folder: &self.path, files: FileSet::replacing(&self.path, part.files()) }
    }
}

/// The files of a result, which appear together, the summary last, in place of all of an earlier one.
pub(crate) struct Results<'f> {
    folder: &'f Path,
    files: FileSet,
}

impl Results<'_> {
    pub(crate) fn write(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut (dyn WriteSeek + '_)) -> std::io::Result<()>,
    ) -> Result<(), Failure> {
        self.files
            .write(Path::new(name), write)
            .map_err(|error| cannot_write(&self.folder.join(name), &error))
    }

    pub(crate) fn publish(self) -> Result<(), Failure> {
        self.files.publish().map_err(|error| cannot_write(self.folder, &error))
    }
}

/// What a record holds, in a message.
fn shown(text: &str) -> String {
    beginning(text, SHOWN)
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Input(format!("{}: cannot write: {error}; name another folder with --out", path.display()))
}
