//! The example of the README: a plate with holes on a mesh from Gmsh, with every backend.

use std::path::Path;

use membrane_contact::action::certify_pair;
use membrane_contact::cli::{CaseFile, MeshSource};
use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::Mesh;

use crate::common::{TOLERANCE, distance, solve, solvers};

/// The displacements of two backends agree to this fraction of their range.
const AGREEMENT: f64 = 1e-6;

/// Unpolished ones agree to the square root of the tolerance: both gap and action may be that large at one vertex.
const UNPOLISHED: f64 = 1e-4;

/// A polished result is right to rounding, amplified by the square of the mesh size (here 1e3).
const POLISHED: f64 = 1e-10;

/// Multigrid knows the contact set, but solves to its tolerance only.
const ITERATED: f64 = 1e-7;

fn plate() -> (CaseFile, Mesh) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/plate.toml");
    let case = CaseFile::read(&path).expect("the example is valid");
    let MeshSource::File(mesh) = &case.mesh else { panic!("the example's mesh comes from Gmsh") };
    let mesh = Mesh::read_gmsh(mesh).expect("the mesh is valid");
    (case, mesh)
}

#[test]
fn backends_agree_on_displacements_action_and_contact() {
    let (case, mesh) = plate();
    let d = PairDiscretization::new(&case.problem, mesh.clone()).unwrap();
    let range = |u: &[f64]| u.iter().copied().fold(0.0, f64::max) - u.iter().copied().fold(0.0, f64::min);
    let solutions: Vec<_> = solvers()
        .into_iter()
        .flat_map(|mut solver| [true, false].map(|polish| (polish, solve(solver.as_mut(), &d, polish))))
        .map(|(polish, candidate)| (polish, certify_pair(&d, candidate, TOLERANCE).expect("certified")))
        .collect();
    let (_, reference) = &solutions[0];
    for (polish, solution) in &solutions {
        for i in 0..2 {
            let [u, v] = [&reference.displacement()[i], &solution.displacement()[i]];
            let agreement = if *polish { AGREEMENT } else { UNPOLISHED };
            assert!(distance(u, v) < agreement * range(u));
        }
        let differing: Vec<usize> =
            (0..mesh.points().len()).filter(|&a| reference.contact()[a] != solution.contact()[a]).collect();
        if *polish {
            assert!(differing.is_empty(), "polished, the contact sets are the same");
            let agreement = if solution.statistics().solver == "multigrid" { ITERATED } else { POLISHED };
            assert!(distance(reference.lambda(), solution.lambda()) < agreement * d.scales().force_density);
        }
        for a in differing {
            assert!(
                at_free_boundary(&mesh, reference.contact(), a),
                "vertex {a} is not at the free boundary"
            );
        }
    }
}

/// Whether a triangle at `a` has corners in and out of contact.
fn at_free_boundary(mesh: &Mesh, contact: &[bool], a: usize) -> bool {
    mesh.triangles()
        .iter()
        .filter(|corners| corners.contains(&a))
        .any(|corners| corners.iter().any(|&b| contact[b]) && corners.iter().any(|&b| !contact[b]))
}
