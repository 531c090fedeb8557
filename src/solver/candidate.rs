//! What a solver returns, and what it may start from.

use super::statistics::Statistics;
use crate::discretization::{
    Discretization, Displacement, Displacements, PairDiscretization, StackDiscretization,
};
use crate::qp::Answer;

/// What a solver returns: displacements and multipliers that nobody has checked yet.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// Over vertices, one for each membrane from the top, fixed values included.
    pub displacement: Displacements,
    /// `y = lambda |D_a|` over rows: for a pair the unknowns of a membrane, else those of
    /// [`StackDiscretization::rows`]. Unit: force.
    pub multiplier: Vec<f64>,
    /// How it was found.
    pub statistics: Statistics,
}

impl Candidate {
    /// `[u1, u2]`, if it is one of two membranes.
    pub fn as_pair(&self) -> Option<&Displacement> {
        self.displacement.as_slice().try_into().ok()
    }

    /// The candidate that an answer to [`qp_of`](crate::qp::qp_of) stands for.
    ///
    /// # Panics
    /// When the answer has not one entry for each unknown and each row.
    pub fn from_answer(d: &Discretization, answer: Answer, statistics: Statistics) -> Self {
        match d {
            Discretization::Pair(d) => Self::from_pair_answer(d, answer, statistics),
            Discretization::Stack(d) => Self::from_stack_answer(d, answer, statistics),
        }
    }

    /// The candidate that an answer to [`contact_qp`](crate::qp::contact_qp) stands for: the displacements at the
    /// unknowns get their boundary values, `g_h` and zero.
    ///
    /// # Panics
    /// When `x` has not two entries for each unknown.
    pub fn from_pair_answer(d: &PairDiscretization, Answer { x, y }: Answer, statistics: Statistics) -> Self {
        assert_eq!(x.len(), 2 * d.interior().len(), "an answer has two displacements for each unknown");
        let (x1, x2) = x.split_at(d.interior().len());
        let displacement = vec![d.extend(x1, |a| d.height()[a]), d.extend(x2, |_| 0.0)];
        Self { displacement, multiplier: y, statistics }
    }

    /// The candidate that an answer to [`stack_qp`](crate::qp::stack_qp) stands for.
    ///
    /// # Panics
    /// When the answer has not one entry for each unknown and each row.
    pub fn from_stack_answer(d: &StackDiscretization, answer: Answer, statistics: Statistics) -> Self {
        assert_eq!(answer.x.len(), d.unknowns(), "an answer has a displacement for each unknown");
        assert_eq!(answer.y.len(), d.rows().len(), "an answer has a multiplier for each row");
        Self { displacement: d.extend(&answer.x), multiplier: answer.y, statistics }
    }
}

/// A guess of displacements and multipliers: of a nearby problem, or of a coarser mesh, prolonged.
#[derive(Debug, Clone)]
pub struct StartingPoint {
    /// Over vertices, one for each membrane from the top.
    pub displacement: Displacements,
    /// `y = lambda |D_a|` over rows, as in [`Candidate`].
    pub multiplier: Vec<f64>,
}

impl From<Candidate> for StartingPoint {
    fn from(candidate: Candidate) -> Self {
        Self { displacement: candidate.displacement, multiplier: candidate.multiplier }
    }
}

impl StartingPoint {
    /// Whether it has the lengths of this discretization; solvers leave out one that has not.
    pub fn fits(&self, d: &Discretization) -> bool {
        match d {
            Discretization::Pair(d) => self.fits_pair(d),
            Discretization::Stack(d) => self.fits_stack(d),
        }
    }

    /// Likewise.
    pub(crate) fn fits_pair(&self, d: &PairDiscretization) -> bool {
        self.has_lengths(2, d.mesh().points().len(), d.interior().len())
    }

    /// Likewise.
    pub(crate) fn fits_stack(&self, d: &StackDiscretization) -> bool {
        self.has_lengths(d.membranes(), d.mesh().points().len(), d.rows().len())
    }

    fn has_lengths(&self, membranes: usize, vertices: usize, rows: usize) -> bool {
        self.displacement.len() == membranes
            && self.displacement.iter().all(|u| u.len() == vertices)
            && self.multiplier.len() == rows
    }
}
