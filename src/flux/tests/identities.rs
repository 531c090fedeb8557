//! The identities of section 4.2 on every mesh, and faults that each of them sees.

use super::samples::{Reconstructed, cubic_problem, loads, meshes, solve, touches_in_part};
use crate::discretization::{Displacement, PairDiscretization};
use crate::flux::{Flux, FluxDefects, Reconstruction, discrete_flux};
use crate::mesh::samples::irregular;
use crate::mesh::{Mesh, SubTriangulation, VertexKind};

/// Rounding of the sums around a vertex, relative to the tension times the displacement; obtuse angles cost a digit.
const ROUNDING: f64 = 1e-13;

/// Faults show with about their own size, a fraction of a flux of about `1e-2` here.
const SEEN: f64 = 1e-6;

/// Solves the cubic problem on `mesh` and hands over the fluxes of one kind.
fn with_fluxes(mesh: &Mesh, kind: Reconstruction, check: impl Fn(Reconstructed)) {
    let problem = cubic_problem();
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let sub = SubTriangulation::new(mesh).unwrap();
    let solution = solve(&d);
    assert!(touches_in_part(&d, &solution));
    check(Reconstructed::new(&d, &sub, loads(&problem, mesh), &solution, kind));
}

#[test]
fn all_identities_hold_to_rounding_on_every_mesh() {
    for (name, mesh) in meshes() {
        for kind in Reconstruction::ALL {
            with_fluxes(&mesh, kind, |found| {
                for (identity, defect) in found.defects().named() {
                    assert!(defect < ROUNDING, "{name}, {}: {identity} {defect:e}", kind.name());
                }
            });
        }
    }
}

#[test]
fn each_reconstruction_has_its_own_identities_and_not_those_of_the_others() {
    use Reconstruction::{Averaged, Full, PaperCompatible};
    let measured_as = |kind, other: Reconstruction, check: &dyn Fn(FluxDefects)| {
        with_fluxes(&irregular(8), kind, |mut found| {
            found.kind = other;
            check(found.defects());
        });
    };
    measured_as(Full, PaperCompatible, &|defects| assert!(defects.interior > SEEN, "{defects:?}"));
    measured_as(PaperCompatible, Full, &|defects| assert!(defects.equilibrium > SEEN, "{defects:?}"));
    measured_as(Averaged, PaperCompatible, &|defects| assert!(defects.equilibrium > SEEN, "{defects:?}"));
    // What is balanced on the parts is balanced on the whole.
    measured_as(Full, Averaged, &|defects| assert!(defects.equilibrium < ROUNDING, "{defects:?}"));
}

/// The fluxes of membrane `i` with `fault` applied to the outward fluxes.
fn spoil(found: &mut Reconstructed, membrane: usize, fault: impl Fn(&mut [[f64; 3]])) {
    let flux = &found.flux[membrane];
    let mut outward = flux.outward().to_vec();
    fault(&mut outward);
    found.flux[membrane] = Flux::new(flux.sub_triangulation(), outward);
}

/// The first half, (vertex, midpoint, barycentre), of a wedge at an interior vertex that touches.
fn touching_half(found: &Reconstructed) -> usize {
    let sub = found.reconstructor.sub;
    let mut halves = (0..sub.mesh().triangles().len()).step_by(2);
    halves.find(|&t| found.solution.lambda()[sub.vertex_of(t)] > 0.0).unwrap()
}

#[test]
fn a_flux_that_is_dropped_on_one_side_of_a_half_edge_is_seen() {
    for kind in Reconstruction::ALL {
        for membrane in 0..2 {
            with_fluxes(&irregular(8), kind, |mut found| {
                let t = touching_half(&found);
                spoil(&mut found, membrane, |outward| outward[t][2] = 0.0);
                let defects = found.defects();
                assert!(defects.continuity > SEEN && defects.equilibrium > SEEN && defects.balance > SEEN);
            });
        }
    }
}

#[test]
fn a_flux_between_two_cells_that_is_moved_on_both_sides_is_seen_by_the_balance() {
    with_fluxes(&irregular(8), Reconstruction::Full, |mut found| {
        let t = touching_half(&found);
        let sub = found.reconstructor.sub;
        let [_, midpoint, barycentre] = sub.mesh().triangles()[t];
        let beyond = |s: &usize| {
            *s != t && [midpoint, barycentre].iter().all(|p| sub.mesh().triangles()[*s].contains(p))
        };
        let beyond = (0..sub.mesh().triangles().len()).find(beyond).unwrap();
        spoil(&mut found, 0, |outward| {
            outward[t][0] *= 1.1;
            outward[beyond][0] *= 1.1;
        });
        let defects = found.defects();
        assert!(defects.continuity < ROUNDING);
        assert!(defects.balance > SEEN && defects.interior > SEEN && defects.equilibrium > SEEN);
    });
}

#[test]
fn signs_and_factors_matter() {
    for kind in Reconstruction::ALL {
        with_fluxes(&irregular(8), kind, |found| {
            let (u, lambda) = (found.solution.displacement(), found.solution.lambda());
            let measure = |displacement: &Displacement, lambda: &[f64], flux: &[Flux; 2]| {
                FluxDefects::new(&found.reconstructor, displacement, lambda, flux, kind)
            };
            let turned: Vec<f64> = lambda.iter().map(|lambda| -lambda).collect();
            assert!(measure(u, &turned, &found.flux).equilibrium > SEEN, "the sign of the action");
            let [first, second] = found.flux.clone();
            assert!(measure(u, lambda, &[second, first.clone()]).equilibrium > SEEN, "(-1)^i");
            let upside_down = u.clone().map(|u| u.iter().map(|u| -u).collect::<Vec<_>>());
            let defects = measure(&upside_down, lambda, &found.flux);
            assert!(defects.balance > SEEN && defects.interior > SEEN, "the sign of the flux");
            let mut wrong = found.reconstructor.clone();
            // As if |D_a cap K| were |K| / 4.
            wrong.load.iter_mut().flatten().flatten().for_each(|load| *load *= 0.75);
            let defects = FluxDefects::new(&wrong, u, lambda, &found.flux, kind);
            assert!(defects.equilibrium > SEEN, "the factor 1/3");
            // With it, the fluxes would not be in equilibrium with lambda either, but in H(div) still.
            let flux = wrong.reconstruct(u, kind);
            let defects = measure(u, lambda, &flux);
            assert!(defects.continuity < ROUNDING && defects.balance < ROUNDING);
            assert!(kind == Reconstruction::Averaged || defects.equilibrium > SEEN);
        });
    }
}

#[test]
fn nan_is_an_infinite_defect() {
    with_fluxes(&irregular(8), Reconstruction::Full, |mut found| {
        let t = touching_half(&found);
        spoil(&mut found, 1, |outward| outward[t][0] = f64::NAN);
        let defects = found.defects();
        assert!(defects.balance == f64::INFINITY && defects.continuity == f64::INFINITY);
        assert!(defects.equilibrium == f64::INFINITY && defects.interior == f64::INFINITY);
    });
}

/// `||t + mu grad u||^2` over the sub-triangles at vertex `a`.
fn distance_sq_around(found: &Reconstructed, flux: &Flux, membrane: usize, a: usize) -> f64 {
    let sub = found.reconstructor.sub;
    let q = discrete_flux(found.reconstructor.d, membrane, &found.solution.displacement()[membrane]);
    let at_a = (0..sub.mesh().triangles().len()).filter(|&t| sub.vertex_of(t) == a);
    at_a.map(|t| flux.distance_sq(t, q[sub.triangle_of(t)])).sum()
}

/// Of all fluxes with the same divergence, or with (4.13) and the same balances, the one next to `-mu grad u` is taken.
#[test]
fn a_circulation_around_any_vertex_makes_the_distance_larger() {
    for (kind, across) in [(Reconstruction::Full, 1.0), (Reconstruction::PaperCompatible, 0.0)] {
        with_fluxes(&irregular(5), kind, |found| {
            let mesh = found.reconstructor.d.mesh();
            let circulate = |membrane: usize, a: usize, alpha: f64| {
                let flux = &found.flux[membrane];
                let mut outward = flux.outward().to_vec();
                for w in 0..outward.len() / 2 {
                    if flux.sub_triangulation().vertex_of(2 * w) == a {
                        outward[2 * w][2] -= alpha;
                        outward[2 * w][1] += across * alpha;
                        outward[2 * w + 1][2] -= across * alpha;
                        outward[2 * w + 1][1] += alpha;
                    }
                }
                Flux::new(flux.sub_triangulation(), outward)
            };
            for membrane in 0..2 {
                for a in 0..mesh.points().len() {
                    let distance_sq =
                        |alpha| distance_sq_around(&found, &circulate(membrane, a, alpha), membrane, a);
                    let [less, least, more] = [-0.1, 0.0, 0.1].map(distance_sq);
                    assert!(less > least && more > least, "{membrane} {a}: {less} {least} {more}");
                    // A parabola in alpha with its vertex at zero.
                    assert!((more - less).abs() < ROUNDING * more, "{membrane} {a}: {less} {least} {more}");
                    let moved = [-0.1, 0.1].map(|step| distance_sq(0.01 + step));
                    assert!((moved[1] - moved[0]).abs() > SEEN * more);
                }
            }
            // And a circulation is no fault: it keeps all identities.
            let a = (0..mesh.points().len()).find(|&a| mesh.kind()[a] == VertexKind::Interior).unwrap();
            let flux = [0, 1].map(|membrane| circulate(membrane, a, 0.1));
            let (u, lambda) = (found.solution.displacement(), found.solution.lambda());
            let defects = FluxDefects::new(&found.reconstructor, u, lambda, &flux, kind);
            assert!(defects.named().iter().all(|(_, defect)| *defect < ROUNDING), "{defects:?}");
        });
    }
}
