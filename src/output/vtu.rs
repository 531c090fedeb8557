//! The solution as a VTK unstructured grid.

use std::io::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;

use crate::action::ContactSolution;
use crate::mesh::Mesh;

/// Bytes that are compressed together.
const BLOCK: usize = 1 << 16;

/// VTK's number for a triangle.
const VTK_TRIANGLE: u8 = 5;

/// Writes `solution.vtu`: the mesh, with point data `u1`, `u2`, `gap`, `lambda` (zero on the boundary) and `contact` (0 or
/// 1), vertices in the order of the mesh. Binary, compressed by zlib; ParaView, PyVista and meshio read it.
///
/// # Errors
/// When writing fails.
pub fn write_vtu(mesh: &Mesh, solution: &ContactSolution, mut out: impl Write) -> io::Result<()> {
    let [u1, u2] = solution.displacement();
    let points = mesh.points();
    let triangles = mesh.triangles();
    let out = &mut out;
    writeln!(out, r#"<?xml version="1.0"?>"#)?;
    writeln!(
        out,
        r#"<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor">"#
    )?;
    writeln!(out, "<UnstructuredGrid>")?;
    writeln!(out, r#"<Piece NumberOfPoints="{}" NumberOfCells="{}">"#, points.len(), triangles.len())?;

    writeln!(out, r#"<PointData Scalars="lambda">"#)?;
    for (name, values) in
        [("u1", u1), ("u2", u2), ("gap", &solution.gap()), ("lambda", &solution.lambda().to_vec())]
    {
        array(out, &format!(r#"type="Float64" Name="{name}""#), values.iter().flat_map(|v| v.to_le_bytes()))?;
    }
    array(
        out,
        r#"type="UInt8" Name="contact""#,
        solution.contact().iter().map(|&contact| u8::from(contact)),
    )?;
    writeln!(out, "</PointData>\n<Points>")?;
    let coordinates = points.iter().flat_map(|&[x, y]| [x, y, 0.0]).flat_map(f64::to_le_bytes);
    array(out, r#"type="Float64" Name="Points" NumberOfComponents="3""#, coordinates)?;
    writeln!(out, "</Points>\n<Cells>")?;
    let index = |a: usize| (a as i64).to_le_bytes();
    array(out, r#"type="Int64" Name="connectivity""#, triangles.iter().flatten().flat_map(|&a| index(a)))?;
    array(out, r#"type="Int64" Name="offsets""#, (1..=triangles.len()).flat_map(|t| index(3 * t)))?;
    array(out, r#"type="UInt8" Name="types""#, triangles.iter().map(|_| VTK_TRIANGLE))?;
    writeln!(out, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")?;
    out.flush()
}

/// One data array: a header of the numbers and sizes of the blocks, then the compressed blocks, each part in base64.
fn array(out: &mut impl Write, attributes: &str, bytes: impl Iterator<Item = u8>) -> io::Result<()> {
    let bytes: Vec<u8> = bytes.collect();
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
