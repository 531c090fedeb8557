//! Meshes bisected towards a corner: many levels, each of which refines a small part of the one before.

use membrane_contact::action::{PairSolution, certify_pair};
use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::{Bisection, Mesh, Pattern, l_shape};
use membrane_contact::problem::{ContactProblem, Function};
use membrane_contact::solver::{ActiveSet, ContactSolver, Multigrid, SolverOptions};

use crate::common::{TOLERANCE, distance, solve};

/// Cycles of multigrid on the finest level: 12 to 18 were seen on 15 to 31 levels, without growth in their number.
const CYCLES: usize = 20;

/// Cycles that are not enough.
const TOO_FEW: usize = 5;

/// An L-shape bisected towards its re-entrant corner: in each step where the centre of the triangle is within `ratio` times
/// the distance of the step before.
fn towards_corner(steps: i32, ratio: f64) -> Mesh {
    let mut bisection = Bisection::new(l_shape(1.0, 8, Pattern::Right).unwrap());
    for step in 0..steps {
        let mesh = bisection.mesh();
        let reach = ratio.powi(step);
        let is_near = |t: &usize| {
            let corners = mesh.corners(*t);
            [0, 1].iter().all(|&axis| corners.iter().map(|p| p[axis]).sum::<f64>().abs() < 3.0 * reach)
        };
        let marked: Vec<usize> = (0..mesh.triangles().len()).filter(is_near).collect();
        bisection.refine(&marked).expect("far from the limit");
    }
    Mesh::clone(bisection.mesh())
}

fn problem() -> ContactProblem {
    let load = Function::from_fn(|x: f64, y: f64| 30.0 * (6.3 * x).sin() * (4.7 * y).sin());
    ContactProblem::builder().tension(1.0, 3.0).load(-10.0, load).height(0.05).build().unwrap()
}

/// By multigrid and by the active set method, certified.
fn solutions(mesh: &Mesh) -> [PairSolution; 2] {
    let d = PairDiscretization::new(&problem(), mesh.clone()).unwrap();
    let solvers: [&mut dyn ContactSolver; 2] = [&mut Multigrid, &mut ActiveSet];
    solvers.map(|solver| certify_pair(&d, solve(solver, &d, true), TOLERANCE).expect("certified"))
}

#[test]
fn both_solvers_run_along_the_bisections() {
    let [coarse, mesh] = [0, 12].map(|steps| towards_corner(steps, 0.55));
    assert_eq!(mesh.ancestry().len(), coarse.ancestry().len() + 12);
    let [multigrid, active_set] = solutions(&mesh);
    assert_eq!(multigrid.contact(), active_set.contact());
    let contacts = multigrid.contact().iter().filter(|&&contact| contact).count();
    assert!(0 < contacts && contacts < mesh.points().len() / 2, "a free boundary: {contacts}");
    for i in 0..2 {
        let error = distance(&multigrid.displacement()[i], &active_set.displacement()[i]);
        assert!(error < 10.0 * TOLERANCE, "{error}");
    }
    let statistics = multigrid.statistics();
    assert!(statistics.iterations <= CYCLES, "{:?} cycles", statistics.level_iterations);
    let d = PairDiscretization::new(&problem(), mesh.clone()).unwrap();
    let options = SolverOptions { max_iterations: Some(TOO_FEW), ..SolverOptions::default() };
    let stopped = Multigrid.solve_pair(&d, &options).expect("it runs");
    assert!(certify_pair(&d, stopped, TOLERANCE).is_err(), "cycles are needed");
    // The answer on the mesh that was bisected is another one.
    let [_, on_coarse] = solutions(&coarse);
    let old = coarse.points().len();
    assert!(distance(&on_coarse.displacement()[0], &active_set.displacement()[0][..old]) > 100.0 * TOLERANCE);
}
