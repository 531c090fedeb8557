//! Files that are read: regular ones, and none that needs more memory than there is.

use std::fs::File;
use std::io;
use std::path::Path;

use super::memory::Memory;
use crate::formats::open_regular;
use crate::text::grouped;

/// What a file is read as. The bytes of memory for each of the file, at the peak of reading, are the most that were measured
/// on inputs made for it (`tests/hostile/targets.rs`).
#[derive(Clone, Copy)]
pub(crate) enum Input {
    CaseFile,
    Mesh,
    /// The rows of a table.
    Rows,
    /// The arrays of an answer or of a checkpoint.
    Arrays,
}

impl Input {
    fn bytes_per_byte(self) -> f64 {
        match self {
            Self::CaseFile => 330.0,
            Self::Mesh => 12.0,
            Self::Rows => 48.0,
            Self::Arrays => 4.0,
        }
    }

    /// What helps where the file is too large.
    fn remedy(self) -> &'static str {
        match self {
            Self::CaseFile => "have a polygon of so many corners meshed by Gmsh, and name the mesh file",
            Self::Mesh => "make a coarser mesh",
            Self::Rows => "merge the rows to be compared",
            Self::Arrays => "take a coarser mesh",
        }
    }
}

/// Opens a file to be read within the memory that there is.
///
/// # Errors
/// As [`open_regular`], and of the kind [`OutOfMemory`](io::ErrorKind::OutOfMemory), with its remedy, when it is too large.
pub(crate) fn open(path: &Path, input: Input, memory: Memory) -> io::Result<File> {
    let file = open_regular(path)?;
    let length = file.metadata()?.len();
    memory
        .check_bytes(input.bytes_per_byte() * length as f64)
        .map(|()| file)
        .map_err(|[needed, available]| {
            io::Error::new(
                io::ErrorKind::OutOfMemory,
                format!(
                    "reading {} bytes takes about {needed:.2} GiB of memory, and {available:.2} are available: {}, or allow more with --memory-limit",
                    grouped(length as usize),
                    input.remedy()
                ),
            )
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_too_large_for_the_memory_is_not_opened() {
        let file = tempfile::NamedTempFile::new().unwrap();
        // Sparse: it takes no space.
        file.as_file().set_len(100 << 20).unwrap();
        let open = |input, gibibytes| open(file.path(), input, Memory::new(Some(gibibytes)));
        let error = open(Input::Mesh, 0.5).unwrap_err();
        assert_eq!(
            error.to_string(),
            "reading 104,857,600 bytes takes about 1.17 GiB of memory, and 0.50 are available: make a coarser mesh, or allow more with --memory-limit"
        );
        assert!(open(Input::Mesh, 1.2).is_ok() && open(Input::Arrays, 0.5).is_ok());
        assert!(open(Input::Rows, 0.6).is_err() && open(Input::CaseFile, 30.0).is_err());
    }
}
