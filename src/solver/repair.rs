//! The repair of a contact set that cannot go on for ever.

use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};

use crate::discretization::Displacements;
use crate::qp::Status;

/// A multiplier, or a gap times its diagonal entry, below zero by less than this fraction of the terms that cancel in its row
/// is a zero, rounded. Measured in the row alone: at the tip of a mesh refined towards a point, gaps of any size are real.
pub(super) const ROUNDING: f64 = 256.0 * f64::EPSILON;

/// A gap below zero by less than this fraction of the displacements' scale is overlooked until nothing else is wrong: far from
/// the right contact set such gaps come and go, and vertices that have joined for them leave again one layer in a step
/// (138 factorisations in place of 34 for case F on 300,000 vertices).
pub(super) const SLIGHT: f64 = 1e-12;

/// A vertex is taken for touching when its multiplier is so much larger than its gap, each in units of the data. A guess
/// that is too small is repaired in fewer steps than one that is too large: all that has passed through is seen at once.
pub(super) const CAUTION: f64 = 30.0;

/// Which of the wrong signs are repaired in a step: all of them, where that makes progress.
///
/// On meshes where `K` is an M-matrix this ends by itself. Elsewhere, and with rounding at vertices that touch without
/// pushing, a contact set can come back: then only the last wrong one is repaired in a step, which always ends (Murty's
/// rule for positive definite matrices), until fewer are wrong than ever before (Judice, Pires, Comput. Oper. Res. 21
/// (1994) 587).
#[derive(Default)]
pub(super) struct Repair {
    /// The fewest that were wrong.
    fewest: Option<usize>,
    single: bool,
    /// Contact sets that were no progress.
    seen: HashSet<u64>,
}

impl Repair {
    pub(super) fn apply(&mut self, active: &mut [bool], wrong: &[usize]) {
        let progress = self.fewest.is_none_or(|fewest| wrong.len() < fewest);
        self.single = !progress && (self.single || !self.seen.insert(fingerprint(active)));
        if progress {
            self.fewest = Some(wrong.len());
        }
        let repaired = if self.single { &wrong[wrong.len() - 1..] } else { wrong };
        repaired.iter().for_each(|&i| active[i] = !active[i]);
    }
}

/// Displacements over vertices and multipliers over rows for the last contact set of the active set method.
pub(super) struct Settled {
    pub(super) displacement: Displacements,
    pub(super) multiplier: Vec<f64>,
    /// How often the contact set was repaired.
    pub(super) repairs: usize,
    /// Solved when the last contact set needed no repair.
    pub(super) status: Status,
}

/// Tells contact sets apart; two that are taken for one cost single repairs, no more.
fn fingerprint(active: &[bool]) -> u64 {
    let mut hasher = DefaultHasher::new();
    active.hash(&mut hasher);
    hasher.finish()
}
