//! From displacements to the action and the certificate.

mod common;

use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use membrane_contact::action::{Action, certify};
use membrane_contact::solver::{ActiveSet, ContactSolver, SolverOptions};

fn recovery(criterion: &mut Criterion) {
    let options = SolverOptions::default();
    let mut group = criterion.benchmark_group("recovery");
    for cells in [64, 128] {
        let mesh = common::mesh(cells);
        let d = common::discretize(&mesh);
        let candidate = ActiveSet.solve(&d, &options).expect("it runs");
        group.bench_function(BenchmarkId::new("action", cells), |bencher| {
            bencher.iter(|| Action::recover(&d, &candidate.displacement));
        });
        group.bench_function(BenchmarkId::new("certify", cells), |bencher| {
            let certified = |candidate| certify(&d, candidate, options.tolerance).expect("it certifies");
            bencher.iter_batched(|| candidate.clone(), certified, BatchSize::LargeInput);
        });
    }
    group.finish();
}

criterion_group! { name = benches; config = common::criterion(); targets = recovery }
criterion_main!(benches);
