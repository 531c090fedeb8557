//! What the program makes of a solution: everything is finite, can be written, and read back.

use std::io::Cursor;
use std::io::Write;

use membrane_contact::action::{ContactSolution, certify_pair};
use membrane_contact::discretization::{Discretization, PairDiscretization};
use membrane_contact::fem::element_loads;
use membrane_contact::flux::{FluxDefects, Reconstruction, Reconstructor};
use membrane_contact::mesh::{DualMesh, SubTriangulation};
use membrane_contact::output::{Seconds, Summary, write_dual_vtu, write_flux_vtu, write_vtu};
use membrane_contact::pictures::membranes::{Picture, render};
use membrane_contact::pictures::{Drawing, Format, MeshPicture, render_mesh, render_triangulation};
use membrane_contact::qp::{
    QpPart, QpProblem, contact_qp, read_answer, write_matrix_market, write_npz, write_qps,
};
use membrane_contact::solver::Candidate;
use npyz::WriterBuilder;
use serde_json::Value;

use super::Bounded;
use super::problems::Hostile;

/// What may be absent from the summary of a certified solution, and why: nobody left the choice open, there was nothing to
/// polish, the bound is too large to tell the relative error.
const ABSENT: [&str; 3] = ["choice", "polish", "relative_error_bound"];

/// Identities of the fluxes hold up to rounding, relative; slivers lose some digits.
const IDENTITY: f64 = 1e-6;

/// What is wrong with anything that is made of a solution, but for pictures, which take longer.
pub fn complaints(hostile: &Hostile, d: &PairDiscretization, bounded: &Bounded) -> Vec<String> {
    let mut all = absent_numbers(&summary(hostile.name, d, bounded));
    all.extend(not_finite(bounded));
    all.extend(files(d, bounded).err());
    all.extend(fluxes(hostile, d, bounded).err());
    all.extend(exported(d, bounded).err());
    all
}

/// The summary as JSON, where NaN and infinity are `null`.
pub fn summary(title: &str, d: &PairDiscretization, bounded: &Bounded) -> Value {
    let Bounded { solution, bound, tolerance, .. } = bounded;
    let (d, solution) = (Discretization::Pair(d.clone()), ContactSolution::Pair(solution.clone()));
    let summary = Summary::new(title, &d, *tolerance, Ok(&solution), Seconds::default(), Some(Ok(bound)));
    let mut json = Vec::new();
    summary.write(&mut json).expect("it is written to memory");
    serde_json::from_slice(&json).expect("it is JSON")
}

/// Numbers that should be in a summary and are not.
pub fn absent_numbers(summary: &Value) -> Vec<String> {
    let mut absent = Vec::new();
    let fields = summary.as_object().expect("a summary has fields");
    for (name, value) in fields.iter().filter(|(name, _)| !ABSENT.contains(&name.as_str())) {
        match value {
            Value::Null => absent.push(format!("`{name}` is null")),
            Value::Object(inner) => absent.extend(
                inner
                    .iter()
                    .filter(|(_, value)| value.is_null())
                    .map(|(inner, _)| format!("`{name}.{inner}` is null")),
            ),
            _ => {}
        }
    }
    absent
}

fn not_finite(Bounded { solution, bound, .. }: &Bounded) -> Vec<String> {
    let [u1, u2] = solution.displacement();
    let gap = solution.gap();
    let roots: Vec<f64> = bound.indicators.iter().map(|square| square.sqrt()).collect();
    let arrays: [(&str, &[f64]); 6] = [
        ("u1", u1),
        ("u2", u2),
        ("gap", &gap),
        ("lambda", solution.lambda()),
        ("error_indicator", &roots),
        ("action of the bound", &bound.actions[0]),
    ];
    let bad = arrays.into_iter().filter(|(_, values)| !values.iter().all(|value| value.is_finite()));
    bad.map(|(name, _)| format!("{name} is not finite somewhere")).collect()
}

fn files(d: &PairDiscretization, bounded: &Bounded) -> Result<(), String> {
    let Bounded { solution, bound, .. } = bounded;
    let failed = |what: &str, error: &dyn std::fmt::Display| format!("{what}: {error}");
    write_vtu(d.mesh(), solution, bound, std::io::sink()).map_err(|error| failed("solution.vtu", &error))?;
    let sub = SubTriangulation::new(d.mesh()).map_err(|error| failed("S_h", &error))?;
    let dual = DualMesh::new(d.mesh(), &sub);
    write_dual_vtu(&dual, solution, std::io::sink()).map_err(|error| failed("dual.vtu", &error))
}

/// The pictures that cannot be drawn.
pub fn pictures(hostile: &Hostile, d: &PairDiscretization, bounded: &Bounded) -> Result<(), String> {
    let solution = &bounded.solution;
    let failed = |what: &str, error: &dyn std::fmt::Display| format!("{what}: {error}");
    let picture = Picture::of(hostile.name, d.mesh(), solution);
    encode("membranes", render(&picture).map_err(|error| error.to_string()))?;
    let sub = SubTriangulation::new(d.mesh()).map_err(|error| failed("S_h", &error))?;
    let dual = DualMesh::new(d.mesh(), &sub);
    let picture =
        MeshPicture { title: hostile.name, mesh: d.mesh(), dual: &dual, contact: Some(solution.contact()) };
    encode("mesh", render_mesh(&picture).map_err(|error| error.to_string()))?;
    encode("mesh of adapt", render_triangulation(&picture).map_err(|error| error.to_string()))
}

/// Whether a picture was drawn, can be encoded, and lines lie at finite places.
fn encode(name: &str, drawing: Result<Drawing, String>) -> Result<(), String> {
    let drawing = drawing.map_err(|error| format!("{name}: {error}"))?;
    let bytes = |format| drawing.encode(format).map_err(|error| format!("{name}: {error}"));
    bytes(Format::Png)?;
    let svg = String::from_utf8(bytes(Format::Svg)?).map_err(|error| format!("{name}: {error}"))?;
    // Letters of an embedded bitmap may spell anything.
    let mut parts = svg.split("base64,");
    let first = parts.next().into_iter();
    let text: String =
        first.chain(parts.filter_map(|part| part.split_once('"').map(|(_, rest)| rest))).collect();
    let strange = ["NaN", "inf "].iter().find(|number| text.contains(*number));
    strange.map_or(Ok(()), |number| Err(format!("{name}: the SVG has {number}")))
}

fn fluxes(hostile: &Hostile, d: &PairDiscretization, bounded: &Bounded) -> Result<(), String> {
    let solution = &bounded.solution;
    let sub = SubTriangulation::new(d.mesh()).map_err(|error| error.to_string())?;
    let load = |i: usize| {
        element_loads(d.mesh(), &hostile.problem.as_pair().expect("a pair").load()[i])
            .map_err(|error| error.to_string())
    };
    let reconstructor = Reconstructor::new(d, &sub, [load(0)?, load(1)?]);
    let fluxes = reconstructor.reconstruct(solution.displacement(), Reconstruction::Full);
    write_flux_vtu(&sub, &fluxes, solution, std::io::sink()).map_err(|error| format!("flux.vtu: {error}"))?;
    let defects = FluxDefects::new(
        &reconstructor,
        solution.displacement(),
        solution.lambda(),
        &fluxes,
        Reconstruction::Full,
    );
    match defects.named().into_iter().find(|(_, defect)| !(*defect <= IDENTITY)) {
        Some((name, defect)) => Err(format!("fluxes: {name} has the defect {defect:e}")),
        None => Ok(()),
    }
}

/// The exported program holds finite numbers only, the same in every format; the solution, read back as an answer to it,
/// certifies.
fn exported(d: &PairDiscretization, bounded: &Bounded) -> Result<(), String> {
    let qp = contact_qp(d);
    write_npz(d, &qp, Cursor::new(Vec::new())).map_err(|error| format!("problem.npz: {error}"))?;
    let mut qps = Vec::new();
    write_qps(&qp, &mut qps).map_err(|error| format!("problem.qps: {error}"))?;
    let qps = String::from_utf8(qps).map_err(|error| error.to_string())?;
    let of_objective = qps.lines().filter_map(|line| line.trim().split_once(" obj "));
    let (constants, columns): (Vec<_>, Vec<_>) = of_objective.partition(|(name, _)| *name == "rhs");
    if constants.first().map_or(0.0, |(_, minus)| -number(minus)) != qp.constant() {
        return Err("the constant is not read back as it was".into());
    }
    let of_qps: Vec<f64> = columns.into_iter().map(|(_, q)| number(q)).collect();
    let mut mtx = Vec::new();
    write_matrix_market(&qp, QpPart::Q, &mut mtx).map_err(|error| format!("problem_q.mtx: {error}"))?;
    let mtx = String::from_utf8(mtx).map_err(|error| error.to_string())?;
    let of_mtx: Vec<f64> = mtx.lines().skip(2).map(number).collect();
    if of_qps != qp.q() || of_mtx != qp.q() {
        return Err("the linear term is not read back as it was".into());
    }
    answered(d, &qp, bounded)
}

fn number(text: &str) -> f64 {
    text.trim().parse().expect("a number")
}

fn answered(d: &PairDiscretization, qp: &QpProblem, bounded: &Bounded) -> Result<(), String> {
    let solution = &bounded.solution;
    let x: Vec<f64> =
        solution.displacement().iter().flat_map(|u| d.interior().iter().map(|&a| u[a])).collect();
    let y: Vec<f64> = d.interior().iter().map(|&a| solution.lambda()[a] * d.dual_area()[a]).collect();
    let archive = archive(&[("x.npy", &x), ("y.npy", &y)]);
    let answer =
        read_answer(Cursor::new(archive), qp.q().len(), qp.b().len()).map_err(|error| error.to_string())?;
    let candidate = Candidate::from_pair_answer(d, answer, solution.statistics().clone());
    certify_pair(d, candidate, bounded.tolerance)
        .map(|_| ())
        .map_err(|rejected| format!("read back: {rejected}"))
}

fn archive(arrays: &[(&str, &[f64])]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, values) in arrays {
        zip.start_file(*name, zip::write::SimpleFileOptions::default()).expect("memory is writable");
        let options = npyz::WriteOptions::new().default_dtype().shape(&[values.len() as u64]);
        let mut array = options.writer(&mut zip).begin_nd().expect("memory is writable");
        array.extend(values.iter().copied()).expect("memory is writable");
        array.finish().expect("memory is writable");
    }
    zip.flush().expect("memory is writable");
    zip.finish().expect("memory is writable").into_inner()
}

/// The negative test: a bound that is no number is seen.
#[test]
fn a_number_that_is_none_is_seen() {
    let hostile = &super::solvable()[0];
    let d = hostile.discretize();
    let mut bounded = hostile.solve(&d, &mut membrane_contact::solver::ActiveSet).expect("certified");
    assert!(absent_numbers(&summary("", &d, &bounded)).is_empty() && not_finite(&bounded).is_empty());
    bounded.bound.total = f64::NAN;
    bounded.bound.parts.flux = f64::INFINITY;
    bounded.bound.indicators[0] = -1.0;
    assert_eq!(
        absent_numbers(&summary("", &d, &bounded)),
        ["`error_bound` is null", "`error_parts.flux` is null"]
    );
    assert_eq!(not_finite(&bounded), ["error_indicator is not finite somewhere"]);
}
