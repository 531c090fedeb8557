//! Every check of the certificate sees what it checks broken.

use super::{Action, Reason, Residual, Residuals, certify_pair};
use crate::discretization::{Displacement, PairDiscretization};
use crate::mesh::samples::irregular;
use crate::mesh::{Mesh, Pattern, VertexKind, rectangle};
use crate::numeric::largest;
use crate::problem::{ContactProblem, Function};
use crate::qp::{Clarabel, QpBackend, QpOptions, contact_qp};
use crate::solver::{ActiveSet, Candidate, ContactSolver, QpSolver, SolverOptions};

/// What is asked of the backend and of the certificate.
const TOLERANCE: f64 = 1e-8;

/// A fault shows as a residual of about its own size; this is far above the tolerance and below every fault made here.
const SEEN: f64 = 1e-4;

/// Contact on a part of the square, a varying height, different tensions.
fn problem(push: f64) -> ContactProblem {
    ContactProblem::builder()
        .tension(1.0, 3.0)
        .load(Function::from_fn(move |x, _| -15.0 * x + push), 5.0 - push)
        .height(Function::from_fn(|x, _| 0.2 + 0.05 * x))
        .build()
        .expect("valid data")
}

fn mesh() -> Mesh {
    rectangle([0.0, 0.0], [1.0, 1.0], [8, 8], Pattern::Right).unwrap()
}

fn solve(d: &PairDiscretization, polish: bool, max_iterations: Option<usize>) -> Candidate {
    let options = SolverOptions { tolerance: TOLERANCE, polish, max_iterations, ..SolverOptions::default() };
    QpSolver::new(Clarabel).solve_pair(d, &options).expect("Clarabel runs")
}

/// Asserts that the candidate is rejected, and that the checks named are among those that see why.
fn assert_seen(d: &PairDiscretization, candidate: Candidate, checks: &[fn(&Residuals) -> Residual]) {
    let rejected = certify_pair(d, candidate, TOLERANCE).expect_err("a broken candidate is rejected");
    let residuals = rejected.residuals.expect("there is something to measure");
    for (k, check) in checks.iter().enumerate() {
        let residual = check(&residuals);
        assert!(residual.beyond_rounding > SEEN, "check {k} sees {residual:?} of {residuals:?}");
    }
}

#[test]
fn a_sound_candidate_is_certified_with_part_in_contact() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    let solution = certify_pair(&d, solve(&d, true, None), TOLERANCE).unwrap();
    let touching = solution.contact().iter().filter(|&&contact| contact).count();
    assert!(0 < touching && touching < d.interior().len(), "the faults below need both: {touching}");
}

#[test]
fn a_flipped_boundary_lift_is_seen_although_the_backend_is_content() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    let mut flipped = d.clone();
    flipped.height.iter_mut().for_each(|g| *g = -*g);
    let mut candidate = solve(&flipped, false, None);
    assert_eq!(candidate.statistics.status, crate::qp::Status::Solved);
    for a in (0..d.height().len()).filter(|&a| mesh.kind()[a] == VertexKind::Boundary) {
        candidate.displacement[0][a] = d.height()[a];
    }
    assert_seen(&d, candidate, &[|r| r.stationarity, |r| r.action_mismatch]);
}

#[test]
fn a_wrong_dual_area_is_seen() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    let candidate = solve(&d, true, None);
    let pushed = (0..candidate.multiplier.len()).find(|&k| candidate.multiplier[k] > 0.0).expect("contact");
    let mut wrong = d.clone();
    wrong.dual_area[d.interior()[pushed]] *= 2.0;
    assert_seen(&wrong, candidate, &[|r| r.dual_mismatch]);
}

#[test]
fn a_flipped_dual_is_seen() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    let mut candidate = solve(&d, true, None);
    candidate.multiplier.iter_mut().for_each(|y| *y = -*y);
    assert_seen(&d, candidate, &[|r| r.dual_sign, |r| r.stationarity, |r| r.dual_mismatch]);
}

#[test]
fn action_without_touching_is_seen_although_the_equations_hold() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    // A push p of one membrane on the other, wherever they are: mu1 K u1 - F_1 = p |D_a| = F_2 - mu2 K u2.
    let push = 30.0;
    let pushed = PairDiscretization::new(&problem(push), mesh.clone()).unwrap();
    let mut candidate = solve(&pushed, true, None);
    for (y, &a) in candidate.multiplier.iter_mut().zip(d.interior()) {
        assert_eq!(*y, 0.0, "the membranes are apart");
        *y = push * d.dual_area()[a];
    }
    let residuals = certify_pair(&d, candidate.clone(), TOLERANCE).unwrap_err().residuals.unwrap();
    assert!(
        residuals.stationarity.beyond_rounding < TOLERANCE && residuals.dual_sign.beyond_rounding < TOLERANCE
    );
    assert_seen(&d, candidate, &[|r| r.complementarity, |r| r.variational_inequality]);
}

#[test]
fn membranes_that_pass_through_each_other_are_seen() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    let mut candidate = solve(&d, true, None);
    let a = d.interior()[candidate.multiplier.iter().position(|&y| y > 0.0).expect("contact")];
    candidate.displacement[0][a] -= 0.1;
    assert_seen(&d, candidate, &[|r| r.primal, |r| r.stationarity]);
}

#[test]
fn a_wrong_trace_is_seen() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    for membrane in 0..2 {
        let mut candidate = solve(&d, true, None);
        candidate.displacement[membrane][0] += 0.1;
        assert_seen(&d, candidate, &[|r| r.primal]);
    }
}

#[test]
fn displacements_of_one_membrane_alone_are_seen_by_the_mismatch_of_the_actions() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    for membrane in 0..2 {
        let mut candidate = solve(&d, true, None);
        let middle = d.interior()[d.interior().len() / 2];
        candidate.displacement[membrane][middle] *= 1.01;
        assert_seen(&d, candidate, &[|r| r.action_mismatch]);
    }
}

#[test]
fn the_action_depends_on_the_gap_alone() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    let [mut u1, mut u2] = Displacement::try_from(solve(&d, true, None).displacement).unwrap();
    let before = Action::recover(&d, &[u1.clone(), u2.clone()]);
    for &a in d.interior() {
        let [x, y] = mesh.points()[a];
        let together = x * x * y;
        u1[a] += together;
        u2[a] += together;
    }
    let after = Action::recover(&d, &[u1, u2]);
    let change = |of: &dyn Fn(&Action) -> f64| {
        largest(before.iter().zip(&after).map(|(before, after)| (of(before) - of(after)).abs()))
    };
    assert!(change(&|action| action.lambda) < TOLERANCE, "both membranes moved alike");
    for i in 0..2 {
        assert!(change(&|action| action.from_membrane[i]) > SEEN, "each by itself sees it");
    }
}

#[test]
fn nan_and_infinity_never_pass() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    let sound = solve(&d, true, None);
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut candidate = sound.clone();
        candidate.displacement[0][d.interior()[3]] = value;
        assert_seen(&d, candidate, &[|r| r.stationarity]);
        let mut candidate = sound.clone();
        candidate.multiplier[3] = value;
        assert_seen(&d, candidate, &[|r| r.stationarity]);
        let mut candidate = sound.clone();
        candidate.displacement[1][0] = value;
        assert_seen(&d, candidate, &[|r| r.primal]);
    }
    assert!(certify_pair(&d, sound, f64::NAN).is_err(), "a tolerance that is no number certifies nothing");
}

#[test]
fn an_early_stop_is_seen_and_repaired_by_the_polish() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    let stopped = solve(&d, false, Some(3));
    assert_eq!(stopped.statistics.status, crate::qp::Status::IterationLimit);
    assert_seen(&d, stopped, &[|r| r.complementarity]);
    let polished = solve(&d, true, Some(3));
    assert!(certify_pair(&d, polished, TOLERANCE).is_ok(), "the status does not decide: the residuals do");
}

#[test]
fn what_is_held_against_the_tolerance_is_the_largest_residual_beyond_rounding() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    let sound = certify_pair(&d, solve(&d, true, None), TOLERANCE).unwrap();
    assert!(sound.residuals().beyond_rounding() <= TOLERANCE);
    let rejected = certify_pair(&d, solve(&d, false, Some(3)), TOLERANCE).unwrap_err();
    let residuals = rejected.residuals.expect("there is something to measure");
    assert!(residuals.beyond_rounding() >= residuals.complementarity.beyond_rounding);
    assert!(residuals.beyond_rounding() > SEEN);
}

#[test]
fn the_remedy_follows_from_why_the_solver_stopped() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    let mut stopped = solve(&d, false, Some(3));
    let remedy = |candidate: Candidate| certify_pair(&d, candidate, TOLERANCE).unwrap_err().remedy();
    assert!(remedy(stopped.clone()).contains("more iterations"));
    stopped.statistics.status = crate::qp::Status::Stalled;
    assert!(remedy(stopped).contains("another solver"));
}

#[test]
fn vectors_of_the_wrong_length_are_rejected() {
    let mesh = mesh();
    let d = PairDiscretization::new(&problem(0.0), mesh.clone()).unwrap();
    let sound = solve(&d, true, None);
    let mut short = sound.clone();
    short.multiplier.pop();
    assert_eq!(certify_pair(&d, short, TOLERANCE).unwrap_err().reason, Reason::Lengths);
    let mut long = sound;
    long.displacement[1].push(0.0);
    assert_eq!(certify_pair(&d, long, TOLERANCE).unwrap_err().reason, Reason::Lengths);
}

/// What any solver of the exported program finds as its least value is the energy in the summary.
#[test]
fn the_optimum_of_the_program_is_the_energy() {
    let mesh = irregular(8);
    let height = Function::from_fn(|x, y| 0.1 + 0.05 * x + 0.02 * y);
    let load = Function::from_fn(|x, _| x - 15.0);
    let problem =
        ContactProblem::builder().tension(1.0, 3.0).load(load, 10.0).height(height).build().unwrap();
    let d = PairDiscretization::new(&problem, mesh).unwrap();
    let qp = contact_qp(&d);
    let options = QpOptions { tolerance: 1e-12, ..QpOptions::default() };
    let optimum = QpBackend::solve(&mut Clarabel, &qp.nondimensional(), &options).unwrap();
    let x: Vec<f64> = optimum.x.iter().map(|z| qp.primal_scale() * z).collect();
    let solution =
        certify_pair(&d, ActiveSet.solve_pair(&d, &SolverOptions::default()).unwrap(), 1e-8).unwrap();
    let defect = |value: f64| (value / solution.energy() - 1.0).abs();
    // The energy is stationary at the optimum: its error is the square of the solver's.
    assert!(defect(qp.objective(&x)) < 1e-9, "{:e}", defect(qp.objective(&x)));
    assert!(defect(qp.objective(&x) - qp.constant()) > 1e-3, "without the constant it is not");
}
