//! Norms of solutions of the exact cases.

use std::collections::BTreeMap;

use super::norms::{Fields, cut_rule};
use super::*;
use crate::action::{PairSolution, certify_pair};
use crate::discretization::{Displacement, PairDiscretization};
use crate::fem::CutRule;
use crate::mesh::samples::irregular;
use crate::mesh::{Mesh, Pattern, disk, l_shape, rectangle};
use crate::numeric::largest;
use crate::problem::{Case, ContactProblem, Domain, ExactSolution};
use crate::solver::{ActiveSet, ContactSolver, SolverOptions};

pub(super) fn exact(case: Case, parameters: &[(&str, f64)]) -> ExactSolution {
    let parameters: BTreeMap<_, _> =
        parameters.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
    case.solution(&parameters).unwrap()
}

pub(super) fn mesh(domain: &Domain, cells: usize) -> Mesh {
    match *domain {
        Domain::Rectangle { lower, upper } => rectangle(lower, upper, [cells; 2], Pattern::Right),
        Domain::LShape { half_width } => l_shape(half_width, cells, Pattern::Right),
        Domain::Disk { centre, radius } => disk(centre, radius, cells),
        Domain::Polygon { .. } => unreachable!("no case is posed on one"),
    }
    .unwrap()
}

pub(super) fn problem(exact: &ExactSolution) -> ContactProblem {
    let [mu1, mu2] = exact.tension();
    let [f1, f2] = exact.load_functions();
    ContactProblem::builder().tension(mu1, mu2).load(f1, f2).height(exact.height_function()).build().unwrap()
}

pub(super) fn solve(d: &PairDiscretization) -> PairSolution {
    certify_pair(d, ActiveSet.solve_pair(d, &SolverOptions::default()).unwrap(), 1e-8).unwrap()
}

fn measure(exact: &ExactSolution, mesh: &Mesh) -> ErrorNorms {
    let problem = problem(exact);
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    ErrorNorms::new(&d, &solve(&d), exact).unwrap()
}

/// Integrals of some thousand terms of size one.
const ROUNDING: f64 = 1e-12;

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < ROUNDING
}

/// With `c = 0` the lower membrane rests at zero and the upper one is an interpolated parabola: over each cell of width
/// `h`, `int (A0 (2 s - h))^2 = A0^2 h^3 / 3` and `int (A0 s (h - s))^2 = A0^2 h^5 / 30`. The action is `q`, `q/2`, `0`
/// left of, on and right of the free boundary, and 0 in the cells of the boundary, of which half lies left of it.
#[test]
fn the_strip_has_the_errors_that_are_known_in_closed_form() {
    let (mu1, mu2, curvature) = (4.0, 3.0, 0.7);
    let exact = exact(Case::Strip, &[("mu1", mu1), ("mu2", mu2), ("A0", curvature)]);
    let q = 2.0 * mu1 * mu2 / (mu1 + mu2) * curvature;
    for cells in [4, 8] {
        let (n, h) = (f64::from(cells), 1.0 / f64::from(cells));
        let norms = measure(&exact, &mesh(&exact.domain(), cells as usize));
        let h1 = curvature * h * (0.5f64 / 3.0).sqrt();
        assert!(close(norms.h1[0], h1) && close(norms.energy, mu1.sqrt() * h1), "{norms:?}");
        assert!(close(norms.l2[0], curvature * h * h * (0.5f64 / 30.0).sqrt()), "{norms:?}");
        assert!(
            norms.h1[1] < ROUNDING && norms.l2[1] < ROUNDING && norms.nodal_max[0] < ROUNDING,
            "{norms:?}"
        );
        let largest = curvature * h * h / 4.0;
        assert!(norms.max[0] <= largest && norms.max[0] > 0.9 * largest, "{norms:?}");
        let on_line = (n - 1.0) * h * h * q * q / 4.0;
        let at_boundary = 0.5 * (1.0 - (n - 1.0).powi(2) * h * h) * q * q;
        assert!(close(norms.lambda_l2, (on_line + at_boundary).sqrt()), "{norms:?}");
        assert!(close(norms.contact.contact, 0.5) && close(norms.contact.pressed, 0.5), "{norms:?}");
        assert!(close(norms.contact.error(), 0.5 - (n - 1.0) * (n / 2.0) * h * h), "{norms:?}");
        assert!(norms.quadrature < ROUNDING && norms.lambda_dual.quadrature < ROUNDING, "nothing is cut");
        // The negative test: another curvature has other errors.
        assert!(!close(norms.h1[0], h1 / curvature));
    }
}

#[test]
fn an_affine_solution_has_no_error() {
    let errors = |c: f64| {
        let exact = exact(Case::NoContact, &[("c", c), ("k", 0.0)]);
        measure(&exact, &irregular(5))
    };
    let none = errors(0.0);
    let figures = |norms: &ErrorNorms| [norms.energy, norms.l2[0], norms.l2[1], norms.max[0], norms.max[1]];
    assert!(figures(&none).iter().all(|&figure| figure < ROUNDING), "{none:?}");
    assert!(figures(&errors(0.1)).iter().all(|&figure| figure > 1e-4));
    assert_eq!([none.lambda_l2, none.lambda_dual.value, none.contact.error()], [0.0; 3]);
}

/// Rates per halving over two halvings on coarse meshes, against those of fine ones: at the corner of an L-shape the H1
/// rate falls towards 2/3 only later.
const COARSE: f64 = 0.2;

/// Rates of H1, L2, lambda in L2 and in H^-1, and the largest energy error at 32 cells.
#[test]
fn the_cases_converge_at_their_rates() {
    let expected = [
        (Case::Circle, [1.0, 2.0, 0.5, 1.5], 0.10),
        (Case::Strip, [1.0, 2.0, 0.5, 1.5], 0.013),
        (Case::Annulus, [1.0, 2.0, 1.0, 2.0], 0.22),
        (Case::LShape, [0.92, 1.7, 0.5, 1.5], 0.17),
        (Case::LShapeFree, [0.8, 1.5, 0.0, 0.0], 0.14),
        (Case::Disk, [1.0, 2.0, 0.5, 1.5], 0.12),
        (Case::NoContact, [1.0, 2.0, 0.0, 0.0], 0.09),
    ];
    for (case, rates, largest) in expected {
        let exact = exact(case, &[]);
        let [coarse, middle, fine] = [8, 16, 32].map(|cells| measure(&exact, &mesh(&exact.domain(), cells)));
        let figures = |e: &ErrorNorms| [e.energy, e.l2[0].hypot(e.l2[1]), e.lambda_l2, e.lambda_dual.value];
        let found = rates_between(figures(&coarse), figures(&fine));
        let agrees = |found: &[f64; 4]| (0..4).all(|k| (found[k] - rates[k]).abs() < COARSE);
        assert!(agrees(&found), "{case}: {found:?}");
        assert!(fine.energy < largest && fine.energy > 0.9 * largest, "{case}: {}", fine.energy);
        assert!(fine.quadrature < 1e-5 && fine.lambda_dual.estimate() <= 0.12 * fine.lambda_dual.value);
        // The negative test: of two halvings, one taken for two.
        assert!(!agrees(&rates_between(figures(&coarse), figures(&middle))), "{case}");
    }
}

/// Rates per halving of `h`, two halvings apart; zero where there is no error.
fn rates_between(coarse: [f64; 4], fine: [f64; 4]) -> [f64; 4] {
    [0, 1, 2, 3].map(|k| if fine[k] > 0.0 { (coarse[k] / fine[k]).log2() / 2.0 } else { 0.0 })
}

#[test]
fn an_action_of_the_wrong_sign_or_displacements_exchanged_do_not_converge() {
    let exact = exact(Case::Circle, &[]);
    let problem = problem(&exact);
    let norms = [16, 32].map(|cells| {
        let mesh = mesh(&exact.domain(), cells);
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let solution = solve(&d);
        let [u1, u2] = solution.displacement().clone();
        let flipped: Vec<f64> = solution.lambda().iter().map(|lambda| -lambda).collect();
        let rule = cut_rule(&exact, 3);
        let measure = |displacement: Displacement, lambda: &[f64]| {
            let fields = Fields { displacement: &displacement, lambda };
            ErrorNorms::of_fields(&d, fields, solution.contact_area(), &rule, &exact).unwrap()
        };
        [measure([u1.clone(), u2.clone()], solution.lambda()), measure([u2, u1], &flipped)]
    });
    let [[coarse, coarse_wrong], [fine, fine_wrong]] = norms;
    let falls = |figure: fn(&ErrorNorms) -> f64, coarse: &ErrorNorms, fine: &ErrorNorms| {
        figure(fine) < 0.8 * figure(coarse)
    };
    let figures: [fn(&ErrorNorms) -> f64; 7] = [
        |e| e.h1[0],
        |e| e.energy,
        |e| e.l2[1],
        |e| e.max[0],
        |e| e.nodal_max[1],
        |e| e.lambda_l2,
        |e| e.lambda_dual.value,
    ];
    for (k, figure) in figures.into_iter().enumerate() {
        assert!(falls(figure, &coarse, &fine), "figure {k}");
        assert!(!falls(figure, &coarse_wrong, &fine_wrong), "figure {k} does not see it");
    }
}

#[test]
fn the_quadrature_resolves_the_free_boundary_and_says_how_well() {
    let exact = exact(Case::Circle, &[]);
    let mesh = irregular(8);
    let problem = problem(&exact);
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let solution = solve(&d);
    let measure = |rule: &CutRule| {
        let fields = Fields { displacement: solution.displacement(), lambda: solution.lambda() };
        ErrorNorms::of_fields(&d, fields, solution.contact_area(), rule, &exact).unwrap()
    };
    let [usual, deep] = [4, 7].map(|depth| measure(&cut_rule(&exact, depth)));
    // Rules of a case without curves cut nothing.
    let no_curves = Case::NoContact.solution(&BTreeMap::new()).unwrap();
    let unresolved = measure(&cut_rule(&no_curves, 3));
    let figures = |e: &ErrorNorms| [e.lambda_l2, e.h1[0], e.contact.pressed];
    let change = |e: &ErrorNorms| {
        let pairs = figures(e).into_iter().zip(figures(&deep));
        largest(pairs.map(|(figure, deep)| (figure - deep).abs() / deep))
    };
    assert!(change(&usual) < usual.quadrature && usual.quadrature < 1e-4, "{usual:?}");
    assert!(deep.quadrature < usual.quadrature / 16.0, "{deep:?}");
    assert!(change(&unresolved) > 2.0 * usual.quadrature, "{unresolved:?}");
    assert_eq!(unresolved.quadrature, 0.0, "it cannot know");
    let disk = std::f64::consts::PI * 0.09;
    assert!((deep.contact.pressed - disk).abs() < 1e-5 && (unresolved.contact.pressed - disk).abs() > 5e-5);
}

#[test]
fn the_error_of_the_contact_area_leaves_out_the_biactive_set() {
    let error = |discrete: f64| ContactAreas { discrete, pressed: 1.0, contact: 2.0 }.error();
    assert_eq!([0.5, 1.0, 1.5, 2.0, 2.25].map(error), [0.5, 0.0, 0.0, 0.0, 0.25]);
    let exact = exact(Case::Annulus, &[]);
    let contact = measure(&exact, &mesh(&exact.domain(), 16)).contact;
    let [inner, outer] = [0.25f64, 0.35].map(|radius| std::f64::consts::PI * radius * radius);
    assert!((contact.pressed - inner).abs() < 1e-4 && (contact.contact - outer).abs() < 1e-4, "{contact:?}");
}

#[test]
fn a_solution_of_another_mesh_is_refused() {
    let exact = exact(Case::Circle, &[]);
    let problem = problem(&exact);
    let meshes = [4, 5].map(|cells| mesh(&exact.domain(), cells));
    let [d, other] = [0, 1].map(|k| PairDiscretization::new(&problem, meshes[k].clone()).unwrap());
    let error = ErrorNorms::new(&other, &solve(&d), &exact).unwrap_err();
    assert_eq!(error, MeasureError::OtherMesh { values: 25, vertices: 36 });
    assert!(error.to_string().contains("25 values") && ErrorNorms::new(&d, &solve(&d), &exact).is_ok());
}

#[test]
fn a_mesh_without_unknowns_can_be_measured() {
    let exact = exact(Case::FullContact, &[]);
    let norms = measure(&exact, &mesh(&exact.domain(), 1));
    assert!(norms.lambda_l2 > 0.0 && norms.lambda_dual.value > norms.lambda_dual.coarser);
}
