use super::*;
use crate::geometry::Interface;
use crate::mesh::samples::{irregular, square};
use crate::problem::Expression;

fn difference(mesh: &Mesh, f: &Function) -> f64 {
    LoadMoments::new(mesh, f).unwrap().quadrature_difference()
}

fn formula(text: &str) -> Function {
    text.parse::<Expression>().unwrap().into()
}

/// A load that no point of the first rule meets: it acts within a thousandth, and cells have the size 1/32.
fn spike(x: f64, y: f64) -> Function {
    formula(&format!("-1-1000000*exp(-((x-{x})^2+(y-{y})^2)/0.000001)"))
}

#[test]
fn a_load_between_the_points_of_the_quadrature_is_seen_by_the_second_rule() {
    let mesh = square(32);
    let mut unseen = 0;
    for [x, y] in [[0.53, 0.52], [0.501, 0.51], [0.26, 0.765], [0.123, 0.456], [0.9, 0.33]] {
        // The force of the spike is pi.
        if (load_sum(&mesh, &spike(x, y)) + 1.0).abs() < 0.1 {
            unseen += 1;
            assert!(difference(&mesh, &spike(x, y)) > 0.1, "({x}, {y}): {}", difference(&mesh, &spike(x, y)));
        }
    }
    assert!(unseen >= 3, "the first rule misses it, or there is nothing to see: {unseen}");
}

fn load_sum(mesh: &Mesh, f: &Function) -> f64 {
    let moments = LoadMoments::new(mesh, f).unwrap();
    (0..mesh.triangles().len()).map(|t| moments.on(mesh, t).integrals.iter().sum::<f64>()).sum()
}

#[test]
fn both_rules_find_the_same_of_constants_and_affine_loads() {
    let mesh = irregular(6);
    assert_eq!(difference(&mesh, &Function::Constant(3.0)), 0.0);
    // Rounding of values of order one.
    assert!(difference(&mesh, &formula("1 + 2*x - y")) < 1e-14);
    assert!(difference(&mesh, &formula("1 + 2*x - y + x^6")) > 1e-10, "of others they do not");
}

/// A load that is resolved has a difference that falls faster than the error of the solution, which is of order one.
#[test]
fn of_a_smooth_load_it_falls_fast() {
    let of = |cells: usize| difference(&square(cells), &formula("sin(3*pi*x)*exp(y)"));
    let [coarse, fine] = [of(32), of(64)];
    assert!(coarse < 1e-2 && fine < coarse / 3.5, "{coarse:e} {fine:e}");
}

/// A jump within triangles, at a third of a cell on both meshes: of the order of the mesh size, as what the quadrature moves;
/// cut along it, of a higher one.
#[test]
fn of_a_jump_it_falls_with_the_mesh_size() {
    let of = |cells: usize| difference(&square(cells), &formula("if(x < 1/3, 1, -1)"));
    assert!(of(128) > 3.0 * of(512), "{:e} {:e}", of(128), of(512));
    let step = |x: f64, _: f64| if x < 0.4321 { 1.0 } else { -1.0 };
    let cut = Function::piecewise(step, [Interface::VerticalLine { x: 0.4321 }]);
    assert!(difference(&square(64), &cut) < 1e-10, "{:e}", difference(&square(64), &cut));
    let circle = |x: f64, y: f64| f64::from(x.hypot(y) < 0.7);
    let along = Function::piecewise(circle, [Interface::Circle { centre: [0.0; 2], radius: 0.7 }]);
    assert!(difference(&square(64), &along) < 0.1 * difference(&square(64), &Function::from_fn(circle)));
}

#[test]
fn what_is_not_finite_beside_a_jump_is_refused() {
    let mesh = square(8);
    for value in [f64::NAN, f64::INFINITY] {
        // The points of both rules on whole triangles lie beside it: only the parts along the lines see it.
        let thin = move |x: f64, _: f64| if (0.3..0.3001).contains(&x) { value } else { 1.0 };
        assert!(LoadMoments::new(&mesh, &Function::from_fn(thin)).is_ok());
        let f = Function::piecewise(thin, [0.3, 0.3001].map(|x| Interface::VerticalLine { x }));
        let error = LoadMoments::new(&mesh, &f).map(|_| ()).unwrap_err();
        let EvaluationError::NotFinite { point, .. } = error else { panic!("{error}") };
        assert!((0.3..0.3001).contains(&point[0]));
    }
    let finite = Function::piecewise(|x, _| f64::from(x < 0.3), [Interface::VerticalLine { x: 0.3 }]);
    assert!(LoadMoments::new(&mesh, &finite).is_ok());
}

#[test]
fn a_failure_is_passed_on() {
    let f = Function::try_from_fn(|x: &[f64], _: &[f64], values: &mut [f64]| {
        values.fill(1.0);
        if x.iter().any(|&x| x > 0.9) { Err("beyond the table") } else { Ok(()) }
    });
    let error = LoadMoments::new(&square(8), &f).map(|_| ()).unwrap_err();
    assert_eq!(error.to_string(), "cannot be evaluated: beyond the table");
}

#[test]
fn a_load_that_is_zero_wherever_one_looks_is_told_from_the_constant() {
    let mesh = square(8);
    let sees_nothing = |f: &Function| LoadMoments::new(&mesh, f).unwrap().sees_nothing();
    assert!(sees_nothing(&formula("if(x > 2, 1, 0)")));
    assert!(!sees_nothing(&Function::Constant(0.0)) && !sees_nothing(&formula("if(x > 0.5, 1, 0)")));
}

#[test]
fn the_difference_does_not_depend_on_the_number_of_threads() {
    let mesh = irregular(60);
    let with = |threads: usize, f: &Function| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| difference(&mesh, f)).to_bits()
    };
    let f = formula("sin(30*x)*exp(y)");
    assert!(with(1, &f) == with(2, &f) && with(1, &f) == with(5, &f));
    assert_ne!(with(1, &f), with(1, &formula("sin(31*x)*exp(y)")));
}
