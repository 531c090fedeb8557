//! Problems drawn at random.

use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::{Mesh, Pattern, VertexKind, disk, l_shape, polygon, rectangle};
use membrane_contact::problem::{ContactProblem, Expression, Function};
use proptest::prelude::*;

use crate::random::Random;

/// A problem and its mesh, as few numbers.
#[derive(Debug, Clone)]
pub struct Draw {
    pub mesh: MeshDraw,
    pub tension: [f64; 2],
    pub load: [Formula; 2],
    pub height: Formula,
}

/// `constant + slope . (x, y) + wave sin(4 x + 3 y)`, cut off at zero for a height.
#[derive(Debug, Clone, Copy)]
pub struct Formula {
    pub constant: f64,
    pub slope: [f64; 2],
    pub wave: f64,
    pub cut_off: bool,
}

/// How a mesh is made.
#[derive(Debug, Clone)]
pub enum MeshDraw {
    /// A rectangle in cells; their inner corners moved by up to this fraction of a cell.
    Grid { upper: [f64; 2], cells: [usize; 2], crossed: bool, moved: f64, seed: u64 },
    /// An L-shape.
    LShape { cells: usize },
    /// A disk.
    Disk { rings: usize },
    /// A polygon whose corners have these distances from the origin, in equal angles; with triangular holes of this radius.
    Polygon { radii: Vec<f64>, holes: Vec<f64>, size: f64, min_angle: f64 },
}

/// Any problem: tensions and loads over several decades, about as many with as without contact.
pub fn draw() -> impl Strategy<Value = Draw> {
    let tension = || (-3.0..3.0).prop_map(|exponent| 10_f64.powf(exponent));
    let decade = || (-2..=2).prop_map(|exponent| 10_f64.powi(exponent));
    let pushed_down = (formula(-20.0..5.0), decade()).prop_map(|(formula, size)| formula.times(size));
    let pushed_up = (formula(-5.0..20.0), decade()).prop_map(|(formula, size)| formula.times(size));
    let height =
        prop_oneof![Just(Formula::constant(0.0)), formula(-0.1..0.3), (0.0..0.3).prop_map(Formula::constant)]
            .prop_map(|height| Formula { cut_off: true, ..height });
    (mesh(), [tension(), tension()], pushed_down, pushed_up, height)
        .prop_map(|(mesh, tension, f1, f2, height)| Draw { mesh, tension, load: [f1, f2], height })
}

fn formula(constant: std::ops::Range<f64>) -> impl Strategy<Value = Formula> {
    let size = 0.5 * (constant.end - constant.start);
    let flat = constant.clone().prop_map(Formula::constant);
    let any = (constant, [-size..size, -size..size], -size..size)
        .prop_map(|(constant, slope, wave)| Formula { constant, slope, wave, cut_off: false });
    prop_oneof![flat, any]
}

fn mesh() -> impl Strategy<Value = MeshDraw> {
    let grid = ([0.5..2.0, 0.5..2.0], [1..13_usize, 1..13_usize], any::<bool>(), any::<u64>());
    let grid = |moved: f64| {
        grid.clone().prop_map(move |(upper, cells, crossed, seed)| MeshDraw::Grid {
            upper,
            cells,
            crossed,
            moved,
            seed,
        })
    };
    let radii = prop::collection::vec(0.6..1.2, 5..9);
    let holes = prop::collection::vec(0.05..0.12, 0..3);
    let polygon = (radii, holes, 0.1..0.4, 10.0..28.0)
        .prop_map(|(radii, holes, size, min_angle)| MeshDraw::Polygon { radii, holes, size, min_angle });
    prop_oneof![
        grid(0.0),
        grid(0.2),
        (1..7_usize).prop_map(|cells| MeshDraw::LShape { cells }),
        (1..9_usize).prop_map(|rings| MeshDraw::Disk { rings }),
        polygon,
    ]
}

impl Formula {
    pub fn constant(constant: f64) -> Self {
        Self { constant, slope: [0.0; 2], wave: 0.0, cut_off: false }
    }

    pub fn times(self, factor: f64) -> Self {
        let Self { constant, slope, wave, .. } = self;
        Self { constant: factor * constant, slope: slope.map(|s| factor * s), wave: factor * wave, ..self }
    }

    pub fn at(&self, x: f64, y: f64) -> f64 {
        let value =
            self.constant + self.slope[0] * x + self.slope[1] * y + self.wave * (4.0 * x + 3.0 * y).sin();
        if self.cut_off { value.max(0.0) } else { value }
    }

    /// As a user writes it: a number, or an expression.
    pub fn function(&self) -> Function {
        let Self { constant, slope: [a, b], wave, cut_off } = *self;
        if self.slope == [0.0; 2] && wave == 0.0 {
            return Function::Constant(self.at(0.0, 0.0));
        }
        let sum = format!("{constant:?} + {a:?}*x + {b:?}*y + {wave:?}*sin(4*x + 3*y)");
        let source = if cut_off { format!("max(0, {sum})") } else { sum };
        Expression::parse(&source).expect("a formula").into()
    }
}

impl Draw {
    pub fn problem(&self) -> Result<ContactProblem, String> {
        let [f1, f2] = &self.load;
        self.problem_with([f1.function(), f2.function()], self.height.function())
    }

    /// The problem with other functions.
    pub fn problem_with(&self, [f1, f2]: [Function; 2], height: Function) -> Result<ContactProblem, String> {
        let [mu1, mu2] = self.tension;
        let problem = ContactProblem::builder().tension(mu1, mu2).load(f1, f2).height(height).build();
        problem.map_err(|error| error.to_string())
    }

    pub fn discretize(&self, mesh: &Mesh) -> Result<PairDiscretization, String> {
        PairDiscretization::new(&self.problem()?, mesh.clone()).map_err(|error| error.to_string())
    }
}

impl MeshDraw {
    /// The same, but for grids that are not Delaunay.
    pub fn delaunay(&self) -> Self {
        match self.clone() {
            Self::Grid { upper, cells, seed, .. } => {
                Self::Grid { upper, cells, crossed: false, moved: 0.0, seed }
            }
            other => other,
        }
    }

    pub fn build(&self) -> Result<Mesh, String> {
        match self {
            Self::Grid { upper, cells, crossed, moved, seed } => {
                let pattern = if *crossed { Pattern::Crossed } else { Pattern::Right };
                let mesh = rectangle([0.0; 2], *upper, *cells, pattern).map_err(|error| error.to_string())?;
                let cell = [0, 1].map(|axis| upper[axis] / cells[axis] as f64);
                if *moved > 0.0 { shaken(&mesh, cell.map(|side| moved * side), *seed) } else { Ok(mesh) }
            }
            Self::LShape { cells } => l_shape(1.0, *cells, Pattern::Right).map_err(|error| error.to_string()),
            Self::Disk { rings } => disk([0.0; 2], 1.0, *rings).map_err(|error| error.to_string()),
            Self::Polygon { radii, holes, size, min_angle } => {
                let corners = ring([0.0; 2], radii);
                let hole = |(k, radius): (usize, &f64)| ring([0.44 * k as f64 - 0.22, 0.0], &[*radius; 3]);
                let holes: Vec<_> = holes.iter().enumerate().map(hole).collect();
                polygon(&corners, &holes, *size, *min_angle).map_err(|error| error.to_string())
            }
        }
    }
}

/// The corners of a polygon around `centre`.
fn ring(centre: [f64; 2], radii: &[f64]) -> Vec<[f64; 2]> {
    let corner = |(k, radius): (usize, &f64)| {
        let angle = std::f64::consts::TAU * k as f64 / radii.len() as f64;
        [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()]
    };
    radii.iter().enumerate().map(corner).collect()
}

/// The mesh with its inner vertices moved by up to `reach`.
fn shaken(mesh: &Mesh, reach: [f64; 2], seed: u64) -> Result<Mesh, String> {
    let mut random = Random::new(seed);
    let moved = mesh.points().iter().zip(mesh.kind()).map(|(&[x, y], kind)| match kind {
        VertexKind::Interior => {
            [x + reach[0] * random.between(-1.0, 1.0), y + reach[1] * random.between(-1.0, 1.0)]
        }
        _ => [x, y],
    });
    Mesh::new(moved.collect(), mesh.triangles().to_vec()).map_err(|error| error.to_string())
}
