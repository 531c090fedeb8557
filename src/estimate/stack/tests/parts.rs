//! The parts of the bound one by one.

use super::{bound, posed, solve};
use crate::discretization::{IntegrationRule, StackDiscretization};
use crate::estimate::stack::rest;
use crate::estimate::{DataWarning, ErrorBound, NoBound};
use crate::mesh::samples::{irregular, square, square_without};
use crate::mesh::{Mesh, Pattern, rectangle};
use crate::problem::{ContactProblem, Field, Function, Membrane};

/// Rounding of sums over a few hundred triangles, relative.
const ROUNDING: f64 = 1e-9;

/// The paper's pair as a stack has the parts of the pair's bound; only how they are put together is sharper.
#[test]
fn of_the_pair_they_are_those_of_its_own_bound() {
    let load = Function::from_fn(|x, y| -15.0 + 4.0 * x * y);
    let problem = ContactProblem::pair([1.0, 3.0], [load, 10.0.into()], 0.1).unwrap();
    let mesh = irregular(10);
    let d = posed(&problem, &mesh);
    let solution = solve(&d);
    let of_pair = crate::discretization::PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let displacement: [Vec<f64>; 2] = solution.displacement().clone().try_into().unwrap();
    let expected = ErrorBound::new(&problem, None, &of_pair, &displacement).unwrap();
    let found = bound(&d, &solution);
    for (found, expected) in [
        (found.parts.flux, expected.parts.flux),
        (found.parts.oscillation, expected.parts.oscillation),
        (found.parts.contact, expected.parts.contact),
        (found.energy_norm, expected.energy_norm),
    ] {
        assert!((found / expected - 1.0).abs() < ROUNDING, "{found} {expected}");
        assert!(expected > 0.0);
    }
    assert!(found.total < expected.total && found.total > 0.9 * expected.total);
    let off = |(one, other): (&f64, &f64)| (one - other).abs();
    assert!(found.actions[0].iter().zip(&expected.actions[0]).map(off).fold(0.0, f64::max) < 1e-8);
}

/// The norm of a rest of 1 that is dual to the energy, where it is known.
#[test]
fn the_rest_is_bounded_wherever_the_membrane_is_held() {
    let mesh = |cells: usize| rectangle([0.0, 0.0], [1.0, 1.0], [cells, cells], Pattern::Right).unwrap();
    let sheet = || Membrane::new(4.0).load(1.0);
    // (int v)^2 of the torsion of a square is 0.0351443; a strip that is held at one end has 1/3; a foundation of 5, 1/5.
    let cases = [
        ("all around", sheet(), 0.035_144_3 / 4.0, 16.0),
        ("on the left", sheet().free().height_on("left", 0.0), 1.0 / 12.0, 6.0),
        ("a foundation", sheet().free().foundation(5.0), 0.2, 1000.0),
    ];
    for (name, sheet, exact_sq, above) in cases {
        let problem = ContactProblem::stack().membrane(sheet).build().unwrap();
        for cells in [8, 16] {
            let mesh = mesh(cells);
            let d = posed(&problem, &mesh);
            let norm_sq =
                rest::norm_sq(&d, 1, &vec![4.0; mesh.triangles().len()], &vec![1.0; d.dual_area().len()]);
            assert!(norm_sq >= exact_sq, "{name}: {norm_sq} is below {exact_sq}");
            assert!(norm_sq <= above * exact_sq, "{name}: {norm_sq} is far above {exact_sq}");
        }
    }
}

fn no_bound(problem: &ContactProblem, mesh: &Mesh) -> NoBound {
    let d = posed(problem, mesh);
    ErrorBound::of_stack(&d, &solve(&d)).unwrap_err()
}

#[test]
fn where_there_is_no_bound_the_reason_is_said() {
    let sheet = || Membrane::new(1.0).load(-5.0);
    let one = |sheet: Membrane| ContactProblem::obstacle(sheet, -1.0).unwrap();
    let soft = one(sheet().foundation(Function::from_fn(|x, _| x)));
    assert_eq!(no_bound(&soft, &square(4)), NoBound::VaryingFoundation { membrane: 1 });
    // Two holes touch; held at the left only, the membrane is free around them.
    let mesh = square_without(4, |i, j| i == j && (i == 1 || i == 2));
    let mesh = mesh.with_curve("left", |[x, _]| x == 0.0).unwrap();
    let around_holes = one(sheet().free().height_on("left", 0.0));
    let found = no_bound(&around_holes, &mesh);
    assert!(
        matches!(found, NoBound::MeetInAVertex { membrane: 1, vertex } if mesh.points()[vertex] == [0.5; 2]),
        "{found}"
    );
    let d = StackDiscretization::by_rule(&one(sheet()), square(4), IntegrationRule::Vertices).unwrap();
    assert_eq!(ErrorBound::of_stack(&d, &solve(&d)).unwrap_err(), NoBound::VertexRule);
    let other = posed(&one(sheet()), &square(5));
    assert_eq!(ErrorBound::of_stack(&other, &solve(&d)).unwrap_err(), NoBound::OtherMesh);
    let hidden = Function::from_fn(|x, _| if x == 0.125 { f64::NAN } else { 1.0 + x });
    assert!(matches!(no_bound(&one(Membrane::new(Field::from(hidden))), &square(4)), NoBound::Data(_)));
    // And the negative test: where all is well, there is one.
    let d = posed(&one(sheet().foundation(Field::PerTriangle(vec![2.0; 32].into()))), &square(4));
    assert!(bound(&d, &solve(&d)).total > 0.0);
}

/// A line load that varies along an edge oscillates; a constant one does not.
#[test]
fn varying_line_loads_oscillate() {
    let oscillation = |traction: Function| {
        let sheet = Membrane::new(1.0).traction_on("right", traction);
        let problem = ContactProblem::stack().membrane(sheet).build().unwrap();
        let d = posed(&problem, &rectangle([0.0, 0.0], [1.0, 1.0], [6, 6], Pattern::Right).unwrap());
        bound(&d, &solve(&d)).parts.oscillation
    };
    assert_eq!(oscillation(3.0.into()), 0.0);
    let slope = oscillation(Function::from_fn(|_, y| 10.0 * y));
    assert!(slope > 0.0 && (oscillation(Function::from_fn(|_, y| 20.0 * y)) / slope - 2.0).abs() < ROUNDING);
}

/// A height that is not affine between two vertices is named; one that is, or that is known at vertices only, is not.
#[test]
fn heights_that_bend_are_named() {
    let warnings = |height: Field| {
        let problem = ContactProblem::stack().membrane(Membrane::new(1.0).load(-1.0).height(height));
        let d = posed(&problem.build().unwrap(), &square(4));
        bound(&d, &solve(&d)).warnings
    };
    let bent = Function::from_fn(|x, y| x * x + y);
    assert_eq!(warnings(bent.into()), [DataWarning::BentHeight { membrane: 1 }]);
    assert_eq!(warnings(Function::from_fn(|x, y| 1.0 + 2.0 * x - y).into()), []);
    assert_eq!(warnings(Field::PerVertex((0..25).map(f64::from).collect())), []);
}
