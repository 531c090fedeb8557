//! A domain that is turned, reflected, moved or scaled: the membranes go with it.

use membrane_contact::mesh::Mesh;
use membrane_contact::problem::Function;

use super::random::{Draw, Formula};
use super::{EXACT, Fields, holds, is_seen, solve};
use crate::invariance::random::MeshDraw;
use membrane_contact::discretization::PairDiscretization;

/// `p -> origin + size Q p`, with a rotation `Q` or one after a reflection.
#[derive(Clone, Copy)]
struct Motion {
    angle: f64,
    reflected: bool,
    origin: [f64; 2],
    size: f64,
}

impl Motion {
    /// One that depends on the problem, so that all are tried.
    fn of(draw: &Draw) -> Self {
        let number = draw.tension[0].ln();
        Self {
            angle: 10.0 * number,
            reflected: draw.tension[1] > 1.0,
            origin: [number.sin(), -2.0 * number.cos()],
            size: 1.0,
        }
    }

    fn apply(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sine, cosine) = self.angle.sin_cos();
        let y = if self.reflected { -y } else { y };
        [
            self.origin[0] + self.size * (cosine * x - sine * y),
            self.origin[1] + self.size * (sine * x + cosine * y),
        ]
    }

    fn undo(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sine, cosine) = self.angle.sin_cos();
        let [x, y] = [(x - self.origin[0]) / self.size, (y - self.origin[1]) / self.size];
        let [x, y] = [cosine * x + sine * y, cosine * y - sine * x];
        [x, if self.reflected { -y } else { y }]
    }

    /// The function that goes with the domain, times a factor.
    fn carry(self, formula: &Formula, factor: f64) -> Function {
        let formula = *formula;
        Function::from_fn(move |x, y| {
            let [x, y] = self.undo([x, y]);
            factor * formula.at(x, y)
        })
    }
}

/// Solves on the moved domain, with loads times a factor, and compares: the displacements must be the same, the action the
/// same times the factor.
fn goes_with_the_domain(draw: &Draw, motion: Motion, factor: f64, mesh: &MeshDraw) -> Result<(), String> {
    let mesh = mesh.build()?;
    let d = draw.discretize(&mesh)?;
    let expected = Fields::from(&solve(&d)?);

    let points = mesh.points().iter().map(|&point| motion.apply(point)).collect();
    let moved = Mesh::new(points, mesh.triangles().to_vec()).map_err(|error| error.to_string())?;
    let [f1, f2] = draw.load.map(|load| motion.carry(&load, factor));
    let problem = draw.problem_with([f1, f2], motion.carry(&draw.height, 1.0))?;
    let d_moved = PairDiscretization::new(&problem, moved.clone()).map_err(|error| error.to_string())?;
    let mut found = Fields::from(&solve(&d_moved)?);
    found.lambda.iter_mut().for_each(|lambda| *lambda /= factor);
    expected.compare(&found, &d, EXACT)
}

holds!(rigid_motions_of_the_domain, |draw| {
    super::goes_with_the_domain(draw, super::Motion::of(draw), 1.0, &draw.mesh)
});

holds!(scalings_of_the_domain, |draw| {
    let size = draw.tension[0] * draw.tension[1];
    let motion = super::Motion { size, ..super::Motion::of(draw) };
    super::goes_with_the_domain(draw, super::Motion { origin: [0.0; 2], ..motion }, size.powi(-2), &draw.mesh)
});

#[test]
fn loads_that_stay_behind_are_seen() {
    is_seen(|draw| {
        let motion = Motion { size: 1.1, ..Motion::of(draw) };
        goes_with_the_domain(draw, motion, 1.0, &draw.mesh)
    });
}
