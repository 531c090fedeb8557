//! The files that the program writes.

use crate::pictures::Format;

/// The files of one picture, in the order of [`FORMATS`].
pub(crate) type Picture = [&'static str; 3];

/// The formats of pictures.
pub(crate) const FORMATS: [Format; 3] = [Format::Png, Format::Svg, Format::Pdf];

macro_rules! picture {
    ($stem:literal) => {
        [concat!($stem, ".png"), concat!($stem, ".svg"), concat!($stem, ".pdf")]
    };
}

pub(crate) const SUMMARY: &str = "summary.json";
pub(crate) const SOLUTION: &str = "solution.vtu";
pub(crate) const RIM: &str = "rim.vtp";
pub(crate) const MEMBRANES: Picture = picture!("membranes");
pub(crate) const DUAL: &str = "dual.vtu";
pub(crate) const FLUX: &str = "flux.vtu";
pub(crate) const MESH: Picture = picture!("mesh");

pub(crate) const ERRORS: &str = "summary.csv";
pub(crate) const ERRORS_TABLE: &str = "convergence.md";
pub(crate) const RATES: Picture = picture!("convergence");

pub(crate) const LEVELS: &str = "adapt.csv";
pub(crate) const CHECKPOINT: &str = "checkpoint.npz";
pub(crate) const HISTORY: Picture = picture!("adapt");

pub(crate) const ROWS: &str = "bench.csv";
pub(crate) const ROWS_TABLE: &str = "bench.md";
pub(crate) const TIMES: Picture = picture!("bench");

pub(crate) const QPS: &str = "problem.qps";
pub(crate) const NPZ: &str = "problem.npz";
/// In the order of [`QpPart::ALL`](crate::qp::QpPart::ALL).
pub(crate) const MTX: [&str; 5] =
    ["problem_P.mtx", "problem_A.mtx", "problem_q.mtx", "problem_b.mtx", "problem_c.mtx"];

/// Results that belong together: they come and go together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// A solution, of `solve` or of the last level of `adapt`, or the verdict on an answer.
    Solution,
    /// The levels of `converge`.
    Converge,
    /// The levels of `adapt`.
    Adapt,
    /// The rows of `bench`.
    Bench,
    /// A quadratic program.
    Export,
}

impl Part {
    pub(crate) const ALL: [Self; 5] =
        [Self::Solution, Self::Converge, Self::Adapt, Self::Bench, Self::Export];

    /// Its files, the one that vouches for the others first.
    pub(crate) fn files(self) -> &'static [&'static str] {
        match self {
            Self::Solution => &[
                SUMMARY,
                SOLUTION,
                RIM,
                MEMBRANES[0],
                MEMBRANES[1],
                MEMBRANES[2],
                DUAL,
                FLUX,
                MESH[0],
                MESH[1],
                MESH[2],
            ],
            Self::Converge => &[ERRORS, ERRORS_TABLE, RATES[0], RATES[1], RATES[2]],
            Self::Adapt => &[LEVELS, CHECKPOINT, HISTORY[0], HISTORY[1], HISTORY[2]],
            Self::Bench => &[ROWS, ROWS_TABLE, TIMES[0], TIMES[1], TIMES[2]],
            Self::Export => &[QPS, NPZ, MTX[0], MTX[1], MTX[2], MTX[3], MTX[4]],
        }
    }

    /// Its name in the record of a folder.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Solution => "solution",
            Self::Converge => "converge",
            Self::Adapt => "adapt",
            Self::Bench => "bench",
            Self::Export => "export",
        }
    }
}
