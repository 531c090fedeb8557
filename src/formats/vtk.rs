//! VTK's XML format for unstructured grids and polylines: binary, compressed by zlib; ParaView, PyVista and meshio read it.

use std::borrow::Cow;
use std::io::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;

/// Bytes that are compressed together.
const BLOCK: usize = 1 << 16;

/// VTK's numbers for the shapes of cells.
pub(crate) const VTK_TRIANGLE: u8 = 5;
pub(crate) const VTK_POLYGON: u8 = 7;

/// A named array of numbers, one for each point or cell.
pub(crate) struct DataArray {
    name: Cow<'static, str>,
    kind: &'static str,
    components: usize,
    bytes: Vec<u8>,
}

impl DataArray {
    pub(crate) fn floats(name: impl Into<Cow<'static, str>>, values: impl IntoIterator<Item = f64>) -> Self {
        Self {
            name: name.into(),
            kind: "Float64",
            components: 1,
            bytes: values.into_iter().flat_map(f64::to_le_bytes).collect(),
        }
    }

    /// Vectors of the plane, as VTK's three components.
    pub(crate) fn vectors(
        name: impl Into<Cow<'static, str>>,
        values: impl IntoIterator<Item = [f64; 2]>,
    ) -> Self {
        let components = values.into_iter().flat_map(|[x, y]| [x, y, 0.0]);
        Self { components: 3, ..Self::floats(name, components) }
    }

    pub(crate) fn integers(
        name: impl Into<Cow<'static, str>>,
        values: impl IntoIterator<Item = usize>,
    ) -> Self {
        Self {
            name: name.into(),
            kind: "Int64",
            components: 1,
            bytes: values.into_iter().flat_map(integer).collect(),
        }
    }

    pub(crate) fn flags(name: impl Into<Cow<'static, str>>, values: impl IntoIterator<Item = bool>) -> Self {
        Self {
            name: name.into(),
            kind: "UInt8",
            components: 1,
            bytes: values.into_iter().map(u8::from).collect(),
        }
    }
}

/// The cells of a grid, all of one shape.
pub(crate) struct Cells {
    shape: u8,
    count: usize,
    corners: Vec<u8>,
    ends: Vec<u8>,
}

impl Cells {
    /// Cells of VTK's `shape`, each given by the numbers of its corners.
    pub(crate) fn new(shape: u8, cells: impl Iterator<Item: IntoIterator<Item = usize>>) -> Self {
        let (mut count, mut end) = (0, 0);
        let (mut corners, mut ends) = (Vec::new(), Vec::new());
        for cell in cells {
            for corner in cell {
                corners.extend(integer(corner));
                end += 1;
            }
            ends.extend(integer(end));
            count += 1;
        }
        Self { shape, count, corners, ends }
    }
}

/// What the arrays of a grid belong to.
#[derive(Clone, Copy)]
pub(crate) enum Location {
    Points,
    Cells,
}

/// Writes a grid with its arrays; `lambda` is the one that a viewer shows first.
pub(crate) fn write_grid(
    mut out: impl Write,
    points: &[[f64; 2]],
    cells: &Cells,
    sections: &[(Location, &[DataArray])],
) -> io::Result<()> {
    let out = &mut out;
    begin(out, "UnstructuredGrid")?;
    writeln!(out, r#"<Piece NumberOfPoints="{}" NumberOfCells="{}">"#, points.len(), cells.count)?;
    for (location, arrays) in sections {
        write_section(out, *location, arrays)?;
    }
    write_points(out, points)?;
    writeln!(out, "<Cells>")?;
    write_array(out, r#"type="Int64" Name="connectivity""#, &cells.corners)?;
    write_array(out, r#"type="Int64" Name="offsets""#, &cells.ends)?;
    write_array(out, r#"type="UInt8" Name="types""#, &vec![cells.shape; cells.count])?;
    writeln!(out, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")?;
    out.flush()
}

/// Writes polylines, each through points of its own in their order, with arrays over the lines.
pub(crate) fn write_lines(
    mut out: impl Write,
    lines: &[&[[f64; 2]]],
    arrays: &[DataArray],
) -> io::Result<()> {
    let out = &mut out;
    let points = lines.concat();
    begin(out, "PolyData")?;
    writeln!(
        out,
        r#"<Piece NumberOfPoints="{}" NumberOfVerts="0" NumberOfLines="{}" NumberOfStrips="0" NumberOfPolys="0">"#,
        points.len(),
        lines.len()
    )?;
    write_section(out, Location::Cells, arrays)?;
    write_points(out, &points)?;
    let ends = lines.iter().scan(0, |end, line| {
        *end += line.len();
        Some(*end)
    });
    writeln!(out, "<Lines>")?;
    let numbers: Vec<u8> = (0..points.len()).flat_map(integer).collect();
    write_array(out, r#"type="Int64" Name="connectivity""#, &numbers)?;
    write_array(out, r#"type="Int64" Name="offsets""#, &ends.flat_map(integer).collect::<Vec<u8>>())?;
    writeln!(out, "</Lines>\n</Piece>\n</PolyData>\n</VTKFile>")?;
    out.flush()
}

fn begin(out: &mut impl Write, kind: &str) -> io::Result<()> {
    writeln!(out, r#"<?xml version="1.0"?>"#)?;
    writeln!(
        out,
        r#"<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor">"#
    )?;
    writeln!(out, "<{kind}>")
}

fn write_section(out: &mut impl Write, location: Location, arrays: &[DataArray]) -> io::Result<()> {
    let section = match location {
        Location::Points => "PointData",
        Location::Cells => "CellData",
    };
    let has_lambda = arrays.iter().any(|array| array.name == "lambda");
    let first = if has_lambda { r#" Scalars="lambda""# } else { "" };
    writeln!(out, "<{section}{first}>")?;
    for DataArray { name, kind, components, bytes } in arrays {
        // Of a scalar with a number of components, meshio makes an array of one column.
        let components =
            if *components == 1 { String::new() } else { format!(r#" NumberOfComponents="{components}""#) };
        let attributes = format!(r#"type="{kind}" Name="{}"{components}"#, escaped(name));
        write_array(out, &attributes, bytes)?;
    }
    writeln!(out, "</{section}>")
}

fn write_points(out: &mut impl Write, points: &[[f64; 2]]) -> io::Result<()> {
    writeln!(out, "<Points>")?;
    let coordinates: Vec<u8> =
        points.iter().flat_map(|&[x, y]| [x, y, 0.0]).flat_map(f64::to_le_bytes).collect();
    write_array(out, r#"type="Float64" Name="Points" NumberOfComponents="3""#, &coordinates)?;
    writeln!(out, "</Points>")
}

/// One data array: a header of the numbers and sizes of the blocks, then the compressed blocks, each part in base64.
fn write_array(out: &mut impl Write, attributes: &str, bytes: &[u8]) -> io::Result<()> {
    let mut header = vec![bytes.len().div_ceil(BLOCK) as u64, BLOCK as u64, (bytes.len() % BLOCK) as u64];
    let mut compressed = Vec::new();
    for block in bytes.chunks(BLOCK) {
        let before = compressed.len();
        let mut encoder = ZlibEncoder::new(compressed, Compression::fast());
        encoder.write_all(block)?;
        compressed = encoder.finish()?;
        header.push((compressed.len() - before) as u64);
    }
    let header: Vec<u8> = header.iter().flat_map(|n| n.to_le_bytes()).collect();
    writeln!(out, r#"<DataArray {attributes} format="binary">"#)?;
    writeln!(out, "{}{}", STANDARD.encode(header), STANDARD.encode(compressed))?;
    writeln!(out, "</DataArray>")
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

fn integer(number: usize) -> [u8; 8] {
    (number as i64).to_le_bytes()
}

/// Reading back, for the tests of all writers.
#[cfg(test)]
pub(crate) mod samples {
    use super::*;

    /// The bytes of the array of this name in a file, decompressed.
    pub(crate) fn read_array(file: &str, name: &str) -> Option<Vec<u8>> {
        let mut lines = file.lines();
        lines.find(|line| line.starts_with("<DataArray") && line.contains(&format!(r#" Name="{name}""#)))?;
        let data = lines.next()?;
        let number = |bytes: &[u8]| u64::from_le_bytes(bytes.try_into().expect("eight bytes"));
        let blocks = number(&STANDARD.decode(&data[..32]).expect("base64")[..8]) as usize;
        let header_end = (8 * (3 + blocks)).div_ceil(3) * 4;
        let header = STANDARD.decode(&data[..header_end]).expect("base64");
        let compressed = STANDARD.decode(&data[header_end..]).expect("base64");
        let (mut bytes, mut start) = (Vec::new(), 0);
        for size in header[24..].chunks_exact(8).map(number) {
            let end = start + size as usize;
            io::copy(&mut flate2::read::ZlibDecoder::new(&compressed[start..end]), &mut bytes).expect("zlib");
            start = end;
        }
        Some(bytes)
    }

    /// The floating-point numbers of an array.
    pub(crate) fn floats(bytes: &[u8]) -> Vec<f64> {
        bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("eight bytes"))).collect()
    }

    /// The integers of an array.
    pub(crate) fn integers(bytes: &[u8]) -> Vec<i64> {
        bytes.chunks_exact(8).map(|b| i64::from_le_bytes(b.try_into().expect("eight bytes"))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::samples::{floats, integers, read_array};
    use super::*;

    #[test]
    fn vectors_alone_have_a_number_of_components() {
        let data = [DataArray::floats("scalar", [1.0]), DataArray::vectors("vector", [[1.0, 2.0]])];
        let cells = Cells::new(VTK_POLYGON, std::iter::empty::<[usize; 3]>());
        let mut file = Vec::new();
        write_grid(&mut file, &[[0.0, 0.0]], &cells, &[(Location::Points, &data)]).unwrap();
        let file = String::from_utf8(file).unwrap();
        let line = |name: &str| file.lines().find(|line| line.contains(name)).unwrap();
        assert!(!line(r#"Name="scalar""#).contains("NumberOfComponents"));
        assert!(line(r#"Name="vector""#).contains(r#"NumberOfComponents="3""#));
    }

    #[test]
    fn names_of_all_kinds_are_attributes() {
        let data = [DataArray::flags("a \"<b>\" & c\n", [true])];
        let cells = Cells::new(VTK_POLYGON, std::iter::empty::<[usize; 3]>());
        let mut file = Vec::new();
        write_grid(&mut file, &[[0.0, 0.0]], &cells, &[(Location::Points, &data)]).unwrap();
        let file = String::from_utf8(file).unwrap();
        assert!(file.contains(r#"Name="a &quot;&lt;b&gt;&quot; &amp; c""#), "{file}");
    }

    #[test]
    fn arrays_of_no_one_and_several_blocks_are_read_back() {
        let a_block = BLOCK / 8;
        for count in [0, 1, a_block - 1, a_block, a_block + 1, 3 * a_block] {
            let values: Vec<f64> = (0..count).map(|k| (k as f64).sqrt()).collect();
            let data = [DataArray::floats("values", values.iter().copied())];
            let cells = Cells::new(VTK_POLYGON, (0..count).map(|k| [k, k + 1, k + 2, k + 3]));
            let mut file = Vec::new();
            write_grid(&mut file, &vec![[1.0, -2.0]; count], &cells, &[(Location::Cells, &data)]).unwrap();
            let file = String::from_utf8(file).unwrap();
            assert!(file.contains(&format!(r#"NumberOfPoints="{count}" NumberOfCells="{count}""#)));
            assert_eq!(floats(&read_array(&file, "values").unwrap()), values);
            let ends: Vec<i64> = (1..=count as i64).map(|k| 4 * k).collect();
            assert_eq!(integers(&read_array(&file, "offsets").unwrap()), ends);
            assert_eq!(read_array(&file, "types").unwrap(), vec![VTK_POLYGON; count]);
            assert_eq!(read_array(&file, "another"), None);
        }
    }

    #[test]
    fn lines_are_read_back_with_their_points_and_numbers() {
        let (loop_, line) = ([[0.0, 1.0], [2.0, 3.0], [0.0, 1.0]], [[4.0, 5.0], [6.0, 7.0]]);
        for (lines, ends) in [(vec![&loop_[..], &line[..]], vec![3, 5]), (Vec::new(), Vec::new())] {
            let mut file = Vec::new();
            let numbers = DataArray::integers("gap", (1..).take(lines.len()));
            write_lines(&mut file, &lines, &[numbers]).unwrap();
            let file = String::from_utf8(file).unwrap();
            assert!(file.contains(r#"type="PolyData""#));
            assert!(file.contains(&format!(r#"NumberOfLines="{}""#, lines.len())), "{file}");
            let expected: Vec<f64> = lines.concat().iter().flat_map(|&[x, y]| [x, y, 0.0]).collect();
            assert_eq!(floats(&read_array(&file, "Points").unwrap()), expected);
            assert_eq!(integers(&read_array(&file, "offsets").unwrap()), ends);
            assert_eq!(read_array(&file, "gap").unwrap().len(), 8 * lines.len());
        }
    }
}
