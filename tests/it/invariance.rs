//! What does not change, or changes in a known way, when a problem is stated differently: held on random problems.
//!
//! Every property has a quick test, the same in every run, and a long one of a thousand new problems. Both say the seed on
//! standard error, and `PROPTEST_RNG_SEED=... cargo test ...` repeats it.

mod comparison;
mod motion;
mod numbering;
mod random;
mod solvers;
mod swap;

use std::io::Write;
use std::time::{SystemTime, UNIX_EPOCH};

use membrane_contact::action::{PairSolution, certify_pair};
use membrane_contact::discretization::PairDiscretization;
use membrane_contact::solver::{ActiveSet, ContactSolver, SolverOptions};
use proptest::test_runner::{Config, RngSeed, TestCaseError, TestError, TestRunner};

use crate::common::TOLERANCE;
use random::{Draw, draw};

/// Problems of a quick test, and the seed from which they are drawn.
const QUICK: u32 = 64;
const QUICK_SEED: u64 = 2009;

/// Problems of a long test.
const LONG: u32 = 1000;

/// How often a counterexample is tried to be made simpler.
const SIMPLIFICATIONS: u32 = 500;

/// What holds for a problem, or why it does not.
type Property = fn(&Draw) -> Result<(), String>;

/// A quick and a long test of a property.
macro_rules! holds {
    ($name:ident, $property:expr) => {
        mod $name {
            #[test]
            fn on_a_few_problems() {
                $crate::invariance::hold_on_few(stringify!($name), $property);
            }

            #[test]
            #[ignore = "long: `bash tests/long.sh`"]
            fn on_a_thousand_problems() {
                $crate::invariance::hold_on_many(stringify!($name), $property);
            }
        }
    };
}
use holds;

fn hold_on_few(name: &str, property: Property) {
    hold(name, QUICK, QUICK_SEED, property);
}

/// A seed that no run has had before.
fn hold_on_many(name: &str, property: Property) {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).expect("after 1970");
    hold(name, LONG, now.as_nanos() as u64, property);
}

fn hold(name: &str, cases: u32, seed: u64, property: Property) {
    let seed = match Config::default().rng_seed {
        RngSeed::Fixed(chosen) => chosen,
        RngSeed::Random => seed,
    };
    let repeat = format!("PROPTEST_RNG_SEED={seed} repeats it");
    // Written past the test harness, which keeps what a test prints to itself unless it fails.
    let _ = writeln!(std::io::stderr(), "invariance, {name}: {cases} random problems, {repeat}");
    if let Err(counterexample) = first_counterexample(cases, seed, property) {
        panic!("{name}: {counterexample}\n{repeat}");
    }
}

/// Draws problems until one does not have the property, and makes that one simpler.
fn first_counterexample(cases: u32, seed: u64, property: Property) -> Result<(), String> {
    let config = Config {
        cases,
        rng_seed: RngSeed::Fixed(seed),
        failure_persistence: None,
        max_shrink_iters: SIMPLIFICATIONS,
        ..Config::default()
    };
    let holds = |draw: Draw| property(&draw).map_err(TestCaseError::fail);
    TestRunner::new(config).run(&draw(), holds).map_err(|error| match error {
        TestError::Fail(reason, draw) => format!("{reason}\n{draw:#?}"),
        TestError::Abort(reason) => reason.to_string(),
    })
}

/// Asserts that a property that is wrong is seen to be.
#[track_caller]
fn is_seen(property: Property) {
    assert!(
        first_counterexample(QUICK, QUICK_SEED, property).is_err(),
        "it holds on {QUICK} random problems"
    );
}

/// A certified solution by one of the built-in solvers.
fn solve_by(solver: &mut dyn ContactSolver, d: &PairDiscretization) -> Result<PairSolution, String> {
    let options = SolverOptions { tolerance: TOLERANCE, ..SolverOptions::default() };
    let name = solver.name().to_owned();
    let candidate = solver.solve_pair(d, &options).map_err(|error| format!("{name}: {error}"))?;
    certify_pair(d, candidate, TOLERANCE).map_err(|rejected| rejected.to_string())
}

fn solve(d: &PairDiscretization) -> Result<PairSolution, String> {
    solve_by(&mut ActiveSet, d)
}

/// What a solution is, over the vertices of a mesh.
#[derive(Clone)]
struct Fields {
    displacement: [Vec<f64>; 2],
    lambda: Vec<f64>,
    contact: Vec<bool>,
}

impl From<&PairSolution> for Fields {
    fn from(solution: &PairSolution) -> Self {
        Self {
            displacement: solution.displacement().clone(),
            lambda: solution.lambda().to_vec(),
            contact: solution.contact().to_vec(),
        }
    }
}

/// How far two solutions of one problem may be from each other, in units of the data: the displacements, and the action, in
/// which rounding is divided by the square of the mesh size.
#[derive(Clone, Copy)]
struct Nearness {
    displacement: f64,
    action: f64,
}

/// Solutions that are exact to rounding.
const EXACT: Nearness = Nearness { displacement: 1e-11, action: 1e-8 };

impl Fields {
    /// Whether two solutions are the same: their displacements, their actions, and their contact sets where it is clear
    /// whether the membranes touch: where neither gap nor action is zero up to rounding, or one of them alone.
    fn compare(&self, other: &Self, d: &PairDiscretization, near: Nearness) -> Result<(), String> {
        let scales = d.scales();
        let gap = |a: usize| (self.displacement[0][a] - self.displacement[1][a]) / scales.displacement;
        for a in 0..self.lambda.len() {
            let at = |what: &str, x: f64, y: f64, scale: f64| {
                format!(
                    "{what} at vertex {a}: {x:e} and {y:e}, apart by {:e} of the scale",
                    (x - y).abs() / scale
                )
            };
            for (name, i) in [("u1", 0), ("u2", 1)] {
                let (x, y) = (self.displacement[i][a], other.displacement[i][a]);
                if !((x - y).abs() <= near.displacement * scales.displacement) {
                    return Err(at(name, x, y, scales.displacement));
                }
            }
            let (x, y) = (self.lambda[a], other.lambda[a]);
            if !((x - y).abs() <= near.action * scales.force_density) {
                return Err(at("lambda", x, y, scales.force_density));
            }
            let clear = gap(a) > near.displacement.sqrt() || x / scales.force_density > near.action.sqrt();
            if clear && self.contact[a] != other.contact[a] {
                return Err(format!("only one touches at vertex {a}: gap {:e}, action {x:e}", gap(a)));
            }
        }
        Ok(())
    }
}

/// The negative test: each part of a solution that is changed is seen.
#[test]
fn a_change_of_any_part_is_seen() {
    let property: Property = |draw| {
        let mesh = draw.mesh.build()?;
        let d = draw.discretize(&mesh)?;
        let solution = Fields::from(&solve(&d)?);
        solution.compare(&solution, &d, EXACT)?;
        let Some(pushed) =
            (0..mesh.points().len()).find(|&a| solution.lambda[a] > 1e-3 * d.scales().force_density)
        else {
            return Ok(());
        };
        let changes: [fn(&mut Fields, usize, f64); 4] = [
            |fields, a, length| fields.displacement[0][a] += 0.01 * length,
            |fields, a, length| fields.displacement[1][a] -= 0.01 * length,
            |fields, a, _| fields.lambda[a] *= 1.01,
            |fields, a, _| fields.contact[a] ^= true,
        ];
        for (k, change) in changes.iter().enumerate() {
            let mut changed = solution.clone();
            change(&mut changed, pushed, d.scales().displacement);
            if solution.compare(&changed, &d, EXACT).is_ok() {
                return Err(format!("change {k} is not seen"));
            }
        }
        Ok(())
    };
    hold_on_few("a_change_of_any_part_is_seen", property);
}
