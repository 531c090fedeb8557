//! Arrays of numbers in VTK's XML format: compressed by zlib block by block, on all cores, and written in base64.

use std::borrow::Cow;
use std::io::{self, Write};
use std::ops::Range;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;

use crate::parallel::blocks_of;
use crate::parallel::prelude::*;

/// Bytes that are compressed together.
pub(super) const BLOCK: usize = 1 << 16;

/// Bytes of a block that are tried.
const SAMPLE: usize = BLOCK / 16;

/// Bytes that are encoded together: threes of them become four letters.
const ENCODED: usize = 3 << 14;

/// A named array of numbers, one or more for each point or cell. They are asked for block by block while it is written, in
/// no order: no copy of a whole array is made.
pub(crate) struct DataArray<'a> {
    pub(super) name: Cow<'static, str>,
    kind: &'static str,
    components: usize,
    count: usize,
    /// Bytes of a number.
    width: usize,
    bytes: Box<dyn Fn(Range<usize>) -> Vec<u8> + Sync + 'a>,
}

impl<'a> DataArray<'a> {
    /// `value(0), ..., value(count - 1)`.
    pub(crate) fn floats(
        name: impl Into<Cow<'static, str>>,
        count: usize,
        value: impl Fn(usize) -> f64 + Sync + 'a,
    ) -> Self {
        Self::new(name, "Float64", count, move |k| value(k).to_le_bytes())
    }

    /// Vectors of the plane, as VTK's three components.
    pub(crate) fn vectors(
        name: impl Into<Cow<'static, str>>,
        count: usize,
        value: impl Fn(usize) -> [f64; 2] + Sync + 'a,
    ) -> Self {
        let component = move |k: usize| value(k / 3).get(k % 3).copied().unwrap_or(0.0);
        Self { components: 3, ..Self::floats(name, 3 * count, component) }
    }

    pub(crate) fn integers(
        name: impl Into<Cow<'static, str>>,
        count: usize,
        value: impl Fn(usize) -> usize + Sync + 'a,
    ) -> Self {
        Self::new(name, "Int64", count, move |k| (value(k) as i64).to_le_bytes())
    }

    pub(crate) fn flags(
        name: impl Into<Cow<'static, str>>,
        count: usize,
        value: impl Fn(usize) -> bool + Sync + 'a,
    ) -> Self {
        Self::bytes(name, count, move |k| u8::from(value(k)))
    }

    pub(super) fn bytes(
        name: impl Into<Cow<'static, str>>,
        count: usize,
        value: impl Fn(usize) -> u8 + Sync + 'a,
    ) -> Self {
        Self::new(name, "UInt8", count, move |k| [value(k)])
    }

    fn new<const WIDTH: usize>(
        name: impl Into<Cow<'static, str>>,
        kind: &'static str,
        count: usize,
        number: impl Fn(usize) -> [u8; WIDTH] + Sync + 'a,
    ) -> Self {
        let bytes = move |numbers: Range<usize>| {
            let mut bytes = vec![[0; WIDTH]; numbers.len()];
            bytes.iter_mut().zip(numbers).for_each(|(bytes, k)| *bytes = number(k));
            bytes.into_flattened()
        };
        Self { name: name.into(), kind, components: 1, count, width: WIDTH, bytes: Box::new(bytes) }
    }

    /// Writes the array: a header of the numbers and sizes of the blocks, then the compressed blocks, each part in base64.
    pub(super) fn write(&self, out: &mut impl Write) -> io::Result<()> {
        // Of a scalar with a number of components, meshio makes an array of one column.
        let components = match self.components {
            1 => String::new(),
            components => format!(r#" NumberOfComponents="{components}""#),
        };
        let (kind, name) = (self.kind, escaped(&self.name));
        writeln!(out, r#"<DataArray type="{kind}" Name="{name}"{components} format="binary">"#)?;
        let blocks = self.compressed()?;
        let rest = self.count * self.width % BLOCK;
        let sizes = blocks.iter().map(Vec::len);
        let header: Vec<u8> =
            [blocks.len(), BLOCK, rest].into_iter().chain(sizes).flat_map(usize::to_le_bytes).collect();
        out.write_all(STANDARD.encode(header).as_bytes())?;
        let compressed = blocks.concat();
        let encoded: Vec<String> =
            compressed.par_chunks(ENCODED).map(|bytes| STANDARD.encode(bytes)).collect();
        encoded.iter().try_for_each(|letters| out.write_all(letters.as_bytes()))?;
        writeln!(out, "\n</DataArray>")
    }

    /// The blocks, each a stream of its own.
    fn compressed(&self) -> io::Result<Vec<Vec<u8>>> {
        let blocks = blocks_of(BLOCK / self.width, self.count).into_par_iter();
        blocks.map_init(Deflate::new, |zlib, numbers| zlib.stream(&(self.bytes)(numbers))).collect()
    }
}

/// Compresses blocks, or keeps them as they are: both are streams of zlib's.
///
/// The digits of a smooth function are noise. They do not become fewer, and to find that out takes most of the time: it is asked of
/// a sample.
struct Deflate {
    fast: ZlibEncoder<Vec<u8>>,
    none: ZlibEncoder<Vec<u8>>,
}

impl Deflate {
    fn new() -> Self {
        let encoder = |level| ZlibEncoder::new(Vec::new(), level);
        Self { fast: encoder(Compression::fast()), none: encoder(Compression::none()) }
    }

    fn stream(&mut self, block: &[u8]) -> io::Result<Vec<u8>> {
        let sample = &block[..block.len().min(SAMPLE)];
        let is_noise = encoded(&mut self.fast, sample)?.len() > sample.len();
        encoded(if is_noise { &mut self.none } else { &mut self.fast }, block)
    }
}

fn encoded(encoder: &mut ZlibEncoder<Vec<u8>>, bytes: &[u8]) -> io::Result<Vec<u8>> {
    encoder.write_all(bytes)?;
    // What was written went to the vector that is replaced by this one.
    encoder.reset(Vec::new())
}

/// A name as the value of an attribute; control characters, which XML does not have, are left out.
fn escaped(name: &str) -> String {
    let mut text = String::new();
    for letter in name.chars().filter(|letter| !letter.is_control()) {
        match letter {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '>' => text.push_str("&gt;"),
            '"' => text.push_str("&quot;"),
            _ => text.push(letter),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a stream of zlib's has beside what it holds, when that is kept as it is: two bytes, the head of a block for each 64 KiB or
    /// less, four bytes.
    const BESIDE: usize = 2 + 2 * 5 + 4;

    fn sizes(value: impl Fn(usize) -> f64 + Sync) -> Vec<usize> {
        let array = DataArray::floats("", 3 * BLOCK / 8, value);
        array.compressed().unwrap().iter().map(Vec::len).collect()
    }

    #[test]
    fn noise_is_kept_as_it_is_and_all_else_is_compressed() {
        let noise = sizes(|k| ((BLOCK + k) as f64).sqrt());
        assert!(noise.iter().all(|&size| (BLOCK..=BLOCK + BESIDE).contains(&size)), "{noise:?}");
        let [zeros, whole] = [sizes(|_| 0.0), sizes(|k| (k % 64) as f64)];
        assert!(zeros.iter().chain(&whole).all(|&size| size < BLOCK / 4), "{zeros:?} {whole:?}");
        // Each block for itself.
        let mixed = sizes(|k| if k < BLOCK / 8 { 0.0 } else { ((BLOCK + k) as f64).sqrt() });
        assert_eq!(mixed, [zeros[0], noise[1], noise[2]]);
    }
}
