//! The reduced discrete problem (3.4) as a quadratic program.

mod stack;

use sprs::{CsMat, TriMat};

pub use stack::stack_qp;

use super::QpProblem;
use crate::discretization::{Discretization, PairDiscretization};

/// The discrete problem as a quadratic program: [`contact_qp`] or [`stack_qp`].
pub fn qp_of(d: &Discretization) -> QpProblem {
    match d {
        Discretization::Pair(d) => contact_qp(d),
        Discretization::Stack(d) => stack_qp(d),
    }
}

/// (3.4) in the unknowns `x = (u1, u2)` at the interior vertices, boundary values eliminated:
///
/// ```text
/// P = blkdiag(mu1 K_II, mu2 K_II)       q = (mu1 K_IB g_B - F_1, -F_2)
/// A = [I, -I]                           b = 0         c = mu1/2 g_B'K_BB g_B - F_1B'g_B
/// ```
///
/// With the constant `c`, the objective is the energy (2.9).
///
/// The multiplier of row `a` is `y_a = lambda_a |D_a|`, a force. Boundary values are eliminated, not kept as equality
/// rows: `P` stays positive definite, and every solver does less work.
///
/// Shapes: with `n` interior vertices, `2 n` variables and `n` constraints.
pub fn contact_qp(d: &PairDiscretization) -> QpProblem {
    let n = d.interior().len();
    let q = (0..2).flat_map(|i| linear_term(d, i)).collect();
    let scales = d.scales();
    QpProblem::new(block_diagonal_upper(&d.interior_stiffness(), d.tension()), q, gap_matrix(n), vec![0.0; n])
        .and_then(|qp| qp.with_scales(scales.displacement, scales.force_density * scales.dual_area))
        .and_then(|qp| qp.with_constant(energy_of_lift(d)))
        .expect("a discretization makes a valid quadratic program")
}

/// `mu_i K_IB g_B - F_i`, where `g` is zero for membrane 2: the imbalance of displacements that vanish inside.
fn linear_term(d: &PairDiscretization, i: usize) -> Vec<f64> {
    let lift = |a: usize| if i == 0 { d.height()[a] } else { 0.0 };
    d.imbalance(i, &d.extend(&vec![0.0; d.interior().len()], lift))
}

/// The energy of `g_h` for membrane 1 and zero for membrane 2: that of `x = 0`.
fn energy_of_lift(d: &PairDiscretization) -> f64 {
    let g = d.height();
    let at = |a: usize| (0.5 * d.tension()[0] * d.stiffness_row(a, |b| g[b]) - d.load()[0][a]) * g[a];
    (0..g.len()).filter(|&a| g[a] != 0.0).map(at).sum()
}

/// The upper triangle of `blkdiag(mu1 K, mu2 K)` in compressed columns; `K` is symmetric, so its rows are its columns.
fn block_diagonal_upper(k: &CsMat<f64>, tension: [f64; 2]) -> CsMat<f64> {
    let n = k.rows();
    let (mut start, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for (block, mu) in tension.into_iter().enumerate() {
        for (column, entries) in k.outer_iterator().enumerate() {
            for (row, value) in entries.iter().filter(|&(row, _)| row <= column) {
                rows.push(block * n + row);
                values.push(mu * value);
            }
            start.push(rows.len());
        }
    }
    CsMat::new_csc((2 * n, 2 * n), start, rows, values)
}

/// `[I, -I]`: the gap `u1 - u2` of a pair.
fn gap_matrix(n: usize) -> CsMat<f64> {
    let mut triplets = TriMat::with_capacity((n, 2 * n), 2 * n);
    for a in 0..n {
        triplets.add_triplet(a, a, 1.0);
        triplets.add_triplet(a, n + a, -1.0);
    }
    triplets.to_csc()
}

#[cfg(test)]
mod tests;
