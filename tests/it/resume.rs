//! What a study goes on from: a checkpoint of its own, and nothing else, whatever the file says.

use membrane_contact::action::ContactSolution;
use membrane_contact::mesh::{Pattern, rectangle};
use membrane_contact::problem::ContactProblem;
use membrane_contact::qp::Clarabel;
use membrane_contact::solver::{Auto, ContactSolver, QpSolver, SolverOptions};
use membrane_contact::study::{AdaptiveStudy, Checkpoint, Tolerance};

/// A study of few triangles, before its first level.
fn small_study() -> AdaptiveStudy {
    study_by(Box::new(Auto), true)
}

fn study_by(solver: Box<dyn ContactSolver>, polish: bool) -> AdaptiveStudy {
    let problem = ContactProblem::builder().tension(1.0, 3.0).load(-15.0, 10.0).height(0.1).build();
    let problem = problem.expect("the data are in range");
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [2, 2], Pattern::Crossed).expect("a square");
    let options = SolverOptions { polish, ..SolverOptions::default() };
    AdaptiveStudy::new(problem, None, None, mesh, solver, options, Tolerance::Fixed(1e-8))
}

type Change<'a> = &'a dyn Fn(&mut Checkpoint);

#[test]
fn only_a_checkpoint_of_the_study_is_taken_up() {
    let mut study = small_study();
    study.next_level().expect("it is solved");
    study.next_level().expect("it is solved");
    let own = study.checkpoint().expect("there is a solution");
    let is_taken = |change: Change| {
        let mut checkpoint = own.clone();
        change(&mut checkpoint);
        small_study().resume(checkpoint).expect("the problem can be posed")
    };
    assert!(is_taken(&|_| {}));
    let changes: [(&str, Change); 11] = [
        ("a tolerance that certifies anything", &|c| c.tolerance = f64::INFINITY),
        ("a tolerance that is none", &|c| c.tolerance = f64::NAN),
        ("a tolerance that is looser than that of the study", &|c| c.tolerance *= 2.0),
        ("another displacement", &|c| c.displacement[0][0] = 1e300),
        ("a displacement that is no number", &|c| c.displacement[1][4] = f64::NAN),
        ("a displacement of fewer vertices", &|c| c.displacement[0].truncate(1)),
        ("a third membrane", &|c| c.displacement.push(c.displacement[0].clone())),
        ("no action", &|c| c.actions.clear()),
        ("a triangle that is not there", &|c| c.marked[0].push(usize::MAX)),
        ("a refinement of nothing", &|c| c.marked.push(Vec::new())),
        ("refinements without end", &|c| c.marked = vec![vec![0]; 1 << 20]),
    ];
    for (what, change) in changes {
        assert!(!is_taken(change), "{what}");
    }
}

/// An interior-point answer has a gap and an action at each vertex: its solution has not, and would not certify in its place.
#[test]
fn a_study_without_polish_goes_on_too() {
    let by_clarabel = || study_by(Box::new(QpSolver::new(Clarabel)), false);
    let mut study = by_clarabel();
    for _ in 0..4 {
        study.next_level().expect("it is solved");
    }
    let checkpoint = study.checkpoint().expect("there is a solution");
    let solution = study.solution().expect("there is one").0.clone();
    assert!(solution.cut_off().gap > 0.0, "{:?}", solution.cut_off());
    let mut again = by_clarabel();
    let projected = Checkpoint {
        displacement: solution.displacement().to_vec(),
        actions: vec![solution.action(1).expect("of the gap").to_vec()],
        ..checkpoint.clone()
    };
    assert!(!again.resume(projected).expect("the problem can be posed"));
    assert!(again.resume(checkpoint).expect("the problem can be posed"));
    let resumed = again.solution().expect("there is one").0;
    assert_eq!(resumed.displacement(), solution.displacement());
    let contact = |solution: &ContactSolution| solution.gap(1).expect("a gap").contact.to_vec();
    assert_eq!(contact(resumed), contact(&solution));
}
