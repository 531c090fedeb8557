use std::collections::BTreeMap;

use super::*;
use crate::fem::moments::BLOCK;
use crate::mesh::samples::{irregular, renumbered, square};
use crate::numeric::largest;
use crate::problem::Expression;

/// Rounding of the sums around a vertex, and of abscissae of 16 digits; loads are of order one.
const ROUNDING: f64 = 1e-14;

/// A polynomial in barycentric coordinates: coefficients of `l0^i l1^j l2^k`.
type Barycentric = BTreeMap<[i32; 3], f64>;

fn times(p: &Barycentric, q: &Barycentric) -> Barycentric {
    let mut product = Barycentric::new();
    for (a, x) in p {
        for (b, y) in q {
            *product.entry([a[0] + b[0], a[1] + b[1], a[2] + b[2]]).or_default() += x * y;
        }
    }
    product
}

/// `int_T p = 2 |T| sum c_ijk i! j! k! / (i + j + k + 2)!`.
fn integral(p: &Barycentric, area: f64) -> f64 {
    let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
    let term = |(n, c): (&[i32; 3], &f64)| {
        c * n.iter().map(|&n| factorial(n)).product::<f64>() / factorial(n.iter().sum::<i32>() + 2)
    };
    2.0 * area * p.iter().map(term).sum::<f64>()
}

/// `int x^p y^q phi_a` by that formula.
fn exact_load(mesh: &Mesh, p: i32, q: i32) -> Vec<f64> {
    let hat = |i: usize| [0, 1, 2].map(|j| i32::from(i == j));
    let mut load = vec![0.0; mesh.points().len()];
    for (t, vertices) in mesh.triangles().iter().enumerate() {
        let coordinate =
            |axis: usize| (0..3).map(|i| (hat(i), mesh.corners(t)[i][axis])).collect::<Barycentric>();
        let factors = (0..p).map(|_| coordinate(0)).chain((0..q).map(|_| coordinate(1)));
        let monomial =
            factors.fold(Barycentric::from([([0; 3], 1.0)]), |product, factor| times(&product, &factor));
        for (i, &a) in vertices.iter().enumerate() {
            load[a] +=
                integral(&times(&monomial, &Barycentric::from([(hat(i), 1.0)])), mesh.triangle_area(t));
        }
    }
    load
}

fn largest_difference(found: &[f64], expected: &[f64]) -> f64 {
    largest(found.iter().zip(expected).map(|(x, y)| (x - y).abs()))
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn a_constant_gives_the_dual_areas() {
    let mesh = irregular(7);
    let found = load(&mesh, &Function::Constant(-3.0)).unwrap();
    let mut expected = vec![0.0; mesh.points().len()];
    for (t, &vertices) in mesh.triangles().iter().enumerate() {
        vertices.into_iter().for_each(|a| expected[a] -= mesh.triangle_area(t));
    }
    assert!(largest_difference(&found, &expected) < ROUNDING);
    assert!((found.iter().sum::<f64>() + 3.0).abs() < ROUNDING);
    assert!(largest_difference(&load(&mesh, &Function::Constant(3.0)).unwrap(), &expected) > 0.01);
}

#[test]
fn cubic_polynomials_are_integrated_exactly_and_no_others() {
    let mesh = irregular(3);
    let defect = |p: i32, q: i32| {
        let f = Function::from_fn(move |x, y| x.powi(p) * y.powi(q));
        largest_difference(&load(&mesh, &f).unwrap(), &exact_load(&mesh, p, q))
    };
    for p in 0..=3 {
        for q in 0..=3 - p {
            assert!(defect(p, q) < ROUNDING, "x^{p} y^{q}: {}", defect(p, q));
        }
    }
    assert!((0..=4).any(|p| defect(p, 4 - p) > 1e6 * ROUNDING));
}

/// On one triangle, by hand: `int x phi_a` on the reference triangle is 1/24, 1/12, 1/24.
#[test]
fn a_linear_load_by_hand() {
    let mesh = Mesh::new(vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], vec![[0, 1, 2]]).unwrap();
    let found = load(&mesh, &Function::from_fn(|x, _| x)).unwrap();
    assert!(largest_difference(&found, &[1.0 / 24.0, 1.0 / 12.0, 1.0 / 24.0]) < ROUNDING);
    let other = load(&mesh, &Function::from_fn(|_, y| y)).unwrap();
    assert!(largest_difference(&other, &[1.0 / 24.0, 1.0 / 24.0, 1.0 / 12.0]) < ROUNDING);
}

#[test]
fn expressions_and_closures_agree_to_the_last_bit() {
    // More points than one block.
    let mesh = irregular(30);
    assert!(mesh.triangles().len() > 3 * BLOCK);
    let expression: Expression = "if(x < 0.5, 10*x*y, -15) + y/3".parse().unwrap();
    let closure =
        |tenth: f64| Function::from_fn(move |x, y| if x < 0.5 { tenth * x * y } else { -15.0 } + y / 3.0);
    let found = load(&mesh, &expression.into()).unwrap();
    assert_eq!(bits(&found), bits(&load(&mesh, &closure(10.0)).unwrap()));
    assert_ne!(bits(&found), bits(&load(&mesh, &closure(10.000_000_1)).unwrap()));
}

#[test]
fn values_that_are_not_finite_are_named_with_their_point() {
    let mesh = square(40);
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let f = Function::from_fn(move |x, y| if x > 0.8 && y > 0.5 { value } else { 1.0 });
        let error = load(&mesh, &f).expect_err("not finite");
        let EvaluationError::NotFinite { point: [x, y], value: found } = error else { panic!("{error}") };
        assert!(found == value || found.is_nan() && value.is_nan());
        // In the first cell of the first row that reaches into the corner.
        assert!((0.8..0.825).contains(&x) && (0.5..0.525).contains(&y), "{error}");
        assert_eq!(error.to_string(), format!("is {value} at the point ({x}, {y})"));
    }
    // Beside the quadrature points, for instance at vertices, values do not matter.
    let at_vertices = Function::from_fn(|x, y| if (40.0 * x).fract() == 0.0 { 1.0 / (y - y) } else { 1.0 });
    assert!(load(&mesh, &at_vertices).is_ok());
}

/// Also when several blocks of triangles hold such values, the first point is named.
#[test]
fn the_result_and_the_error_do_not_depend_on_the_number_of_threads() {
    let mesh = irregular(60);
    let with = |threads: usize, f: &Function| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| load(&mesh, f))
    };
    let smooth = Function::from_fn(|x, y| (3.0 * x).sin() * y.exp());
    let expected = bits(&with(1, &smooth).unwrap());
    assert!(expected == bits(&with(2, &smooth).unwrap()) && expected == bits(&with(5, &smooth).unwrap()));
    assert!(expected != bits(&with(1, &Function::from_fn(|x, y| (3.0 * x).sin() * y.cosh())).unwrap()));

    let poles = Function::from_fn(|x, y| if y > 0.1 { f64::INFINITY } else { x });
    let first = with(1, &poles).unwrap_err();
    for _ in 0..20 {
        assert_eq!(with(2, &poles).unwrap_err(), first);
    }
    let later = Function::from_fn(|x, y| if y > 0.5 { f64::INFINITY } else { x });
    assert_ne!(with(1, &later).unwrap_err(), first);
}

#[test]
fn unused_vertices_carry_no_load_and_numbering_changes_the_order_alone() {
    let points = [irregular(5).points(), &[[0.3, 0.3]]].concat();
    let mesh = Mesh::new(points, irregular(5).triangles().to_vec()).unwrap();
    let f = Function::from_fn(|x, y| x + y * y);
    let found = load(&mesh, &f).unwrap();
    assert_eq!(found[36], 0.0);
    assert!(found[..36].iter().all(|&f| f > 0.0));
    let (other, number) = renumbered(&mesh, 3);
    let permuted = load(&other, &f).unwrap();
    assert!((0..37).all(|a| (permuted[number[a]] - found[a]).abs() < ROUNDING));
}
