use proptest::prelude::*;

use super::*;
use crate::mesh::samples::{irregular, square, square_without};
use crate::mesh::{Pattern, l_shape, rectangle};
use crate::numeric::largest;
use crate::problem::Function;

/// Rounding of sums over the triangles of small meshes of size one.
const ROUNDING: f64 = 1e-12;

fn problem(f1: impl Into<Function>, f2: impl Into<Function>, g: impl Into<Function>) -> ContactProblem {
    ContactProblem::builder().tension(2.0, 0.5).load(f1, f2).height(g).build().unwrap()
}

fn height() -> Function {
    Function::from_fn(|x, y| 1.0 + x + y * y)
}

#[test]
fn unknowns_are_the_interior_vertices_in_order() {
    let mesh = square_without(5, |i, j| i == 1 && j == 2);
    let d = PairDiscretization::new(&problem(1.0, 1.0, height()), mesh.clone()).unwrap();
    let expected: Vec<usize> = (0..36).filter(|&a| mesh.kind()[a] == VertexKind::Interior).collect();
    assert_eq!(d.interior(), expected);
    assert_eq!(d.interior().len(), 16 - 4);
    for a in 0..36 {
        let [x, y] = mesh.points()[a];
        let on_boundary = mesh.kind()[a] == VertexKind::Boundary;
        assert_eq!(d.height()[a], if on_boundary { 1.0 + x + y * y } else { 0.0 });
    }
}

#[test]
fn k_ii_is_k_on_the_unknowns() {
    let mesh = irregular(5);
    let d = PairDiscretization::new(&problem(1.0, 1.0, 0.0), mesh.clone()).unwrap();
    let (k, k_ii) = (d.stiffness(), d.interior_stiffness());
    assert_eq!(k_ii.shape(), (16, 16));
    for (row, &a) in d.interior().iter().enumerate() {
        for (column, &b) in d.interior().iter().enumerate() {
            assert_eq!(k_ii.get(row, column), k.get(a, b));
        }
    }
    let x: Vec<f64> = (0..16).map(|k| (k as f64).sin()).collect();
    let energy: f64 = k_ii.iter().map(|(value, (a, b))| x[a] * value * x[b]).sum();
    assert!(energy > 0.0, "positive definite");
    assert!(k_ii.nnz() < k.nnz());
}

#[test]
fn principal_submatrices_of_nothing_and_of_everything() {
    let k = stiffness(&square(3));
    assert_eq!(principal_submatrix(&k, &[]).shape(), (0, 0));
    let first = |count: usize| principal_submatrix(&k, &(0..count).collect::<Vec<_>>());
    assert_eq!(first(16), k.to_other_types());
    assert_ne!(first(15), k.to_other_types());
}

#[test]
fn dual_areas_fill_the_domain_and_loads_are_those_of_the_membranes() {
    for mesh in [irregular(6), l_shape(1.0, 3, Pattern::Crossed).unwrap()] {
        let d = PairDiscretization::new(&problem(-3.0, 5.0, 0.0), mesh.clone()).unwrap();
        assert!((d.dual_area().iter().sum::<f64>() - mesh.area()).abs() < ROUNDING);
        assert!(d.dual_area().iter().all(|&area| area > 0.0));
        for (load, f) in d.load().iter().zip([-3.0, 5.0]) {
            let differences = load.iter().zip(d.dual_area()).map(|(load, area)| (load - f * area).abs());
            assert!(largest(differences) < ROUNDING);
        }
    }
    // An inner vertex of right-angled cells has one cell's area, a corner of a square a third or a sixth.
    let mesh = square(2);
    let d = PairDiscretization::new(&problem(0.0, 0.0, 0.0), mesh.clone()).unwrap();
    let expected = [2.0, 3.0, 1.0, 3.0, 6.0, 3.0, 1.0, 3.0, 2.0].map(|triangles| triangles * 0.125 / 3.0);
    assert!(d.dual_area().iter().zip(expected).all(|(found, expected)| (found - expected).abs() < ROUNDING));
}

#[test]
fn vectors_over_vertices_have_zeros_at_unused_ones() {
    let points = [square(3).points(), &[[0.4, 0.4]]].concat();
    let mesh = Mesh::new(points, square(3).triangles().to_vec()).unwrap();
    let d = PairDiscretization::new(&problem(1.0, 1.0, height()), mesh.clone()).unwrap();
    assert_eq!([d.height()[16], d.dual_area()[16], d.load()[0][16], d.load()[1][16]], [0.0; 4]);
    assert_eq!(d.interior().len(), 4);
    assert_eq!(d.extend(&[1.0; 4], |_| 2.0)[16], 0.0);
}

/// `mu K u - F` vanishes where `u` solves `-mu Lap u = f` and P1 elements are exact: `u = x^2` with `f = -2 mu` on
/// right-angled cells.
#[test]
fn imbalance_of_an_exact_solution_is_rounding() {
    let mesh = square(8);
    let d = PairDiscretization::new(&problem(-4.0, -1.0, 0.0), mesh.clone()).unwrap();
    let u: Vec<f64> = mesh.points().iter().map(|&[x, _]| x * x).collect();
    for membrane in 0..2 {
        for (&a, &whole) in d.interior().iter().zip(&d.imbalance(membrane, &u)) {
            let Balance { imbalance, terms } = d.balance(a, [&u, &u])[membrane];
            assert!(imbalance.abs() <= 8.0 * f64::EPSILON * terms, "vertex {a}: {imbalance}, of {terms}");
            assert!((imbalance - whole).abs() <= 8.0 * f64::EPSILON * terms);
        }
        let doubled: Vec<f64> = u.iter().map(|u| 2.0 * u).collect();
        // mu K (2 u) - F = F = -2 mu |D_a|
        let expected = -2.0 * d.tension()[membrane] / 64.0;
        assert!(d.imbalance(membrane, &doubled).iter().all(|found| (found - expected).abs() < ROUNDING));
    }
}

#[test]
fn the_terms_of_a_balance_are_sums_of_sizes() {
    let mesh = square(2);
    let d = PairDiscretization::new(&problem(-4.0, 1.0, 0.0), mesh.clone()).unwrap();
    // At the centre K has 4 and four times -1: 2 (4 * 3 + 4 * 5) + 4 / 4.
    let u = vec![-5.0, -5.0, -5.0, -5.0, 3.0, 5.0, 5.0, 5.0, 5.0];
    let terms = |lower: &[f64]| d.balance(d.interior()[0], [&u, lower])[0].terms;
    assert!((terms(&u) - 65.0).abs() < ROUNDING);
    // A gap as large as u adds m (4 * 3 + 4 * 5).
    let [mu1, mu2] = d.tension();
    assert!((terms(&[0.0; 9]) - 65.0 - mu1 * mu2 / (mu1 + mu2) * 32.0).abs() < ROUNDING);
    assert!((d.imbalance(0, &u)[0] - (2.0 * 12.0 + 1.0)).abs() < ROUNDING);
}

#[test]
fn extend_takes_unknowns_and_boundary_values() {
    let mesh = square(2);
    let d = PairDiscretization::new(&problem(0.0, 0.0, 0.0), mesh.clone()).unwrap();
    let found = d.extend(&[7.0], |a| a as f64);
    assert_eq!(found, [0.0, 1.0, 2.0, 3.0, 7.0, 5.0, 6.0, 7.0, 8.0]);
}

#[test]
fn scales_follow_their_formulas() {
    let scales = |f1: f64, f2: f64, g: Function| {
        let mesh = rectangle([0.0, 0.0], [4.0, 2.0], [8, 4], Pattern::Right).unwrap();
        PairDiscretization::new(&problem(f1, f2, g), mesh.clone()).unwrap().scales()
    };
    let close = |found: Scales, [displacement, force_density]: [f64; 2]| {
        let near = |x: f64, y: f64| (x - y).abs() < ROUNDING * y;
        // Six triangles of area 1/8 around an inner vertex.
        near(found.displacement, displacement)
            && near(found.force_density, force_density)
            && near(found.dual_area, 0.25)
    };
    // With mu = (2, 1/2) and d = 2, d^2 / 8 mu = (1/4, 1).
    assert!(close(scales(-3.0, 0.5, 0.25.into()), [0.25 + 0.75, 3.0]));
    assert!(close(scales(1.0, -2.0, 0.25.into()), [0.25 + 2.0, 2.0]));
    // Heights from 1 to 3 exert 8 mu1 (3 - 1) / d^2 = 8.
    let slope = || Function::from_fn(|x, _| 1.0 + 0.5 * x);
    assert!(close(scales(-3.0, 0.5, slope()), [3.0 + 0.75, 8.0]));
    assert!(close(scales(-9.0, 0.5, slope()), [3.0 + 2.25, 9.0]));
    // At rest.
    assert!(close(scales(0.0, 0.0, 0.0.into()), [1.0, 1.0]));
    assert!(close(scales(0.0, 0.0, 0.5.into()), [0.5, 1.0]));
    assert!(!close(scales(-3.0, 0.5, 0.25.into()), [0.25 + 0.75, 3.1]));
}

/// A discretization in which every number is to be `2^length` and `2^force` times itself, by its dimension.
fn in_units(mesh: &Mesh, length: i32, force: i32) -> ContactProblem {
    let [length, force] = [length, force].map(|exponent| f64::from(exponent).exp2());
    let area = length * length;
    let load =
        |f: fn(f64, f64) -> f64| Function::from_fn(move |x, y| force / area * f(x / length, y / length));
    let height = Function::from_fn(move |x, y| length * (1.0 + 0.3 * x / length + 0.1 * y / length));
    assert!(mesh.points().len() > 4);
    ContactProblem::builder()
        .tension(1.3 * force / length, 0.7 * force / length)
        .load(load(|x, y| (3.0 * x).sin() - y), load(|x, y| 7.0 * x * y))
        .height(height)
        .build()
        .unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Powers of two as units change no digit.
    #[test]
    fn units_of_length_and_force_scale_everything_exactly(length in -40..40i32, force in -40..40i32) {
        let mesh = irregular(4);
        let [l, f] = [length, force].map(|exponent| f64::from(exponent).exp2());
        let points = mesh.points().iter().map(|point| point.map(|x| l * x)).collect();
        let scaled_mesh = Mesh::new(points, mesh.triangles().to_vec()).unwrap();
        let original = PairDiscretization::new(&in_units(&mesh, 0, 0), mesh.clone()).unwrap();
        let scaled = PairDiscretization::new(&in_units(&scaled_mesh, length, force), scaled_mesh.clone()).unwrap();

        let times = |values: &[f64], unit: f64| values.iter().map(|value| unit * value).collect::<Vec<_>>();
        prop_assert_eq!(scaled.stiffness(), original.stiffness());
        prop_assert_eq!(scaled.dual_area(), times(original.dual_area(), l * l));
        prop_assert_eq!(scaled.height(), times(original.height(), l));
        for membrane in 0..2 {
            prop_assert_eq!(&scaled.load()[membrane], &times(&original.load()[membrane], f));
        }
        let (expected, found) = (original.scales(), scaled.scales());
        prop_assert_eq!(found.displacement, l * expected.displacement);
        prop_assert_eq!(found.force_density, f / (l * l) * expected.force_density);
        prop_assert_eq!(found.dual_area, l * l * expected.dual_area);
        prop_assert_eq!(found == expected, length == 0 && force == 0);
    }
}

#[test]
fn heights_below_zero_and_loads_without_a_value_are_refused() {
    let mesh = square(4);
    let new = |problem: &ContactProblem| PairDiscretization::new(problem, mesh.clone()).map(|_| ());
    let fixed = problem(1.0, 1.0, 0.5);
    assert_eq!(new(&fixed), Ok(()));

    // Below zero inside, the height is not looked at.
    let basin = |depth: f64| {
        Function::from_fn(move |x, y| if x * (1.0 - x) * y * (1.0 - y) > 0.0 { -1.0 } else { depth })
    };
    assert_eq!(new(&problem(1.0, 1.0, basin(0.0))), Ok(()));
    let error = new(&problem(1.0, 1.0, basin(-0.5))).unwrap_err();
    assert_eq!(
        error.to_string(),
        "height g is -0.5 at the boundary vertex 0 (0, 0): it must be finite and >= 0 on the whole boundary (where a formula is zero up to rounding, write max(0, ...))"
    );
    let tilted = Function::from_fn(|x, y| 0.5 - x * y);
    let expected = PairError::Height { vertex: 19, point: [1.0, 0.75], value: -0.25 };
    assert_eq!(new(&problem(1.0, 1.0, tilted)), Err(expected));
    for value in [f64::NAN, f64::INFINITY] {
        let g = Function::from_fn(move |x, _| if x == 1.0 { value } else { 0.0 });
        assert!(matches!(new(&problem(1.0, 1.0, g)), Err(PairError::Height { vertex: 4, .. })));
    }

    let hole = || Function::from_fn(|x, y| if x > 0.5 { f64::NAN } else { y });
    for (membrane, data) in [(1, problem(hole(), 1.0, 0.5)), (2, problem(1.0, hole(), 0.5))] {
        let error = new(&data).unwrap_err();
        assert!(matches!(error, PairError::Load { membrane: found, .. } if found == membrane));
        let message = error.to_string();
        assert!(message.starts_with(&format!("load f{membrane} is NaN at the point (0.6")), "{message}");
    }
}

/// Numbers that would overflow later, in products and energies, are refused here.
#[test]
fn sizes_out_of_range_are_refused() {
    let mesh = square(4);
    let message = |mu: f64, f: Function, g: f64| {
        let problem = ContactProblem::builder().tension(mu, 1.0).load(f, 0.0).height(g).build().unwrap();
        PairDiscretization::new(&problem, mesh.clone()).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(message(1.0, 1.0.into(), 1.0), Ok(()));
    assert_eq!(message(1e30, 1e30.into(), 1.0), Ok(()));
    let range = ", out of the range from 1e-40 to 1e40: choose other units";
    assert_eq!(message(1e308, 0.0.into(), 1.0), Err(format!("the tension mu1 is 1e308{range}")));
    assert_eq!(message(1.0, 0.0.into(), 1e300), Err(format!("the displacements have the size 1e300{range}")));
    assert!(message(1.0, 1e300.into(), 0.0).unwrap_err().starts_with("the forces per area have the size 1"));
    assert!(message(1.0, 1e-300.into(), 1.0).unwrap_err().starts_with("the forces per area have the size"));
    assert!(message(1e-30, 1e30.into(), 0.0).unwrap_err().starts_with("the displacements have the size"));
    // Loads that overflow to infinities of either sign leave a NaN at every vertex.
    let large = rectangle([-1e6, -1e6], [1e6, 1e6], [1, 1], Pattern::Crossed).unwrap();
    let alternating = Function::from_fn(|x, y| if x.abs() > y.abs() { 1.7e308 } else { -1.7e308 });
    let problem = ContactProblem::builder().load(alternating, 0.0).build().unwrap();
    let error = PairDiscretization::new(&problem, large.clone()).map(|_| ()).unwrap_err();
    assert!(matches!(error, PairError::OutOfRange { value: f64::INFINITY, .. }), "{error}");
}

/// What the quadrature has not met cannot be put right by other units.
#[test]
fn a_load_that_the_quadrature_misses_is_named() {
    let message = |f2: &str| {
        let load: crate::problem::Expression = f2.parse().unwrap();
        let problem = ContactProblem::builder().load(0.0, load).build().unwrap();
        PairDiscretization::new(&problem, square(32)).map(|_| ()).map_err(|error| error.to_string())
    };
    // Of this spike nothing but its foot of 1e-50 lies at the points.
    let spike = "1000000*exp(-((x-0.53)^2+(y-0.52)^2)/0.0000001)";
    let error = message(spike).unwrap_err();
    assert!(error.starts_with("the quadrature sees nothing of load f2: at its points"), "{error}");
    assert!(!error.contains("0.00e0"), "{error}");
    assert_eq!(message(&format!("1e-3 + {spike}")), Ok(()));
    // A constant that is as small is in units that are too large.
    let problem = ContactProblem::builder().load(0.0, 1e-300).build().unwrap();
    let error = PairDiscretization::new(&problem, square(2)).map(|_| ()).unwrap_err();
    assert!(matches!(error, PairError::OutOfRange { .. }));
}

#[test]
fn a_height_that_fails_says_why() {
    let g = Function::try_from_fn(|_, _, _| Err("no connection"));
    let error = PairDiscretization::new(&problem(1.0, 1.0, g), square(2)).map(|_| ()).unwrap_err();
    assert_eq!(error.to_string(), "height g cannot be evaluated: no connection");
}

/// A stiffer membrane moves less by what is not known of its load.
#[test]
fn the_quadrature_difference_is_one_of_the_energy_norm() {
    let difference = |mu2: f64| {
        let wave = Function::from_fn(|x, y| (40.0 * x).sin() * (50.0 * y).cos());
        let problem = ContactProblem::builder().tension(1.0, mu2).load(-1.0, wave).build().unwrap();
        PairDiscretization::new(&problem, square(8)).unwrap().quadrature_difference()
    };
    let [first, second] = difference(1.0);
    assert!(first == 0.0 && second > 0.0);
    assert_eq!(difference(4.0), [0.0, 0.5 * second]);
}
