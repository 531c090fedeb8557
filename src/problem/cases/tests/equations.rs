//! Every case against the equations that it claims to solve, by differences blind to its formulas.

use super::points::{boundary, interior, on_interfaces};
use super::{PLANTED, ROUNDING, solutions};
use crate::numeric::largest;
use crate::problem::cases::ExactSolution;

/// Step of the central differences: truncation `STEP^2` times third derivatives, rounding `1e-16 / STEP`.
const STEP: f64 = 1e-5;
/// What the differences may be wrong by, relative to the data: third derivatives reach 1e4 near a corner.
const DIFFERENCES: f64 = 1e-6;
/// Half the distance of the two points that face each other across an interface.
const ACROSS: f64 = 1e-7;
/// Jump that a C1 function with second derivatives up to 50 may show over `2 ACROSS`.
const CONTINUITY: f64 = 1e-5;

type Vector = Box<dyn Fn(f64, f64) -> [f64; 2]>;
type Scalar = Box<dyn Fn(f64, f64) -> f64>;

/// The functions of a solution, each of which a test can replace by a wrong one.
struct Fields {
    tension: [f64; 2],
    u: Vector,
    grad_u: Box<dyn Fn(f64, f64) -> [[f64; 2]; 2]>,
    lambda: Scalar,
    load: Vector,
    height: Scalar,
}

impl Fields {
    fn of(solution: &ExactSolution) -> Self {
        let [a, b, c, d, e] = [0; 5].map(|_| solution.clone());
        Self {
            tension: solution.tension(),
            u: Box::new(move |x, y| a.u(x, y)),
            grad_u: Box::new(move |x, y| b.grad_u(x, y)),
            lambda: Box::new(move |x, y| c.lambda(x, y)),
            load: Box::new(move |x, y| d.load(x, y)),
            height: Box::new(move |x, y| e.height(x, y)),
        }
    }

    fn gap(&self, x: f64, y: f64) -> f64 {
        let [u1, u2] = (self.u)(x, y);
        u1 - u2
    }
}

/// The central difference of `f` in the direction `k`.
fn difference(f: impl Fn(f64, f64) -> f64, [x, y]: [f64; 2], k: usize) -> f64 {
    let [dx, dy] = [[STEP, 0.0], [0.0, STEP]][k];
    (f(x + dx, y + dy) - f(x - dx, y - dy)) / (2.0 * STEP)
}

/// The size of the data: relative to it the defects are judged.
fn scale(fields: &Fields, points: &[[f64; 2]]) -> f64 {
    let sizes = points.iter().flat_map(|&[x, y]| {
        let [f1, f2] = (fields.load)(x, y);
        let [[a, b], [c, d]] = (fields.grad_u)(x, y);
        [f1, f2, (fields.lambda)(x, y), a, b, c, d].map(f64::abs)
    });
    1.0 + largest(sizes)
}

/// How far the gradients are from the differences of `u`.
fn gradient_defect(fields: &Fields, points: &[[f64; 2]]) -> f64 {
    let defect = |&p: &[f64; 2]| {
        let gradients = (fields.grad_u)(p[0], p[1]);
        largest(
            [(0, 0), (0, 1), (1, 0), (1, 1)]
                .into_iter()
                .map(|(i, k)| (difference(|x, y| (fields.u)(x, y)[i], p, k) - gradients[i][k]).abs()),
        )
    };
    largest(points.iter().map(defect)) / scale(fields, points)
}

/// How far both equations of (1.1) are from holding, the divergence of the gradients taken by differences.
fn equation_defect(fields: &Fields, points: &[[f64; 2]]) -> f64 {
    let defect = |&p: &[f64; 2]| {
        let (lambda, load) = ((fields.lambda)(p[0], p[1]), (fields.load)(p[0], p[1]));
        let laplacian = |i: usize| -> f64 {
            [0, 1].map(|k| difference(|x, y| (fields.grad_u)(x, y)[i][k], p, k)).iter().sum()
        };
        largest(
            [(0, -lambda), (1, lambda)]
                .into_iter()
                .map(|(i, action)| (-fields.tension[i] * laplacian(i) + action - load[i]).abs()),
        )
    };
    largest(points.iter().map(defect)) / scale(fields, points)
}

/// How far `w >= 0`, `lambda >= 0` and `lambda w = 0` are from holding.
fn contact_defect(fields: &Fields, points: &[[f64; 2]]) -> f64 {
    let defect = |&[x, y]: &[f64; 2]| {
        let (w, lambda) = (fields.gap(x, y), (fields.lambda)(x, y));
        largest([-w, -lambda, (lambda * w).abs()])
    };
    largest(points.iter().map(defect))
}

/// How far `u1 = g >= 0` and `u2 = 0` are from holding on the boundary.
fn boundary_defect(fields: &Fields, points: &[[f64; 2]]) -> f64 {
    let defect = |&[x, y]: &[f64; 2]| {
        let ([u1, u2], g) = ((fields.u)(x, y), (fields.height)(x, y));
        largest([(u1 - g).abs(), u2.abs(), -g])
    };
    largest(points.iter().map(defect))
}

/// The largest jump of `u` or its gradient across an interface.
fn continuity_defect(fields: &Fields, curve: &[([f64; 2], [f64; 2])]) -> f64 {
    let jump = |([x, y], [nx, ny]): &([f64; 2], [f64; 2])| {
        let ahead = (x + ACROSS * nx, y + ACROSS * ny);
        let behind = (x - ACROSS * nx, y - ACROSS * ny);
        let values = |(x, y)| {
            let ([u1, u2], [[a, b], [c, d]]) = ((fields.u)(x, y), (fields.grad_u)(x, y));
            [u1, u2, a, b, c, d]
        };
        largest(values(ahead).into_iter().zip(values(behind)).map(|(p, q)| (p - q).abs()))
    };
    largest(curve.iter().map(jump))
}

#[test]
fn gradients_are_those_of_the_displacements() {
    for (name, solution) in solutions() {
        let (mut fields, points) =
            (Fields::of(&solution), interior(&solution.domain(), &solution.interfaces()));
        let defect = gradient_defect(&fields, &points);
        assert!(defect < DIFFERENCES, "{name}: {defect:e}");
        fields.grad_u = Box::new(move |x, y| solution.grad_u(x, y).map(|g| g.map(|d| d + PLANTED)));
        assert!(gradient_defect(&fields, &points) > 10.0 * DIFFERENCES, "{name}: the negative test passes");
    }
}

#[test]
fn both_equations_hold_off_the_interfaces() {
    for (name, solution) in solutions() {
        let (mut fields, points) =
            (Fields::of(&solution), interior(&solution.domain(), &solution.interfaces()));
        let defect = equation_defect(&fields, &points);
        assert!(defect < DIFFERENCES, "{name}: {defect:e}");
        let exact = solution.clone();
        fields.load = Box::new(move |x, y| exact.load(x, y).map(|f| (1.0 + PLANTED) * f));
        assert!(equation_defect(&fields, &points) > 10.0 * DIFFERENCES, "{name}: wrong loads pass");
        fields = Fields::of(&solution);
        fields.lambda = Box::new(move |x, y| -solution.lambda(x, y) - PLANTED);
        assert!(equation_defect(&fields, &points) > 10.0 * DIFFERENCES, "{name}: a pull passes");
    }
}

#[test]
fn gap_and_action_are_complementary() {
    for (name, solution) in solutions() {
        let (mut fields, points) =
            (Fields::of(&solution), interior(&solution.domain(), &solution.interfaces()));
        let defect = contact_defect(&fields, &points);
        assert!(defect < ROUNDING, "{name}: {defect:e}");
        let exact = solution.clone();
        fields.lambda = Box::new(move |x, y| -exact.lambda(x, y) - PLANTED);
        assert!(contact_defect(&fields, &points) > PLANTED / 2.0, "{name}: a pull passes");
        fields = Fields::of(&solution);
        let exact = solution.clone();
        fields.u = Box::new(move |x, y| [exact.u(x, y)[0] - 10.0, exact.u(x, y)[1]]);
        assert!(contact_defect(&fields, &points) > 1.0, "{name}: penetration passes");
        fields = Fields::of(&solution);
        fields.lambda = Box::new(move |x, y| solution.lambda(x, y) + PLANTED);
        let parts = points.iter().any(|&[x, y]| fields.gap(x, y) > PLANTED);
        assert_eq!(contact_defect(&fields, &points) > ROUNDING, parts, "{name}: action without contact");
    }
}

#[test]
fn boundary_conditions_hold() {
    for (name, solution) in solutions() {
        let (mut fields, points) = (Fields::of(&solution), boundary(&solution.domain()));
        let defect = boundary_defect(&fields, &points);
        assert!(defect < ROUNDING, "{name}: {defect:e}");
        for membrane in [0, 1] {
            let exact = solution.clone();
            fields.u = Box::new(move |x, y| {
                let mut u = exact.u(x, y);
                u[membrane] += PLANTED;
                u
            });
            assert!(boundary_defect(&fields, &points) > PLANTED / 2.0, "{name}: a lifted membrane passes");
        }
    }
}

#[test]
fn membranes_are_c1_across_the_interfaces() {
    for (name, solution) in solutions() {
        let (mut fields, curve) =
            (Fields::of(&solution), on_interfaces(&solution.domain(), &solution.interfaces()));
        assert_eq!(curve.len() > 30, !solution.interfaces().is_empty(), "{name}: {} points", curve.len());
        let defect = continuity_defect(&fields, &curve);
        assert!(defect < CONTINUITY, "{name}: {defect:e}");
        let curves = solution.interfaces();
        fields.grad_u = Box::new(move |x, y| {
            let beyond = curves.iter().filter(|curve| curve.signed_distance(x, y) > 0.0).count() as f64;
            solution.grad_u(x, y).map(|g| g.map(|d| d + PLANTED * beyond))
        });
        assert_eq!(
            continuity_defect(&fields, &curve) > 5.0 * CONTINUITY,
            !curve.is_empty(),
            "{name}: a kink"
        );
    }
}
