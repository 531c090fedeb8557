//! The solvers, in one group with the unit of work, the product `K x`: their ratio hardly depends on the machine.

mod common;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use membrane_contact::qp::Clarabel;
use membrane_contact::solver::{ActiveSet, ContactSolver, Multigrid, QpSolver, SolverOptions};
use membrane_contact::study::comparison::CsrProduct;

fn solvers() -> Vec<Box<dyn ContactSolver>> {
    vec![
        Box::new(QpSolver::new(Clarabel)),
        #[cfg(feature = "osqp")]
        Box::new(QpSolver::new(membrane_contact::qp::Osqp)),
        Box::new(ActiveSet),
        Box::new(Multigrid),
    ]
}

fn solve(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("solve");
    for cells in [32, 64] {
        let mesh = common::mesh(cells);
        let d = common::discretize(&mesh);
        let product = CsrProduct::new(d.stiffness());
        let (x, mut y) = (vec![1.0; product.size()], vec![0.0; product.size()]);
        group.bench_function(BenchmarkId::new("product", cells), |bencher| {
            bencher.iter(|| product.apply(&x, &mut y));
        });
        for mut solver in solvers() {
            let id = BenchmarkId::new(solver.name(), cells);
            group.bench_function(id, |bencher| {
                bencher.iter(|| solver.solve_pair(&d, &SolverOptions::default()).expect("it runs"));
            });
        }
    }
    group.finish();
}

criterion_group! { name = benches; config = common::criterion(); targets = solve }
criterion_main!(benches);
