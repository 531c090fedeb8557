use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;
use crate::discretization::StackDiscretization;
use crate::mesh::Mesh;
use crate::problem::ContactProblem;
use crate::solver::{ActiveSet, Candidate, SolverError};

/// Rounding of a handful of operations on logarithms of order one.
const ROUNDING: f64 = 1e-12;

/// A time limit that no solve of these meshes exceeds, seconds.
const AMPLE: f64 = 600.0;

fn timed(solver: &str, vertices: usize, seconds: f64) -> Row {
    let row =
        Row { problem: SQUARE.into(), vertices, solver: solver.into(), certified: true, ..Row::default() };
    Row { total_seconds: Some(seconds), ..row }
}

fn meshes() -> [Mesh; 2] {
    [4, 8].map(|n| square_mesh(n).expect("a valid size"))
}

fn discretizations(problem: &ContactProblem, meshes: &[Mesh]) -> Vec<PairDiscretization> {
    meshes.iter().map(|mesh| PairDiscretization::new(problem, mesh.clone()).expect("valid data")).collect()
}

/// Runs a solver on all meshes of the built-in family.
fn rows(solver: impl ContactSolver + 'static, options: SolverOptions) -> Vec<Row> {
    let (problem, meshes) = (square_problem().expect("valid"), meshes());
    let mut comparison = Comparison::new(vec![("it".into(), Box::new(solver))], options);
    let d = discretizations(&problem, &meshes);
    let place = |k: usize| Place { problem: SQUARE, n: k, discretization: &d[k] };
    (0..d.len()).flat_map(|k| comparison.rows(&place(k))).collect()
}

/// Solves, and then says or does something else.
struct Altered<F>(F);

impl<F: FnMut(Candidate) -> Result<Candidate, SolverError> + Send> ContactSolver for Altered<F> {
    fn name(&self) -> &str {
        "altered"
    }

    fn solve_pair(
        &mut self,
        d: &PairDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError> {
        self.0(ActiveSet.solve_pair(d, options)?)
    }

    fn solve_stack(&mut self, _: &StackDiscretization, _: &SolverOptions) -> Result<Candidate, SolverError> {
        Err(SolverError::NotFactored)
    }
}

#[test]
fn the_slope_is_the_exponent_of_the_certified_rows_of_one_curve() {
    let mut rows: Vec<Row> =
        [100, 400, 1600].map(|vertices| timed("a", vertices, 1e-6 * (vertices as f64).powf(1.5))).into();
    let curve = Curve { problem: SQUARE, solver: "a", origin: "" };
    let near = |rows: &[Row], expected: f64| (slope(rows, curve).unwrap() - expected).abs() < ROUNDING;
    assert!(near(&rows, 1.5));
    rows.push(timed("b", 6400, 1e9));
    rows.push(Row { origin: "elsewhere".into(), ..timed("a", 6400, 1e9) });
    rows.push(Row { problem: "another".into(), ..timed("a", 6400, 1e9) });
    rows.push(Row { certified: false, ..timed("a", 6400, 1e9) });
    rows.push(Row { total_seconds: None, ..timed("a", 6400, 1e9) });
    assert!(near(&rows, 1.5), "none of these belongs to the curve");
    rows.push(timed("a", 6400, 1e9));
    assert!(!near(&rows, 1.5));
    assert_eq!(slope(&rows[..1], curve), None, "one point has no slope");
    assert_eq!(slope(&[timed("a", 100, 1.0), timed("a", 100, 2.0)], curve), None, "nor has one mesh");
}

#[test]
fn a_solved_problem_is_a_certified_row_whose_figures_fit() {
    let rows = rows(
        ActiveSet,
        SolverOptions {
            time_limit: Some(TimeLimit::from_seconds(AMPLE).unwrap()),
            ..SolverOptions::default()
        },
    );
    assert_eq!(rows.len(), 2);
    for (row, vertices) in rows.iter().zip([25, 81]) {
        assert_eq!((row.vertices, row.certified, row.status.as_str()), (vertices, true, "solved"));
        assert_eq!((row.problem.as_str(), row.solver.as_str(), row.origin.as_str()), (SQUARE, "it", "rust"));
        assert!(row.residual.is_some_and(|residual| residual <= SolverOptions::default().tolerance));
        assert!(row.contact_vertices.is_some_and(|contact| contact > 0));
        let [total, unit, units] =
            [row.total_seconds, row.work_unit_seconds, row.work_units].map(Option::unwrap);
        assert!((units * unit - total).abs() <= ROUNDING * total);
        let parts = [row.setup_seconds, row.solve_seconds, row.certify_seconds].map(Option::unwrap);
        assert!(parts.iter().sum::<f64>() <= total * (1.0 + ROUNDING), "{parts:?} of {total}");
    }
}

#[test]
fn a_wrong_candidate_is_not_certified_whatever_it_says() {
    let rows = rows(
        Altered(|mut candidate: Candidate| {
            candidate.multiplier.iter_mut().for_each(|y| *y *= 1.5);
            Ok(candidate)
        }),
        SolverOptions::default(),
    );
    for row in &rows {
        assert_eq!((row.certified, row.status.as_str()), (false, "solved"));
        assert!(row.residual.is_some_and(|residual| residual > SolverOptions::default().tolerance));
        assert_eq!((row.contact_vertices, row.point()), (None, None));
    }
    assert_eq!(slope(&rows, rows[0].curve()), None);
}

#[test]
fn one_wrong_run_of_several_is_the_one_that_counts() {
    let runs = Arc::new(AtomicUsize::new(0));
    let counted = runs.clone();
    let second_is_wrong = Altered(move |mut candidate: Candidate| {
        counted.fetch_add(1, Ordering::Relaxed);
        if counted.load(Ordering::Relaxed) == 2 {
            candidate.displacement[0][12] += 1.0;
        }
        Ok(candidate)
    });
    let rows = rows(second_is_wrong, SolverOptions::default());
    assert!(!rows[0].certified);
    assert!(rows[1].certified);
    assert_eq!(runs.load(Ordering::Relaxed), 2 + REPEAT);
}

#[test]
fn a_solver_that_cannot_run_is_a_row_with_its_message() {
    let rows = rows(Altered(|_| Err(SolverError::NotFactored)), SolverOptions::default());
    for row in rows {
        assert!(!row.certified && row.status.starts_with("error: the stiffness matrix"), "{}", row.status);
        assert_eq!((row.total_seconds, row.work_units), (None, None));
    }
}

#[test]
fn who_exceeds_the_time_limit_is_not_tried_on_larger_meshes_of_that_problem() {
    let runs = Arc::new(AtomicUsize::new(0));
    let counted = runs.clone();
    let slow: Box<dyn ContactSolver> = Box::new(Altered(move |mut candidate: Candidate| {
        counted.fetch_add(1, Ordering::Relaxed);
        candidate.statistics.status = Status::TimeLimit;
        Ok(candidate)
    }));
    let quick: Box<dyn ContactSolver> = Box::new(ActiveSet);
    let options = SolverOptions {
        time_limit: Some(TimeLimit::from_seconds(AMPLE).unwrap()),
        ..SolverOptions::default()
    };
    let mut comparison = Comparison::new(vec![("slow".into(), slow), ("quick".into(), quick)], options);
    let (problem, meshes) = (square_problem().expect("valid"), meshes());
    let d = discretizations(&problem, &meshes);
    let mut on = |problem: &str, k: usize| comparison.rows(&Place { problem, n: k, discretization: &d[k] });
    let status = |rows: Vec<Row>| rows.into_iter().map(|row| row.status).collect::<Vec<_>>();
    let in_time: Vec<bool> = on(SQUARE, 0).iter().map(|row| row.certified).collect();
    assert_eq!(in_time, [false, true], "a solution that comes too late does not count");
    let skipped = on(SQUARE, 1);
    assert!(!skipped[0].certified && skipped[0].total_seconds.is_none());
    assert_eq!(status(skipped), [SKIPPED, "solved"]);
    assert_eq!(status(on("another", 1)), ["time_limit", "solved"]);
    assert_eq!(status(on(SQUARE, 0)), ["time_limit", "solved"], "a mesh that is no larger is tried again");
    assert_eq!(runs.load(Ordering::Relaxed), 3 * REPEAT);
}

#[test]
fn a_total_above_the_limit_exceeds_it_too() {
    let limit = |seconds| Some(TimeLimit::from_seconds(seconds).unwrap());
    let limited = |limit| SolverOptions { time_limit: limit, ..SolverOptions::default() };
    let row = timed("a", 100, 2.0);
    assert!(row.exceeds(&limited(limit(1.0))));
    assert!(!row.exceeds(&limited(limit(3.0))) && !row.exceeds(&limited(None)));
}

#[cfg(feature = "cli")]
#[test]
fn rows_survive_a_csv_file_also_with_empty_cells() {
    let full = Row {
        n: Some(8),
        threads: Some(2),
        status: "error: a, \"b\"".into(),
        residual: Some(1.25e-17),
        iterations: Some(3),
        setup_seconds: Some(0.0),
        solve_seconds: Some(0.1),
        certify_seconds: Some(0.3),
        work_unit_seconds: Some(1e-6),
        work_units: Some(2e5),
        contact_vertices: Some(0),
        origin: ORIGIN.into(),
        ..timed("a", 81, 0.2)
    };
    let rows = [full, Row { certified: false, ..timed("b", 289, 1.5) }];
    let mut writer = csv::Writer::from_writer(Vec::new());
    rows.iter().for_each(|row| writer.serialize(row).unwrap());
    let text = String::from_utf8(writer.into_inner().unwrap()).unwrap();
    let header = "problem,n,vertices,solver,origin,threads,status,certified,residual,iterations,setup_seconds,\
                  solve_seconds,certify_seconds,total_seconds,work_unit_seconds,work_units,contact_vertices";
    assert_eq!(text.lines().next(), Some(header));
    let read =
        |text: &str| csv::Reader::from_reader(text.as_bytes()).deserialize().collect::<Result<Vec<Row>, _>>();
    assert_eq!(read(&text).unwrap(), rows);

    let as_python = |line: &str| read(&format!("{header}\n{line}\n")).map(|rows| rows[0].clone());
    let row = as_python("square,8.0,81,qp,qpsolvers,,solved,True,,17.0,,,,0.5,,,").unwrap();
    assert_eq!((row.n, row.iterations, row.threads, row.certified), (Some(8), Some(17), None, true));
    assert!(!as_python("square,,81,qp,qpsolvers,,,,,,,,,,,,").unwrap().certified);
    for wrong in ["square,,81,qp,qpsolvers,,,maybe,,,,,,,,,", "square,8.5,81,qp,qpsolvers,,,True,,,,,,,,,"] {
        assert!(as_python(wrong).is_err(), "{wrong}");
    }
}
