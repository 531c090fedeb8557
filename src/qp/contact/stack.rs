//! The discrete problem of a stack as a quadratic program.

use sprs::{CsMat, TriMat};

use crate::discretization::StackDiscretization;
use crate::qp::QpProblem;

/// The discrete problem of a stack in the unknowns `x = (u_1, ..., u_N)` at the vertices where the membranes are free:
///
/// ```text
/// P = blkdiag(K_i,II)      q_i = K_i,IB g_i - F_i      c = sum_i (1/2 g_i'K_i,BB g_i - F_iB'g_i)
/// rows, by gap and vertex: upper - lower >= 0;   a side that is known moves into b
/// ```
///
/// The multiplier of a row is `y = lambda_k |D_a| >= 0`, with which layer `k` is pushed up and layer `k + 1` down. For the
/// paper's pair this is [`contact_qp`](crate::qp::contact_qp), bit by bit.
///
/// Shapes: [`unknowns`](StackDiscretization::unknowns) variables, [`rows`](StackDiscretization::rows) constraints.
pub fn stack_qp(d: &StackDiscretization) -> QpProblem {
    let lift = d.extend(&vec![0.0; d.unknowns()]);
    let membranes = || 1..=d.membranes();
    let linear_term = |i: usize| d.free_vertices(i).iter().map(move |&a| (i, a));
    let q = membranes().flat_map(linear_term).map(|(i, a)| d.imbalance(i, a, &lift[i - 1])[0]).collect();
    let bounds = d.rows().iter().map(|row| row.bound).collect();
    let energy_of_lift = |i: usize| -> f64 {
        let g = &lift[i - 1];
        let at = |a: usize| (0.5 * d.stiffness_times(i, a, g)[0] - d.load(i)[a]) * g[a];
        (0..g.len()).filter(|&a| g[a] != 0.0).map(at).sum()
    };
    let scales = d.scales();
    QpProblem::new(stiffness_upper(d), q, gap_matrix(d), bounds)
        .and_then(|qp| qp.with_scales(scales.displacement, scales.force_density * scales.dual_area))
        .and_then(|qp| qp.with_constant(membranes().map(energy_of_lift).sum()))
        .expect("a discretization makes a valid quadratic program")
}

/// The upper triangle of `blkdiag(K_i,II)` in compressed columns; `K_i` is symmetric, so its rows are its columns.
fn stiffness_upper(d: &StackDiscretization) -> CsMat<f64> {
    let (mut start, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for i in 1..=d.membranes() {
        for (column, &a) in d.free_vertices(i).iter().enumerate() {
            let column = d.first_unknown(i) + column;
            for (b, k) in d.stiffness_row(i, a) {
                if let Some(row) = d.unknown(i, b).filter(|&row| row <= column) {
                    rows.push(row);
                    values.push(if b == a { k + d.foundation(i, a) } else { k });
                }
            }
            start.push(rows.len());
        }
    }
    CsMat::new_csc((d.unknowns(), d.unknowns()), start, rows, values)
}

/// `upper - lower` of each row.
fn gap_matrix(d: &StackDiscretization) -> CsMat<f64> {
    let shape = (d.rows().len(), d.unknowns());
    let mut triplets = TriMat::with_capacity(shape, 2 * shape.0);
    for (k, row) in d.rows().iter().enumerate() {
        for (side, sign) in [(row.upper, 1.0), (row.lower, -1.0)] {
            if let Some(unknown) = side {
                triplets.add_triplet(k, unknown, sign);
            }
        }
    }
    triplets.to_csc()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::discretization::PairDiscretization;
    use crate::mesh::samples::{assorted, irregular};
    use crate::problem::{ContactProblem, Field, Function, Membrane};
    use crate::qp::contact_qp;

    fn pair() -> ContactProblem {
        let height = Function::from_fn(|x, y| 0.3 + 0.1 * x * x + 0.01 * y);
        let load = Function::from_fn(|x, y| (3.0 * x).sin() - 15.0 * y);
        ContactProblem::pair([0.7, 3.1], [load, 10.3.into()], height).unwrap()
    }

    fn assert_equal(found: &QpProblem, expected: &QpProblem) {
        assert_eq!(found.p_upper(), expected.p_upper());
        assert_eq!(found.a(), expected.a());
        assert_eq!((found.q(), found.b()), (expected.q(), expected.b()));
        assert_eq!(found.constant(), expected.constant());
        assert_eq!(found.primal_scale(), expected.primal_scale());
        assert_eq!(found.dual_scale(), expected.dual_scale());
    }

    #[test]
    fn the_program_of_the_pair_is_that_of_the_pair_bit_by_bit() {
        for mesh in assorted().into_iter().chain([irregular(9)]) {
            let pair = pair();
            let expected = contact_qp(&PairDiscretization::new(&pair, mesh.clone()).unwrap());
            assert_equal(&stack_qp(&StackDiscretization::new(&pair, mesh).unwrap()), &expected);
        }
    }

    /// One triangle fixed at the corner at the origin, foundation 6, load 12, floor at -1: the hypotenuse is free.
    #[test]
    fn one_triangle_over_a_floor_by_hand() {
        let mesh = crate::mesh::Mesh::new(vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], vec![[0, 1, 2]]).unwrap();
        let mesh = mesh.with_curve("held", |[x, y]| x.min(y).abs() < 1e-9 && x + y < 1.0 + 1e-9).unwrap();
        let hypotenuse = mesh.clone().with_curve("free", |[x, y]| (x + y - 1.0).abs() < 1e-9).unwrap();
        assert!(mesh.groups().curve("held").is_some());
        let membrane = Membrane::new(2.0).load(12.0).foundation(6.0).height(0.0).free_on("free");
        let problem = ContactProblem::obstacle(membrane, -1.0).unwrap();
        // Both ends of the hypotenuse belong to fixed edges, which win.
        let qp = stack_qp(&StackDiscretization::new(&problem, hypotenuse.clone()).unwrap());
        assert_eq!((qp.q().len(), qp.b().len()), (0, 0));
        let free = Membrane::new(2.0).load(12.0).foundation(Field::PerTriangle([6.0].into())).free();
        let problem = ContactProblem::stack().membrane(free).floor(-1.0).ceiling(5.0).build().unwrap();
        let qp = stack_qp(&StackDiscretization::new(&problem, hypotenuse).unwrap());
        // mu K = [2, -1, -1; -1, 1, 0; -1, 0, 1], lumped foundation 6/6, load 12/6.
        assert_eq!(qp.p_times(&[1.0, 0.0, 0.0]), [3.0, -1.0, -1.0]);
        assert_eq!(qp.p_times(&[0.0, 1.0, 0.0]), [-1.0, 2.0, 0.0]);
        assert_eq!((qp.q(), qp.b()), ([-2.0; 3].as_slice(), [-5.0, -5.0, -5.0, -1.0, -1.0, -1.0].as_slice()));
        assert_eq!(qp.a_times(&[1.0, 2.0, 3.0]), [-1.0, -2.0, -3.0, 1.0, 2.0, 3.0]);
    }
}
