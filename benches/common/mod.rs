//! What the benchmarks share.

use std::time::Duration;

use criterion::Criterion;
use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::Mesh;
use membrane_contact::study::comparison::{square_mesh, square_problem};

/// Cells along a side under `cargo test --benches`, which runs each benchmark once to see that it works.
const TEST_CELLS: usize = 8;

/// The built-in family on `cells` x `cells` cells, or on few when nothing is measured.
pub fn mesh(cells: usize) -> Mesh {
    let measured = std::env::args().any(|argument| argument == "--bench");
    square_mesh(if measured { cells } else { TEST_CELLS }).expect("a valid size")
}

/// The problem of the family on one of its meshes.
pub fn discretize(mesh: &Mesh) -> PairDiscretization {
    PairDiscretization::new(&square_problem().expect("valid data"), mesh.clone()).expect("valid data")
}

/// Few samples, a few seconds for each benchmark.
pub fn criterion() -> Criterion {
    Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3))
}
