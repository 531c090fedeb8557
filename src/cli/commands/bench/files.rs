//! The files of a comparison.

use std::path::Path;

use crate::cli::failure::Failure;
use crate::cli::run::files::{ROWS, ROWS_TABLE, TIMES};
use crate::cli::run::folder::Folder;
use crate::cli::run::input::{self, Input};
use crate::cli::run::memory::Memory;
use crate::cli::run::pictures::Pictures;
use crate::pictures::{Drawing, Times, TimesPicture, render_times};
use crate::study::comparison::{Curve, ORIGIN, Row, curves, markdown};
use crate::text::grouped;

/// The slopes to compare with: work in proportion to the vertices, and that of a sparse factorisation in the plane.
const SLOPES: [f64; 2] = [1.0, 1.5];

/// Rows of a file at most: far more than a picture can tell apart. Each curve is looked for among all of them.
const MAX_ROWS: usize = 5000;

/// Rows of a file in the form of `bench.csv`.
pub(super) fn read_rows(path: &Path, memory: Memory) -> Result<Vec<Row>, Failure> {
    let bad_input = |error: csv::Error| {
        let error = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        let remedy = format!("give a CSV file with the columns of {ROWS}");
        Failure::Input(format!("{}: {error}; {remedy}", path.display()))
    };
    let mut reader = csv::Reader::from_reader(
        input::open(path, Input::Rows, memory).map_err(|error| bad_input(error.into()))?,
    );
    let rows: Vec<Row> =
        reader.deserialize().take(MAX_ROWS + 1).collect::<Result<_, _>>().map_err(bad_input)?;
    if rows.len() > MAX_ROWS {
        let path = path.display();
        return Err(Failure::Input(format!(
            "{path}: more than {} rows: merge those to be compared",
            grouped(MAX_ROWS)
        )));
    }
    Ok(rows)
}

/// The rows as they are.
pub(super) fn write_rows(folder: &Folder, rows: &[Row]) -> Result<(), Failure> {
    folder.write(ROWS, |out| {
        let mut writer = csv::Writer::from_writer(out);
        rows.iter().try_for_each(|row| writer.serialize(row))?;
        writer.flush()
    })
}

/// Table and picture.
pub(super) fn write_results(
    folder: &Folder,
    title: &str,
    rows: &[Row],
    pictures: &Pictures,
) -> Result<(), Failure> {
    folder.write(ROWS_TABLE, |out| out.write_all(markdown(rows).as_bytes()))?;
    // Of other rows, or in formats that nobody wants now.
    TIMES.iter().try_for_each(|file| folder.remove(file))?;
    let (title, rows) = (format!("{title}: time to a certified solution"), rows.to_vec());
    let draw = move || Ok(picture(&title, &rows));
    pictures.write(TIMES, draw, |file, bytes| folder.write(file, |out| out.write_all(bytes)))?;
    Ok(())
}

/// The times of all curves, each in the group of who ran it.
fn picture(title: &str, rows: &[Row]) -> Drawing {
    let curves = curves(rows);
    let names = names(&curves);
    let points: Vec<Vec<[f64; 2]>> = curves
        .iter()
        .map(|&curve| rows.iter().filter(|row| row.curve() == curve).filter_map(Row::point).collect())
        .collect();
    let drawn: Vec<Times> = names
        .iter()
        .zip(&points)
        .zip(&curves)
        .filter(|((_, points), _)| !points.is_empty())
        .map(|((name, points), curve)| Times { name, group: group(curve), points })
        .collect();
    render_times(&TimesPicture { title, curves: &drawn, slopes: &SLOPES })
}

/// Who ran a solver.
fn group<'a>(curve: &Curve<'a>) -> &'a str {
    if curve.origin == ORIGIN { "membranes" } else { curve.origin }
}

/// Names that tell the curves of one group apart: of the solver, and of the problem if there are several.
fn names(curves: &[Curve]) -> Vec<String> {
    let several = curves.iter().any(|curve| curve.problem != curves[0].problem);
    let name = |curve: &Curve| {
        let problem = if several { format!(", {}", curve.problem) } else { String::new() };
        format!("{}{problem}", curve.solver)
    };
    curves.iter().map(name).collect()
}

/// The solver, and who ran it if that was not this program.
pub(super) fn solver_name(curve: &Curve) -> String {
    let Curve { solver, origin, .. } = curve;
    if *origin == ORIGIN || origin.is_empty() { (*solver).into() } else { format!("{solver} ({origin})") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_too_many_rows_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let read = |rows: usize| {
            let mut writer = csv::Writer::from_path(folder.path().join(ROWS)).unwrap();
            (0..rows).for_each(|_| writer.serialize(Row::default()).unwrap());
            drop(writer);
            read_rows(&folder.path().join(ROWS), Memory::new(None))
        };
        assert_eq!(read(MAX_ROWS).map(|rows| rows.len()), Ok(MAX_ROWS));
        let message = read(MAX_ROWS + 1).unwrap_err().to_string();
        assert!(message.ends_with("more than 5,000 rows: merge those to be compared"), "{message}");
    }

    #[test]
    fn names_say_what_tells_curves_apart() {
        let ours = Curve { problem: "square", solver: "clarabel", origin: ORIGIN };
        let theirs = Curve { origin: "qpsolvers", ..ours };
        assert_eq!(names(&[ours, theirs]), ["clarabel", "clarabel"]);
        assert_eq!([ours, theirs].each_ref().map(group), ["membranes", "qpsolvers"]);
        let other = Curve { problem: "plate", ..ours };
        assert_eq!(names(&[ours, other]), ["clarabel, square", "clarabel, plate"]);
    }
}
