//! Data scaled by powers of two: the solution is scaled, to the last bit.

use membrane_contact::action::certify_pair;
use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::{Mesh, polygon};
use membrane_contact::problem::{ContactProblem, Function};

use crate::common::{TOLERANCE, solve, solvers};

/// Factors of the tensions, loads, heights and lengths.
#[derive(Clone, Copy)]
struct Scaling {
    tension: f64,
    load: f64,
    height: f64,
    length: f64,
}

impl Scaling {
    const NONE: Self = Self { tension: 1.0, load: 1.0, height: 1.0, length: 1.0 };

    /// By the power `n` of two: loads and heights alike; tensions and loads alike; the domain, and the loads so that the
    /// displacements stay.
    fn all(n: i32) -> [Self; 3] {
        let factor = 2_f64.powi(n);
        [
            Self { load: factor, height: factor, ..Self::NONE },
            Self { tension: factor, load: factor, ..Self::NONE },
            Self { length: factor, load: factor.powi(-2), ..Self::NONE },
        ]
    }

    fn problem(self) -> ContactProblem {
        let Self { tension, load, height, length } = self;
        let wave = Function::from_fn(move |x, y| load * 10.0 * (3.0 * x / length + 2.0 * y / length).sin());
        let slope = Function::from_fn(move |x, _| height * (0.1 + 0.05 * x / length));
        let problem = ContactProblem::builder().tension(tension, 3.0 * tension);
        problem.load(-15.0 * load, wave).height(slope).build().expect("valid data")
    }

    fn mesh(self, of_size_one: &Mesh) -> Mesh {
        let points = of_size_one.points().iter().map(|point| point.map(|x| self.length * x));
        Mesh::new(points.collect(), of_size_one.triangles().to_vec()).expect("a mesh")
    }
}

/// `[u1, u2, lambda]` over vertices by every solver.
fn solutions(scaling: Scaling, of_size_one: &Mesh) -> Vec<(String, [Vec<f64>; 3])> {
    let mesh = scaling.mesh(of_size_one);
    let d = PairDiscretization::new(&scaling.problem(), mesh.clone()).expect("it can be computed with");
    let solve = |mut solver: Box<dyn membrane_contact::solver::ContactSolver>| {
        let solution = certify_pair(&d, solve(&mut *solver, &d, true), TOLERANCE).expect("certified");
        let [u1, u2] = solution.displacement().clone();
        (solver.name().to_owned(), [u1, u2, solution.lambda().to_vec()])
    };
    solvers().into_iter().map(solve).collect()
}

fn unit_polygon() -> Mesh {
    let outer = [[0.0, 0.0], [1.0, 0.0], [1.2, 0.9], [0.1, 1.0]];
    polygon(&outer, &[vec![[0.5, 0.5], [0.7, 0.5], [0.6, 0.7]]], 0.12, 25.0).expect("a polygon with a hole")
}

/// The entries that are not exactly those expected.
fn differences(expected: &[f64], factor: f64, found: &[f64]) -> usize {
    expected.iter().zip(found).filter(|(expected, found)| **expected * factor != **found).count()
}

#[test]
fn powers_of_two_scale_the_solution_exactly() {
    let mesh = unit_polygon();
    let expected = solutions(Scaling::NONE, &mesh);
    for n in [-60, -7, 1, 40] {
        for scaling in Scaling::all(n) {
            for ((solver, found), (_, expected)) in solutions(scaling, &mesh).iter().zip(&expected) {
                let factors = [scaling.height, scaling.height, scaling.load];
                for k in 0..3 {
                    let count = differences(&expected[k], factors[k], &found[k]);
                    assert_eq!(count, 0, "{solver}, 2^{n}: {count} entries of {}", ["u1", "u2", "lambda"][k]);
                }
            }
        }
    }
}

/// The negative test: a factor that is no power of two moves the last bits.
#[test]
fn other_factors_are_seen_in_the_last_bits() {
    let mesh = unit_polygon();
    let [(_, expected), (_, found)] = [Scaling::NONE, Scaling { load: 3.0, height: 3.0, ..Scaling::NONE }]
        .map(|s| solutions(s, &mesh).swap_remove(0));
    assert!(differences(&expected[0], 3.0, &found[0]) > 0);
}
