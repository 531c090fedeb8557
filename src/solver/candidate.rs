//! What a solver returns, and what it may start from.

use super::statistics::Statistics;
use crate::discretization::{Displacement, PairDiscretization};
use crate::qp::Answer;

/// What a solver returns: displacements and multipliers that nobody has checked yet.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// `[u1, u2]` over vertices, boundary values included.
    pub displacement: Displacement,
    /// `y_a = lambda_a |D_a|` over unknowns. Unit: force.
    pub multiplier: Vec<f64>,
    /// How it was found.
    pub statistics: Statistics,
}

impl Candidate {
    /// The candidate that an answer to [`contact_qp`](crate::qp::contact_qp) stands for: the displacements at the
    /// unknowns get their boundary values, `g_h` and zero.
    ///
    /// # Panics
    /// When `x` has not two entries for each unknown.
    pub fn from_answer(d: &PairDiscretization, Answer { x, y }: Answer, statistics: Statistics) -> Self {
        assert_eq!(x.len(), 2 * d.interior().len(), "an answer has two displacements for each unknown");
        let (x1, x2) = x.split_at(d.interior().len());
        let displacement = [d.extend(x1, |a| d.height()[a]), d.extend(x2, |_| 0.0)];
        Self { displacement, multiplier: y, statistics }
    }
}

/// A guess of displacements and multipliers: of a nearby problem, or of a coarser mesh, prolonged.
#[derive(Debug, Clone)]
pub struct StartingPoint {
    /// `[u1, u2]` over vertices.
    pub displacement: Displacement,
    /// `y_a = lambda_a |D_a|` over unknowns.
    pub multiplier: Vec<f64>,
}

impl From<Candidate> for StartingPoint {
    fn from(candidate: Candidate) -> Self {
        Self { displacement: candidate.displacement, multiplier: candidate.multiplier }
    }
}

impl StartingPoint {
    /// Whether it has the lengths of this discretization.
    pub(crate) fn fits(&self, d: &PairDiscretization) -> bool {
        self.displacement.iter().all(|u| u.len() == d.mesh().points().len())
            && self.multiplier.len() == d.interior().len()
    }
}

/// `x = (u1, u2)` at the interior vertices.
pub(super) fn unknowns(d: &PairDiscretization, displacement: &Displacement) -> Vec<f64> {
    displacement.iter().flat_map(|u| d.interior().iter().map(|&a| u[a])).collect()
}
