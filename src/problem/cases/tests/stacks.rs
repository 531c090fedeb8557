//! Every stack against the equations that it claims to solve, by differences blind to its formulas.

use super::points::{boundary, interior, on_interfaces};
use super::{Choice, PLANTED, ROUNDING, chosen};
use crate::numeric::largest;
use crate::problem::Domain;
use crate::problem::cases::{ExactStack, NamedCase, StackCase};

/// Step of the central differences: truncation `STEP^2` times third derivatives, rounding `1e-16 / STEP`.
const STEP: f64 = 1e-5;
/// What the differences may be wrong by, relative to the data.
const DIFFERENCES: f64 = 1e-6;
/// Half the distance of the two points that face each other across an interface.
const ACROSS: f64 = 1e-7;
/// Jump that a function with derivatives up to 200 may show over `2 ACROSS`: a force in a stack of five tensions.
const CONTINUITY: f64 = 4e-5;

/// Every stack with its defaults and with two other choices.
fn stacks() -> Vec<(String, ExactStack)> {
    let others: [(StackCase, [Choice; 2]); 12] = [
        (StackCase::FloorDisk, [&[("mu", 0.5), ("R", 0.8)], &[("q", 1.0), ("R", 0.1)]]),
        (StackCase::Ball, [&[("R", 0.3)], &[("R", 0.85)]]),
        (StackCase::ThreeStrips, [&[("mu1", 4.0), ("f1", -40.0)], &[("f2", 7.0), ("x1", 0.8), ("x2", 0.7)]]),
        (StackCase::ThreeDiscs, [&[("mu3", 0.5), ("R1", 0.9)], &[("f3", 7.0), ("R1", 0.2), ("R2", 0.05)]]),
        (StackCase::GradedDisk, [&[("s", 0.01), ("R", 0.7)], &[("s", 9.0), ("q", 1.0)]]),
        (StackCase::TwoTensions, [&[("f1", -1.0), ("R", 0.6)], &[("f2", 0.5), ("R", 0.1)]]),
        (StackCase::TensionJump, [&[("mu", 1.5), ("x1", 0.9)], &[("mu", 20.0), ("xm", 0.1), ("x1", 0.2)]]),
        (StackCase::StripOnFloor, [&[("mu1", 0.5), ("f2", 2.0)], &[("f1", -30.0), ("x1", 0.9), ("x2", 0.1)]]),
        (StackCase::Foundation, [&[("mu", 9.0), ("c", 1.0)], &[("c", 0.01), ("q", 2.0), ("x0", 0.6)]]),
        (StackCase::FreeEnd, [&[("mu1", 3.0), ("t1", 1.0), ("t2", 1.0)], &[("q", 0.5), ("t2", 2.0)]]),
        (
            StackCase::Manufactured,
            [
                &[("membranes", 5.0), ("floor", 0.0), ("free", 1.0), ("c", 3.0)],
                &[("membranes", 1.0), ("s", 0.0), ("R", 0.35)],
            ],
        ),
        (StackCase::BiactiveStack, [&[("membranes", 2.0), ("c", -1.0)], &[("membranes", 5.0), ("k", 0.0)]]),
    ];
    let choices = others.into_iter().flat_map(|(case, [one, two])| [&[][..], one, two].map(|p| (case, p)));
    choices
        .map(|(case, pairs)| {
            (format!("{case} {pairs:?}"), case.solution(&chosen(pairs)).expect("parameters in range"))
        })
        .collect()
}

type Of = Box<dyn Fn(usize, f64, f64) -> f64>;

/// The functions of a stack, each of which a test can replace by a wrong one.
struct Fields {
    exact: ExactStack,
    u: Of,
    grad_u: Box<dyn Fn(usize, f64, f64) -> [f64; 2]>,
    lambda: Of,
    load: Of,
}

impl Fields {
    fn of(exact: &ExactStack) -> Self {
        let [a, b, c, d] = [0; 4].map(|_| exact.clone());
        Self {
            exact: exact.clone(),
            u: Box::new(move |i, x, y| a.u(i, x, y)),
            grad_u: Box::new(move |i, x, y| b.grad_u(i, x, y)),
            lambda: Box::new(move |k, x, y| c.lambda(k, x, y)),
            load: Box::new(move |i, x, y| d.load(i, x, y)),
        }
    }

    fn points(&self) -> Vec<[f64; 2]> {
        interior(&self.exact.domain(), &self.exact.interfaces())
    }

    /// `mu_i grad u_i`.
    fn flux(&self, i: usize, x: f64, y: f64) -> [f64; 2] {
        (self.grad_u)(i, x, y).map(|d| self.exact.tension(i, x, y) * d)
    }

    /// `lambda_i - lambda_(i-1)`.
    fn push(&self, i: usize, x: f64, y: f64) -> f64 {
        let of = |k: usize| if self.exact.gaps().contains(&k) { (self.lambda)(k, x, y) } else { 0.0 };
        of(i) - of(i - 1)
    }

    fn membranes(&self) -> std::ops::RangeInclusive<usize> {
        1..=self.exact.membranes()
    }

    /// The size of the data: relative to it the defects are judged.
    fn scale(&self) -> f64 {
        let sizes = self.points().into_iter().flat_map(|[x, y]| {
            self.membranes().flat_map(move |i| {
                let [a, b] = self.flux(i, x, y);
                [a, b, (self.load)(i, x, y), self.push(i, x, y)].map(f64::abs)
            })
        });
        1.0 + largest(sizes.collect::<Vec<_>>())
    }

    fn largest_inside(&self, defect: impl Fn(usize, f64, f64) -> f64) -> f64 {
        let points = self.points();
        let defects = points.iter().flat_map(|&[x, y]| self.membranes().map(move |i| [i as f64, x, y]));
        largest(defects.map(|[i, x, y]| defect(i as usize, x, y))) / self.scale()
    }

    /// How far the gradients are from the differences of `u`.
    fn gradient_defect(&self) -> f64 {
        self.largest_inside(|i, x, y| {
            let gradient = (self.grad_u)(i, x, y);
            largest([0, 1].map(|k| (difference(|x, y| (self.u)(i, x, y), [x, y], k) - gradient[k]).abs()))
        })
    }

    /// How far the equations are from holding, the divergence of the flux taken by differences.
    fn equation_defect(&self) -> f64 {
        self.largest_inside(|i, x, y| {
            let divergence: f64 =
                [0, 1].map(|k| difference(|x, y| self.flux(i, x, y)[k], [x, y], k)).iter().sum();
            let pull = self.exact.foundation(i) * (self.u)(i, x, y);
            (-divergence + pull - (self.load)(i, x, y) - self.push(i, x, y)).abs()
        })
    }

    /// How far `w >= 0`, `lambda >= 0` and `lambda w = 0` are from holding.
    fn contact_defect(&self) -> f64 {
        let defect = |k: usize, [x, y]: [f64; 2]| {
            let (w, lambda) = ((self.u)(k, x, y) - (self.u)(k + 1, x, y), (self.lambda)(k, x, y));
            largest([-w, -lambda, (lambda * w).abs()])
        };
        let points = self.points();
        largest(self.exact.gaps().flat_map(|k| points.iter().map(move |&p| defect(k, p)).collect::<Vec<_>>()))
    }

    /// The largest jump across an interface of `u`, and of the flux but for the line actions.
    fn continuity_defect(&self) -> f64 {
        let curves = self.exact.interfaces();
        let jump = |([x, y], [nx, ny]): ([f64; 2], [f64; 2]), i: usize| {
            let ahead = [x + ACROSS * nx, y + ACROSS * ny];
            let behind = [x - ACROSS * nx, y - ACROSS * ny];
            let normal = |[x, y]: [f64; 2]| {
                let [a, b] = self.flux(i, x, y);
                a * nx + b * ny
            };
            let height = |[x, y]: [f64; 2]| (self.u)(i, x, y);
            let lines = |k: usize| {
                let gaps = self.exact.gaps();
                let lines = if gaps.contains(&k) { self.exact.line_actions(k) } else { Vec::new() };
                let here = lines.iter().filter(|line| line.curve.signed_distance(x, y).abs() < 1e-9);
                here.map(|line| line.density).sum::<f64>()
            };
            // -[mu d_n u] = l_i - l_(i-1).
            let force = normal(ahead) - normal(behind) + lines(i) - lines(i - 1);
            force.abs().max((height(ahead) - height(behind)).abs())
        };
        let curve = on_interfaces(&self.exact.domain(), &curves);
        let jumps = curve.into_iter().flat_map(|at| self.membranes().map(move |i| (at, i)));
        largest(jumps.map(|(at, i)| jump(at, i)))
    }
}

/// The central difference of `f` in the direction `k`.
fn difference(f: impl Fn(f64, f64) -> f64, [x, y]: [f64; 2], k: usize) -> f64 {
    let [dx, dy] = [[STEP, 0.0], [0.0, STEP]][k];
    (f(x + dx, y + dy) - f(x - dx, y - dy)) / (2.0 * STEP)
}

#[test]
fn gradients_are_those_of_the_displacements() {
    for (name, exact) in stacks() {
        let mut fields = Fields::of(&exact);
        let defect = fields.gradient_defect();
        assert!(defect < DIFFERENCES, "{name}: {defect:e}");
        fields.grad_u = Box::new(move |i, x, y| exact.grad_u(i, x, y).map(|d| d + PLANTED));
        assert!(fields.gradient_defect() > 10.0 * DIFFERENCES, "{name}: the negative test passes");
    }
}

#[test]
fn the_equations_hold_off_the_interfaces() {
    for (name, exact) in stacks() {
        let mut fields = Fields::of(&exact);
        let defect = fields.equation_defect();
        assert!(defect < DIFFERENCES, "{name}: {defect:e}");
        let right = exact.clone();
        fields.load = Box::new(move |i, x, y| right.load(i, x, y) + PLANTED);
        assert!(fields.equation_defect() > 10.0 * DIFFERENCES, "{name}: wrong loads pass");
        fields = Fields::of(&exact);
        fields.lambda = Box::new(move |k, x, y| exact.lambda(k, x, y) + PLANTED * k as f64);
        assert!(fields.equation_defect() > 10.0 * DIFFERENCES, "{name}: wrong actions pass");
    }
}

#[test]
fn gaps_and_actions_are_complementary() {
    for (name, exact) in stacks() {
        let mut fields = Fields::of(&exact);
        let defect = fields.contact_defect();
        assert!(defect < ROUNDING, "{name}: {defect:e}");
        let right = exact.clone();
        fields.lambda = Box::new(move |k, x, y| -right.lambda(k, x, y) - PLANTED);
        assert!(fields.contact_defect() > PLANTED / 2.0, "{name}: a pull passes");
        fields = Fields::of(&exact);
        let right = exact.clone();
        fields.u = Box::new(move |i, x, y| right.u(i, x, y) + 10.0 * i as f64);
        assert!(fields.contact_defect() > 1.0, "{name}: penetration passes");
        fields = Fields::of(&exact);
        let right = exact.clone();
        fields.lambda = Box::new(move |k, x, y| right.lambda(k, x, y) + PLANTED);
        let wide = |k: usize| fields.points().iter().any(|&[x, y]| exact.gap(k, x, y) > PLANTED);
        let parts = exact.gaps().any(wide);
        assert_eq!(fields.contact_defect() > ROUNDING, parts, "{name}: action without contact");
    }
}

#[test]
fn displacements_and_forces_are_continuous_across_the_interfaces() {
    for (name, exact) in stacks() {
        let mut fields = Fields::of(&exact);
        let defect = fields.continuity_defect();
        assert!(defect < CONTINUITY, "{name}: {defect:e}");
        let curves = exact.interfaces();
        let some = !curves.is_empty();
        fields.grad_u = Box::new(move |i, x, y| {
            let beyond = curves.iter().filter(|curve| curve.signed_distance(x, y) > 0.0).count() as f64;
            exact.grad_u(i, x, y).map(|d| d + PLANTED * beyond)
        });
        assert_eq!(fields.continuity_defect() > 5.0 * CONTINUITY, some, "{name}: a kink");
    }
}

/// `mu_i d_n u_i = t_i + l_i - l_(i-1)` on the free sides of a rectangle; at least one side holds.
#[test]
fn free_sides_are_pulled_as_they_say() {
    let sides = [("left", [-1.0, 0.0]), ("right", [1.0, 0.0]), ("bottom", [0.0, -1.0]), ("top", [0.0, 1.0])];
    let mut free = 0;
    for (name, exact) in stacks() {
        let Domain::Rectangle { lower: [x0, y0], upper: [x1, y1] } = exact.domain() else { continue };
        let points = boundary(&exact.domain());
        for i in 1..=exact.membranes() {
            let mut held = 0;
            for (k, (side, [nx, ny])) in sides.into_iter().enumerate() {
                let on_side =
                    |&&[x, y]: &&[f64; 2]| [x == x0, x == x1, y == y0, y == y1][k] && 0.01 < y && y < 0.45;
                let on_side: Vec<[f64; 2]> = points.iter().filter(on_side).copied().collect();
                if exact.traction(i, side, x0, y0).is_none() {
                    held += 1;
                    continue;
                }
                for [x, y] in on_side {
                    let line = |k: usize| {
                        let lines =
                            if exact.gaps().contains(&k) { exact.line_actions(k) } else { Vec::new() };
                        let here = lines.iter().filter(|line| line.curve.signed_distance(x, y).abs() < 1e-9);
                        here.map(|line| line.density).sum::<f64>()
                    };
                    let [dx, dy] = exact.grad_u(i, x, y);
                    let flux = exact.tension(i, x, y) * (dx * nx + dy * ny);
                    let pull = exact.traction(i, side, x, y).unwrap() + line(i) - line(i - 1);
                    assert!((flux - pull).abs() < ROUNDING, "{name}, {side}: {flux}, not {pull}");
                    free += usize::from(pull != 0.0);
                }
            }
            assert!(held > 0, "{name}: nothing holds membrane {i}");
        }
    }
    assert!(free > 100, "{free} points of free sides that are pulled");
}

#[test]
fn contact_is_exact_and_ends_at_the_rims() {
    for (name, exact) in stacks() {
        for k in exact.gaps() {
            let rim = exact.rim(k);
            for [x, y] in Fields::of(&exact).points() {
                let (touches, pressed) = (exact.gap(k, x, y) == 0.0, exact.lambda(k, x, y) > 0.0);
                match rim {
                    None => assert!(pressed || name.starts_with("biactive"), "{name}"),
                    Some(rim) => {
                        let inside = rim.signed_distance(x, y) < 0.0;
                        assert_eq!((touches, pressed), (inside, inside), "{name}: ({x}, {y})");
                    }
                }
            }
        }
    }
}

#[test]
fn choices_that_contradict_each_other_are_refused_with_the_bound() {
    let refused = |case: StackCase, pairs: &[(&str, f64)]| {
        case.solution(&chosen(pairs)).expect_err("out of range").to_string()
    };
    let messages = [
        (refused(StackCase::ThreeStrips, &[("x2", 0.5)]), "choose 0 < x2 < x1 = 0.5"),
        (refused(StackCase::ThreeDiscs, &[("R1", 0.1)]), "choose 0 < R2 < R1 = 0.1"),
        (refused(StackCase::ThreeStrips, &[("f1", 1.0)]), "choose f1/mu1 < f2/mu2 = 1"),
        (refused(StackCase::ThreeDiscs, &[("f2", 16.0)]), "choose f2/mu2 < f3/mu3 = 8"),
        (refused(StackCase::StripOnFloor, &[("f2", 6.0)]), "choose f1 + f2 < 0"),
        (refused(StackCase::TwoTensions, &[("f1", 0.0)]), "choose f1 < 0"),
        (refused(StackCase::TensionJump, &[("mu", 1.0)]), "choose mu > 1"),
        (refused(StackCase::TensionJump, &[("xm", 0.5)]), "choose 0 < xm < x1 = 0.5"),
        (refused(StackCase::FreeEnd, &[("t1", 0.5)]), "choose t1/mu1 <= t2/mu2 = 0"),
        (
            refused(StackCase::Manufactured, &[("membranes", 1.0), ("floor", 0.0)]),
            "choose 2 to 5 without a floor",
        ),
        (refused(StackCase::Manufactured, &[("free", 0.5)]), "choose free a whole number, 0 to 1"),
    ];
    for (message, end) in messages {
        assert!(message.ends_with(end), "{message}");
    }
    for case in StackCase::ALL {
        for parameter in case.parameters() {
            assert!(parameter.range.contains(parameter.default), "{case} {}", parameter.name);
            let error = case.solution(&chosen(&[(parameter.name, f64::NAN)])).expect_err("NaN");
            assert!(error.to_string().ends_with(&parameter.condition()), "{error}");
        }
    }
}

#[test]
fn all_cases_have_names_and_numbers_of_their_own_and_fit_a_terminal() {
    let fits = |line: &str| line.is_ascii() && line.len() <= 76 && line.trim_end() == line;
    for case in NamedCase::all() {
        assert_eq!(NamedCase::from_name(case.name()), Ok(case));
        let lines =
            case.formulas().iter().chain(case.notation()).chain([case.title()].iter()).all(|l| fits(l));
        assert!(lines, "{}", case.name());
        let alike = |other: &NamedCase| other.name() == case.name() || other.letter() == case.letter();
        assert_eq!(NamedCase::all().filter(alike).count(), 1, "{}", case.name());
    }
    assert_eq!(NamedCase::all().count(), 21);
    let message = NamedCase::from_name("strip-on-flor").expect_err("unknown").to_string();
    assert!(message.contains("nearest is `strip-on-floor`") && message.len() < 120, "{message}");
}
