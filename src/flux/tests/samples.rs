//! Meshes of every kind, data of every kind, solutions to reconstruct fluxes from.

use std::path::Path;

use crate::action::{PairSolution, certify_pair};
use crate::discretization::PairDiscretization;
use crate::fem::element_loads;
use crate::flux::{Flux, FluxDefects, Reconstruction, Reconstructor};
use crate::mesh::samples::{irregular, renumbered, square, square_without};
use crate::mesh::{Mesh, Pattern, SubTriangulation, disk, l_shape, polygon, rectangle};
use crate::problem::{ContactProblem, Function};
use crate::solver::{ActiveSet, Candidate, ContactSolver, SolverOptions};

/// What is asked of the certificate; the active set method leaves rounding.
const TOLERANCE: f64 = 1e-9;

/// Vertices moved, triangles kept.
pub(super) fn moved(mesh: &Mesh, to: impl Fn([f64; 2]) -> [f64; 2]) -> Mesh {
    Mesh::new(mesh.points().iter().map(|&point| to(point)).collect(), mesh.triangles().to_vec()).unwrap()
}

fn read(file: &str) -> Mesh {
    Mesh::read_gmsh(&Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap()
}

/// Structured, unstructured, from Gmsh, graded, with obtuse angles, with two fans at a vertex, with an unused vertex, in
/// any order.
pub(super) fn meshes() -> Vec<(&'static str, Mesh)> {
    let ring = vec![[0.0, 0.0], [1.2, 0.1], [1.0, 1.1], [0.3, 0.9]];
    let hole = vec![[0.5, 0.4], [0.7, 0.45], [0.6, 0.6]];
    let with_unused = [irregular(6).points(), &[[0.31, 0.3]]].concat();
    vec![
        ("right", square(8)),
        ("crossed", rectangle([0.0, 0.0], [1.5, 1.0], [6, 5], Pattern::Crossed).unwrap()),
        ("L-shape", l_shape(1.0, 5, Pattern::Right).unwrap()),
        ("disk", disk([0.1, 0.5], 1.0, 6).unwrap()),
        ("polygon with hole", polygon(&ring, &[hole], 0.1, 25.0).unwrap()),
        ("gmsh, hole", read("tests/data/gmsh/hole_41.msh")),
        ("gmsh, plate", read("examples/plate.msh")),
        ("graded", moved(&renumbered(&irregular(9), 4).0, |[x, y]| [x * x, y * y])),
        ("obtuse", moved(&irregular(8), |[x, y]| [x + 1.5 * y, y])),
        ("touching holes", square_without(8, |i, j| i == j && (i == 3 || i == 4))),
        ("unused vertex", Mesh::new(with_unused, irregular(6).triangles().to_vec()).unwrap()),
    ]
}

/// Cubic loads, which quadrature integrates exactly, different tensions, a height that varies. The first membrane is
/// pushed down where `y` is large and up where it is small: some of it touches.
pub(super) fn cubic_problem() -> ContactProblem {
    ContactProblem::builder()
        .tension(1.0, 3.0)
        .load(
            Function::from_fn(|x, y| 40.0 * (0.5 - y) - 2.0 * x * x * y),
            Function::from_fn(|x, y| 2.0 + x * y - 3.0 * y * y * y),
        )
        .height(Function::from_fn(|x, y| 0.02 + 0.005 * x * y + 0.01 * y * y))
        .build()
        .unwrap()
}

/// `int_K f_i phi_a` for both loads of a problem.
pub(super) fn loads(problem: &ContactProblem, mesh: &Mesh) -> [Vec<[f64; 3]>; 2] {
    [0, 1].map(|i| element_loads(mesh, &problem.as_pair().expect("a pair").load()[i]).unwrap())
}

/// The certified solution.
pub(super) fn solve(d: &PairDiscretization) -> PairSolution {
    let candidate: Candidate = ActiveSet.solve_pair(d, &SolverOptions::default()).unwrap();
    certify_pair(d, candidate, TOLERANCE).unwrap_or_else(|rejected| panic!("{rejected}"))
}

/// A solved problem with its fluxes of one kind.
pub(super) struct Reconstructed<'a> {
    pub(super) reconstructor: Reconstructor<'a>,
    pub(super) solution: &'a PairSolution,
    pub(super) kind: Reconstruction,
    pub(super) flux: [Flux<'a>; 2],
}

impl<'a> Reconstructed<'a> {
    pub(super) fn new(
        d: &'a PairDiscretization,
        sub: &'a SubTriangulation,
        load: [Vec<[f64; 3]>; 2],
        solution: &'a PairSolution,
        kind: Reconstruction,
    ) -> Self {
        let reconstructor = Reconstructor::new(d, sub, load);
        let flux = reconstructor.reconstruct(solution.displacement(), kind);
        Self { reconstructor, solution, kind, flux }
    }

    pub(super) fn defects(&self) -> FluxDefects {
        let (displacement, lambda) = (self.solution.displacement(), self.solution.lambda());
        FluxDefects::new(&self.reconstructor, displacement, lambda, &self.flux, self.kind)
    }
}

/// Whether some interior vertices touch and others do not: only then does the sign of the action matter.
pub(super) fn touches_in_part(d: &PairDiscretization, solution: &PairSolution) -> bool {
    let touching = d.interior().iter().filter(|&&a| solution.lambda()[a] > 0.0).count();
    0 < touching && touching < d.interior().len()
}
