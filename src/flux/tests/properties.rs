//! The identities on meshes and data drawn at random.

use proptest::prelude::*;

use super::samples::{Reconstructed, loads, moved, solve};
use crate::discretization::PairDiscretization;
use crate::flux::{FluxDefects, Reconstruction, Reconstructor};
use crate::mesh::samples::square;
use crate::mesh::{Mesh, SubTriangulation, VertexKind, polygon};
use crate::numeric::Random;
use crate::problem::samples::drawn;
use crate::problem::{ContactProblem, Function};

/// As for the fixed meshes; tensions, thin triangles and stronger action are drawn with it.
const ROUNDING: f64 = 1e-11;

/// A grid whose inner vertices are moved by up to a fifth of a cell, and which is then sheared: angles up to 160 degrees.
fn jittered() -> impl Strategy<Value = Mesh> {
    let offsets = |cells: usize| prop::collection::vec([-0.2..0.2f64, -0.2..0.2], (cells + 1) * (cells + 1));
    (2usize..8).prop_flat_map(move |cells| (Just(cells), offsets(cells), -1.5..1.5f64)).prop_map(
        |(cells, offsets, shear)| {
            let regular = square(cells);
            let jitter = regular.points().iter().zip(regular.kind()).zip(offsets);
            let points = jitter.map(|((&[x, y], &kind), [dx, dy])| match kind {
                VertexKind::Interior => [x + dx / cells as f64, y + dy / cells as f64],
                _ => [x, y],
            });
            let mesh = Mesh::new(points.collect(), regular.triangles().to_vec()).unwrap();
            moved(&mesh, |[x, y]| [x + shear * y, y])
        },
    )
}

/// A star-shaped polygon of any radii with a triangular hole, in triangles of angles of at least 20 degrees.
fn polygonal() -> impl Strategy<Value = Mesh> {
    (prop::collection::vec(0.6..1.4f64, 4..9), 0.12..0.3f64).prop_map(|(radii, size)| {
        let at = |radius: f64, k: usize, n: usize| {
            let angle = std::f64::consts::TAU * k as f64 / n as f64;
            [radius * angle.cos(), radius * angle.sin()]
        };
        let ring: Vec<_> = radii.iter().enumerate().map(|(k, &r)| at(r, k, radii.len())).collect();
        let hole = (0..3).map(|k| at(0.15, k, 3)).collect();
        polygon(&ring, &[hole], size, 20.0).unwrap()
    })
}

/// The height is zero at places.
fn data() -> impl Strategy<Value = ContactProblem> {
    drawn(|height| Function::from_fn(move |x, _| height * x * x))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn solutions_have_fluxes_with_all_identities(mesh in prop_oneof![jittered(), polygonal()], problem in data()) {
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let sub = SubTriangulation::new(&mesh).unwrap();
        let solution = solve(&d);
        for kind in Reconstruction::ALL {
            let found = Reconstructed::new(&d, &sub, loads(&problem, &mesh), &solution, kind);
            for (identity, defect) in found.defects().named() {
                prop_assert!(defect < ROUNDING, "{}: {identity} {defect:e}", kind.name());
            }
        }
    }

    /// Also displacements that solve nothing have fluxes in `H(div)` with (4.13) and (4.18); equilibrium they have not.
    #[test]
    fn any_displacements_have_fluxes_in_h_div(
        mesh in prop_oneof![jittered(), polygonal()],
        problem in data(),
        seed in any::<u64>(),
    ) {
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let sub = SubTriangulation::new(&mesh).unwrap();
        let mut random = Random::new(seed);
        let scale = d.scales().displacement;
        let displacement = [(); 2].map(|()| {
            mesh.points().iter().map(|_| scale * random.between(-1.0, 1.0)).collect::<Vec<f64>>()
        });
        let lambda = vec![0.0; mesh.points().len()];
        let reconstructor = Reconstructor::new(&d, &sub, loads(&problem, &mesh));
        for kind in Reconstruction::ALL {
            let flux = reconstructor.reconstruct(&displacement, kind);
            let defects = FluxDefects::new(&reconstructor, &displacement, &lambda, &flux, kind);
            prop_assert!(defects.continuity < ROUNDING, "{defects:?}");
            prop_assert!(defects.interior < ROUNDING, "{defects:?}");
            prop_assert!(defects.balance < ROUNDING, "{defects:?}");
            prop_assert!(defects.equilibrium > 1e-6, "{defects:?}");
        }
    }
}
