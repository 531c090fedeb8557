use sprs::{CsMat, TriMat};
use web_time::Instant;

use super::*;
use crate::action::certify_pair;
use crate::mesh::samples::irregular;
use crate::mesh::{Bisection, Mesh, Pattern, l_shape, rectangle};
use crate::problem::{Case, ContactProblem, Function};
use crate::qp::Status;
use crate::solver::repair::SLIGHT;
use crate::solver::{ActiveSet, ContactSolver};

/// Factorisations on a level that nested iteration needs at most.
const FACTORIZATIONS: usize = 4;

const TOLERANCE: f64 = 1e-8;

/// Rounding of solutions of size one.
const ROUNDING: f64 = 1e-12;

/// Bisections towards a corner that halve the mesh size there each.
const DEEP: usize = 22;

/// A distance from the corner within which gaps are below [`SLIGHT`].
const TIP: f64 = 1e-6;

fn limits(steps: usize) -> Limits {
    Limits::new(steps, None, Instant::now(), None)
}

fn dense(entries: &[[f64; 3]; 3]) -> CsMat<f64> {
    let mut triplets = TriMat::new((3, 3));
    for (i, row) in entries.iter().enumerate() {
        row.iter().enumerate().for_each(|(j, &value)| triplets.add_triplet(i, j, value));
    }
    triplets.to_csr()
}

fn obstacle(k: &CsMat<f64>, b: &[f64]) -> Obstacle {
    Obstacle::new(k.clone(), b.to_vec(), b.to_vec(), 1.0).unwrap()
}

/// Whether all repairs at once come back to a contact set.
fn cycles(k: &CsMat<f64>, b: &[f64], start: &[bool]) -> bool {
    let mut half = obstacle(k, b);
    let mut active = start.to_vec();
    let mut seen = Vec::new();
    while !seen.contains(&active) {
        seen.push(active.clone());
        let gap = half.solve(&active).unwrap();
        let wrong = half.wrong(&active, &gap, 0.0);
        if wrong.is_empty() {
            return false;
        }
        wrong.iter().for_each(|&i| active[i] = !active[i]);
    }
    true
}

#[test]
fn contact_sets_that_would_come_back_are_left_by_single_repairs() {
    // Curtis, Han, Robinson, Comput. Optim. Appl. 60 (2015) 311, example 2.1.
    let k = dense(&[[4.0, 5.0, -5.0], [5.0, 9.0, -5.0], [-5.0, -5.0, 7.0]]);
    let b = [2.0, 1.0, -3.0];
    let starts = (0..8).map(|bits| [0, 1, 2].map(|i| bits >> i & 1 == 1).to_vec());
    let mut found = 0;
    for start in starts {
        found += usize::from(cycles(&k, &b, &start));
        let limits = limits(60);
        let (gap, status, _) = obstacle(&k, &b).settle(start, &limits).unwrap();
        assert_eq!(status, Status::Solved);
        for i in 0..3 {
            assert!(gap.w[i] >= -ROUNDING && gap.y[i] >= -ROUNDING && gap.w[i] * gap.y[i] == 0.0);
        }
    }
    assert!(found > 0, "there were cycles to be left");
}

#[test]
fn few_factorisations_are_needed_on_each_level() {
    let load = Function::from_fn(|x: f64, y: f64| 30.0 * (12.566 * x).sin() * (9.425 * y).sin());
    let problem = ContactProblem::builder().tension(1.0, 1.0).load(-10.0, load).height(0.05).build().unwrap();
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [128; 2], Pattern::Right).unwrap();
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let found = ActiveSet.solve_pair(&d, &SolverOptions::default()).unwrap();
    let steps = &found.statistics.level_iterations;
    assert_eq!(steps.len(), 7);
    assert!(steps.iter().all(|&steps| steps <= FACTORIZATIONS), "{steps:?}");
    // A guess of no contact needs more.
    let nothing = vec![false; d.interior().len()];
    let cold = settle(&d, nothing, &limits(MAX_STEPS)).unwrap();
    assert!(cold.repairs + 1 > FACTORIZATIONS);
}

#[test]
fn biactive_data_and_obtuse_triangles_are_solved() {
    // Everywhere in contact without pushing: any contact set is right.
    for q in [0.0, 1e-12, 1e-8] {
        let parameters = [("q".to_string(), q)].into_iter().collect();
        let problem = Case::FullContact.solution(&parameters).unwrap().problem().unwrap();
        for mesh in [rectangle([0.0, 0.0], [1.0, 1.0], [24; 2], Pattern::Right).unwrap(), irregular(16)] {
            let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
            let found = ActiveSet.solve_pair(&d, &SolverOptions::default()).unwrap();
            assert_eq!(found.statistics.status, Status::Solved);
            assert!(certify_pair(&d, found, TOLERANCE).is_ok());
        }
    }
    // A long thin rectangle in square cells' place: obtuse once it is sheared.
    let flat = rectangle([0.0, 0.0], [1.0, 1.0], [20; 2], Pattern::Right).unwrap();
    let sheared = flat.points().iter().map(|&[x, y]| [x + 3.0 * y, y]).collect();
    let mesh = Mesh::new(sheared, flat.triangles().to_vec()).unwrap();
    let problem = ContactProblem::builder().tension(1.0, 2.0).load(-30.0, 10.0).height(0.1).build().unwrap();
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let positive = d.stiffness().iter().filter(|&(&k, (i, j))| i != j && k > 0.1).count();
    assert!(positive > 100, "K is no M-matrix");
    let found = ActiveSet.solve_pair(&d, &SolverOptions::default()).unwrap();
    assert!(certify_pair(&d, found, TOLERANCE).is_ok());
}

/// An L-shape whose triangles at the re-entrant corner are bisected again and again.
fn bisected_at_the_corner(steps: usize) -> Mesh {
    let mut bisection = Bisection::new(l_shape(1.0, 2, Pattern::Right).unwrap());
    for _ in 0..steps {
        let mesh = bisection.mesh();
        let at_corner = |t: &usize| mesh.corners(*t).contains(&[0.0; 2]);
        let marked: Vec<usize> = (0..mesh.triangles().len()).filter(at_corner).collect();
        bisection.refine(&marked).unwrap();
    }
    Mesh::clone(bisection.mesh())
}

#[test]
fn contact_is_found_at_the_tip_of_a_deep_mesh() {
    let problem = ContactProblem::builder().tension(1.0, 3.0).load(-10.0, 10.0).height(0.0).build().unwrap();
    let with_ancestry = bisected_at_the_corner(DEEP);
    let without = Mesh::new(with_ancestry.points().to_vec(), with_ancestry.triangles().to_vec()).unwrap();
    for mesh in [with_ancestry, without] {
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let found = ActiveSet.solve_pair(&d, &SolverOptions::default()).unwrap();
        let solution = certify_pair(&d, found, TOLERANCE).expect("certified");
        assert!(d.interior().iter().all(|&a| solution.contact()[a]), "the load closes the gap everywhere");
        // Vertices near the tip that are left out pass through by less than a rounded displacement, but not by rounding.
        let near = |a: usize| mesh.points()[a][0].hypot(mesh.points()[a][1]) < TIP;
        let active: Vec<bool> = d.interior().iter().map(|&a| !near(a)).collect();
        let mut half = gap_half(&d, &Decoupled::new(&d)).unwrap();
        let gap = half.solve(&active).unwrap();
        assert!(half.wrong(&active, &gap, SLIGHT * d.scales().displacement).is_empty());
        assert!(!half.wrong(&active, &gap, 0.0).is_empty());
        let cut = settle(&d, active, &limits(1)).unwrap();
        let statistics = Statistics::of("cut", cut.status);
        let cut = Candidate { displacement: cut.displacement, multiplier: cut.multiplier, statistics };
        assert!(certify_pair(&d, cut, TOLERANCE).is_err(), "it is no solution");
    }
}
