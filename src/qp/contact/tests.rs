use super::*;
use crate::mesh::samples::{irregular, square};
use crate::mesh::{Mesh, Pattern, rectangle};
use crate::numeric::largest;
use crate::problem::{ContactProblem, Function};

/// Rounding of a few operations on numbers of order ten.
const ROUNDING: f64 = 1e-13;

/// `g = 1 + x + 2 y`, tensions 2 and 3.
fn problem(f1: f64, f2: f64) -> ContactProblem {
    let height = Function::from_fn(|x, y| 1.0 + x + 2.0 * y);
    ContactProblem::builder().tension(2.0, 3.0).load(f1, f2).height(height).build().unwrap()
}

fn qp(mesh: &Mesh, problem: &ContactProblem) -> QpProblem {
    contact_qp(&PairDiscretization::new(problem, mesh.clone()).unwrap())
}

fn dense(matrix: &CsMat<f64>) -> Vec<Vec<f64>> {
    let entry = |row, column| matrix.get(row, column).copied().unwrap_or(0.0);
    (0..matrix.rows()).map(|row| (0..matrix.cols()).map(|column| entry(row, column)).collect()).collect()
}

#[track_caller]
fn assert_close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    let close = found.iter().zip(expected).all(|(x, y)| (x - y).abs() < ROUNDING);
    assert!(close, "{found:?} is not {expected:?}");
}

/// One unknown a membrane, in the middle of the square: `K` has 4 there and -1 at the middles of the sides, where `g` is 2,
/// 3/2, 5/2 + 1, ... with the sum 4 g(1/2, 1/2) = 10; `|D_a|` is 1/4.
#[test]
fn one_interior_vertex_by_hand() {
    let qp = qp(&square(2), &problem(-4.0, 8.0));
    assert_eq!(dense(qp.p_upper()), [[8.0, 0.0], [0.0, 12.0]]);
    assert_eq!(dense(qp.a()), [[1.0, -1.0]]);
    assert_close(qp.q(), &[2.0 * -10.0 + 4.0 / 4.0, -8.0 / 4.0]);
    assert_eq!(qp.b(), [0.0]);
    let flipped_lift = [2.0 * 10.0 + 4.0 / 4.0, -8.0 / 4.0];
    assert!((qp.q()[0] - flipped_lift[0]).abs() > 1.0);
}

/// Three unknowns a membrane, side by side in cells of 1/2; `|D_a|` is 1/4.
#[test]
fn three_interior_vertices_by_hand() {
    let mesh = rectangle([0.0, 0.0], [2.0, 1.0], [4, 2], Pattern::Right).unwrap();
    let qp = qp(&mesh, &problem(-4.0, 8.0));
    let mut p = vec![vec![0.0; 6]; 6];
    for (membrane, mu) in [2.0, 3.0].into_iter().enumerate() {
        for k in 0..3 {
            let a = 3 * membrane + k;
            p[a][a] = 4.0 * mu;
            if k < 2 {
                p[a][a + 1] = -mu;
            }
        }
    }
    assert_eq!(dense(qp.p_upper()), p, "the upper triangle");
    let g = |x: f64, y: f64| 1.0 + x + 2.0 * y;
    // Above and below each, and beside the first and the last, lies the boundary.
    let lift = [
        g(0.5, 0.0) + g(0.5, 1.0) + g(0.0, 0.5),
        g(1.0, 0.0) + g(1.0, 1.0),
        g(1.5, 0.0) + g(1.5, 1.0) + g(2.0, 0.5),
    ];
    let first = lift.map(|lift| -2.0 * lift + 4.0 / 4.0);
    assert_close(qp.q(), &[&first[..], &[-2.0; 3]].concat());
    let gap = [[1, 0, 0, -1, 0, 0], [0, 1, 0, 0, -1, 0], [0, 0, 1, 0, 0, -1]];
    assert_eq!(dense(qp.a()), gap.map(|row| row.map(f64::from)));
    assert_eq!(qp.b(), [0.0; 3]);
}

/// Without loads both membranes are planes, `u1 = g` and `u2 = 0`: the gradient vanishes there. It sees the sign of the
/// boundary lift, which no comparison of solvers does.
#[test]
fn planes_are_at_rest() {
    let mesh = irregular(5);
    let d = PairDiscretization::new(&problem(0.0, 0.0), mesh.clone()).unwrap();
    let qp = contact_qp(&d);
    let n = d.interior().len();
    let mut x = vec![0.0; 2 * n];
    for (k, &a) in d.interior().iter().enumerate() {
        let [u, v] = mesh.points()[a];
        x[k] = 1.0 + u + 2.0 * v;
    }
    let gradient = |q: &[f64]| {
        let sums = qp.p_times(&x).into_iter().zip(q).map(|(px, q)| (px + q).abs());
        largest(sums)
    };
    assert!(gradient(qp.q()) < ROUNDING);
    let flipped: Vec<f64> = qp.q().iter().map(|q| -q).collect();
    assert!(gradient(&flipped) > 1.0);
    assert_eq!(qp.a_times(&x), x[..n]);
}

/// For any displacements, the objective is the energy of (2.9), and the gradient is the imbalance of the discretization.
#[test]
fn the_objective_is_the_energy_and_its_gradient_the_imbalance() {
    let mesh = irregular(4);
    let d = PairDiscretization::new(&problem(-4.0, 8.0), mesh.clone()).unwrap();
    let qp = contact_qp(&d);
    let n = d.interior().len();
    let x: Vec<f64> = (0..2 * n).map(|k| (k as f64).cos()).collect();
    let displacement = [d.extend(&x[..n], |a| d.height()[a]), d.extend(&x[n..], |_| 0.0)];
    let expected = [d.imbalance(0, &displacement[0]), d.imbalance(1, &displacement[1])].concat();
    let gradient: Vec<f64> = qp.p_times(&x).iter().zip(qp.q()).map(|(px, q)| px + q).collect();
    assert_close(&gradient, &expected);
    let without_lift = d.imbalance(0, &d.extend(&x[..n], |_| 0.0));
    assert!(gradient.iter().zip(&without_lift).any(|(x, y)| (x - y).abs() > 1.0));

    let energy_of = |i: usize, u: &[f64]| {
        let at = |a: usize| (0.5 * d.tension()[i] * d.stiffness_row(a, |b| u[b]) - d.load()[i][a]) * u[a];
        (0..u.len()).map(at).sum::<f64>()
    };
    let energy = energy_of(0, &displacement[0]) + energy_of(1, &displacement[1]);
    assert_close(&[qp.objective(&x)], &[energy]);
    assert!((qp.objective(&x) - qp.constant() - energy).abs() > 1.0, "the constant counts");
}

#[test]
fn scales_are_those_of_the_data() {
    let mesh = square(4);
    let d = PairDiscretization::new(&problem(-4.0, 8.0), mesh.clone()).unwrap();
    let (scales, qp) = (d.scales(), contact_qp(&d));
    assert_eq!(qp.primal_scale(), scales.displacement);
    assert_eq!(qp.dual_scale(), scales.force_density * scales.dual_area);
    assert_ne!(qp.primal_scale(), 1.0);
}

#[test]
fn a_mesh_without_interior_vertices_makes_an_empty_program() {
    let qp = qp(&square(1), &problem(-4.0, 8.0));
    assert!(qp.q().is_empty() && qp.b().is_empty());
    assert_eq!((qp.p_upper().shape(), qp.a().shape()), ((0, 0), (0, 0)));
}
