//! Stacks with known solutions, by every solver; section 6 of the notes on stacks.

use std::f64::consts::PI;

use super::{TOLERANCE, posed, solve_by, solvers};
use crate::action::{GapSolution, StackSolution, certify_pair};
use crate::discretization::{IntegrationRule, PairDiscretization, StackDiscretization};
use crate::mesh::samples::irregular;
use crate::mesh::{Mesh, Pattern, rectangle};
use crate::numeric::largest;
use crate::problem::{ContactProblem, Field, Function, Membrane};
use crate::solver::{ActiveSet, Auto, ContactSolver, SolverOptions};

/// Rounding of displacements of size one on meshes of some thousand triangles.
const ROUNDING: f64 = 1e-12;

/// `(0, 1) x (0, 1/2)` in right triangles; `x = k/4` are mesh lines.
fn strip_mesh(cells: usize) -> Mesh {
    rectangle([0.0, 0.0], [1.0, 0.5], [2 * cells, cells], Pattern::Right).unwrap()
}

/// A membrane that is fixed on the left and on the right of a strip, and free on its long sides.
fn across(membrane: Membrane, [left, right]: [f64; 2]) -> Membrane {
    membrane.free().height_on("left", left).height_on("right", right)
}

/// The largest distance of the displacement of membrane `i` from `u(x)`.
fn distance(mesh: &Mesh, solution: &StackSolution, i: usize, u: impl Fn(f64) -> f64) -> f64 {
    let found = &solution.displacement()[i - 1];
    largest(mesh.points().iter().zip(found).map(|(&[x, _], found)| (found - u(x)).abs()))
}

/// The largest distance of the action in gap `k` from `lambda(x)`, where that is not `None`.
fn action_distance(mesh: &Mesh, s: &StackSolution, k: usize, lambda: impl Fn(f64) -> Option<f64>) -> f64 {
    let found = &s.gap(k).unwrap().lambda;
    let points = mesh.points().iter().zip(found);
    largest(points.filter_map(|(&[x, _], found)| Some((found - lambda(x)?).abs())))
}

/// `value` on either side of a line, the mean on it.
fn step(x: f64, at: f64, [below, above]: [f64; 2]) -> f64 {
    if (x - at).abs() < 1e-9 {
        0.5 * (below + above)
    } else if x < at {
        below
    } else {
        above
    }
}

/// Continuation of a parabola `c0 + c1 x + c2 x^2` beyond `at` with the curvature `k`.
#[derive(Clone, Copy)]
struct Parabola([f64; 3]);

impl Parabola {
    fn at(&self, x: f64) -> f64 {
        self.0[0] + x * (self.0[1] + x * self.0[2])
    }

    fn continued(&self, at: f64, curvature: f64) -> Self {
        let slope = self.0[1] + 2.0 * self.0[2] * at;
        let c1 = slope - curvature * at;
        Self([self.at(at) - at * (c1 + 0.5 * curvature * at), c1, 0.5 * curvature])
    }
}

/// S3: three membranes in a strip, nodally exact, contact of all up to 1/4 and of the upper two up to 1/2.
#[test]
fn three_membranes_in_a_strip_are_nodally_exact() {
    let (mu, f) = ([1.0, 2.0, 3.0], [-8.0, 2.0, 12.0]);
    let (k_a, k_b) = (-(f[0] + f[1] + f[2]) / 6.0, -(f[0] + f[1]) / 3.0);
    let together = Parabola([0.2, 0.3, 0.5 * k_a]);
    let upper_two = together.continued(0.25, k_b);
    let curves = [
        upper_two.continued(0.5, -f[0] / mu[0]),
        upper_two.continued(0.5, -f[1] / mu[1]),
        together.continued(0.25, -f[2] / mu[2]),
    ];
    let exact = move |i: usize, x: f64| match i {
        1 | 2 if x <= 0.5 => if x <= 0.25 { together } else { upper_two }.at(x),
        3 if x <= 0.25 => together.at(x),
        _ => curves[i - 1].at(x),
    };
    let mut stack = ContactProblem::stack();
    for i in 1..=3 {
        stack =
            stack.membrane(across(Membrane::new(mu[i - 1]).load(f[i - 1]), [0.0, 1.0].map(|x| exact(i, x))));
    }
    let mesh = strip_mesh(8);
    let d = posed(&stack.build().unwrap(), &mesh);
    for (name, mut solver) in solvers() {
        let solution = solve_by(&mut *solver, &d);
        for i in 1..=3 {
            let off = distance(&mesh, &solution, i, |x| exact(i, x));
            assert!(off < ROUNDING, "{name}: membrane {i} is off by {off:e}");
            assert!(distance(&mesh, &solution, i, |x| exact(4 - i, x) + x) > 1e-3, "no other function");
        }
        // Held vertices have no row, so lambda is zero there.
        let inside = |x: f64, lambda: f64| (0.0 < x && x < 1.0).then_some(lambda);
        let first = |x: f64| {
            inside(
                x,
                if x < 0.375 {
                    step(x, 0.25, [-k_a - f[0], -k_b - f[0]])
                } else {
                    step(x, 0.5, [-k_b - f[0], 0.0])
                },
            )
        };
        let second = |x: f64| inside(x, step(x, 0.25, [f[2] + 3.0 * k_a, 0.0]));
        for (k, off) in [
            (1, action_distance(&mesh, &solution, 1, first)),
            (2, action_distance(&mesh, &solution, 2, second)),
        ] {
            assert!(off < 1e4 * ROUNDING, "{name}: the action in gap {k} is off by {off:e}");
        }
        assert!(solution.imbalance() < ROUNDING);
    }
}

/// S7: the tension of the upper membrane jumps inside the contact zone, which carries a line action of 0.45 there.
#[test]
fn a_jump_of_the_tension_in_contact_carries_a_line_action() {
    let mesh = strip_mesh(8).with_region("right part", |[x, _]| x > 0.25).unwrap();
    let slope = |x: f64| -2.0 + 2.0 * x;
    // (mu1 + mu2) u' = slope; beyond 1/2 the membranes are apart.
    let together = |x: f64| -> f64 {
        let integral = |x: f64| -2.0 * x + x * x;
        if x <= 0.25 {
            integral(x) / 2.0
        } else {
            integral(0.25) / 2.0 + (integral(x) - integral(0.25)) / 5.0
        }
    };
    let apart = |mu: f64, f: f64, x: f64| {
        let s = x - 0.5;
        together(0.5) + slope(0.5) / 5.0 * s - f / mu * s * s / 2.0
    };
    let u = move |i: usize, x: f64| match (x <= 0.5, i) {
        (true, _) => together(x),
        (false, 1) => apart(4.0, -4.0, x),
        (false, _) => apart(1.0, 2.0, x),
    };
    let tension = Field::by_region([("right part", 4.0)]).elsewhere(1.0);
    let problem = ContactProblem::stack()
        .membrane(across(Membrane::new(tension).load(-4.0), [u(1, 0.0), u(1, 1.0)]))
        .membrane(across(Membrane::new(1.0).load(2.0), [u(2, 0.0), u(2, 1.0)]))
        .build()
        .unwrap();
    let d = posed(&problem, &mesh);
    for (name, mut solver) in solvers() {
        let solution = solve_by(&mut *solver, &d);
        for i in 1..=2 {
            let off = distance(&mesh, &solution, i, |x| u(i, x));
            assert!(off < ROUNDING, "{name}: membrane {i} is off by {off:e}");
        }
        let gap = solution.gap(1).unwrap();
        for (a, &[x, y]) in mesh.points().iter().enumerate().filter(|(_, p)| (p[0] - 0.25).abs() < 1e-9) {
            let half_lengths = if y == 0.0 || y == 0.5 { 1.0 / 32.0 } else { 1.0 / 16.0 };
            let expected = 0.5 * (3.0 + 2.4) * d.dual_area()[a] + 0.45 * half_lengths;
            // On the edges y = 0 and y = 1/2 the two sides of the line have not the same area.
            let off = (gap.force[a] - expected).abs();
            assert!(off < if y == 0.0 || y == 0.5 { 1e-3 } else { ROUNDING }, "{name}: ({x}, {y}): {off:e}");
        }
        // The line action as a density, away from the ends of the line.
        let on_line = |(_, [x, y]): &(usize, &[f64; 2])| (x - 0.25).abs() < 1e-9 && *y > 0.1 && *y < 0.4;
        for (a, _) in mesh.points().iter().enumerate().filter(on_line) {
            assert!((gap.line_density[a] - 0.45).abs() < 1e-9, "{name}: {}", gap.line_density[a]);
        }
    }
}

/// S8: two membranes over a floor at zero.
#[test]
fn two_membranes_over_a_floor_are_nodally_exact() {
    let (x2, x1) = (0.25, 0.5);
    let k_b = 7.0 / 3.0;
    let block = Parabola([0.5 * k_b * x2 * x2, -k_b * x2, 0.5 * k_b]);
    let [u1, u2] = [block.continued(x1, 6.0), block.continued(x1, 0.5)];
    let u = move |i: usize, x: f64| match (x, i) {
        (x, _) if x <= x2 => 0.0,
        (x, _) if x <= x1 => block.at(x),
        (x, 1) => u1.at(x),
        (x, _) => u2.at(x),
    };
    let problem = ContactProblem::stack()
        .membrane(across(Membrane::new(1.0).load(-6.0), [0.0, u(1, 1.0)]))
        .membrane(across(Membrane::new(2.0).load(-1.0), [0.0, u(2, 1.0)]))
        .floor(0.0)
        .build()
        .unwrap();
    let mesh = strip_mesh(8);
    let d = posed(&problem, &mesh);
    for (name, mut solver) in solvers() {
        let solution = solve_by(&mut *solver, &d);
        for i in 1..=2 {
            let off = distance(&mesh, &solution, i, |x| u(i, x));
            assert!(off < ROUNDING, "{name}: membrane {i} is off by {off:e}");
        }
        let inside = |x: f64, lambda: f64| (0.0 < x && x < 1.0).then_some(lambda);
        let between = |x: f64| {
            inside(x, if x < 0.375 { step(x, x2, [6.0, 11.0 / 3.0]) } else { step(x, x1, [11.0 / 3.0, 0.0]) })
        };
        let floor = |x: f64| inside(x, step(x, x2, [7.0, 0.0]));
        assert!(action_distance(&mesh, &solution, 1, between) < 1e4 * ROUNDING, "{name}");
        assert!(action_distance(&mesh, &solution, 2, floor) < 1e4 * ROUNDING, "{name}");
    }
}

/// S10: line loads at a free end in contact.
#[test]
fn line_loads_on_a_free_end_in_contact_are_a_line_action() {
    let sheet = |load: f64, traction: f64| {
        Membrane::new(1.0).load(load).free().height_on("left", 0.0).traction_on("right", traction)
    };
    let problem =
        ContactProblem::stack().membrane(sheet(-2.0, -1.0)).membrane(sheet(2.0, 0.0)).build().unwrap();
    let mesh = strip_mesh(8);
    let d = posed(&problem, &mesh);
    for (name, mut solver) in solvers() {
        let solution = solve_by(&mut *solver, &d);
        for i in 1..=2 {
            let off = distance(&mesh, &solution, i, |x| -0.5 * x);
            assert!(off < ROUNDING, "{name}: membrane {i} is off by {off:e}");
        }
        let gap = solution.gap(1).unwrap();
        for (a, &[x, y]) in mesh.points().iter().enumerate().filter(|(_, p)| p[0] > 0.0) {
            let edge = if x < 1.0 {
                0.0
            } else if y == 0.0 || y == 0.5 {
                1.0 / 32.0
            } else {
                1.0 / 16.0
            };
            let off = (gap.force[a] - 2.0 * d.dual_area()[a] - 0.5 * edge).abs();
            assert!(off < ROUNDING, "{name}: ({x}, {y}): {off:e}");
        }
        for (a, _) in
            mesh.points().iter().enumerate().filter(|(_, p)| p[0] == 1.0 && p[1] > 0.1 && p[1] < 0.4)
        {
            assert!((gap.line_density[a] - 0.5).abs() < 1e-9, "{name}: {}", gap.line_density[a]);
        }
        let inside = mesh.points().iter().enumerate().filter(|(_, p)| p[0] < 1.0 && p[1] > 0.1 && p[1] < 0.4);
        assert!(inside.into_iter().all(|(a, _)| gap.line_density[a] == 0.0));
    }
}

/// S9: a foundation and a floor; the lumped foundation is of second order.
#[test]
fn a_foundation_over_a_floor_converges_at_second_order() {
    let (c, q, x0) = (20.0f64, 10.0, 0.25);
    let u = move |x: f64| if x <= x0 { 0.0 } else { q / c * ((c.sqrt() * (x - x0)).cosh() - 1.0) };
    let sheet = across(Membrane::new(1.0).load(-q).foundation(c), [0.0, u(1.0)]);
    let problem = ContactProblem::obstacle(sheet, 0.0).unwrap();
    let errors = [4, 8, 16].map(|cells| {
        let mesh = strip_mesh(cells);
        let solution = solve_by(&mut ActiveSet, &posed(&problem, &mesh));
        distance(&mesh, &solution, 1, u)
    });
    for pair in errors.windows(2) {
        let rate = (pair[0] / pair[1]).log2();
        assert!((1.8..2.2).contains(&rate), "{errors:?}");
    }
}

/// N = 1 over a floor is the gap of a pair.
#[test]
fn one_membrane_over_a_floor_is_the_gap_of_a_pair() {
    let mesh = irregular(12);
    let load = || Function::from_fn(|x, y| -20.0 + 30.0 * (PI * x).sin() * y);
    let pair = ContactProblem::pair(
        [2.0, 2.0],
        [load(), Function::from_fn(move |x, y| 20.0 - 30.0 * (PI * x).sin() * y)],
        0.1,
    )
    .unwrap();
    let d = PairDiscretization::new(&pair, mesh.clone()).unwrap();
    let of_pair =
        certify_pair(&d, ActiveSet.solve_pair(&d, &SolverOptions::default()).unwrap(), TOLERANCE).unwrap();
    // m = mu1 mu2 / (mu1 + mu2) = 1, and m w solves the problem of the load (f1 - f2) / 2 = f1.
    let sheet = Membrane::new(1.0).load(load()).height(0.1);
    let d = posed(&ContactProblem::obstacle(sheet, 0.0).unwrap(), &mesh);
    let contact = of_pair.contact().iter().filter(|&&contact| contact).count();
    assert!(contact > 5);
    for (name, mut solver) in solvers() {
        let solution = solve_by(&mut *solver, &d);
        let gap = solution.gap(1).unwrap();
        let off = largest(gap.gap.iter().zip(of_pair.gap()).map(|(one, other)| (one - other).abs()));
        assert!(off < ROUNDING, "{name}: {off:e}");
        assert_eq!(gap.contact, of_pair.contact(), "{name}");
        let off = largest(gap.lambda.iter().zip(of_pair.lambda()).map(|(one, other)| (one - other).abs()));
        assert!(off < 1e3 * ROUNDING, "{name}: {off:e}");
    }
}

/// A stack of two with a floor out of reach is the pair.
#[test]
fn a_floor_out_of_reach_leaves_the_pair_as_it_is() {
    let mesh = irregular(12);
    let load = Function::from_fn(|x, y| -30.0 * x * (1.0 - y));
    let pair = ContactProblem::pair([1.0, 3.0], [load.clone(), 10.0.into()], 0.05).unwrap();
    let d = PairDiscretization::new(&pair, mesh.clone()).unwrap();
    let of_pair =
        certify_pair(&d, ActiveSet.solve_pair(&d, &SolverOptions::default()).unwrap(), TOLERANCE).unwrap();
    let membranes = [Membrane::new(1.0).load(load).height(0.05), Membrane::new(3.0).load(10.0)];
    let [upper, lower] = membranes;
    let problem = ContactProblem::stack().membrane(upper).membrane(lower).floor(-100.0).build().unwrap();
    assert!(problem.as_pair().is_none());
    let d = posed(&problem, &mesh);
    for (name, mut solver) in solvers() {
        let solution = solve_by(&mut *solver, &d);
        for i in 0..2 {
            let pairs = solution.displacement()[i].iter().zip(&of_pair.displacement()[i]);
            let off = largest(pairs.map(|(one, other)| (one - other).abs()));
            assert!(off < ROUNDING, "{name}: {off:e}");
        }
        assert_eq!(solution.gap(1).unwrap().contact, of_pair.contact());
        assert_eq!(solution.gap(2).unwrap().contact_vertices(), 0);
    }
}

/// S11: a quarter with lines of symmetry is the full model.
#[test]
fn a_quarter_with_lines_of_symmetry_is_the_full_model() {
    let load = || Function::from_fn(|x, y| -40.0 + 25.0 * ((2.0 * PI * x).cos() + (2.0 * PI * y).cos()));
    let problem = |symmetric: bool| {
        let membrane = |mu: f64, height: f64| {
            let whole = Membrane::new(mu).height(height);
            if symmetric { whole.free_on("right").free_on("top") } else { whole }
        };
        let upper = membrane(1.0, 0.2).load(load());
        ContactProblem::stack().membrane(upper).membrane(membrane(2.0, 0.0)).floor(-0.5).build().unwrap()
    };
    let whole = rectangle([0.0, 0.0], [1.0, 1.0], [16, 16], Pattern::Crossed).unwrap();
    let quarter = rectangle([0.0, 0.0], [0.5, 0.5], [8, 8], Pattern::Crossed).unwrap();
    let of_whole = solve_by(&mut ActiveSet, &posed(&problem(false), &whole));
    let of_quarter = solve_by(&mut ActiveSet, &posed(&problem(true), &quarter));
    assert!(of_whole.gap(1).unwrap().contact_vertices() > 50);
    for (a, point) in quarter.points().iter().enumerate() {
        let b = whole.points().iter().position(|other| other == point).expect("a vertex of both");
        for i in 0..2 {
            let off = (of_quarter.displacement()[i][a] - of_whole.displacement()[i][b]).abs();
            assert!(off < 1e-10, "{point:?}: {off:e}");
        }
        for k in 1..=2 {
            let off = (of_quarter.gap(k).unwrap().lambda[a] - of_whole.gap(k).unwrap().lambda[b]).abs();
            // Corners of the quarter are held.
            assert!(off < 1e-9, "{point:?}: {off:e}");
        }
    }
}

/// G1 of the notes, found by an independent program: energy, contact and total actions of three membranes of varying tensions.
#[test]
fn the_reference_values_are_reproduced() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [32, 32], Pattern::Right).unwrap();
    let membranes = [
        (
            Function::from_fn(|x, _| 1.0 + 2.0 * x * x),
            Function::from_fn(|x, y| -12.0 + 18.0 * (2.0 * PI * x).sin() * (PI * y).sin()),
            0.04,
        ),
        (
            Function::from_fn(|_, y| 1.0 + 2.0 * y),
            Function::from_fn(|x, y| 25.0 * (4.0 * PI * x).sin() * (3.0 * PI * y).sin()),
            0.02,
        ),
        (
            Function::from_fn(|x, _| 3.0 - 2.0 * x),
            Function::from_fn(|x, y| 6.0 - 20.0 * (3.0 * PI * x).sin() * (2.0 * PI * y).sin()),
            0.0,
        ),
    ];
    let stack = membranes.into_iter().fold(ContactProblem::stack(), |stack, (mu, f, g)| {
        stack.membrane(Membrane::new(mu).load(f).height(g))
    });
    let problem = stack.build().unwrap();
    let d = StackDiscretization::by_rule(&problem, mesh.clone(), IntegrationRule::Vertices).unwrap();
    for (name, mut solver) in solvers() {
        let solution = solve_by(&mut *solver, &d);
        // To the digits that are given.
        assert!((solution.energy() + 0.201_490_276_169).abs() < 1e-11, "{name}: {}", solution.energy());
        let totals: Vec<f64> = solution.gaps().iter().map(|gap| gap.total_force).collect();
        assert!(
            (totals[0] - 6.982_501_3).abs() < 1e-6 && (totals[1] - 5.476_097_42).abs() < 1e-7,
            "{name}: {totals:?}"
        );
        let contact: Vec<usize> = solution.gaps().iter().map(GapSolution::contact_vertices).collect();
        assert_eq!(contact, [529, 431], "{name}");
    }
    // By quadrature, the energy is another one.
    let solution = solve_by(&mut Auto, &posed(&problem, &mesh));
    assert!((solution.energy() + 0.201_490_276_169).abs() > 1e-5, "{}", solution.energy());
}
