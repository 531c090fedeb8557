//! The rows of a comparison, as they stand in `bench.csv`.

use serde::de::{Deserializer, Error};
use serde::{Deserialize, Serialize};

use crate::study::exponent;

/// One solver on one mesh. Rows of other programs come from CSV files with the same columns, where what they do not know
/// is empty.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The name of the problem.
    pub problem: String,
    /// The number of the mesh: cells along a side in the built-in family, else refinements.
    #[serde(deserialize_with = "count")]
    pub n: Option<usize>,
    /// Vertices of the mesh.
    pub vertices: usize,
    /// The solver.
    pub solver: String,
    /// Who ran it: `rust` is this program.
    pub origin: String,
    /// Threads that it may use.
    #[serde(deserialize_with = "count")]
    pub threads: Option<usize>,
    /// What the solver says of its result; `skipped`, or `error: ...`.
    pub status: String,
    /// Whether the residuals, recomputed, are within the tolerance, and the time is within its limit.
    #[serde(deserialize_with = "flag")]
    pub certified: bool,
    /// The largest residual.
    pub residual: Option<f64>,
    /// Iterations.
    #[serde(deserialize_with = "count")]
    pub iterations: Option<usize>,
    /// Seconds before the first iteration.
    pub setup_seconds: Option<f64>,
    /// Seconds of the iterations, and of what makes their result exact.
    pub solve_seconds: Option<f64>,
    /// Seconds for the certificate.
    pub certify_seconds: Option<f64>,
    /// Wall time from the discrete problem to the certified solution.
    pub total_seconds: Option<f64>,
    /// Seconds of one product `y = K x` in the same run.
    pub work_unit_seconds: Option<f64>,
    /// `total_seconds / work_unit_seconds`.
    pub work_units: Option<f64>,
    /// Vertices in contact.
    #[serde(deserialize_with = "count")]
    pub contact_vertices: Option<usize>,
}

impl Row {
    /// Whether both stand for the same measurement: the same solver of the same origin on the same mesh.
    pub fn repeats(&self, other: &Self) -> bool {
        let key = |row: &Self| (row.n, row.vertices);
        key(self) == key(other) && self.curve() == other.curve()
    }

    /// The curve that it is a point of.
    pub fn curve(&self) -> Curve<'_> {
        Curve { problem: &self.problem, solver: &self.solver, origin: &self.origin }
    }

    /// Vertices and total seconds, if they are those of a certified solution.
    pub fn point(&self) -> Option<[f64; 2]> {
        let seconds = self.total_seconds.filter(|&seconds| self.certified && seconds > 0.0);
        Some([self.vertices as f64, seconds?])
    }
}

/// What the rows of one curve share: seconds of a solver on a problem, against vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Curve<'a> {
    /// The problem.
    pub problem: &'a str,
    /// The solver.
    pub solver: &'a str,
    /// Who ran it.
    pub origin: &'a str,
}

/// The curves of these rows, in the order in which they begin.
pub fn curves(rows: &[Row]) -> Vec<Curve<'_>> {
    let mut curves = Vec::new();
    for row in rows {
        if !curves.contains(&row.curve()) {
            curves.push(row.curve());
        }
    }
    curves
}

/// The exponent `p` of `seconds = c vertices^p` by least squares over the certified rows of a curve; `None` with fewer
/// than two meshes.
pub fn slope(rows: &[Row], curve: Curve) -> Option<f64> {
    exponent(rows.iter().filter(|row| row.curve() == curve).filter_map(Row::point))
}

/// A count, also as other programs write it when some cells of its column are empty: `81.0`.
fn count<'de, D: Deserializer<'de>>(cell: D) -> Result<Option<usize>, D::Error> {
    /// Counts up to here are exact as floating point numbers.
    const LARGEST: f64 = 9e15;
    match Option::<f64>::deserialize(cell)? {
        None => Ok(None),
        Some(value) if value.is_nan() => Ok(None),
        Some(value) if value >= 0.0 && value.fract() == 0.0 && value <= LARGEST => Ok(Some(value as usize)),
        Some(value) => Err(D::Error::custom(format!("{value} is no count"))),
    }
}

/// A truth value in the spelling of Rust or Python; what is unknown is false.
fn flag<'de, D: Deserializer<'de>>(cell: D) -> Result<bool, D::Error> {
    match String::deserialize(cell)?.as_str() {
        "true" | "True" => Ok(true),
        "false" | "False" | "" => Ok(false),
        other => Err(D::Error::custom(format!("`{other}` is neither true nor false"))),
    }
}
