//! The stability of Corollary 6, (2.17): the constant stays bounded under refinement.

use membrane_contact::action::{PairSolution, certify_pair};
use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::{Pattern, rectangle};
use membrane_contact::problem::{ContactProblem, Function};
use membrane_contact::solver::{ActiveSet, ContactSolver, SolverOptions};

use crate::common::{TOLERANCE, largest};
use crate::random::Random;

/// Modes `sin(k pi x) sin(l pi y)` of a load, `k, l = 1 .. MODES`.
const MODES: usize = 4;

/// Data drawn at random: coefficients of both loads, and a constant height.
struct Data {
    load: [Vec<f64>; 2],
    height: f64,
}

impl Data {
    fn draw(random: &mut Random) -> Self {
        let mut coefficients = || (0..MODES * MODES).map(|_| random.between(-1.0, 1.0)).collect();
        let load = [coefficients(), coefficients()];
        Self { load, height: random.between(0.0, 0.05) }
    }

    fn problem(&self) -> ContactProblem {
        let load = |i: usize| {
            let coefficients = self.load[i].clone();
            Function::from_fn(move |x, y| {
                let mode = |k: usize| {
                    let [kx, ky] = [k / MODES + 1, k % MODES + 1].map(|k| k as f64 * std::f64::consts::PI);
                    coefficients[k] * (kx * x).sin() * (ky * y).sin()
                };
                (0..MODES * MODES).map(mode).sum()
            })
        };
        let builder = ContactProblem::builder().tension(1.0, 3.0).load(load(0), load(1));
        builder.height(self.height).build().expect("valid data")
    }

    /// `||f1|| + ||f2|| + ||g||`: the modes are orthogonal with the norm 1/2; a constant is its own harmonic lift.
    fn norm(&self) -> f64 {
        let load_norm = |i: usize| 0.5 * self.load[i].iter().map(|c| c * c).sum::<f64>().sqrt();
        load_norm(0) + load_norm(1) + self.height
    }
}

/// `||u1|| + ||u2||` in H1 and `||lambda||` in L2, the L2 norms of the displacements by the lumped masses.
fn solution_norm(d: &PairDiscretization, solution: &PairSolution) -> f64 {
    let l2_sq = |v: &[f64]| v.iter().zip(d.dual_area()).map(|(v, area)| area * v * v).sum::<f64>();
    let h1 = |u: &[f64]| {
        let seminorm_sq: f64 =
            d.stiffness().iter().map(|(k, (a, b))| k * u[a as usize] * u[b as usize]).sum();
        (seminorm_sq + l2_sq(u)).sqrt()
    };
    let [u1, u2] = solution.displacement();
    h1(u1) + h1(u2) + l2_sq(solution.lambda()).sqrt()
}

/// The largest ratio of both sides of (2.17) over data drawn at random, on a mesh of `cells x cells`.
fn constant(cells: usize, scale: impl Fn(usize) -> f64) -> f64 {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [cells, cells], Pattern::Right).unwrap();
    let mut random = Random::new(2009);
    let ratios = (0..20).map(|_| {
        let data = Data::draw(&mut random);
        let d = PairDiscretization::new(&data.problem(), mesh.clone()).unwrap();
        let candidate = ActiveSet.solve_pair(&d, &SolverOptions::default()).expect("it runs");
        let solution = certify_pair(&d, candidate, TOLERANCE).expect("certified");
        scale(cells) * solution_norm(&d, &solution) / data.norm()
    });
    largest(ratios)
}

/// Whether the constants keep below the coarsest one, but for what its coarseness explains.
fn is_bounded(constants: &[f64]) -> bool {
    constants.iter().all(|&constant| constant <= 1.1 * constants[0])
}

#[test]
fn the_constant_of_the_stability_estimate_is_bounded() {
    let constants = [16, 32, 64].map(|cells| constant(cells, |_| 1.0));
    println!("constants of (2.17) on 16, 32, 64 cells: {constants:.3?}");
    assert!(is_bounded(&constants), "{constants:?}");
    // An action scaled by the mesh, as when the division by |D_a| is forgotten, does not keep a constant.
    assert!(!is_bounded(&[16, 32].map(|cells| constant(cells, |cells| cells as f64))));
}
