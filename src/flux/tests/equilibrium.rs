//! Equilibrium with element means, by the divergence itself; zero mean residuals for any load.

use super::samples::{cubic_problem, loads, meshes, solve, touches_in_part};
use crate::discretization::{Displacement, PairDiscretization};
use crate::fem::{DEGREE_4, element_means};
use crate::flux::{Flux, Reconstruction, Reconstructor};
use crate::mesh::{Mesh, SubTriangulation, VertexKind};
use crate::numeric::largest;
use crate::problem::ContactProblem;

/// Rounding of a divergence of the size of the loads, 20: fluxes over areas of `1e-5` on the graded mesh.
const ROUNDING: f64 = 1e-9;

/// Far above rounding, below the oscillation of the loads on a triangle.
const SEEN: f64 = 1e-2;

/// The problem with the element means `f_ih` in place of `f_i`.
struct MeanLoads {
    d: PairDiscretization,
    /// `f_ih` on the triangles.
    means: Displacement,
    /// `int_K f_ih phi_a = |K| f_ih / 3`.
    integrals: [Vec<[f64; 3]>; 2],
}

impl MeanLoads {
    fn new(problem: &ContactProblem, mesh: &Mesh) -> Self {
        let mut d = PairDiscretization::new(problem, mesh.clone()).unwrap();
        let means =
            [0, 1].map(|i| element_means(mesh, &problem.as_pair().expect("a pair").load()[i]).unwrap());
        let integrals = [0, 1].map(|i: usize| {
            let third = |k: usize| [means[i][k] * mesh.triangle_area(k) / 3.0; 3];
            (0..mesh.triangles().len()).map(third).collect::<Vec<_>>()
        });
        for (load, integrals) in d.load.iter_mut().zip(&integrals) {
            load.fill(0.0);
            for (corners, integrals) in mesh.triangles().iter().zip(integrals) {
                corners.iter().zip(integrals).for_each(|(&a, integral)| load[a] += integral);
            }
        }
        Self { d, means, integrals }
    }
}

/// The largest of `|R| / |T|`, where `R` is the integral of `div t_ih - fih + (-1)^i lambda_a` over groups `T` of
/// sub-triangles that `group` numbers; those without a number do not count.
fn largest_residual(
    flux: &Flux,
    mean: &[f64],
    action: impl Fn(usize) -> f64,
    group: impl Fn(usize) -> Option<usize>,
) -> f64 {
    let sub = flux.sub_triangulation();
    let triangles = sub.mesh().triangles().len();
    let (mut residual, mut area) = (vec![0.0; triangles], vec![0.0; triangles]);
    for (t, group) in (0..triangles).filter_map(|t| group(t).map(|group| (t, group))) {
        let source = mean[sub.triangle_of(t)] + action(sub.vertex_of(t));
        residual[group] += (flux.divergence(t) - source) * sub.mesh().triangle_area(t);
        area[group] += sub.mesh().triangle_area(t);
    }
    let densities = residual.iter().zip(&area).filter(|(_, area)| **area > 0.0);
    largest(densities.map(|(residual, area)| (residual / area).abs()))
}

#[test]
fn the_divergence_is_the_mean_load_and_the_action() {
    let problem = cubic_problem();
    for (name, mesh) in meshes() {
        let MeanLoads { d, means, integrals } = MeanLoads::new(&problem, &mesh);
        let sub = SubTriangulation::new(&mesh).unwrap();
        let solution = solve(&d);
        assert!(touches_in_part(&d, &solution), "{name}");
        let reconstructor = Reconstructor::new(&d, &sub, integrals);
        for kind in Reconstruction::ALL {
            let flux = reconstructor.reconstruct(solution.displacement(), kind);
            let group = |t: usize| match kind {
                Reconstruction::Full => Some(t),
                Reconstruction::PaperCompatible => Some(t / 2),
                Reconstruction::Averaged => {
                    Some(sub.vertex_of(t)).filter(|&a| mesh.kind()[a] == VertexKind::Interior)
                }
            };
            for (i, sign) in [(0, 1.0), (1, -1.0)] {
                let residual = |factor: f64| {
                    let action = |a: usize| factor * sign * solution.lambda()[a];
                    largest_residual(&flux[i], &means[i], action, group)
                };
                assert!(residual(1.0) < ROUNDING, "{name}, {}: {:e}", kind.name(), residual(1.0));
                assert!(residual(-1.0) > SEEN && residual(0.75) > SEEN);
            }
        }
    }
}

/// With `f` itself as the load, `f - (-1)^i lambda_h - div t_ih` has the mean zero on every `K`.
#[test]
fn residuals_have_the_mean_zero_on_every_triangle_for_any_load() {
    let problem = cubic_problem();
    for (name, mesh) in meshes() {
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let sub = SubTriangulation::new(&mesh).unwrap();
        let solution = solve(&d);
        let means =
            [0, 1].map(|i| element_means(&mesh, &problem.as_pair().expect("a pair").load()[i]).unwrap());
        let reconstructor = Reconstructor::new(&d, &sub, loads(&problem, &mesh));
        for kind in [Reconstruction::Full, Reconstruction::PaperCompatible] {
            let flux = reconstructor.reconstruct(solution.displacement(), kind);
            for (i, sign) in [(0, 1.0), (1, -1.0)] {
                let action = |a: usize| sign * solution.lambda()[a];
                let on_triangles = largest_residual(&flux[i], &means[i], action, |t| Some(t / 6));
                assert!(on_triangles < ROUNDING, "{name}, {}: {on_triangles:e}", kind.name());
                let on_wedges = largest_residual(&flux[i], &means[i], action, |t| Some(t / 2));
                assert!(on_wedges > SEEN, "but not on their thirds, unless the load is constant there");
            }
        }
    }
}

/// The divergence on a wedge is the share `(3 / |K|) int_K f phi_a` of the load, here by another way: the integral over
/// the six quadrature points.
#[test]
fn the_share_of_a_wedge_is_the_load_weighted_by_the_hat_function() {
    let problem = cubic_problem();
    let mesh = crate::mesh::samples::irregular(6);
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let sub = SubTriangulation::new(&mesh).unwrap();
    let solution = solve(&d);
    let reconstructor = Reconstructor::new(&d, &sub, loads(&problem, &mesh));
    let [flux, _] = reconstructor.reconstruct(solution.displacement(), Reconstruction::Full);
    for t in 0..sub.mesh().triangles().len() {
        let (corners, i) = (mesh.corners(sub.triangle_of(t)), t / 2 % 3);
        let weighted = |power: i32| {
            let terms = DEGREE_4.points.iter().zip(DEGREE_4.weights);
            let term = |(b, weight): (&[f64; 3], &f64)| {
                let [x, y] = [0, 1].map(|axis| (0..3).map(|j| b[j] * corners[j][axis]).sum::<f64>());
                weight * b[i].powi(power) * problem.as_pair().expect("a pair").load()[0].eval(x, y).unwrap()
            };
            terms.map(term).sum::<f64>()
        };
        let action = solution.lambda()[sub.vertex_of(t)];
        assert!((flux.divergence(t) - action - 3.0 * weighted(1)).abs() < ROUNDING);
        assert!((flux.divergence(t) - action - weighted(0)).abs() > ROUNDING, "not the plain mean");
    }
}
