//! The registry of the cases, and facts on single cases; `equations` verifies all of them alike.

mod equations;
mod points;
mod stacks;

use std::f64::consts::PI;

use super::*;
use crate::problem::Domain;
use points::{boundary, interior};

/// Formulas evaluated two ways differ by a few roundings.
const ROUNDING: f64 = 1e-12;
/// Size of the errors planted to see a check fail: far above every tolerance.
const PLANTED: f64 = 1e-2;

type Choice = &'static [(&'static str, f64)];

fn chosen(pairs: &[(&str, f64)]) -> BTreeMap<String, f64> {
    pairs.iter().map(|&(name, value)| (name.to_owned(), value)).collect()
}

/// Every case with its defaults and with two other choices.
fn solutions() -> Vec<(String, ExactSolution)> {
    let others: [(Case, [Choice; 2]); 9] = [
        (Case::Disk, [&[("mu1", 4.0), ("R", 0.8), ("s0", -1.0)], &[("mu2", 0.1), ("R", 0.2), ("q", 1.0)]]),
        (Case::Strip, [&[("mu1", 4.0), ("x0", 0.25), ("c", 3.0)], &[("mu2", 0.1), ("A0", 0.2), ("c", -1.0)]]),
        (Case::Circle, [&[("mu1", 4.0), ("R", 0.45), ("c", -2.0)], &[("mu2", 0.1), ("R", 0.1), ("q", 1.0)]]),
        (
            Case::Annulus,
            [&[("mu1", 4.0), ("R0", 0.1), ("A", 2.0)], &[("mu2", 0.1), ("R1", 0.45), ("c", -3.0)]],
        ),
        (Case::LShape, [&[("mu1", 4.0)], &[("mu2", 0.1)]]),
        (Case::LShapeFree, [&[("mu1", 4.0), ("g", 0.01)], &[("mu2", 0.1), ("g", 7.0)]]),
        (Case::NoContact, [&[("mu1", 4.0), ("k", 0.0)], &[("mu2", 0.1), ("c", -2.0), ("k", 3.0)]]),
        (Case::FullContact, [&[("mu1", 4.0), ("q", 1.0)], &[("mu2", 0.1), ("c", -2.0)]]),
        (Case::Biactive, [&[("mu1", 4.0), ("q", 1e-8)], &[("mu2", 0.1), ("q", 1e-12)]]),
    ];
    let choices = others.into_iter().flat_map(|(case, [one, two])| [&[][..], one, two].map(|p| (case, p)));
    choices
        .map(|(case, pairs)| {
            (format!("{case} {pairs:?}"), case.solution(&chosen(pairs)).expect("parameters in range"))
        })
        .collect()
}

#[test]
fn loads_agree_with_their_closed_forms() {
    let close = |a: f64, b: f64| (a - b).abs() <= ROUNDING * (1.0 + b.abs());
    for (_, solution) in solutions().into_iter().filter(|(name, _)| name.starts_with("disk []")) {
        // mu = (1, 3), q = 10, s0 = 4, hence f = (1 - 10, 3 + 10) everywhere.
        for [x, y] in interior(&solution.domain(), &solution.interfaces()) {
            let [f1, f2] = solution.load(x, y);
            assert!(close(f1, -9.0) && close(f2, 13.0) && !close(f2, -13.0), "{f1} {f2}");
        }
    }
    let circle = Case::Circle.solution(&chosen(&[])).expect("defaults");
    // mu = (1, 3), q = 10, c = 0.2, m = 3/4; the centre is in contact, the corner is not.
    let at_centre = [0.4 * PI * PI - 10.0, 1.2 * PI * PI + 10.0];
    assert!(circle.load(0.5, 0.5).into_iter().zip(at_centre).all(|(f, expected)| close(f, expected)));
    assert!(
        circle.load(0.0, 0.0).into_iter().zip([-40.0 / 3.0, 0.0]).all(|(f, expected)| close(f, expected))
    );
    let l_shape = Case::LShape.solution(&chosen(&[])).expect("defaults");
    assert!(l_shape.load(-1.5, 0.3).into_iter().zip([-0.75, 0.75]).all(|(f, expected)| close(f, expected)));
    assert!(l_shape.load(-0.1, 0.1).into_iter().zip([0.0, 0.0]).all(|(f, expected)| close(f, expected)));
}

/// On the uniform right-triangle mesh `K` is the five-point stencil and `|D_a| = h^2`. A vertex on `x = x0`
/// has three of its six triangles on either side, so that each side gives its load times `h^2/2`.
#[test]
fn the_strip_is_exact_at_the_nodes_of_aligned_meshes() {
    let solution = Case::Strip.solution(&chosen(&[])).expect("defaults");
    let ([mu1, mu2], (h, x0)) = (solution.tension(), (0.125, 0.5));
    let action = 2.0 * mu1 * mu2 / (mu1 + mu2);
    let residual = |x: f64, lambda_h: f64, membrane: usize| {
        let u = |x: f64, y: f64| solution.u(x, y)[membrane];
        let stiffness = 4.0 * u(x, 0.5) - u(x - h, 0.5) - u(x + h, 0.5) - u(x, 0.5 - h) - u(x, 0.5 + h);
        let sides = [-1.0, 1.0].map(|side| solution.load(x + side * h / 3.0, 0.5)[membrane]);
        let load = h * h * (sides[0] + sides[1]) / 2.0;
        let sign = [-1.0, 1.0][membrane];
        solution.tension()[membrane] * stiffness + sign * h * h * lambda_h - load
    };
    for (x, lambda_h) in [(x0 - h, action), (x0, action / 2.0), (x0 + h, 0.0), (x0 + 2.0 * h, 0.0)] {
        for membrane in [0, 1] {
            assert!(residual(x, lambda_h, membrane).abs() < ROUNDING, "x = {x}, membrane {}", membrane + 1);
            assert!(
                residual(x, lambda_h + PLANTED, membrane).abs() > ROUNDING,
                "the negative test at x = {x} passes"
            );
        }
    }
    // The gap alone sees only F = -q, also with the loads taken on the line itself.
    let [f1, f2] = solution.load(x0, 0.5);
    assert!(((mu2 * f1 - mu1 * f2) / (mu1 + mu2) + action).abs() < ROUNDING);
}

#[test]
fn values_are_finite_also_slightly_outside_and_at_the_corner() {
    for (name, solution) in solutions() {
        let mut points = boundary(&solution.domain());
        points.extend(points.clone().iter().flat_map(|&[x, y]| [[x + 1e-3, y - 1e-3], [x - 1e-9, y + 1e-9]]));
        points.extend([[0.0, 0.0], [0.5, 0.5], [-0.0, -0.0], [1e-300, -1e-300]]);
        for [x, y] in points {
            let ([u1, u2], [f1, f2]) = (solution.u(x, y), solution.load(x, y));
            let values = [u1, u2, f1, f2, solution.lambda(x, y), solution.height(x, y)];
            assert!(values.into_iter().all(f64::is_finite), "{name} at ({x}, {y}): {values:?}");
            let gradients = solution.grad_u(x, y).concat();
            assert!(!gradients.iter().any(|d| d.is_nan()), "{name} at ({x}, {y}): {gradients:?}");
            let corner = matches!(solution.domain(), Domain::LShape { .. }) && (x, y) == (0.0, 0.0);
            assert_eq!(gradients.iter().any(|d| d.is_infinite()), corner, "{name} at ({x}, {y})");
        }
    }
}

#[test]
fn functions_of_the_problem_are_those_of_the_solution() {
    for (name, solution) in solutions() {
        let ([f1, f2], g) = (solution.load_functions(), solution.height_function());
        let [x, y] = interior(&solution.domain(), &solution.interfaces())[0];
        assert_eq!([f1.eval(x, y).unwrap(), f2.eval(x, y).unwrap()], solution.load(x, y), "{name}");
        assert_eq!(g.eval(x, y).unwrap(), solution.height(x, y), "{name}");
        assert_ne!(f1.eval(x, y), f2.eval(x, y), "{name}: the loads of the two membranes differ");
    }
}

#[test]
fn names_lead_to_cases_and_unknown_ones_to_the_nearest() {
    for case in Case::ALL {
        assert_eq!(Case::from_name(case.name()), Ok(case));
    }
    let message = |name| Case::from_name(name).expect_err("unknown").to_string();
    assert!(message("L_shape").contains("`L_shape`") && message("L_shape").contains("nearest is `l-shape`"));
    assert!(message("disc").contains("nearest is `disk`"), "{}", message("disc"));
    let unknown = Case::Disk.solution(&chosen(&[("x0", 0.5)])).expect_err("a parameter of the strip");
    assert!(unknown.to_string().contains("case `disk` has no parameter `x0`"), "{unknown}");
}

#[test]
fn parameters_out_of_range_are_errors_and_defaults_are_not() {
    for case in Case::ALL {
        assert_eq!([case.parameters()[0].name, case.parameters()[1].name], ["mu1", "mu2"]);
        for parameter in case.parameters() {
            assert!(parameter.range.contains(parameter.default), "{case} {}", parameter.name);
            let error = case.solution(&chosen(&[(parameter.name, f64::NAN)])).expect_err("NaN");
            assert!(error.to_string().ends_with(&parameter.condition()), "{error}");
        }
    }
    let radii = |inner, outer| Case::Annulus.solution(&chosen(&[("R0", inner), ("R1", outer)]));
    let error = radii(0.3, 0.3).expect_err("an empty annulus").to_string();
    assert_eq!(error, "`R0 = 0.3` is out of range in the case `annulus`; choose 0 < R0 < R1 = 0.3");
    assert!(radii(0.29, 0.3).is_ok());
}

#[test]
fn descriptions_fit_a_terminal() {
    let fits = |line: &str| line.is_ascii() && line.len() <= 76 && line.trim_end() == line;
    assert!(!fits(&"-".repeat(77)) && !fits("\u{3bb} = 0") && !fits("trailing "));
    assert!(Case::NOTATION.iter().all(|line| fits(line)));
    for case in Case::ALL {
        assert!(case.formulas().iter().chain([&case.title()]).all(|line| fits(line)), "{case}");
        let others = Case::ALL.into_iter().filter(|other| *other != case);
        assert!(others.clone().all(|o| o.name() != case.name() && o.letter() != case.letter()), "{case}");
    }
}

#[test]
fn contact_and_pressure_end_at_the_rim() {
    let mut rims = 0;
    for (name, solution) in solutions() {
        let Some(rim) = solution.rim() else { continue };
        rims += 1;
        for [x, y] in interior(&solution.domain(), &solution.interfaces()) {
            let (inside, [u1, u2]) = (rim.signed_distance(x, y) < 0.0, solution.u(x, y));
            assert_eq!((u1 == u2, solution.lambda(x, y) > 0.0), (inside, inside), "{name}: ({x}, {y})");
        }
    }
    assert_eq!(rims, 9, "disk, strip, and circle, three choices each");
}
