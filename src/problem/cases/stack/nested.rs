//! Constant tensions and loads, contact of ever fewer membranes from the middle to the rim: cases S1, S3, S4, S8.

use std::sync::Arc;

use super::layers::{LONG_SIDES, Layers, STRIP, Sheet, Surface, UNIT_DISK, circle};
use crate::geometry::Interface;
use crate::problem::cases::description::Description;
use crate::problem::cases::parameter::{CaseError, Parameter, Values};
use crate::problem::{Domain, Function};

pub(super) static FLOOR_DISK: Description<dyn Layers> = Description {
    name: "floor-disk",
    title: "unit disk, one membrane pressed on a floor in the disk of radius R",
    letter: "S1",
    formulas: &[
        "Omega = { r < 1 }, N = 1, f1 = -q, floor 0, kappa = q/(4 mu)",
        "u1     = kappa (r^2 - R^2 - 2 R^2 ln(r/R)) for r > R, else 0",
        "lambda = q for r < R, else 0",
    ],
    parameters: &[
        Parameter::positive("mu", 2.0, "tension"),
        Parameter::positive("q", 10.0, "downward load, and action in the contact zone"),
        Parameter::between("R", [0.0, 0.4, 1.0], "radius of the contact zone"),
    ],
    build: |values| {
        let [mu, q, radius] = values.all(["mu", "q", "R"]);
        Nested { shape: Shape::Disk, tension: vec![mu], load: vec![-q], ends: vec![radius], start: [0.0; 2] }
            .checked(values)
    },
};

pub(super) static THREE_STRIPS: Description<dyn Layers> = Description {
    name: "three-strips",
    title: "strip, three membranes in contact left of x2, two of them left of x1",
    letter: "S3",
    formulas: &[
        "Omega = (0,1) x (0,1/2), N = 3, long sides free, k(i..j) = -sum f/sum mu",
        "u1 = u2 = u3 = 1/5 + 3/10 x + k(1..3) x^2/2 for x < x2",
        "From there on with the same value and slope, and the second derivative",
        "k(1..2) for u1 = u2 in x2 < x < x1, k(3) for u3 in x > x2,",
        "k(1) for u1 and k(2) for u2 in x > x1",
        "lambda_k = -sum_{i<=k} (mu_i u_i'' + f_i)",
        "On meshes with x1, x2 on mesh lines exact at the nodes; lambda_h is the",
        "mean of both sides there.",
    ],
    parameters: &[
        Parameter::positive("mu1", 1.0, "tension of membrane 1"),
        Parameter::positive("mu2", 2.0, "tension of membrane 2"),
        Parameter::positive("mu3", 3.0, "tension of membrane 3"),
        Parameter::any("f1", -8.0, "load of membrane 1, f1/mu1 < f2/mu2"),
        Parameter::any("f2", 2.0, "load of membrane 2, f2/mu2 < f3/mu3"),
        Parameter::any("f3", 12.0, "load of membrane 3"),
        Parameter::between("x1", [0.0, 0.5, 1.0], "end of the contact in gap 1"),
        Parameter::between("x2", [0.0, 0.25, 1.0], "end of the contact in gap 2, below x1"),
    ],
    build: |values| Nested::three(values, Shape::Strip, ["x1", "x2"], [0.2, 0.3]),
};

pub(super) static THREE_DISCS: Description<dyn Layers> = Description {
    name: "three-discs",
    title: "unit disk, three membranes, contact in two nested discs",
    letter: "S4",
    formulas: &[
        "Omega = { r < 1 }, N = 3, k(i..j) = -sum f/sum mu",
        "u1 = u2 = u3 = k(1..3) r^2/4 for r < R2",
        "From there on with the same value and slope, and the Laplacian k(1..2)",
        "for u1 = u2 in R2 < r < R1, k(3) for u3 in r > R2, k(1) for u1 and",
        "k(2) for u2 in r > R1: v(r0) + k (r^2 - r0^2)/4",
        "                       + (r0 v'(r0) - k r0^2/2) ln(r/r0)",
        "lambda_k = -sum_{i<=k} (mu_i Lap u_i + f_i)",
    ],
    parameters: &[
        Parameter::positive("mu1", 1.0, "tension of membrane 1"),
        Parameter::positive("mu2", 2.0, "tension of membrane 2"),
        Parameter::positive("mu3", 3.0, "tension of membrane 3"),
        Parameter::any("f1", -20.0, "load of membrane 1, f1/mu1 < f2/mu2"),
        Parameter::any("f2", 4.0, "load of membrane 2, f2/mu2 < f3/mu3"),
        Parameter::any("f3", 24.0, "load of membrane 3"),
        Parameter::between("R1", [0.0, 0.3, 1.0], "radius of the contact in gap 1"),
        Parameter::between("R2", [0.0, 0.15, 1.0], "radius of the contact in gap 2, below R1"),
    ],
    build: |values| Nested::three(values, Shape::Disk, ["R1", "R2"], [0.0; 2]),
};

pub(super) static STRIP_ON_FLOOR: Description<dyn Layers> = Description {
    name: "strip-on-floor",
    title: "strip, two membranes over a floor: on it, together, apart",
    letter: "S8",
    formulas: &[
        "Omega = (0,1) x (0,1/2), N = 2, floor 0, long sides free",
        "u1 = u2 = 0 for x < x2",
        "u1 = u2 = k (x - x2)^2/2 for x2 < x < x1, k = -(f1 + f2)/(mu1 + mu2)",
        "From there on with the same value and slope, and u_i'' = -f_i/mu_i",
        "lambda_1 = -f1, -mu1 k - f1, 0; lambda_2 = -(f1 + f2), 0, 0",
        "On meshes with x1, x2 on mesh lines exact at the nodes; lambda_h is the",
        "mean of both sides there.",
    ],
    parameters: &[
        Parameter::positive("mu1", 1.0, "tension of membrane 1"),
        Parameter::positive("mu2", 2.0, "tension of membrane 2"),
        Parameter::any("f1", -6.0, "load of membrane 1, f1/mu1 < f2/mu2"),
        Parameter::any("f2", -1.0, "load of membrane 2, f1 + f2 < 0"),
        Parameter::between("x1", [0.0, 0.5, 1.0], "end of the contact in gap 1"),
        Parameter::between("x2", [0.0, 0.25, 1.0], "end of the contact with the floor, below x1"),
    ],
    build: |values| {
        let (tension, load) = (values.all(["mu1", "mu2"]).into(), values.all(["f1", "f2"]).into());
        let ends = values.all(["x1", "x2"]).into();
        Nested { shape: Shape::Strip, tension, load, ends, start: [0.0; 2] }.checked(values)
    },
};

/// The coordinate `s` on which a stack depends, and its Laplacian.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    /// `s = x`.
    Strip,
    /// `s = r`.
    Disk,
}

impl Shape {
    /// Value and slope at `s` of the function with this value and slope at `from` and the constant Laplacian `k`.
    fn continued(self, [value, slope]: [f64; 2], k: f64, from: f64, s: f64) -> [f64; 2] {
        match self {
            Self::Strip => {
                let beyond = s - from;
                [value + beyond * (slope + 0.5 * k * beyond), slope + k * beyond]
            }
            Self::Disk if from == 0.0 => [value + 0.25 * k * s * s, 0.5 * k * s],
            Self::Disk => {
                let log = from * slope - 0.5 * k * from * from;
                [value + 0.25 * k * (s - from) * (s + from) + log * (s / from).ln(), 0.5 * k * s + log / s]
            }
        }
    }
}

/// In gap `k` there is contact up to `ends[k - 1]`, and these decrease: the membranes leave the stack from below, one after the
/// other. With as many gaps as membranes, the last one is that above a floor at zero.
#[derive(Debug)]
struct Nested {
    shape: Shape,
    tension: Vec<f64>,
    load: Vec<f64>,
    ends: Vec<f64>,
    /// Value and slope of all membranes at `s = 0`.
    start: [f64; 2],
}

impl Nested {
    fn three(
        values: &Values,
        shape: Shape,
        ends: [&'static str; 2],
        start: [f64; 2],
    ) -> Result<Arc<dyn Layers>, CaseError> {
        let tension = values.all(["mu1", "mu2", "mu3"]).into();
        let load = values.all(["f1", "f2", "f3"]).into();
        Self { shape, tension, load, ends: values.all(ends).into(), start }.checked(values)
    }

    /// That the actions push and the gaps open.
    fn checked(self, values: &Values) -> Result<Arc<dyn Layers>, CaseError> {
        const LOADS: [&str; 3] = ["f1", "f2", "f3"];
        let slope = |i: usize| self.load[i] / self.tension[i];
        for i in 1..self.tension.len() {
            if slope(i - 1) >= slope(i) {
                let [above, below] = [i, i + 1];
                let bound = slope(i);
                let range = format!("f{above}/mu{above} < f{below}/mu{below} = {bound}");
                return Err(values.out_of_range(LOADS[i - 1], range));
            }
        }
        let total: f64 = self.load.iter().sum();
        if self.has_floor() && total >= 0.0 {
            let names = LOADS[..self.load.len()].join(" + ");
            return Err(values.out_of_range(LOADS[self.load.len() - 1], format!("{names} < 0")));
        }
        if let [first, second] = self.ends[..]
            && second >= first
        {
            let [one, two] = if self.shape == Shape::Strip { ["x1", "x2"] } else { ["R1", "R2"] };
            return Err(values.out_of_range(two, format!("0 < {two} < {one} = {first}")));
        }
        Ok(Arc::new(self))
    }

    fn has_floor(&self) -> bool {
        self.ends.len() == self.tension.len()
    }

    /// Where the contact in gap `k` ends; 0 where there is no such gap.
    fn end(&self, k: usize) -> f64 {
        self.ends.get(k - 1).copied().unwrap_or(0.0)
    }

    /// The Laplacian of the membranes `first ..= last` that touch.
    fn laplacian(&self, first: usize, last: usize) -> f64 {
        let sum = |values: &[f64]| values[first - 1..last].iter().sum::<f64>();
        -sum(&self.load) / sum(&self.tension)
    }

    /// Where the Laplacian of membrane `i` changes, and what it is from there on.
    fn pieces(&self, i: usize) -> Vec<[f64; 2]> {
        let mut pieces = if self.has_floor() { vec![[0.0, 0.0]] } else { Vec::new() };
        let with_those_above = (i..=self.tension.len()).rev();
        pieces.extend(with_those_above.map(|last| [self.end(last), self.laplacian(1, last)]));
        if i > 1 {
            pieces.push([self.end(i - 1), self.laplacian(i, i)]);
        }
        pieces
    }

    /// Value, slope and Laplacian of membrane `i`.
    fn at(&self, i: usize, s: f64) -> [f64; 3] {
        let mut pieces = self.pieces(i);
        let beyond = pieces.iter().skip(1).take_while(|[from, _]| s > *from).count();
        pieces.truncate(1 + beyond);
        let mut state = self.start;
        for pair in pieces.windows(2) {
            let [[from, k], [to, _]] = [pair[0], pair[1]];
            state = self.shape.continued(state, k, from, to);
        }
        let [from, k] = pieces[beyond];
        let [value, slope] = self.shape.continued(state, k, from, s);
        [value, slope, k]
    }

    fn coordinate(&self, x: f64, y: f64) -> f64 {
        match self.shape {
            Shape::Strip => x,
            Shape::Disk => x.hypot(y),
        }
    }
}

impl Layers for Nested {
    fn domain(&self) -> Domain {
        match self.shape {
            Shape::Strip => STRIP,
            Shape::Disk => UNIT_DISK,
        }
    }

    fn sheets(&self) -> Vec<Sheet> {
        let sheet = |(&tension, &load): (&f64, &f64)| {
            let sheet = Sheet::new(tension.into(), load);
            if self.shape == Shape::Strip { sheet.free_on(LONG_SIDES) } else { sheet }
        };
        self.tension.iter().zip(&self.load).map(sheet).collect()
    }

    fn floor(&self) -> Option<Function> {
        self.has_floor().then(|| 0.0.into())
    }

    fn surface(&self, i: usize, x: f64, y: f64) -> Surface {
        let [value, slope, _] = self.at(i, self.coordinate(x, y));
        match self.shape {
            Shape::Strip => Surface::along_x([value, slope]),
            Shape::Disk => Surface::around_origin(x, y, [value, slope]),
        }
    }

    /// `lambda_k = -sum_{i<=k} (mu_i Lap u_i + f_i)`.
    fn action(&self, k: usize, x: f64, y: f64) -> f64 {
        let s = self.coordinate(x, y);
        if s > self.end(k) {
            return 0.0;
        }
        let force = |i: usize| self.tension[i - 1] * self.at(i, s)[2] + self.load[i - 1];
        -(1..=k).map(force).sum::<f64>()
    }

    fn rim(&self, k: usize) -> Option<Interface> {
        let end = self.end(k);
        Some(match self.shape {
            Shape::Strip => Interface::VerticalLine { x: end },
            Shape::Disk => circle(end),
        })
    }

    fn interfaces(&self) -> Vec<Interface> {
        (1..=self.ends.len()).flat_map(|k| self.rim(k)).collect()
    }
}
