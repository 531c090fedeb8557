//! From a mesh to the discrete problem.

mod common;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use membrane_contact::fem::{load, stiffness};
use membrane_contact::study::comparison::square_problem;

fn assembly(criterion: &mut Criterion) {
    let problem = square_problem().expect("valid data");
    let mut group = criterion.benchmark_group("assembly");
    for cells in [128, 512] {
        let mesh = common::mesh(cells);
        let id = |part: &str| BenchmarkId::new(part, cells);
        group.bench_function(id("stiffness"), |bencher| bencher.iter(|| stiffness(&mesh)));
        group.bench_function(id("load"), |bencher| {
            bencher.iter(|| load(&mesh, &problem.as_pair().expect("a pair").load()[1]))
        });
        group.bench_function(id("discretization"), |bencher| {
            bencher.iter(|| common::discretize(&mesh));
        });
    }
    group.finish();
}

criterion_group! { name = benches; config = common::criterion(); targets = assembly }
criterion_main!(benches);
