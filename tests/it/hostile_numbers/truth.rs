//! The bound of the error is not a lie: what a finer mesh finds is no farther away than the two bounds allow.

use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::Refinement;
use membrane_contact::solver::ActiveSet;

use super::problems::{Hostile, solvable};

/// Displacements are rounded to 16 digits, and so are their differences between neighbours, of which energies are made: in the
/// energy norm rounding is this fraction of what the displacements themselves would have if they jumped from vertex to vertex.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// How far the solution is from that on the mesh refined once, in the energy norm, and what the bounds of both allow times
/// `factor`: by the triangle inequality the first is no more than the second.
fn distance_and_bound(hostile: &Hostile, factor: f64) -> Result<[f64; 2], String> {
    let d = hostile.discretize();
    let coarse = hostile.solve(&d, &mut ActiveSet)?;
    let Refinement { mesh, parents } = hostile.mesh.refine().map_err(|error| error.to_string())?;
    let finer = Hostile { name: hostile.name, problem: hostile.problem.clone(), mesh };
    let d = finer.discretize();
    let fine = finer.solve(&d, &mut ActiveSet)?;

    let prolonged = |u: &[f64]| -> Vec<f64> {
        let means = parents.iter().map(|&[a, b]| 0.5 * u[a] + 0.5 * u[b]);
        u.iter().copied().chain(means).collect()
    };
    let (mut distance_sq, mut rounding_sq) = (0.0, 0.0);
    for i in 0..2 {
        let [u, v] = [prolonged(&coarse.solution.displacement()[i]), fine.solution.displacement()[i].clone()];
        let difference: Vec<f64> = u.iter().zip(&v).map(|(u, v)| u - v).collect();
        distance_sq += d.tension()[i] * energy(&d, &difference, |k| k);
        let size = v.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        rounding_sq += d.tension()[i] * energy(&d, &vec![ROUNDING * size; v.len()], f64::abs);
    }
    let allowed = factor * (coarse.bound.total + fine.bound.total) + rounding_sq.sqrt();
    Ok([distance_sq.max(0.0).sqrt(), allowed])
}

/// `v' K v`, with a change of each entry of `K`.
fn energy(d: &PairDiscretization, v: &[f64], entry: impl Fn(f64) -> f64) -> f64 {
    d.stiffness().iter().map(|(&k, (a, b))| entry(k) * v[a as usize] * v[b as usize]).sum()
}

#[test]
fn a_finer_mesh_finds_nothing_beyond_the_bounds() {
    let mut lies = Vec::new();
    for hostile in solvable() {
        match distance_and_bound(&hostile, 1.0) {
            Ok([distance, allowed]) if distance <= allowed => {}
            Ok([distance, allowed]) => {
                lies.push(format!("{}: {distance:e} apart, {allowed:e} allowed", hostile.name));
            }
            Err(error) => lies.push(error),
        }
    }
    assert!(lies.is_empty(), "{}", lies.join("\n"));
}

#[test]
fn a_bound_that_is_too_small_is_seen() {
    let seen = solvable().into_iter().filter(|hostile| {
        let [distance, allowed] = distance_and_bound(hostile, 0.1).expect("certified");
        distance > allowed
    });
    assert!(seen.count() >= 10, "a tenth of the bounds is not enough");
}
