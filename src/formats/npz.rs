//! numpy's archives: zip files of `.npy` arrays.

use std::io::{self, Read, Seek, Write};

use npyz::{NpyFile, NpyHeader, WriterBuilder};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// Bytes of an array before the length of its header: `\x93NUMPY` and two for the version.
const SIGNATURE: usize = 8;

/// The longest header, bytes: so much numpy itself reads when nothing else is asked for.
const LONGEST_HEADER: usize = 10_000;

/// The brackets of a plain array's header: of the dictionary and of the shape. (Records have more.)
const BRACKETS: usize = 2;

/// The most digits of a header: so many in all, and no product of decimal numbers exceeds 64 bits.
const MOST_DIGITS: usize = 19;

/// Writes an archive, array by array.
pub(crate) struct NpzWriter<W: Write + Seek> {
    zip: ZipWriter<W>,
    method: CompressionMethod,
}

impl<W: Write + Seek> NpzWriter<W> {
    /// Arrays are compressed: for programs that read archives of their own.
    pub(crate) fn deflated(out: W) -> Self {
        Self { zip: ZipWriter::new(out), method: CompressionMethod::Deflated }
    }

    /// Arrays are as long as what they hold: for [`read_vector`].
    pub(crate) fn stored(out: W) -> Self {
        Self { zip: ZipWriter::new(out), method: CompressionMethod::Stored }
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
        let options = SimpleFileOptions::default().compression_method(self.method).large_file(true);
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

/// Opens an array: reads its header, and nothing of what that declares.
///
/// The crate `npyz` alone trusts a header: it takes the memory for one of 4 GiB that is not there, tries every
/// bracket in several ways, each of them for those inside it as well (3^n for n braces), and multiplies lengths that overflow.
///
/// # Errors
/// When it is no array, or its header is not like those of plain arrays.
pub(crate) fn open_array<R: Read>(mut entry: R) -> io::Result<NpyFile<R>> {
    let mut header = vec![0; SIGNATURE + 2];
    entry.read_exact(&mut header)?;
    if header[SIGNATURE - 2] > 1 {
        header.resize(SIGNATURE + 4, 0);
        entry.read_exact(&mut header[SIGNATURE + 2..])?;
    }
    let length = header[SIGNATURE..].iter().rev().fold(0, |length, &byte| length << 8 | usize::from(byte));
    if length > LONGEST_HEADER {
        return Err(io::Error::other("its header is too long"));
    }
    let text = header.len();
    header.resize(text + length, 0);
    entry.read_exact(&mut header[text..])?;
    if !is_plain(&header[text..]) {
        return Err(io::Error::other("its header is not that of a plain array"));
    }
    // The messages of `npyz` quote the header in several lines.
    let header = NpyHeader::from_reader(header.as_slice())
        .map_err(|_| io::Error::other("its header does not describe an array"))?;
    Ok(NpyFile::with_header(header, entry))
}

/// Whether a header may be that of a plain array, without lengths whose product overflows.
fn is_plain(header: &[u8]) -> bool {
    let count = |counted: fn(&u8) -> bool| header.iter().filter(|&byte| counted(byte)).count();
    let is_hexadecimal = header.windows(2).any(|pair| pair.eq_ignore_ascii_case(b"0x"));
    count(|byte| b"([{".contains(byte)) <= BRACKETS
        && count(u8::is_ascii_digit) <= MOST_DIGITS
        && !is_hexadecimal
}

/// The array of one axis called `name`, not compressed: so it takes no more memory than the archive has bytes for it.
///
/// # Errors
/// When it is missing, compressed, of another type or shape, or breaks off.
pub(crate) fn read_vector<T: npyz::Deserialize>(
    archive: &mut ZipArchive<impl Read + Seek>,
    name: &str,
) -> io::Result<Vec<T>> {
    let entry = archive.by_name(&format!("{name}.npy")).map_err(io::Error::other)?;
    if entry.compression() != CompressionMethod::Stored {
        return Err(io::Error::other("a compressed array, which may expand a thousandfold"));
    }
    let array = open_array(entry)?;
    if array.shape().len() != 1 {
        return Err(io::Error::other("not an array of one axis"));
    }
    array.data::<T>().map_err(io::Error::other)?.collect()
}
