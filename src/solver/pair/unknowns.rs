//! The unknowns of displacements.

use crate::discretization::PairDiscretization;

/// `x = (u1, u2)` at the interior vertices.
pub(in crate::solver) fn unknowns(d: &PairDiscretization, displacement: &[Vec<f64>]) -> Vec<f64> {
    displacement.iter().flat_map(|u| d.interior().iter().map(|&a| u[a])).collect()
}
