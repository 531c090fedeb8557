//! The sections, lines and numbers of a Gmsh file, ASCII or binary.

use std::str::FromStr;

use super::error::{GmshError, Place};
use crate::text::excerpt;

/// Order of the bytes of a binary number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ByteOrder {
    Little,
    Big,
}

/// How numbers are written. Names of sections are text in both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Binary(ByteOrder),
}

/// Reads a file from front to back.
pub(super) struct Scanner<'a> {
    bytes: &'a [u8],
    /// Index of the next byte.
    at: usize,
    encoding: Encoding,
    /// The section that was opened last, and the index of its first byte.
    section: &'a str,
    opened_at: usize,
}

impl<'a> Scanner<'a> {
    /// Starts at the front of an ASCII file.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, encoding: Encoding::Ascii, section: "", opened_at: 0 }
    }

    pub(super) fn encoding(&self) -> Encoding {
        self.encoding
    }

    pub(super) fn set_encoding(&mut self, encoding: Encoding) {
        self.encoding = encoding;
    }

    /// The current position, for a message.
    pub(super) fn place(&self) -> Place {
        self.place_of(self.at)
    }

    /// The current position, to be made a [`Place`] when it is needed: that takes time.
    pub(super) fn index(&self) -> usize {
        self.at
    }

    pub(super) fn place_of(&self, index: usize) -> Place {
        match self.encoding {
            Encoding::Ascii => Place::Line(1 + self.bytes[..index].iter().filter(|&&b| b == b'\n').count()),
            Encoding::Binary(_) => Place::Byte(index),
        }
    }

    /// The error of finding `found` instead of `expected` at the current position.
    pub(super) fn unexpected(&self, expected: &str, found: &str) -> GmshError {
        self.syntax_error(expected, format!("`{}`", excerpt(found)))
    }

    fn syntax_error(&self, expected: &str, found: String) -> GmshError {
        let (place, section) = (self.place(), excerpt(self.section));
        GmshError::Syntax { place, section, expected: expected.into(), found }
    }

    fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    fn skip_while(&mut self, skipped: impl Fn(u8) -> bool) {
        let rest = self.rest();
        self.at += rest.iter().position(|&b| !skipped(b)).unwrap_or(rest.len());
    }
}

/// Sections.
impl<'a> Scanner<'a> {
    /// Goes to the next section and reads the `$Name` that opens it; `None` at the end of the file. As for Gmsh, other lines
    /// between sections are comments.
    pub(super) fn open_section(&mut self) -> Result<Option<&'a str>, GmshError> {
        loop {
            self.skip_while(|b| b.is_ascii_whitespace());
            let start = self.at;
            match self.rest() {
                [] => return Ok(None),
                [b'$', next, ..] if !next.is_ascii_whitespace() => {}
                _ => {
                    self.rest_of_line();
                    continue;
                }
            }
            let expected = "the next section, or the end of the file";
            let word = self.word(expected)?;
            let name = &word[1..];
            if name.starts_with("End") {
                self.at = start;
                return Err(self.unexpected(expected, word));
            }
            (self.section, self.opened_at) = (name, start);
            return Ok(Some(name));
        }
    }

    /// Reads the line `$EndName` that closes the section.
    pub(super) fn close_section(&mut self) -> Result<(), GmshError> {
        self.skip_while(|b| b.is_ascii_whitespace());
        let expected = format!("`$End{}`", excerpt(self.section));
        let start = self.at;
        let word = self.word(&expected)?;
        if word.strip_prefix("$End") != Some(self.section) {
            self.at = start;
            return Err(self.unexpected(&expected, word));
        }
        self.end_line()
    }

    /// Goes to the line `$EndName` that closes the section, without a look at what is between.
    pub(super) fn skip_section(&mut self) -> Result<(), GmshError> {
        let closing = format!("$End{}", self.section);
        while let Some(dollar) = self.rest().iter().position(|&b| b == b'$') {
            self.at += dollar;
            let opens_line = self.at == 0 || self.bytes[self.at - 1] == b'\n';
            if opens_line
                && let Some(behind) = self.rest().strip_prefix(closing.as_bytes())
                && behind.first().is_none_or(u8::is_ascii_whitespace)
            {
                return Ok(());
            }
            self.at += 1;
        }
        self.at = self.bytes.len();
        Err(self.syntax_error(&format!("`{}`", excerpt(&closing)), "the end of the file".into()))
    }

    /// Skips a section that repeats what `body` has word for word: so Gmsh appends a view to a file, with the mesh once more.
    pub(super) fn skip_repeated(&mut self, body: &[u8]) -> Result<(), GmshError> {
        let start = self.at;
        let is_same = self.skip_section().is_ok() && self.bytes[start..self.at] == *body;
        if is_same { Ok(()) } else { Err(self.repeated_section()) }
    }

    /// What the section has from byte `start` to its end, at which the scanner is to be already, up to blanks.
    pub(super) fn body_since(&mut self, start: usize) -> &'a [u8] {
        self.skip_lines();
        &self.bytes[start..self.at]
    }

    /// The error of a section that was given before.
    pub(super) fn repeated_section(&self) -> GmshError {
        GmshError::RepeatedSection { place: self.place_of(self.opened_at), section: excerpt(self.section) }
    }
}

/// Text: headers, and everything in an ASCII file.
impl<'a> Scanner<'a> {
    /// Reads the next word of the line.
    pub(super) fn word(&mut self, expected: &str) -> Result<&'a str, GmshError> {
        self.skip_while(|b| matches!(b, b' ' | b'\t' | b'\r'));
        let rest = self.rest();
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        if length == 0 {
            let end = if rest.is_empty() { "the end of the file" } else { "the end of the line" };
            return Err(self.syntax_error(expected, end.into()));
        }
        let word = std::str::from_utf8(&rest[..length])
            .map_err(|_| self.syntax_error(expected, "bytes that are no text".into()))?;
        self.at += length;
        Ok(word)
    }

    /// Reads the next word of the line as a number.
    pub(super) fn text_number<T: FromStr>(&mut self, expected: &str) -> Result<T, GmshError> {
        let word = self.word(expected)?;
        word.parse().map_err(|_| self.unexpected(expected, word))
    }

    /// Reads what is left of the line, and goes to the next one.
    pub(super) fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = self.rest();
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.at += (length + 1).min(rest.len());
        &rest[..length]
    }

    /// Reads what stands between the first quotation mark of the line and the next one, or the end of the line, as Gmsh does; nothing
    /// where there is no mark.
    pub(super) fn quoted(&mut self) -> String {
        let line = String::from_utf8_lossy(self.rest_of_line());
        line.split('"').nth(1).unwrap_or("").trim_end_matches('\r').into()
    }

    /// Goes over blanks and the ends of lines before text, in binary files too.
    pub(super) fn skip_lines(&mut self) {
        self.skip_while(|b| b.is_ascii_whitespace());
    }

    /// Goes over blanks and the ends of lines of an ASCII file.
    pub(super) fn skip_blank(&mut self) {
        if self.encoding == Encoding::Ascii {
            self.skip_while(|b| b.is_ascii_whitespace());
        }
    }

    /// Ends a line: nothing but blanks may be left of it. In an ASCII file empty lines behind it are skipped.
    pub(super) fn end_line(&mut self) -> Result<(), GmshError> {
        self.skip_while(|b| matches!(b, b' ' | b'\t' | b'\r'));
        match self.rest().first() {
            None => return Ok(()),
            Some(b'\n') => self.at += 1,
            Some(_) => {
                let word = self.word("the end of the line")?;
                return Err(self.unexpected("the end of the line", word));
            }
        }
        self.skip_blank();
        Ok(())
    }
}

/// Numbers of either encoding.
impl Scanner<'_> {
    /// Reads the next `N` bytes.
    pub(super) fn bytes<const N: usize>(&mut self, expected: &str) -> Result<[u8; N], GmshError> {
        let Some(found) = self.rest().first_chunk() else {
            return Err(self.syntax_error(expected, "the end of the file".into()));
        };
        self.at += N;
        Ok(*found)
    }

    /// Reads a C `int`.
    pub(super) fn int(&mut self, expected: &str) -> Result<i32, GmshError> {
        match self.encoding {
            Encoding::Ascii => self.text_number(expected),
            Encoding::Binary(ByteOrder::Little) => self.bytes(expected).map(i32::from_le_bytes),
            Encoding::Binary(ByteOrder::Big) => self.bytes(expected).map(i32::from_be_bytes),
        }
    }

    /// Reads a C `size_t`.
    pub(super) fn size(&mut self, expected: &str) -> Result<u64, GmshError> {
        match self.encoding {
            Encoding::Ascii => self.text_number(expected),
            Encoding::Binary(ByteOrder::Little) => self.bytes(expected).map(u64::from_le_bytes),
            Encoding::Binary(ByteOrder::Big) => self.bytes(expected).map(u64::from_be_bytes),
        }
    }

    /// Reads a C `double`.
    pub(super) fn double(&mut self, expected: &str) -> Result<f64, GmshError> {
        match self.encoding {
            Encoding::Ascii => self.text_number(expected),
            Encoding::Binary(ByteOrder::Little) => self.bytes(expected).map(f64::from_le_bytes),
            Encoding::Binary(ByteOrder::Big) => self.bytes(expected).map(f64::from_be_bytes),
        }
    }

    /// Ends a record: a line of an ASCII file, nothing in a binary one.
    pub(super) fn end_record(&mut self) -> Result<(), GmshError> {
        match self.encoding {
            Encoding::Ascii => self.end_line(),
            Encoding::Binary(_) => Ok(()),
        }
    }

    /// Bytes to the end of the file.
    pub(super) fn left(&self) -> usize {
        self.rest().len()
    }

    /// Accepts a number of things that the file declares to follow: each of them takes at least one byte.
    pub(super) fn count(&self, declared: impl Into<i128>, of: &'static str) -> Result<usize, GmshError> {
        let (count, left) = (declared.into(), self.rest().len());
        match usize::try_from(count) {
            Ok(count) if count <= left => Ok(count),
            _ => {
                let (place, section) = (self.place(), excerpt(self.section));
                Err(GmshError::Count { place, section, of, count, left })
            }
        }
    }
}
