//! numpy's archives: zip files of `.npy` arrays.

use std::io::{self, Read, Seek, Write};

use npyz::WriterBuilder;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// Writes an archive, array by array.
pub(crate) struct NpzWriter<W: Write + Seek> {
    zip: ZipWriter<W>,
}

impl<W: Write + Seek> NpzWriter<W> {
    pub(crate) fn new(out: W) -> Self {
        Self { zip: ZipWriter::new(out) }
    }

    pub(crate) fn floats(&mut self, name: &str, values: &[f64], shape: &[usize]) -> io::Result<()> {
        self.array(name, values.iter().copied(), shape)
    }

    pub(crate) fn integers(&mut self, name: &str, values: &[usize], shape: &[usize]) -> io::Result<()> {
        self.array(name, values.iter().map(|&value| value as i64), shape)
    }

    pub(crate) fn bytes(&mut self, name: &str, values: &[u8]) -> io::Result<()> {
        self.array(name, values.iter().copied(), &[values.len()])
    }

    fn array<T: npyz::AutoSerialize>(
        &mut self,
        name: &str,
        values: impl Iterator<Item = T>,
        shape: &[usize],
    ) -> io::Result<()> {
        let options =
            SimpleFileOptions::default().compression_method(CompressionMethod::Deflated).large_file(true);
        self.zip.start_file(format!("{name}.npy"), options)?;
        let shape: Vec<u64> = shape.iter().map(|&n| n as u64).collect();
        let mut array =
            npyz::WriteOptions::new().default_dtype().shape(&shape).writer(&mut self.zip).begin_nd()?;
        array.extend(values)?;
        array.finish()
    }

    /// Without this the archive cannot be read.
    pub(crate) fn finish(self) -> io::Result<()> {
        self.zip.finish()?.flush()
    }
}

/// The array of one axis called `name`.
///
/// # Errors
/// When it is missing, of another type or shape, or breaks off.
pub(crate) fn read_vector<T: npyz::Deserialize>(
    archive: &mut ZipArchive<impl Read + Seek>,
    name: &str,
) -> io::Result<Vec<T>> {
    let entry = archive.by_name(&format!("{name}.npy")).map_err(io::Error::other)?;
    let array = npyz::NpyFile::new(entry)?;
    if array.shape().len() != 1 {
        return Err(io::Error::other("not an array of one axis"));
    }
    array.data::<T>().map_err(io::Error::other)?.collect()
}
