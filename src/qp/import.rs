//! The answer of any other solver to an exported program, read back.

use std::fmt;
use std::io::{self, Read, Seek};

use thiserror::Error;
use zip::ZipArchive;
use zip::result::ZipError;

use super::Answer;
use crate::formats::npz::open_array;

/// Reads the arrays `x` and `y` of a numpy archive: the counterpart of [`write_npz`](super::write_npz), in its order of
/// unknowns and its sign of multipliers. Other arrays are not looked at.
///
/// # Errors
/// [`AnswerError`] when it is no such archive, an array is missing, not of 64-bit floats, not of the shape
/// `(variables,)` or `(constraints,)`, or holds a number that is not finite.
pub fn read_answer(
    archive: impl Read + Seek,
    variables: usize,
    constraints: usize,
) -> Result<Answer, AnswerError> {
    let mut archive = ZipArchive::new(archive).map_err(|error| match error {
        ZipError::Io(error) => AnswerError::Io(error),
        error => AnswerError::NotAnArchive(error),
    })?;
    let x = read_array(&mut archive, "x", variables)?;
    let y = read_array(&mut archive, "y", constraints)?;
    Ok(Answer { x, y })
}

fn read_array(
    archive: &mut ZipArchive<impl Read + Seek>,
    name: &'static str,
    length: usize,
) -> Result<Vec<f64>, AnswerError> {
    let entry = archive.by_name(&format!("{name}.npy")).map_err(|error| match error {
        ZipError::FileNotFound => AnswerError::Missing { name },
        error => AnswerError::Array { name, source: io::Error::other(error) },
    })?;
    let broken = |source| AnswerError::Array { name, source };
    let array = open_array(entry).map_err(broken)?;
    // The shape comes first: it says how much will be read, and a hostile header may say anything.
    if array.shape() != [length as u64] {
        let found = Shape(array.shape().to_vec());
        return Err(AnswerError::Shape { name, found, expected: length });
    }
    let kind = array.dtype().descr();
    let numbers = array.data::<f64>().map_err(|_| AnswerError::Kind { name, kind })?;
    let values = numbers.collect::<io::Result<Vec<f64>>>().map_err(broken)?;
    match values.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(AnswerError::NotFinite { name, index, value: values[index] }),
        None => Ok(values),
    }
}

/// A shape, written as numpy writes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shape(pub Vec<u64>);

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let lengths: Vec<String> = self.0.iter().map(u64::to_string).collect();
        let comma = if lengths.len() == 1 { "," } else { "" };
        write!(f, "({}{comma})", lengths.join(", "))
    }
}

/// Why a file is no answer.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AnswerError {
    /// It cannot be read.
    #[error("{0}")]
    Io(#[source] io::Error),
    /// It is no zip archive.
    #[error("this is no numpy archive ({0}): write it by numpy.savez(FILE, x=x, y=y)")]
    NotAnArchive(#[source] ZipError),
    /// An array is not there.
    #[error("there is no array `{name}`: write the archive by numpy.savez(FILE, x=x, y=y)")]
    Missing {
        /// Which.
        name: &'static str,
    },
    /// An array that breaks off or is no array.
    #[error("`{name}` cannot be read ({source}): write the archive anew by numpy.savez(FILE, x=x, y=y)")]
    Array {
        /// Which.
        name: &'static str,
        /// What is wrong.
        source: io::Error,
    },
    /// Numbers of another type.
    #[error("`{name}` holds {kind}: give 64-bit floats, {name}.astype(numpy.float64)")]
    Kind {
        /// Which array.
        name: &'static str,
        /// Its type, as numpy describes it.
        kind: String,
    },
    /// An array of another shape.
    #[error(
        "`{name}` has the shape {found}, but the exported program asks for ({expected},): export this case anew"
    )]
    Shape {
        /// Which array.
        name: &'static str,
        /// Its shape.
        found: Shape,
        /// The length that fits.
        expected: usize,
    },
    /// NaN or an infinity.
    #[error("`{name}` holds {value} (entry {index}): all numbers must be finite")]
    NotFinite {
        /// Which array.
        name: &'static str,
        /// The entry.
        index: usize,
        /// Its value.
        value: f64,
    },
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Write};

    use npyz::WriterBuilder;
    use zip::write::SimpleFileOptions;
    use zip::{CompressionMethod, ZipWriter};

    use super::*;

    fn npy<T: npyz::AutoSerialize>(shape: &[u64], values: impl IntoIterator<Item = T>) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut array =
            npyz::WriteOptions::new().default_dtype().shape(shape).writer(&mut bytes).begin_nd().unwrap();
        array.extend(values).unwrap();
        array.finish().unwrap();
        bytes
    }

    fn archive(method: CompressionMethod, entries: &[(&str, Vec<u8>)]) -> Vec<u8> {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in entries {
            zip.start_file(*name, SimpleFileOptions::default().compression_method(method)).unwrap();
            zip.write_all(bytes).unwrap();
        }
        zip.finish().unwrap().into_inner()
    }

    const X: [f64; 4] = [1.0, -2.5, 1.0 / 3.0, 1e-300];
    const Y: [f64; 2] = [0.0, 0.1];

    fn with_x(x: Vec<u8>) -> Vec<u8> {
        archive(CompressionMethod::Stored, &[("x.npy", x), ("y.npy", npy(&[2], Y))])
    }

    #[test]
    fn stored_and_deflated_arrays_arrive_to_the_last_bit_in_any_company() {
        for method in [CompressionMethod::Stored, CompressionMethod::Deflated] {
            let entries = [("y.npy", npy(&[2], Y)), ("z.npy", vec![7]), ("x.npy", npy(&[4], X))];
            let answer = read_answer(Cursor::new(archive(method, &entries)), 4, 2).unwrap();
            assert_eq!((answer.x.as_slice(), answer.y.as_slice()), (X.as_slice(), Y.as_slice()));
        }
    }

    #[test]
    fn big_endian_numbers_are_numbers() {
        let mut bytes = npy(&[4], X);
        let data = bytes.len() - 4 * size_of::<f64>();
        for (place, value) in bytes[data..].chunks_exact_mut(8).zip(X) {
            place.copy_from_slice(&value.to_be_bytes());
        }
        let mark = bytes.iter().position(|&byte| byte == b'<').expect("the header says little-endian");
        bytes[mark] = b'>';
        assert_eq!(read_answer(Cursor::new(with_x(bytes)), 4, 2).unwrap().x, X);
    }

    #[test]
    fn every_fault_is_named() {
        let whole = npy(&[4], X);
        let broken_off = whole[..whole.len() - 1].to_vec();
        let refused: [(Vec<u8>, &str); 10] = [
            (b"x = [1, 2]".to_vec(), "no numpy archive"),
            (Vec::new(), "no numpy archive"),
            (archive(CompressionMethod::Stored, &[("x.npy", whole.clone())]), "no array `y`"),
            (archive(CompressionMethod::Stored, &[("y.npy", npy(&[2], Y))]), "no array `x`"),
            (with_x(broken_off), "`x` cannot be read"),
            (with_x(b"1 2 3 4".to_vec()), "`x` cannot be read"),
            (with_x(npy(&[4], X.map(|x| x as f32))), "`x` holds '<f4': give 64-bit floats"),
            (with_x(npy(&[2, 2], X)), "`x` has the shape (2, 2), but the exported program asks for (4,)"),
            (with_x(npy(&[3], X[..3].to_vec())), "`x` has the shape (3,)"),
            (with_x(npy(&[4], [1.0, 2.0, f64::NAN, 4.0])), "`x` holds NaN (entry 2)"),
        ];
        for (bytes, says) in refused {
            let message = read_answer(Cursor::new(bytes), 4, 2).expect_err(says).to_string();
            assert!(message.contains(says), "{message}");
            assert_eq!(message.lines().count(), 1, "{message}");
        }
        assert!(read_answer(Cursor::new(with_x(whole)), 4, 2).is_ok());
    }
}
