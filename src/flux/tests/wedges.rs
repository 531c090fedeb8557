//! The full reconstruction wedge by wedge is that on `S_h`.

use super::samples::{cubic_problem, loads, meshes, solve};
use crate::discretization::PairDiscretization;
use crate::flux::{Reconstruction, Reconstructor, WedgeFluxes, discrete_flux};
use crate::mesh::{Mesh, SubTriangulation, VertexKind};
use crate::problem::ContactProblem;

/// Rounding of squares of fluxes, relative to the largest one on the mesh.
const ROUNDING: f64 = 1e-11;

/// The largest differences, relative, of the distances to `-mu_i grad u_ih` on triangles and of the fluxes through the
/// boundary; `kind` on `S_h` against the wedges.
fn differences(problem: &ContactProblem, mesh: &Mesh, kind: Reconstruction) -> [f64; 2] {
    let d = PairDiscretization::new(problem, mesh.clone()).unwrap();
    let solution = solve(&d);
    let sub = SubTriangulation::new(mesh).unwrap();
    let fluxes =
        Reconstructor::new(&d, &sub, loads(problem, mesh)).reconstruct(solution.displacement(), kind);
    let wedges = WedgeFluxes::new(&d, solution.displacement(), solution.lambda());
    let (mut distances, mut traces) = (Largest::default(), Largest::default());
    for (i, flux) in fluxes.iter().enumerate() {
        let q = discrete_flux(&d, i, &solution.displacement()[i]);
        for (k, &q) in q.iter().enumerate() {
            let expected = (6 * k..6 * (k + 1)).map(|t| flux.distance_sq(t, q)).sum::<f64>();
            distances.compare(wedges.distance_sq(k)[i], expected);
            for corner in (0..3).filter(|&corner| is_boundary_edge(mesh, k, corner)) {
                let found = wedges.boundary_outward(i, k, corner);
                // The first half edge of wedge 3 k + corner, and the second of the next one's.
                let [first, last] = [2 * (3 * k + corner), 2 * (3 * k + (corner + 1) % 3) + 1];
                traces.compare(found[0], flux.outward()[first][2]);
                traces.compare(found[1], flux.outward()[last][1]);
            }
        }
    }
    [distances.relative(), traces.relative()]
}

fn is_boundary_edge(mesh: &Mesh, k: usize, corner: usize) -> bool {
    let [a, b] = [0, 1].map(|j| mesh.triangles()[k][(corner + j) % 3]);
    mesh.kind()[a] == VertexKind::Boundary
        && mesh.around().triangles(a).filter(|&t| mesh.triangles()[t].contains(&b)).count() == 1
}

#[derive(Default)]
struct Largest {
    difference: f64,
    value: f64,
}

impl Largest {
    fn compare(&mut self, found: f64, expected: f64) {
        self.difference = self.difference.max((found - expected).abs());
        self.value = self.value.max(expected.abs());
    }

    fn relative(&self) -> f64 {
        self.difference / self.value
    }
}

#[test]
fn they_are_as_far_from_the_discrete_fluxes_and_let_as_much_through_the_boundary() {
    let problem = cubic_problem();
    for (name, mesh) in meshes() {
        let [distances, traces] = differences(&problem, &mesh, Reconstruction::Full);
        assert!(distances < ROUNDING && traces < ROUNDING, "{name}: {distances:e}, {traces:e}");
        let [distances, traces] = differences(&problem, &mesh, Reconstruction::PaperCompatible);
        assert!(distances > 0.1 && traces > 1e-3, "{name}: another reconstruction is another");
    }
}
