//! What an adaptive run goes on from, as a numpy archive.

use std::io::{self, Read, Seek, Write};

use zip::ZipArchive;

use crate::formats::npz::{NpzWriter, read_vector};
use crate::qp::Status;
use crate::solver::Statistics;
use crate::study::Checkpoint;

/// The action in the only gap.
const LAMBDA: &str = "lambda";

/// The solver of which nothing is known.
const UNKNOWN: &str = "unknown";

/// What is known of a solution when nothing is.
fn unknown() -> Statistics {
    Statistics::of(UNKNOWN, Status::Unknown)
}

/// Writes a checkpoint. Arrays: `marked`, the marked triangles of all refinements one after the other, `marked_counts`, their
/// numbers; `u1`, `u2`, ..., the displacements from the top, and `lambda`, or `lambda_1`, `lambda_2`, ... in several gaps, the actions, over the
/// vertices of the last mesh; `tolerance`; `statistics`, the bytes of a JSON object.
///
/// # Errors
/// When writing fails.
pub fn write_checkpoint(checkpoint: &Checkpoint, out: impl Write + Seek) -> io::Result<()> {
    let Checkpoint { marked, displacement, actions, tolerance, statistics } = checkpoint;
    let counts: Vec<usize> = marked.iter().map(Vec::len).collect();
    let marked = marked.concat();
    let mut archive = NpzWriter::stored(out);
    archive.integers("marked_counts", &counts, &[counts.len()])?;
    archive.integers("marked", &marked, &[marked.len()])?;
    for (number, values) in (1..).zip(displacement) {
        archive.floats(&format!("u{number}"), values, &[values.len()])?;
    }
    for (number, values) in (1..).zip(actions) {
        let name = if actions.len() == 1 { LAMBDA.into() } else { format!("{LAMBDA}_{number}") };
        archive.floats(&name, values, &[values.len()])?;
    }
    archive.floats("tolerance", &[*tolerance], &[1])?;
    archive.bytes("statistics", &serde_json::to_vec(statistics)?)?;
    archive.finish()
}

/// Reads a checkpoint, into memory of a few times its length. Whether it belongs to a study is for
/// [`AdaptiveStudy::resume`](crate::study::AdaptiveStudy::resume) to say.
///
/// # Errors
/// When it is no such archive, or an array is missing or broken.
pub fn read_checkpoint(input: impl Read + Seek) -> io::Result<Checkpoint> {
    let mut archive = ZipArchive::new(input).map_err(io::Error::other)?;
    let mut indices = |name: &str| -> io::Result<Vec<usize>> {
        let numbers: Vec<i64> = read_vector(&mut archive, name)?;
        numbers.into_iter().map(|number| usize::try_from(number).map_err(io::Error::other)).collect()
    };
    let (counts, marked) = (indices("marked_counts")?, indices("marked")?);
    let mut rest = marked.as_slice();
    let mut split = |&count: &usize| {
        let (first, others) = rest.split_at_checked(count)?;
        rest = others;
        Some(first.to_vec())
    };
    let marked: Option<Vec<Vec<usize>>> = counts.iter().map(&mut split).collect();
    let marked = marked.ok_or_else(|| io::Error::other("fewer marked triangles than counted"))?;
    let mut fields = |kind: &str| -> io::Result<Vec<Vec<f64>>> {
        let names = (1..).map(|number| format!("{kind}{number}"));
        let there = names.take_while(|name| archive.index_for_name(&format!("{name}.npy")).is_some());
        there.collect::<Vec<_>>().iter().map(|name| read_vector(&mut archive, name)).collect()
    };
    let displacement = fields("u")?;
    let mut actions = fields(&format!("{LAMBDA}_"))?;
    if actions.is_empty() && archive.index_for_name(&format!("{LAMBDA}.npy")).is_some() {
        actions.push(read_vector(&mut archive, LAMBDA)?);
    }
    let tolerance: Vec<f64> = read_vector(&mut archive, "tolerance")?;
    let &[tolerance] = tolerance.as_slice() else {
        return Err(io::Error::other("`tolerance` is not one number"));
    };
    // Infinite residuals are no JSON: then it is not known how the solution was found.
    let statistics = read_vector::<u8>(&mut archive, "statistics");
    let statistics = statistics.ok().and_then(|text| serde_json::from_slice(&text).ok());
    let statistics = statistics.unwrap_or_else(unknown);
    Ok(Checkpoint { marked, displacement, actions, tolerance, statistics })
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn checkpoint() -> Checkpoint {
        Checkpoint {
            marked: vec![vec![3, 1], vec![], vec![7]],
            displacement: vec![vec![0.1, -2.0], vec![f64::MIN_POSITIVE, 1.0 / 3.0]],
            actions: vec![vec![0.0, 1e300]],
            tolerance: 1e-8,
            statistics: Statistics {
                iterations: 7,
                choice: Some("few".into()),
                ..Statistics::of("multigrid", Status::Solved)
            },
        }
    }

    fn written(checkpoint: &Checkpoint) -> Vec<u8> {
        let mut file = Cursor::new(Vec::new());
        write_checkpoint(checkpoint, &mut file).unwrap();
        file.into_inner()
    }

    #[test]
    fn what_is_read_is_what_was_written_to_the_last_bit() {
        let bytes = written(&checkpoint());
        assert_eq!(read_checkpoint(Cursor::new(&bytes)).unwrap(), checkpoint());
        assert_eq!(written(&checkpoint()), bytes, "the same bytes each time");
        let stack = Checkpoint { actions: vec![vec![1.0, 2.0], vec![0.0, 3.0]], ..checkpoint() };
        assert_eq!(read_checkpoint(Cursor::new(written(&stack))).unwrap(), stack);
        let unloaded = Checkpoint { actions: Vec::new(), ..checkpoint() };
        assert_eq!(read_checkpoint(Cursor::new(written(&unloaded))).unwrap(), unloaded);
        let other = Checkpoint { tolerance: 1e-9, ..checkpoint() };
        assert_ne!(read_checkpoint(Cursor::new(written(&other))).unwrap(), checkpoint());
    }

    /// JSON has no infinity: such statistics are written, but cannot be read.
    #[test]
    fn what_is_not_known_is_not_called_solved() {
        let solved = Statistics::of("multigrid", Status::Solved);
        let statistics = Statistics { energies: vec![f64::INFINITY], ..solved };
        let read = read_checkpoint(Cursor::new(written(&Checkpoint { statistics, ..checkpoint() }))).unwrap();
        assert_eq!((read.statistics.status, read.statistics.solver.as_str()), (Status::Unknown, UNKNOWN));
        assert_eq!(read.displacement, checkpoint().displacement, "the rest is there");
        let known = Statistics::of("multigrid", Status::Inaccurate);
        let read = read_checkpoint(Cursor::new(written(&Checkpoint { statistics: known, ..checkpoint() })));
        assert_eq!(read.unwrap().statistics.status, Status::Inaccurate);
    }

    #[test]
    fn what_is_broken_is_an_error() {
        let bytes = written(&checkpoint());
        for length in 0..bytes.len() {
            assert!(read_checkpoint(Cursor::new(&bytes[..length])).is_err(), "{length} bytes");
        }
        let mut file = Cursor::new(Vec::new());
        let mut archive = NpzWriter::deflated(&mut file);
        archive.integers("marked_counts", &[1], &[1]).unwrap();
        archive.finish().unwrap();
        let error = read_checkpoint(file).unwrap_err();
        assert!(error.to_string().contains("compressed"), "{error}");
        let mut file = Cursor::new(Vec::new());
        let mut archive = NpzWriter::stored(&mut file);
        archive.integers("marked_counts", &[5], &[1]).unwrap();
        archive.integers("marked", &[1, 2], &[2]).unwrap();
        archive.finish().unwrap();
        let error = read_checkpoint(file).unwrap_err();
        assert!(error.to_string().contains("fewer"), "{error}");
    }
}
