//! Published values of obstacle problems; section 7 of the notes on stacks. All rest on right triangles, with tensions and loads taken at
//! the vertices.

use std::f64::consts::PI;

use super::exact::{distance, exact};
use super::{solve_by, solvers};
use crate::action::StackSolution;
use crate::discretization::{IntegrationRule, StackDiscretization};
use crate::geometry::Interface;
use crate::mesh::{Mesh, Pattern, rectangle};
use crate::numeric::largest;
use crate::problem::{ContactProblem, Function, Membrane, StackCase};
use crate::solver::Auto;

fn grid(lower: [f64; 2], upper: [f64; 2], cells: [usize; 2]) -> Mesh {
    rectangle(lower, upper, cells, Pattern::Right).unwrap()
}

fn by_vertices(problem: &ContactProblem, mesh: &Mesh) -> StackDiscretization {
    StackDiscretization::by_rule(problem, mesh.clone(), IntegrationRule::Vertices).unwrap()
}

fn solved(problem: &ContactProblem, mesh: &Mesh) -> StackSolution {
    solve_by(&mut Auto, &by_vertices(problem, mesh))
}

/// Whether a number has the printed digits.
fn is_printed(found: f64, printed: f64, decimals: i32) -> bool {
    (found - printed).abs() <= 0.5000001 * 10f64.powi(-decimals)
}

/// Elastic-plastic torsion of a square bar (MINPACK-2 DEPT): the stress function under the distance from the boundary.
fn torsion(load: f64) -> ContactProblem {
    let distance = Function::from_fn(|x: f64, y: f64| x.min(1.0 - x).min(y).min(1.0 - y));
    ContactProblem::stack().membrane(Membrane::new(1.0).load(load)).ceiling(distance).build().unwrap()
}

/// CUTEst TORSIONA to TORSIONF: `2 Q - 1` cells.
#[test]
fn elastic_plastic_torsion() {
    type Row = (usize, f64, i32);
    let tables: [(f64, &[Row]); 3] = [
        (5.0, &[(2, -0.30864, 5), (5, -0.4057, 4), (11, -0.41611, 5), (16, -0.4174, 4), (37, -0.4183, 4)]),
        (10.0, &[(2, -1.037, 3), (37, -1.2042, 4)]),
        (20.0, &[(2, -2.5185, 4), (37, -2.8502, 4)]),
    ];
    for (load, rows) in tables {
        for &(q, energy, decimals) in rows {
            let mesh = grid([0.0, 0.0], [1.0, 1.0], [2 * q - 1; 2]);
            let found = solved(&torsion(load), &mesh).energy();
            assert!(is_printed(found, energy, decimals), "load {load}, Q = {q}: {found}");
        }
    }
    // COPS 3: 50 x 50 unknowns; the digits behind those that are printed are cut off.
    let found = solved(&torsion(5.0), &grid([0.0, 0.0], [1.0, 1.0], [51; 2])).energy();
    assert_eq!((found * 1e6).trunc(), -418_087.0, "{found}");
}

/// PETSc TAO eptorsion1 prints the energy of the bar without plasticity.
#[test]
fn elastic_torsion() {
    let problem = ContactProblem::stack().membrane(Membrane::new(1.0).load(5.0)).build().unwrap();
    let solution = solved(&problem, &grid([0.0, 0.0], [1.0, 1.0], [11; 2]));
    assert!(is_printed(solution.energy(), -0.427745, 6), "{}", solution.energy());
    assert!(solution.gaps().is_empty());
}

/// Pressure in a journal bearing of eccentricity `e` (MINPACK-2 DPJB).
fn bearing(e: f64) -> ContactProblem {
    let tension = Function::from_fn(move |x, _| (1.0 + e * x.cos()).powi(3));
    let load = Function::from_fn(move |x, _| e * x.sin());
    ContactProblem::obstacle(Membrane::new(tension).load(load), 0.0).unwrap()
}

/// CUTEst JNLBRNG1 and JNLBRNG2, PETSc TAO jbearing2. The comment in the file of JNLBRNG2 is ten times too small.
#[test]
fn journal_bearing() {
    let cases: [(f64, [usize; 2], f64, i32); 9] = [
        (0.1, [3, 3], -0.22474, 5),
        (0.1, [9, 9], -0.17896, 5),
        (0.1, [22, 22], -0.18005, 5),
        (0.1, [74, 74], -0.18055, 5),
        (0.5, [3, 3], -4.76402, 5),
        (0.5, [31, 31], -4.12487, 5),
        (0.1, [9, 13], -0.183437, 6),
        (0.9, [11, 17], -15.607, 3),
        (0.99, [51, 51], -60.1509, 4),
    ];
    for (e, cells, energy, decimals) in cases {
        let solution = solved(&bearing(e), &grid([0.0, 0.0], [2.0 * PI, 20.0], cells));
        assert!(is_printed(solution.energy(), energy, decimals), "{e} {cells:?}: {}", solution.energy());
    }
}

/// p4pdes obstacle.c and PETSc snes ex9: average and largest errors, and how many vertices inside are in contact.
#[test]
fn membrane_over_a_ball() {
    let exact = exact(StackCase::Ball);
    let problem = exact.problem().unwrap();
    let rows =
        [(4, 4.531e-2, 1.635e-1, None), (8, 3.076e-3, 1.334e-2, Some(9)), (16, 2.707e-3, 1.428e-2, Some(29))];
    for (cells, average, worst, active) in rows {
        let mesh = grid([-2.0, -2.0], [2.0, 2.0], [cells; 2]);
        let d = by_vertices(&problem, &mesh);
        for (name, mut solver) in solvers() {
            let solution = solve_by(&mut *solver, &d);
            let errors: Vec<f64> = mesh
                .points()
                .iter()
                .zip(&solution.displacement()[0])
                .map(|(&[x, y], u)| (u - exact.u(1, x, y)).abs())
                .collect();
            let mean = errors.iter().sum::<f64>() / errors.len() as f64;
            assert!((mean / average - 1.0).abs() < 1e-3, "{name}, {cells}: {mean:e}");
            assert!((largest(errors) / worst - 1.0).abs() < 1e-3, "{name}, {cells}");
            if let Some(active) = active {
                assert_eq!(solution.gap(1).unwrap().contact_vertices(), active, "{name}, {cells}");
            }
        }
    }
}

/// The contact radius and the displacement over the ball converge.
#[test]
fn contact_with_the_ball_converges() {
    let exact = exact(StackCase::Ball);
    let Some(Interface::Circle { radius, .. }) = exact.rim(1) else { panic!("the rim is a circle") };
    let errors = [16, 32, 64].map(|cells| {
        let mesh = grid([-2.0, -2.0], [2.0, 2.0], [cells; 2]);
        let d = StackDiscretization::new(&exact.problem().unwrap(), mesh.clone()).unwrap();
        let solution = solve_by(&mut Auto, &d);
        let found = (solution.gap(1).unwrap().contact_area / PI).sqrt();
        (distance(&mesh, &solution, &exact), (found - radius).abs())
    });
    let rate = (errors[0].0 / errors[2].0).log2() / 2.0;
    assert!(rate > 1.5, "{errors:?}");
    // The cells at the rim are half the mesh size wide, 1/32.
    assert!(errors[2].1 < 1.0 / 32.0 && errors[2].1 < 0.5 * errors[0].1, "{errors:?}");
}

/// Seepage through a rectangular dam (Brandt, Cryer, SIAM J. Sci. Stat. Comput. 4 (1983), Table 4.1): nodal values on 4 x 6 cells, and
/// how far above the lower water the dam is wet, on 128 x 192.
#[test]
fn seepage_through_a_dam() {
    let (a, y1, y2) = (16.0, 24.0, 4.0);
    let pressure = move |x: f64, y: f64| {
        let head = |level: f64| 0.5 * (level - y).max(0.0).powi(2);
        if x == 0.0 {
            head(y1)
        } else if x == a {
            head(y2)
        } else if y == 0.0 {
            0.5 * (y1 * y1 + (y2 * y2 - y1 * y1) * x / a)
        } else {
            0.0
        }
    };
    let sheet = Membrane::new(1.0).load(-1.0).height(Function::from_fn(pressure));
    let problem = ContactProblem::obstacle(sheet, 0.0).unwrap();
    let coarse = solved(&problem, &grid([0.0, 0.0], [a, y1], [4, 6]));
    for printed in [2.53716015237691, 18.148640609503] {
        assert!(coarse.displacement()[0].iter().any(|u| (u - printed).abs() < 1e-10), "{printed}");
    }
    let mesh = grid([0.0, 0.0], [a, y1], [128, 192]);
    let fine = solved(&problem, &mesh);
    let wet = |&(&[x, _], &u): &(&[f64; 2], &f64)| x == a - a / 128.0 && u > 1e-6;
    let heights = mesh.points().iter().zip(&fine.displacement()[0]).filter(wet).map(|(point, _)| point[1]);
    assert_eq!(heights.fold(0.0, f64::max) - y2, 8.875);
}

/// deal.II step-41: a floor in steps; the tutorial counts 5,399 vertices in contact with bilinear elements.
#[test]
fn floor_in_steps() {
    let floor = |x: f64, _: f64| {
        if x < -0.5 {
            -0.2
        } else if x < 0.0 {
            -0.4
        } else if x < 0.5 {
            -0.6
        } else {
            -0.8
        }
    };
    let problem = ContactProblem::obstacle(Membrane::new(1.0).load(-10.0), Function::from_fn(floor)).unwrap();
    let solution = solved(&problem, &grid([-1.0, -1.0], [1.0, 1.0], [128; 2]));
    assert_eq!(solution.gap(1).unwrap().contact_vertices(), 5389);
}
