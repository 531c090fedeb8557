//! Files that are whole or not there.

use std::fs::Permissions;
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use std::thread::{self, JoinHandle};

use tempfile::{Builder, NamedTempFile};

use crate::formats::open_regular;

/// Names of files that are being written.
const PREFIX: &str = ".membranes-";
const SUFFIX: &str = ".part";

/// Something to write to that can also be wound back, as an archive needs it.
pub trait WriteSeek: Write + Seek {}

impl<T: Write + Seek> WriteSeek for T {}

/// Has `write` fill a temporary file beside `path`, then gives it that name in one step: an interrupted run leaves the
/// file as it was before, or none.
///
/// # Errors
/// When writing fails; then nothing is left behind.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut (dyn WriteSeek + '_)) -> io::Result<()>,
) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = FileSet::new(folder);
    file.write(path.file_name().unwrap_or_default().as_ref(), write)?;
    file.place().map_err(|(_, error)| error)
}

/// Files that belong together: they appear when all of them are whole.
///
/// The last one written is their seal. It is the first to go and the last to come: where it is, the others belong to it, even
/// when the run was ended in between.
pub struct FileSet {
    folder: PathBuf,
    written: Vec<Written>,
    /// Names of which those that are not written go.
    replaced: Vec<PathBuf>,
}

/// A whole file that has not got its name yet.
struct Written {
    file: NamedTempFile,
    path: PathBuf,
    /// Until it is on the disk: nobody waits for that before the file gets its name.
    synced: JoinHandle<io::Result<()>>,
}

impl FileSet {
    /// No files yet, of an existing folder.
    pub fn new(folder: &Path) -> Self {
        Self::replacing(folder, &[])
    }

    /// No files yet, of an existing folder. They come in place of these, of an earlier set: what is not written again goes.
    pub fn replacing(folder: &Path, names: &[&str]) -> Self {
        let replaced = names.iter().map(|name| folder.join(name)).collect();
        Self { folder: folder.into(), written: Vec::new(), replaced }
    }

    /// Has `write` fill the file that will be called `name`.
    ///
    /// # Errors
    /// When writing fails.
    pub fn write(
        &mut self,
        name: &Path,
        write: impl FnOnce(&mut (dyn WriteSeek + '_)) -> io::Result<()>,
    ) -> io::Result<()> {
        let mut file = temporary_file(&self.folder)?;
        let mut buffered = BufWriter::new(file.as_file_mut());
        write(&mut buffered)?;
        buffered.flush()?;
        drop(buffered);
        let on_disk = file.as_file().try_clone()?;
        let synced = thread::spawn(move || on_disk.sync_all());
        self.written.push(Written { file, path: self.folder.join(name), synced });
        Ok(())
    }

    /// Gives the files their names, once all of them are on the disk.
    ///
    /// # Errors
    /// When one does not come there, the folder does not allow it, or another folder lies in the place of a file; the file is named.
    pub fn publish(self) -> io::Result<()> {
        self.place().map_err(|(path, error)| {
            let name = path.file_name().unwrap_or_default().display();
            io::Error::new(error.kind(), format!("{name}: {error}"))
        })
    }

    /// As [`publish`](Self::publish), with the path that is in the way beside the error.
    fn place(self) -> Result<(), (PathBuf, io::Error)> {
        let mut on_disk = Vec::new();
        for Written { file, path, synced } in self.written {
            match synced.join().expect("syncing does not panic") {
                Ok(()) => on_disk.push((file, path)),
                Err(error) => return Err((path, error)),
            }
        }
        let remove = |path: &Path| remove(path).map_err(|error| (path.to_path_buf(), error));
        if let [_, .., (_, seal)] = on_disk.as_slice() {
            remove(seal)?;
        }
        let is_written = |path: &PathBuf| on_disk.iter().any(|(_, written)| written == path);
        self.replaced.iter().filter(|path| !is_written(path)).try_for_each(|path| remove(path))?;
        on_disk.into_iter().try_for_each(|(file, path)| match file.persist(&path) {
            Ok(_) => Ok(()),
            Err(error) => Err((path, error.error)),
        })
    }
}

/// Removes a file, if it is there.
///
/// # Errors
/// When it is there and stays.
pub fn remove(path: &Path) -> io::Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// Tries to write in `folder`, and removes what runs that were killed have left there unfinished.
///
/// # Errors
/// When nothing can be written there.
pub fn prepare_folder(folder: &Path) -> io::Result<()> {
    std::fs::create_dir_all(folder)?;
    drop(temporary_file(folder)?);
    for part in parts(folder, PREFIX)? {
        // A run that is alive holds the lock. What is no file is none of ours.
        if open_regular(&part).is_ok_and(|file| file.try_lock().is_ok()) {
            remove(&part)?;
        }
    }
    Ok(())
}

/// Removes what this process is writing in `folder`, before it ends without having finished.
pub fn discard_unfinished(folder: &Path) {
    for part in parts(folder, &own_prefix()).unwrap_or_default() {
        let _ = remove(&part);
    }
}

fn own_prefix() -> String {
    format!("{PREFIX}{}-", std::process::id())
}

/// The unfinished files in `folder` whose names begin so.
fn parts(folder: &Path, prefix: &str) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        if name.to_str().is_some_and(|name| name.starts_with(prefix) && name.ends_with(SUFFIX)) {
            found.push(entry.path());
        }
    }
    Ok(found)
}

/// A temporary file, locked as long as it is open.
fn temporary_file(folder: &Path) -> io::Result<NamedTempFile> {
    let prefix = own_prefix();
    let mut builder = Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX);
    // A temporary file is private by default; this one becomes a result, readable as the user's umask has it.
    #[cfg(unix)]
    builder.permissions(<Permissions as std::os::unix::fs::PermissionsExt>::from_mode(0o666));
    // What is wrong, without the temporary name.
    let file = builder.tempfile_in(folder).map_err(|error| io::Error::from(error.kind()))?;
    // Not every file system knows locks; there, nobody else gets one either.
    let _ = file.as_file().try_lock();
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(folder)
            .expect("the folder is there")
            .map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_whole_or_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result");
        write_atomically(&path, |out| out.write_all(b"first")).unwrap();
        let failed = write_atomically(&path, |out| {
            out.write_all(b"second, but")?;
            Err(io::Error::other("the disk is full"))
        });
        assert!(failed.is_err());
        assert_eq!(std::fs::read(&path).unwrap(), b"first");
        assert_eq!(names(folder.path()), ["result"], "no temporary file is left behind");
        write_atomically(&path, |out| out.write_all(b"second")).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"second");
    }

    #[test]
    fn files_that_belong_together_appear_together() {
        let folder = tempfile::tempdir().unwrap();
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
        let write = |text: &'static str, fails: bool| {
            let mut files = FileSet::new(folder.path());
            files.write(Path::new("a"), |out| out.write_all(text.as_bytes())).unwrap();
            let seal = files.write(Path::new("seal"), |out| match fails {
                true => Err(io::Error::other("the disk is full")),
                false => out.write_all(text.as_bytes()),
            });
            seal.and_then(|()| files.publish())
        };
        write("old", false).unwrap();
        assert!(write("new", true).is_err());
        assert_eq!((read("a"), read("seal")), ("old".into(), "old".into()), "nothing is lost");
        write("new", false).unwrap();
        assert_eq!((read("a"), read("seal")), ("new".into(), "new".into()));
        // What ends the run while the names are given leaves no seal: here a folder that cannot be replaced.
        std::fs::remove_file(folder.path().join("a")).unwrap();
        std::fs::create_dir(folder.path().join("a")).unwrap();
        assert!(write("newer", false).is_err());
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn a_set_takes_the_place_of_another_one_and_of_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let publish = |names: &[&str]| {
            let mut files = FileSet::replacing(folder.path(), &["a", "b", "seal"]);
            names.iter().for_each(|name| files.write(Path::new(name), |_| Ok(())).unwrap());
            files.publish().unwrap();
        };
        std::fs::write(folder.path().join("notes"), "").unwrap();
        publish(&["a", "b", "seal"]);
        assert_eq!(names(folder.path()), ["a", "b", "notes", "seal"]);
        publish(&["a", "seal"]);
        assert_eq!(names(folder.path()), ["a", "notes", "seal"]);
        publish(&["seal"]);
        assert_eq!(names(folder.path()), ["notes", "seal"]);
    }

    #[test]
    fn what_a_killed_run_has_left_is_removed_and_what_is_being_written_stays() {
        let folder = tempfile::tempdir().unwrap();
        let abandoned = format!("{PREFIX}1-abc{SUFFIX}");
        for name in [&abandoned, "result", ".membranes", "notes.part"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let under_way = temporary_file(folder.path()).unwrap();
        prepare_folder(folder.path()).unwrap();
        let name = under_way.path().file_name().unwrap().to_string_lossy().into_owned();
        let mut expected = vec![".membranes".into(), name, "notes.part".into(), "result".into()];
        expected.sort();
        assert_eq!(names(folder.path()), expected);
        discard_unfinished(folder.path());
        assert_eq!(names(folder.path()), [".membranes", "notes.part", "result"]);
    }

    #[test]
    fn a_folder_that_is_a_file_is_refused() {
        let file = tempfile::NamedTempFile::new().unwrap();
        assert!(prepare_folder(file.path()).is_err());
        assert!(prepare_folder(&file.path().join("below")).is_err());
        assert!(prepare_folder(tempfile::tempdir().unwrap().path()).is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn others_may_read_it_as_the_umask_says() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let mode = |name: &str| std::fs::metadata(folder.path().join(name)).unwrap().permissions().mode();
        std::fs::write(folder.path().join("plain"), b"").unwrap();
        write_atomically(&folder.path().join("ours"), |_| Ok(())).unwrap();
        assert_eq!(mode("ours"), mode("plain"));
    }
}
