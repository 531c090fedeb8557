//! What is done with hostile bytes, one function for each kind of input. The fuzzers (`fuzz/`) and the regression test
//! share them: they run the program's own readers, as far as a file of that kind can reach, and demand that a refusal is
//! a message of one line.

use std::fmt::Display;
use std::io::{Cursor, Write};
use std::path::Path;

use arbitrary::{Arbitrary, Result as Drawn, Unstructured};
use membrane_contact::cli::CaseFile;
use membrane_contact::discretization::{PairDiscretization, StackDiscretization};
use membrane_contact::mesh::{Bisection, Mesh, Pattern, polygon, rectangle};
use membrane_contact::output::read_checkpoint;
use membrane_contact::problem::{ContactProblem, Expression, Field, Membrane};
use membrane_contact::qp::read_answer;
use membrane_contact::solver::{Auto, SolverOptions};
use membrane_contact::study::comparison::{Row, curves, markdown, slope};
use membrane_contact::study::{AdaptiveLevel, AdaptiveStudy, LevelErrors, Tolerance};
use serde::de::DeserializeOwned;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// A message of more characters is no message. (The list of known solvers or cases is in some.)
const LONGEST_MESSAGE: usize = 400;

/// Triangles of the largest mesh on which a problem is posed: the readers are what is tested.
const FEW: usize = 200;

/// A kind of input.
pub struct Target {
    /// Its name: that of the fuzzer and of the folder of its corpus.
    pub name: &'static str,
    /// Reads an input.
    pub run: fn(&[u8]),
    /// Bytes that it may take whatever the input.
    pub base: usize,
    /// Bytes that it may take for each byte of the input.
    pub factor: usize,
}

/// Bytes for what does not grow with the input, such as the buffers of decompression.
const BASE: usize = 1 << 20;

/// The like for arrays: `npyz` takes two hundred bytes for each of a header, of which there are at most 10,000.
const BASE_OF_ARRAYS: usize = 4 << 20;

/// The like for a mesh, whose vertices the generator limits.
const BASE_OF_MESHES: usize = 64 << 20;

/// Every kind. The factors are about one and a half times the largest that were measured, on inputs made for it: open
/// parentheses, each an operator that waits (106); tables of one key, each a node of a tree (327); physical groups of six bytes
/// each, called by their numbers (10), and quadrangles of 18, each two triangles (12); the arrays of a checkpoint, read into vectors that grow twofold (4); empty cells (48).
pub const TARGETS: [Target; 7] = [
    Target { name: "expression", run: expression, base: BASE, factor: 160 },
    Target { name: "case_file", run: case_file, base: BASE, factor: 512 },
    Target { name: "gmsh", run: gmsh, base: BASE, factor: 16 },
    Target { name: "checkpoint", run: checkpoint, base: BASE_OF_ARRAYS, factor: 6 },
    Target { name: "answer", run: answer, base: BASE_OF_ARRAYS, factor: 6 },
    Target { name: "rows", run: rows, base: BASE, factor: 72 },
    Target { name: "polygons", run: polygons, base: BASE_OF_MESHES, factor: 0 },
];

/// The kind called `name`.
pub fn target(name: &str) -> &'static Target {
    TARGETS.iter().find(|target| target.name == name).expect("every fuzzer is in the list")
}

/// Demands that a refusal can stand in a terminal.
fn refused(error: impl Display) {
    let message = error.to_string();
    assert!(!message.contains(char::is_control), "more than one line: {message:?}");
    assert!(message.chars().count() <= LONGEST_MESSAGE, "a long message: {message:?}");
}

/// A formula, evaluated as well.
fn expression(bytes: &[u8]) {
    /// More than one lane of [`Expression::eval_many`].
    const POINTS: usize = 130;
    let Ok(text) = str::from_utf8(bytes) else { return };
    let formula = match Expression::parse(text) {
        Ok(formula) => formula,
        Err(error) => return refused(error),
    };
    let x: [f64; POINTS] = std::array::from_fn(|k| 0.25 * k as f64 - 3.0);
    let y: [f64; POINTS] = std::array::from_fn(|k| [0.0, -0.0, 1e-300, 1e300, f64::INFINITY, 0.7][k % 6]);
    let mut values = [0.0; POINTS];
    formula.eval_many(&x, &y, &mut values);
    for k in [0, 1, 5, POINTS - 1] {
        let value = formula.eval(x[k], y[k]);
        assert!(value.to_bits() == values[k].to_bits() || value.is_nan() && values[k].is_nan());
    }
}

/// A case file.
fn case_file(bytes: &[u8]) {
    let Ok(text) = str::from_utf8(bytes) else { return };
    if let Err(error) = CaseFile::parse("case.toml", text, Path::new("case.toml")) {
        refused(error);
    }
}

/// A Gmsh file in any encoding, through to the discrete problem on the checked mesh.
fn gmsh(bytes: &[u8]) {
    match Mesh::from_gmsh(bytes) {
        Ok(mesh) => {
            loaded_by_views(&mesh);
            posed_on(mesh);
        }
        Err(error) => refused(error),
    }
}

/// A membrane under the first data views of the mesh, one after the other.
fn loaded_by_views(mesh: &Mesh) {
    if mesh.triangles().len() > FEW {
        return;
    }
    for name in mesh.views().names().take(3) {
        let sheet = Membrane::new(1.0).load(Field::view(name)).foundation(1.0);
        let problem = ContactProblem::stack().membrane(sheet).build().expect("the data are in range");
        if let Err(error) = StackDiscretization::new(&problem, mesh.clone()) {
            refused(error);
        }
    }
}

/// A mesh that has passed all checks: it has an area and angles, can be bisected or says why not, and so for the problem.
fn posed_on(mesh: Mesh) {
    let quality = mesh.quality();
    assert!(mesh.area() > 0.0 && quality.min_angle > 0.0 && quality.h_max >= quality.h_min);
    if mesh.triangles().len() > FEW {
        return;
    }
    if let Err(error) = PairDiscretization::new(&problem(), mesh.clone()) {
        refused(error);
    }
    if let Err(error) = Bisection::new(mesh).refine(&[0]) {
        refused(error);
    }
}

fn problem() -> ContactProblem {
    let problem = ContactProblem::builder().tension(1.0, 3.0).load(-15.0, 10.0).height(0.1);
    problem.build().expect("the data are in range")
}

/// A checkpoint, through to the study that goes on from it.
fn checkpoint(bytes: &[u8]) {
    let archive =
        archive(bytes, &["marked_counts", "marked", "u1", "u2", "lambda", "tolerance", "statistics"]);
    let checkpoint = match read_checkpoint(Cursor::new(archive)) {
        Ok(checkpoint) => checkpoint,
        Err(error) => return refused(error),
    };
    match small_study().resume(checkpoint) {
        Ok(_) => {}
        Err(error) => refused(error),
    }
}

/// A study of few triangles, before its first level.
fn small_study() -> AdaptiveStudy {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [2, 2], Pattern::Crossed).expect("a square");
    let options = SolverOptions::default();
    AdaptiveStudy::new(problem(), None, None, mesh, Box::new(Auto), options, Tolerance::Fixed(1e-8))
}

/// An answer to a program of four variables and two constraints.
fn answer(bytes: &[u8]) {
    if let Err(error) = read_answer(Cursor::new(archive(bytes, &["x", "y"])), 4, 2) {
        refused(error);
    }
}

/// A zip archive as it is; of bytes that are none, one of the arrays called `names`: each begins with the signature of
/// numpy's arrays. So a fuzzer changes arrays without a care for check sums.
fn archive(bytes: &[u8], names: &[&str]) -> Vec<u8> {
    const ARRAY: &[u8] = b"\x93NUMPY";
    if bytes.starts_with(b"PK") {
        return bytes.to_vec();
    }
    let starts = (0..bytes.len()).filter(|&at| bytes[at..].starts_with(ARRAY));
    let ends: Vec<usize> = starts.chain([bytes.len()]).collect();
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, ends) in names.iter().zip(ends.windows(2)) {
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
        zip.start_file(format!("{name}.npy"), options).expect("the name is new");
        zip.write_all(&bytes[ends[0]..ends[1]]).expect("memory takes everything");
    }
    zip.finish().expect("memory takes everything").into_inner()
}

/// The tables from which a study goes on, or that are merged.
fn rows(bytes: &[u8]) {
    read_rows::<AdaptiveLevel>(bytes);
    read_rows::<LevelErrors>(bytes);
    let rows: Vec<Row> = read_rows(bytes);
    for curve in curves(&rows) {
        slope(&rows, curve);
    }
    assert!(markdown(&rows).lines().count() >= 2, "a table has a head");
}

/// So many rows the program merges at most.
const MOST_ROWS: usize = 5000;

fn read_rows<T: DeserializeOwned>(bytes: &[u8]) -> Vec<T> {
    csv::Reader::from_reader(bytes).deserialize().map_while(Result::ok).take(MOST_ROWS).collect()
}

/// A polygon with holes, meshed.
fn polygons(bytes: &[u8]) {
    let Ok(Polygon { vertices, holes, size, min_angle }) = Polygon::arbitrary(&mut Unstructured::new(bytes))
    else {
        return;
    };
    match polygon(&vertices, &holes, size, min_angle) {
        Ok(mesh) => posed_on(mesh),
        Err(error) => refused(error),
    }
}

/// What a mesh is asked for, with few vertices.
struct Polygon {
    vertices: Vec<[f64; 2]>,
    holes: Vec<Vec<[f64; 2]>>,
    size: f64,
    min_angle: f64,
}

impl<'a> Arbitrary<'a> for Polygon {
    fn arbitrary(u: &mut Unstructured<'a>) -> Drawn<Self> {
        // Coordinates are those of a coarse grid, on which much coincides, or any.
        let on_grid = u.arbitrary()?;
        let scale = if on_grid { 2f64.powi(i32::from(u.int_in_range(-60..=60i8)?)) } else { 1.0 };
        let coordinate = |u: &mut Unstructured<'a>| -> Drawn<f64> {
            if on_grid { Ok(scale * f64::from(i8::arbitrary(u)?)) } else { f64::arbitrary(u) }
        };
        let ring = |u: &mut Unstructured<'a>, most| -> Drawn<Vec<[f64; 2]>> {
            (0..u.int_in_range(2..=most)?).map(|_| Ok([coordinate(u)?, coordinate(u)?])).collect()
        };
        let vertices: Vec<[f64; 2]> = ring(u, 12)?;
        let holes = (0..u.int_in_range(0..=3)?).map(|_| ring(u, 6)).collect::<Drawn<_>>()?;
        let farthest = vertices.iter().flatten().fold(0.0, |far: f64, x| far.max(x.abs()));
        // At most 4 * 32^2 / 0.43 vertices by the estimate of the generator.
        let size = farthest / f64::from(u.int_in_range(1..=32u8)?);
        Ok(Self { vertices, holes, size, min_angle: f64::from(u.int_in_range(0..=31u8)?) })
    }
}
