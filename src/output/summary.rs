//! `summary.json`: what was solved, how, and how well.

use std::io::{self, Write};

use serde::Serialize;

use crate::action::{ContactSolution, CutOff, GapSolution, PairSolution, Rejected, Residuals, StackSolution};
use crate::discretization::Discretization;
use crate::estimate::{BoundParts, ErrorBound, NoBound};
use crate::formats::gmsh::PhysicalGroup;
use crate::mesh::Mesh;
use crate::solver::Statistics;

/// The contents of `summary.json`, field by field. Other programs read the names.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// The title of the case.
    pub title: String,
    /// The version of this program.
    pub version: &'static str,
    /// The solver.
    pub backend: String,
    /// Why it stopped, in its own view.
    pub status: &'static str,
    /// Whether the residuals are within the tolerance: what counts.
    pub certified: bool,
    /// The tolerance that was asked for, relative.
    pub tolerance: f64,
    /// Vertices of the mesh.
    pub vertices: usize,
    /// Triangles of the mesh.
    pub triangles: usize,
    /// Membranes, where they are another stack than the paper's pair.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub membranes: Option<usize>,
    /// Unknowns of the quadratic program: one for each membrane and vertex where it is not held.
    pub unknowns: usize,
    /// The longest edge.
    pub h: f64,
    /// The smallest angle, degrees.
    pub min_angle: f64,
    /// The largest ratio of the longest edge of a triangle to the diameter of its inscribed circle.
    pub shape_regularity: f64,
    /// Iterations of the solver, on the finest level of those that have several.
    pub iterations: usize,
    /// Iterations on each level, from the coarsest to the finest; empty for a solver that knows no levels.
    pub level_iterations: Vec<usize>,
    /// Why it was chosen; absent when it was named.
    pub choice: Option<String>,
    /// What the polish did; absent when it was not asked for or not possible.
    pub polish: Option<PolishSummary>,
    /// `J(u_h)`; absent when not certified.
    pub energy: Option<f64>,
    /// Interior vertices in contact, with a force or without; absent when not certified.
    pub contact_vertices: Option<usize>,
    /// Those of them that are pressed, by `lambda_a > 0`; absent when not certified.
    pub pressed_vertices: Option<usize>,
    /// The area of the dual cells of the vertices in contact, the paper's; absent when not certified.
    pub contact_area: Option<f64>,
    /// Likewise, with the cells of the boundary around which the membranes touch; absent when not certified.
    pub contact_area_extended: Option<f64>,
    /// `int lambda_h`, the paper's; absent when not certified.
    pub total_force: Option<f64>,
    /// Likewise, with the action continued to these cells of the boundary; absent when not certified.
    pub total_force_extended: Option<f64>,
    /// What happens in each gap of another stack than the paper's pair; absent when not certified.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contacts: Option<Vec<ContactSummary>>,
    /// The forces with which the supports hold each membrane of such a stack, upwards.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reactions: Option<Vec<f64>>,
    /// What is left of the sum of all forces on such a stack, relative to the sum of their sizes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force_imbalance: Option<f64>,
    /// What was cut off to make the solution exactly complementary, relative; absent when not certified.
    pub cut_off: Option<CutOff>,
    /// A bound of the energy error, guaranteed up to the quadrature of the loads; absent when not certified.
    pub error_bound: Option<f64>,
    /// Why there is no bound of a certified solution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub no_error_bound: Option<String>,
    /// The bound relative to the energy norm of the exact solution; absent also when it is too large to know that.
    pub relative_error_bound: Option<f64>,
    /// What the bound consists of; absent when not certified.
    pub error_parts: Option<BoundParts>,
    /// By how much two quadrature rules differ in each load, in the same norm as the bound: zero for constant loads, and where it is
    /// above the bound, that does not hold; absent when not certified.
    pub quadrature_difference: Option<Vec<f64>>,
    /// What makes the bound doubtful, in a sentence each.
    pub warnings: Vec<String>,
    /// The energy norm of the solution; absent when not certified.
    pub energy_norm: Option<f64>,
    /// The relative residuals; absent when there was nothing to measure.
    pub residuals: Option<ResidualSummary>,
    /// The largest of them beyond the rounding of the terms that cancel there: what is compared with the tolerance.
    pub residual_beyond_rounding: Option<f64>,
    /// The physical groups of the mesh file that the run has not used: names, or what they consist of and their numbers.
    pub unused_groups: Vec<String>,
    /// Files that were left out, because the time was over.
    pub left_out: Vec<&'static str>,
    /// Where the time went.
    pub seconds: Seconds,
}

/// What happens in one gap of a stack.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ContactSummary {
    /// The gap `k` lies between layers `k` and `k + 1`, counted from the ceiling, 0.
    pub gap: usize,
    /// Vertices in contact, with a force or without.
    pub contact_vertices: usize,
    /// Those of them that are pressed.
    pub pressed_vertices: usize,
    /// The area of the dual cells of the vertices in contact.
    pub contact_area: f64,
    /// The sum of the nodal forces.
    pub total_force: f64,
}

impl From<&GapSolution> for ContactSummary {
    fn from(gap: &GapSolution) -> Self {
        Self {
            gap: gap.number,
            contact_vertices: gap.contact_vertices(),
            pressed_vertices: gap.pressed_vertices(),
            contact_area: gap.contact_area,
            total_force: gap.total_force,
        }
    }
}

/// See [`PolishReport`](crate::solver::PolishReport).
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(missing_docs, reason = "described at the type that it mirrors")]
pub struct PolishSummary {
    pub kept: bool,
    pub repairs: usize,
    pub settled: bool,
    pub residual_before: f64,
    pub residual_after: f64,
}

/// See [`Residuals`].
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(missing_docs, reason = "described at the type that it mirrors")]
pub struct ResidualSummary {
    pub stationarity: f64,
    pub primal: f64,
    pub dual_sign: f64,
    pub complementarity: f64,
    pub action_mismatch: f64,
    pub dual_mismatch: f64,
    pub variational_inequality: f64,
    pub overlap: f64,
}

/// Seconds of wall time.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Seconds {
    /// Making or reading the mesh.
    pub mesh: f64,
    /// Assembling the discrete problem.
    pub assembly: f64,
    /// Before the first iteration.
    pub setup: f64,
    /// Iterating and polishing.
    pub solve: f64,
    /// Bounding the error.
    pub bound: f64,
    /// Writing the files, but for the summary itself.
    pub output: f64,
}

impl Summary {
    /// The summary of a run, certified or not; with a bound, or the reason why there is none.
    pub fn new(
        title: &str,
        d: &Discretization,
        tolerance: f64,
        result: Result<&ContactSolution, &Rejected>,
        seconds: Seconds,
        bound: Option<Result<&ErrorBound, &NoBound>>,
    ) -> Self {
        let (statistics, residuals) = match result {
            Ok(solution) => (solution.statistics(), Some(solution.residuals())),
            Err(rejected) => (&rejected.statistics, rejected.residuals.as_ref()),
        };
        let blank = Self::of_run(title, d.mesh(), tolerance, statistics, residuals, seconds);
        let blank = Self { unknowns: d.unknowns(), ..blank };
        let summary = match result {
            Err(_) => blank,
            Ok(solution) => Self {
                certified: true,
                energy: Some(solution.energy()),
                cut_off: Some(solution.cut_off()),
                ..match solution {
                    ContactSolution::Pair(solution) => blank.of_pair(solution),
                    ContactSolution::Stack(solution) => blank.of_stack(solution),
                }
            },
        };
        let summary = match d {
            Discretization::Pair(_) => summary,
            Discretization::Stack(d) => Self { membranes: Some(d.membranes()), ..summary },
        };
        match bound {
            None => summary,
            Some(Ok(bound)) => summary.with_bound(bound),
            Some(Err(reason)) => Self { no_error_bound: Some(reason.to_string()), ..summary },
        }
    }

    fn of_pair(self, solution: &PairSolution) -> Self {
        Self {
            contact_vertices: Some(solution.contact().iter().filter(|&&contact| contact).count()),
            pressed_vertices: Some(solution.lambda().iter().filter(|&&lambda| lambda > 0.0).count()),
            contact_area: Some(solution.contact_area()),
            contact_area_extended: Some(solution.contact_area_extended()),
            total_force: Some(solution.total_force()),
            total_force_extended: Some(solution.total_force_extended()),
            ..self
        }
    }

    /// Where a stack has exactly one gap, the names of the pair mean that gap.
    fn of_stack(self, solution: &StackSolution) -> Self {
        let contacts: Vec<ContactSummary> = solution.gaps().iter().map(ContactSummary::from).collect();
        let only = match contacts.as_slice() {
            [only] => Some(only.clone()),
            _ => None,
        };
        Self {
            contact_vertices: only.as_ref().map(|contact| contact.contact_vertices),
            pressed_vertices: only.as_ref().map(|contact| contact.pressed_vertices),
            contact_area: only.as_ref().map(|contact| contact.contact_area),
            total_force: only.as_ref().map(|contact| contact.total_force),
            contacts: Some(contacts),
            reactions: Some(solution.reactions().to_vec()),
            force_imbalance: Some(solution.imbalance()),
            ..self
        }
    }

    fn with_bound(self, bound: &ErrorBound) -> Self {
        Self {
            error_bound: Some(bound.total),
            relative_error_bound: bound.relative(),
            error_parts: Some(bound.parts),
            quadrature_difference: Some(bound.quadrature_difference.clone()),
            warnings: bound.warnings.iter().map(ToString::to_string).collect(),
            energy_norm: Some(bound.energy_norm),
            ..self
        }
    }

    /// What is known of any run.
    fn of_run(
        title: &str,
        mesh: &Mesh,
        tolerance: f64,
        statistics: &Statistics,
        residuals: Option<&Residuals>,
        mut seconds: Seconds,
    ) -> Self {
        seconds.setup = statistics.setup_seconds;
        seconds.solve = statistics.solve_seconds;
        let quality = mesh.quality();
        Self {
            title: title.into(),
            version: env!("CARGO_PKG_VERSION"),
            backend: statistics.solver.clone(),
            status: statistics.status.as_str(),
            certified: false,
            tolerance,
            vertices: mesh.points().len(),
            triangles: mesh.triangles().len(),
            membranes: None,
            unknowns: 0,
            h: quality.h_max,
            min_angle: quality.min_angle,
            shape_regularity: quality.shape_regularity,
            iterations: statistics.iterations,
            level_iterations: statistics.level_iterations.clone(),
            choice: statistics.choice.clone(),
            polish: polish(statistics),
            energy: None,
            contact_vertices: None,
            pressed_vertices: None,
            contact_area: None,
            contact_area_extended: None,
            total_force: None,
            total_force_extended: None,
            contacts: None,
            reactions: None,
            force_imbalance: None,
            cut_off: None,
            error_bound: None,
            no_error_bound: None,
            relative_error_bound: None,
            error_parts: None,
            quadrature_difference: None,
            warnings: Vec::new(),
            energy_norm: None,
            residuals: residuals.map(ResidualSummary::from),
            residual_beyond_rounding: residuals.map(Residuals::beyond_rounding),
            unused_groups: Vec::new(),
            left_out: Vec::new(),
            seconds,
        }
    }

    /// The same with the physical groups that were not used.
    pub fn with_unused_groups(self, groups: &[PhysicalGroup]) -> Self {
        Self { unused_groups: groups.iter().map(PhysicalGroup::to_string).collect(), ..self }
    }

    /// Writes it as JSON.
    ///
    /// # Errors
    /// When writing fails.
    pub fn write(&self, mut out: impl Write) -> io::Result<()> {
        serde_json::to_writer_pretty(&mut out, self)?;
        writeln!(out)
    }
}

fn polish(statistics: &Statistics) -> Option<PolishSummary> {
    statistics.polish.map(|report| PolishSummary {
        kept: report.kept,
        repairs: report.repairs,
        settled: report.settled,
        residual_before: report.residual_before,
        residual_after: report.residual_after,
    })
}

impl From<&Residuals> for ResidualSummary {
    fn from(residuals: &Residuals) -> Self {
        Self {
            stationarity: residuals.stationarity.value,
            primal: residuals.primal.value,
            dual_sign: residuals.dual_sign.value,
            complementarity: residuals.complementarity.value,
            action_mismatch: residuals.action_mismatch.value,
            dual_mismatch: residuals.dual_mismatch.value,
            variational_inequality: residuals.variational_inequality.value,
            overlap: residuals.overlap,
        }
    }
}
