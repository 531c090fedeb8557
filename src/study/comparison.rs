//! Solvers side by side on the same discrete problems.
//!
//! What is timed goes from a finished [`PairDiscretization`] to the finished certificate: [`ContactSolver::solve`] and
//! [`certify_pair`]. A result that does not certify is a row that says so, never a time to compare. Seconds depend on the
//! machine; *work units* hardly do: multiples of the time of one product `y = K x` ([`CsrProduct`]), measured in the same
//! run just before and just after.

mod csr_product;
mod markdown;
mod row;
mod square;
#[cfg(test)]
mod tests;

pub use csr_product::CsrProduct;
pub use markdown::markdown;
pub use row::{Curve, Row, curves, slope};
pub use square::{SQUARE, square_mesh, square_problem};

use std::collections::BTreeMap;

use web_time::Instant;

use crate::action::{Residuals, certify_pair};
use crate::discretization::PairDiscretization;
use crate::qp::{Status, TimeLimit};
use crate::solver::{ContactSolver, SolverOptions, Statistics};

/// The `origin` of rows that this crate has measured.
pub const ORIGIN: &str = "rust";

/// The `status` of a solver that was too slow on a coarser mesh.
pub const SKIPPED: &str = "skipped";

/// The `status` of a solver that needs more memory than there is.
pub const MEMORY: &str = "memory_limit";

/// How often a solve is repeated when nothing else is said.
const REPEAT: usize = 3;

/// Seconds from which on a solve is not repeated: it is long against what else the machine does.
const LONG: f64 = 5.0;

/// Solvers that run on one mesh after the other.
pub struct Comparison {
    contestants: Vec<Contestant>,
    options: SolverOptions,
    repeat: usize,
}

/// A solver and where it was too slow.
struct Contestant {
    name: String,
    solver: Box<dyn ContactSolver>,
    /// For a problem, the number of vertices at which the time limit was exceeded.
    exceeded: BTreeMap<String, usize>,
}

/// Where a row is measured.
#[derive(Debug, Clone, Copy)]
pub struct Place<'a> {
    /// The name of the problem.
    pub problem: &'a str,
    /// The number of the mesh: cells along a side, or refinements.
    pub n: usize,
    /// The problem on the mesh.
    pub discretization: &'a PairDiscretization,
}

impl Comparison {
    /// A comparison of solvers, each with the name that it has in the rows. All get the same options. A solver that
    /// exceeds their time limit, the certificate included, has a row that is not certified, and is not tried on larger
    /// meshes of that problem.
    pub fn new(solvers: Vec<(String, Box<dyn ContactSolver>)>, options: SolverOptions) -> Self {
        let contestant = |(name, solver)| Contestant { name, solver, exceeded: BTreeMap::new() };
        Self { contestants: solvers.into_iter().map(contestant).collect(), options, repeat: REPEAT }
    }

    /// The same with `repeat` runs of each solve (at least one) that takes less than 5 seconds, in place of 3: the fastest
    /// counts. Longer ones run once.
    pub fn repeated(self, repeat: usize) -> Self {
        Self { repeat: repeat.max(1), ..self }
    }

    /// The names of the solvers.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.contestants.iter().map(|contestant| contestant.name.as_str())
    }

    /// The row of a solver that is not run, with the reason as its status.
    ///
    /// # Panics
    /// When there is no solver `index`.
    pub fn left_out(&self, index: usize, place: &Place, status: &str) -> Row {
        Row { status: status.into(), ..blank(&self.contestants[index].name, place) }
    }

    /// Runs all solvers on one mesh.
    pub fn rows(&mut self, place: &Place) -> Vec<Row> {
        (0..self.contestants.len()).map(|index| self.row(index, place)).collect()
    }

    /// Runs one solver on one mesh: the fastest of its runs, or the first that does not certify.
    ///
    /// # Panics
    /// When there is no solver `index`.
    pub fn row(&mut self, index: usize, place: &Place) -> Row {
        let contestant = &mut self.contestants[index];
        let d = place.discretization;
        let blank = blank(&contestant.name, place);
        let exceeded = contestant.exceeded.get(place.problem);
        if exceeded.is_some_and(|&vertices| blank.vertices > vertices) {
            return Row { status: SKIPPED.into(), ..blank };
        }
        let product = CsrProduct::new(d.stiffness());
        let before = product.seconds();
        let mut fastest = contestant.fastest(d, &self.options, self.repeat, &blank);
        let work_unit = before.min(product.seconds());
        if fastest.exceeds(&self.options) {
            contestant.exceeded.insert(place.problem.into(), fastest.vertices);
            // Also when what it stopped at could be repaired afterwards.
            fastest = Row {
                status: Status::TimeLimit.as_str().into(),
                certified: false,
                contact_vertices: None,
                ..fastest
            };
        }
        Row {
            work_unit_seconds: Some(work_unit),
            work_units: fastest.total_seconds.map(|total| total / work_unit),
            ..fastest
        }
    }
}

impl Contestant {
    fn fastest(
        &mut self,
        d: &PairDiscretization,
        options: &SolverOptions,
        repeat: usize,
        blank: &Row,
    ) -> Row {
        let seconds = |row: &Row| row.total_seconds.unwrap_or(f64::INFINITY);
        let mut fastest = attempt(self.solver.as_mut(), d, options, blank);
        if seconds(&fastest) < LONG {
            for _ in 1..repeat {
                if !fastest.certified {
                    break;
                }
                let next = attempt(self.solver.as_mut(), d, options, blank);
                if !next.certified || seconds(&next) < seconds(&fastest) {
                    fastest = next;
                }
            }
        }
        fastest
    }
}

impl Row {
    /// Whether it took longer than was allowed.
    fn exceeds(&self, options: &SolverOptions) -> bool {
        let too_long = |limit: TimeLimit| self.total_seconds.is_some_and(|total| total > limit.seconds());
        self.status == Status::TimeLimit.as_str() || options.time_limit.is_some_and(too_long)
    }
}

/// What is known before anything is measured.
fn blank(name: &str, place: &Place) -> Row {
    Row {
        problem: place.problem.into(),
        n: Some(place.n),
        vertices: place.discretization.mesh().points().len(),
        solver: name.into(),
        origin: ORIGIN.into(),
        threads: Some(crate::parallel::current_num_threads()),
        ..Row::default()
    }
}

/// One run, timed and judged.
fn attempt(
    solver: &mut dyn ContactSolver,
    d: &PairDiscretization,
    options: &SolverOptions,
    blank: &Row,
) -> Row {
    let start = Instant::now();
    let candidate = match solver.solve_pair(d, options) {
        Ok(candidate) => candidate,
        Err(error) => return Row { status: format!("error: {error}"), ..blank.clone() },
    };
    let solved = start.elapsed().as_secs_f64();
    let result = certify_pair(d, candidate, options.tolerance);
    let total = start.elapsed().as_secs_f64();
    let (statistics, residuals, contact): (&Statistics, Option<&Residuals>, _) = match &result {
        Ok(solution) => {
            let contact = solution.contact().iter().filter(|&&contact| contact).count();
            (solution.statistics(), Some(solution.residuals()), Some(contact))
        }
        Err(rejected) => (&rejected.statistics, rejected.residuals.as_ref(), None),
    };
    Row {
        status: statistics.status.as_str().into(),
        certified: result.is_ok(),
        residual: residuals.map(largest),
        iterations: Some(statistics.iterations),
        setup_seconds: Some(statistics.setup_seconds),
        solve_seconds: Some(statistics.solve_seconds),
        certify_seconds: Some(total - solved),
        total_seconds: Some(total),
        contact_vertices: contact,
        ..blank.clone()
    }
}

/// The largest residual as it is, the rounding that the certificate allows included.
fn largest(residuals: &Residuals) -> f64 {
    residuals.named().into_iter().map(|(_, residual)| residual.value).fold(0.0, f64::max)
}
