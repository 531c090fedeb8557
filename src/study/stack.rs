//! Errors of a stack on a sequence of refined meshes.

use web_time::Instant;

use super::LevelErrors;
use super::accuracy::{Bounded, Tolerance, solve_bounded};
use super::converge::StudyError;
use super::prolongation::Fields;
use crate::action::ContactSolution;
use crate::discretization::{Discretization, DiscretizationError, StackDiscretization};
use crate::estimate::{DataWarning, RimError, StackNorms};
use crate::mesh::MeshFamily;
use crate::problem::{ContactProblem, ExactStack};
use crate::qp::TimeLimit;
use crate::solver::{ContactSolver, SolverOptions};

/// Solves a stack with a known solution on finer and finer meshes, each solve started from the one before.
pub struct StackStudy {
    exact: ExactStack,
    problem: ContactProblem,
    family: MeshFamily,
    solver: Box<dyn ContactSolver>,
    options: SolverOptions,
    level: usize,
    last: Option<Fields>,
    /// The vertices of the last mesh that was solved on, and the data of which its bound may know too little.
    warnings: Option<(usize, Vec<DataWarning>)>,
}

impl StackStudy {
    /// A study that starts on the current mesh of `family`, which names the [regions](ExactStack::regions) of the case.
    ///
    /// # Errors
    /// When the data of the case make no problem.
    pub fn new(
        exact: ExactStack,
        family: MeshFamily,
        solver: Box<dyn ContactSolver>,
        options: SolverOptions,
    ) -> Result<Self, StudyError> {
        let problem = exact.problem()?;
        Ok(Self { exact, problem, family, solver, options, level: 0, last: None, warnings: None })
    }

    /// Limits the time of each solve from now on, seconds.
    pub fn set_time_limit(&mut self, time_limit: Option<TimeLimit>) {
        self.options.time_limit = time_limit;
    }

    /// Solves on the next mesh and measures the errors.
    ///
    /// # Errors
    /// [`StudyError`].
    pub fn next_level(&mut self) -> Result<LevelErrors, StudyError> {
        let start = Instant::now();
        let level = self.level;
        let prolonged = self.refine()?;
        let d = StackDiscretization::new(&self.problem, self.family.mesh().clone());
        let d = Discretization::Stack(d.map_err(DiscretizationError::from)?);
        let warm_start = prolonged.map(|fields| fields.into_start(&d));
        let options = SolverOptions { warm_start, ..self.options.clone() };
        let tolerance = Tolerance::Fixed(self.options.tolerance);
        let solved = solve_bounded(&self.problem, None, &d, &mut *self.solver, &options, tolerance);
        let Bounded { solution, bound, .. } = solved.map_err(|error| StudyError::at(level, error))?;
        self.last = Some(Fields::from(&solution));
        let vertices = d.mesh().points().len();
        self.warnings = bound.as_ref().ok().map(|bound| (vertices, bound.warnings.clone()));
        let solve_seconds = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let (Discretization::Stack(d), ContactSolution::Stack(solution)) = (&d, &solution) else {
            unreachable!("it was posed as a stack");
        };
        let norms = StackNorms::new(d, solution, &self.exact)?;
        let quality = d.mesh().quality();
        let norm = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>().sqrt();
        let of_gaps = || norms.gaps.iter();
        let rims: Vec<RimError> = of_gaps().filter_map(|gap| gap.rim).collect();
        // A distance that is not there in one gap is not there at all.
        let distances: Option<Vec<f64>> = rims.iter().map(|rim| rim.hausdorff).collect();
        Ok(LevelErrors {
            level,
            vertices: d.mesh().points().len(),
            triangles: d.mesh().triangles().len(),
            h: quality.h_max,
            h_min: quality.h_min,
            h1: norm(&norms.h1),
            l2: norm(&norms.l2),
            energy: norms.energy,
            bound: bound.as_ref().ok().map(|bound| bound.total),
            nodal: norms.nodal_max.iter().copied().fold(0.0, f64::max),
            lambda_l2: norm(&of_gaps().map(|gap| gap.lambda_l2).collect::<Vec<_>>()),
            lambda_dual: None,
            lambda_dual_estimate: None,
            contact_area: of_gaps().map(|gap| gap.contact_area).sum(),
            quadrature: norms.quadrature,
            iterations: solution.statistics().iterations,
            solve_seconds,
            norm_seconds: start.elapsed().as_secs_f64(),
            rim_distance: distances.and_then(|distances| distances.into_iter().reduce(f64::max)),
            jaccard: rims.iter().map(|rim| rim.jaccard).reduce(f64::min),
        })
    }

    /// The data of which the mesh of `level` may know too little for its bound to hold, where that is the last level or one that an
    /// earlier study has measured: then the problem is assembled there, and not solved.
    ///
    /// # Errors
    /// [`StudyError`] when there is no such mesh.
    pub fn into_warnings(mut self, level: &LevelErrors) -> Result<Vec<DataWarning>, StudyError> {
        let Some(bound) = level.bound else { return Ok(Vec::new()) };
        if let Some((_, warnings)) = self.warnings.take_if(|(vertices, _)| *vertices == level.vertices) {
            return Ok(warnings);
        }
        while self.family.mesh().points().len() < level.vertices {
            self.family.refine()?;
        }
        let d = StackDiscretization::new(&self.problem, self.family.mesh().clone());
        Ok(DataWarning::of_stack(&d.map_err(DiscretizationError::from)?, bound))
    }

    /// Goes on to the next mesh without solving: past a level whose errors are known.
    ///
    /// # Errors
    /// When it cannot be refined.
    pub fn skip_level(&mut self) -> Result<(), StudyError> {
        self.refine().map(|_| ())
    }

    /// Goes on to the next mesh, but for the first level, with the last solution, if there is one.
    fn refine(&mut self) -> Result<Option<Fields>, StudyError> {
        self.level += 1;
        if self.level == 1 {
            return Ok(None);
        }
        let parents = self.family.refine()?;
        Ok(self.last.take().map(|last| last.prolonged(&parents)))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::mesh::{MeshSize, Pattern, generate};
    use crate::problem::StackCase;
    use crate::solver::ActiveSet;
    use crate::study::{MEASURES, fitted_rate};

    fn levels(case: StackCase, parameters: &[(&str, f64)], cells: usize, count: usize) -> Vec<LevelErrors> {
        let parameters: BTreeMap<String, f64> = parameters.iter().map(|&(p, v)| (p.into(), v)).collect();
        let exact = case.solution(&parameters).unwrap();
        let domain = exact.domain();
        let mut mesh = generate(&domain, MeshSize::Cells { cells, pattern: Pattern::Right }).unwrap();
        for (name, curve) in exact.regions() {
            mesh = mesh.with_region(name, |[x, y]| curve.signed_distance(x, y) > 0.0).unwrap();
        }
        let family = MeshFamily::of_domain(mesh, &domain);
        let options = SolverOptions { tolerance: 1e-9, ..SolverOptions::default() };
        let mut study = StackStudy::new(exact, family, Box::new(ActiveSet), options).unwrap();
        (0..count).map(|_| study.next_level().unwrap()).collect()
    }

    /// Rates over all levels of `u` in H1 and L2, within what preasymptotic meshes show.
    #[track_caller]
    fn assert_rates(name: &str, levels: &[LevelErrors]) {
        let [h1, l2] = [0, 1].map(|k| fitted_rate(MEASURES[k], levels).unwrap());
        assert!((0.93..1.1).contains(&h1) && (1.7..2.4).contains(&l2), "{name}: {h1:.2} {l2:.2}");
    }

    #[test]
    fn displacements_converge_at_the_orders_of_the_theory() {
        let cases = [
            (StackCase::FloorDisk, 8),
            (StackCase::Ball, 16),
            (StackCase::ThreeStrips, 8),
            (StackCase::ThreeDiscs, 16),
            (StackCase::GradedDisk, 8),
            (StackCase::TwoTensions, 8),
            (StackCase::TensionJump, 8),
            (StackCase::StripOnFloor, 8),
            (StackCase::Foundation, 8),
            (StackCase::Manufactured, 16),
            (StackCase::BiactiveStack, 8),
        ];
        for (case, cells) in cases {
            let levels = levels(case, &[], cells, 3);
            assert_rates(case.name(), &levels);
            let rim = levels.iter().map(|level| level.rim_distance).collect::<Option<Vec<f64>>>();
            assert_eq!(rim.is_some(), case != StackCase::BiactiveStack, "{case}");
        }
    }

    /// Rims that run along mesh lines, as those of concentric discs, are found within the mesh size, but not at a steady rate.
    #[test]
    fn rims_are_found_within_half_the_mesh_size_and_sets_become_the_same() {
        for (case, cells) in [(StackCase::FloorDisk, 8), (StackCase::Ball, 16), (StackCase::GradedDisk, 8)] {
            let levels = levels(case, &[], cells, 3);
            let measured =
                |level: &LevelErrors| [level.rim_distance.unwrap() / level.h, level.jaccard.unwrap()];
            assert!(levels.iter().all(|level| measured(level)[0] < 0.5), "{case}: {levels:?}");
            assert!(measured(&levels[2])[1] > 0.97, "{case}: {levels:?}");
        }
    }

    #[test]
    fn free_ends_are_exact_and_line_actions_do_not_spoil_the_others() {
        let exact = levels(StackCase::FreeEnd, &[], 8, 2);
        assert!(exact.iter().all(|level| level.h1 < 1e-12 && level.nodal < 1e-12), "{exact:?}");
        let lines = levels(StackCase::TensionJump, &[], 8, 3);
        assert!(lines.windows(2).all(|pair| pair[1].lambda_l2 < pair[0].lambda_l2), "{lines:?}");
        assert!(lines.iter().all(|level| level.nodal < 1e-12));
    }

    #[test]
    fn a_level_that_was_skipped_leads_to_the_same_next_one() {
        let exact = StackCase::FloorDisk.solution(&BTreeMap::new()).unwrap();
        let study = || {
            let domain = exact.domain();
            let mesh = generate(&domain, MeshSize::Cells { cells: 4, pattern: Pattern::Right }).unwrap();
            let family = MeshFamily::of_domain(mesh, &domain);
            StackStudy::new(exact.clone(), family, Box::new(ActiveSet), SolverOptions::default()).unwrap()
        };
        let [mut whole, mut resumed] = [study(), study()];
        whole.next_level().unwrap();
        resumed.skip_level().unwrap();
        let [one, other] = [whole.next_level().unwrap(), resumed.next_level().unwrap()];
        assert_eq!((one.vertices, one.h1, one.rim_distance), (other.vertices, other.h1, other.rim_distance));
    }
}
