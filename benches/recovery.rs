//! From displacements to the action, the certificate and the bound of the error.

mod common;

use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use membrane_contact::action::{Action, certify_pair};
use membrane_contact::estimate::ErrorBound;
use membrane_contact::solver::{ActiveSet, ContactSolver, Multigrid, SolverOptions};
use membrane_contact::study::comparison::square_problem;

fn recovery(criterion: &mut Criterion) {
    let options = SolverOptions::default();
    let mut group = criterion.benchmark_group("recovery");
    for cells in [64, 128, 256] {
        let mesh = common::mesh(cells);
        let d = common::discretize(&mesh);
        let candidate = ActiveSet.solve_pair(&d, &options).expect("it runs");
        let displacement = candidate.as_pair().expect("of two membranes");
        group.bench_function(BenchmarkId::new("action", cells), |bencher| {
            bencher.iter(|| Action::recover(&d, displacement));
        });
        group.bench_function(BenchmarkId::new("certify", cells), |bencher| {
            let certified = |candidate| certify_pair(&d, candidate, options.tolerance).expect("it certifies");
            bencher.iter_batched(|| candidate.clone(), certified, BatchSize::LargeInput);
        });
        // To be compared: the bound should cost less than a solve.
        let problem = square_problem().expect("valid data");
        group.bench_function(BenchmarkId::new("bound", cells), |bencher| {
            bencher.iter(|| ErrorBound::new(&problem, None, &d, displacement).expect("of this mesh"));
        });
        group.bench_function(BenchmarkId::new("multigrid", cells), |bencher| {
            bencher.iter(|| Multigrid.solve_pair(&d, &options).expect("it runs"));
        });
    }
    group.finish();
}

criterion_group! { name = benches; config = common::criterion(); targets = recovery }
criterion_main!(benches);
