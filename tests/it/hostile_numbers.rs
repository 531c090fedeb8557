//! Whatever the numbers are, out comes a certified result, or an error that says what to do.

mod outputs;
mod problems;
#[cfg(feature = "cli")]
mod program;
mod scaling;
mod truth;

use membrane_contact::action::PairSolution;
use membrane_contact::discretization::{Discretization, PairDiscretization};
use membrane_contact::estimate::ErrorBound;
use membrane_contact::solver::{ActiveSet, ContactSolver, SolverOptions};
use membrane_contact::study::{Tolerance, solve_bounded};

use crate::common::{TOLERANCE, distance, largest, solvers};
use problems::{Hostile, refused, solvable};

/// How far two solvers may be from each other, in units of the data: each is certified at [`TOLERANCE`], and on slivers what
/// that leaves of the displacements is more.
const AGREED: f64 = 1e-6;

/// A message that is longer than this is no message.
const LONGEST_MESSAGE: usize = 300;

/// A certified solution and how far it is from the exact one.
struct Bounded {
    solution: PairSolution,
    bound: ErrorBound,
    tolerance: f64,
}

impl Hostile {
    fn discretize(&self) -> PairDiscretization {
        PairDiscretization::new(&self.problem, self.mesh.clone())
            .unwrap_or_else(|error| panic!("{}: {error}", self.name))
    }

    fn solve(&self, d: &PairDiscretization, solver: &mut dyn ContactSolver) -> Result<Bounded, String> {
        let name = format!("{}, {}", self.name, solver.name());
        let options = SolverOptions::default();
        let d = Discretization::Pair(d.clone());
        let found = solve_bounded(&self.problem, None, &d, solver, &options, Tolerance::Fixed(TOLERANCE))
            .map_err(|error| format!("{name}: {error}"))?;
        Ok(Bounded {
            solution: found.solution.as_pair().expect("it is the solution of a pair").clone(),
            bound: found.bound.map_err(|reason| format!("{name}: {reason}"))?,
            tolerance: found.tolerance,
        })
    }
}

#[test]
fn every_solver_is_certified_and_all_find_the_same() {
    let mut complaints = Vec::new();
    for hostile in solvable() {
        let d = hostile.discretize();
        let expected = hostile.solve(&d, &mut ActiveSet).expect("the active set method solves it");
        for mut solver in solvers() {
            let found = hostile.solve(&d, &mut *solver).map(|found| difference(&d, &expected, &found));
            match found {
                Ok(difference) if difference <= AGREED => {}
                Ok(difference) => {
                    complaints.push(format!("{}, {}: {difference:e} apart", hostile.name, solver.name()));
                }
                Err(error) => complaints.push(error),
            }
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

/// How far displacements and actions are apart, in units of the data; infinite where one is not a number.
fn difference(d: &PairDiscretization, first: &Bounded, second: &Bounded) -> f64 {
    let scales = d.scales();
    let [first, second] = [&first.solution, &second.solution];
    let displacements =
        (0..2).map(|i| distance(&first.displacement()[i], &second.displacement()[i]) / scales.displacement);
    let actions = distance(first.lambda(), second.lambda()) / scales.force_density;
    largest(displacements.chain([actions]))
}

/// What is wrong with what is made of the solutions.
fn complaints(
    problems: impl IntoIterator<Item = Hostile>,
    about: impl Fn(&Hostile, &PairDiscretization, &Bounded) -> Vec<String>,
) -> Vec<String> {
    let about_one = |hostile: Hostile| {
        let d = hostile.discretize();
        let bounded = hostile.solve(&d, &mut ActiveSet).expect("the active set method solves it");
        let complaints = about(&hostile, &d, &bounded).into_iter();
        complaints.map(|complaint| format!("{}: {complaint}", hostile.name)).collect::<Vec<_>>()
    };
    problems.into_iter().flat_map(about_one).collect()
}

#[test]
fn summary_files_fluxes_and_export_hold_what_they_should() {
    assert_eq!(complaints(solvable(), outputs::complaints), [""; 0]);
}

fn pictures(hostile: &Hostile, d: &PairDiscretization, bounded: &Bounded) -> Vec<String> {
    outputs::pictures(hostile, d, bounded).err().into_iter().collect()
}

/// One in ten.
#[test]
fn pictures_can_be_drawn() {
    assert_eq!(complaints(solvable().into_iter().step_by(10), pictures), [""; 0]);
}

#[test]
#[ignore = "long: `bash tests/long.sh`"]
fn all_pictures_can_be_drawn() {
    assert_eq!(complaints(solvable(), pictures), [""; 0]);
}

#[test]
fn what_cannot_be_computed_with_is_refused_in_one_line_with_the_remedy() {
    for (hostile, says) in refused() {
        let error = PairDiscretization::new(&hostile.problem, hostile.mesh.clone())
            .map(|_| ())
            .expect_err(hostile.name);
        let message = error.to_string();
        for word in says {
            assert!(message.contains(word), "{}: {word:?} is not in {message:?}", hostile.name);
        }
        assert!(message.len() <= LONGEST_MESSAGE && !message.contains('\n'), "{}: {message}", hostile.name);
    }
}
