//! VTK's XML format for unstructured grids and polylines: binary, compressed by zlib; ParaView, PyVista and meshio read it.

mod array;

use std::io::{self, Write};

pub(crate) use array::DataArray;

/// VTK's numbers for the shapes of cells.
const VTK_TRIANGLE: u8 = 5;
const VTK_POLYGON: u8 = 7;

/// The cells of a grid, all of one shape.
pub(crate) struct Cells<'a> {
    count: usize,
    corners: DataArray<'a>,
    ends: DataArray<'a>,
    shapes: DataArray<'a>,
}

impl<'a> Cells<'a> {
    pub(crate) fn triangles(triangles: &'a [[usize; 3]]) -> Self {
        let (count, corners) = (triangles.len(), triangles.as_flattened());
        Self::new(VTK_TRIANGLE, count, corners.len(), |k| corners[k], |k| 3 * (k + 1))
    }

    /// Polygons, each given by the numbers of its corners.
    pub(crate) fn polygons(polygons: impl Iterator<Item: IntoIterator<Item = usize>>) -> Self {
        let (mut corners, mut ends) = (Vec::new(), Vec::new());
        for polygon in polygons {
            corners.extend(polygon);
            ends.push(corners.len());
        }
        Self::new(VTK_POLYGON, ends.len(), corners.len(), move |k| corners[k], move |k| ends[k])
    }

    fn new(
        shape: u8,
        count: usize,
        corners: usize,
        corner: impl Fn(usize) -> usize + Sync + 'a,
        end: impl Fn(usize) -> usize + Sync + 'a,
    ) -> Self {
        Self {
            count,
            corners: DataArray::integers("connectivity", corners, corner),
            ends: DataArray::integers("offsets", count, end),
            shapes: DataArray::bytes("types", count, move |_| shape),
        }
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
    for array in [&cells.corners, &cells.ends, &cells.shapes] {
        array.write(out)?;
    }
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
    let ends: Vec<usize> = ends.collect();
    writeln!(out, "<Lines>")?;
    DataArray::integers("connectivity", points.len(), |k| k).write(out)?;
    DataArray::integers("offsets", ends.len(), |k| ends[k]).write(out)?;
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
    arrays.iter().try_for_each(|array| array.write(out))?;
    writeln!(out, "</{section}>")
}

fn write_points(out: &mut impl Write, points: &[[f64; 2]]) -> io::Result<()> {
    writeln!(out, "<Points>")?;
    DataArray::vectors("Points", points.len(), |a| points[a]).write(out)?;
    writeln!(out, "</Points>")
}

/// Reading back, for the tests of all writers.
#[cfg(test)]
pub(crate) mod samples {
    use base64::Engine;
    use base64::engine::general_purpose::STANDARD;

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
    use super::array::BLOCK;
    use super::samples::{floats, integers, read_array};
    use super::*;

    #[test]
    fn vectors_alone_have_a_number_of_components() {
        let data = [DataArray::floats("scalar", 1, |_| 1.0), DataArray::vectors("vector", 1, |_| [1.0, 2.0])];
        let cells = Cells::polygons(std::iter::empty::<[usize; 3]>());
        let mut file = Vec::new();
        write_grid(&mut file, &[[0.0, 0.0]], &cells, &[(Location::Points, &data)]).unwrap();
        let file = String::from_utf8(file).unwrap();
        let line = |name: &str| file.lines().find(|line| line.contains(name)).unwrap();
        assert!(!line(r#"Name="scalar""#).contains("NumberOfComponents"));
        assert!(line(r#"Name="vector""#).contains(r#"NumberOfComponents="3""#));
    }

    #[test]
    fn names_of_all_kinds_are_attributes() {
        let data = [DataArray::flags("a \"<b>\" & c\n", 1, |_| true)];
        let cells = Cells::polygons(std::iter::empty::<[usize; 3]>());
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
            let data = [DataArray::floats("values", count, |k| values[k])];
            let cells = Cells::polygons((0..count).map(|k| [k, k + 1, k + 2, k + 3]));
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
            let numbers = DataArray::integers("gap", lines.len(), |k| k + 1);
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
