//! The repair of a contact set that cannot go on for ever.

use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Which of the wrong signs are repaired in a step: all of them, where that makes progress.
///
/// On meshes where `K` is an M-matrix this ends by itself. Elsewhere, and with rounding at vertices that touch without
/// pushing, a contact set can come back: then only the last wrong one is repaired in a step, which always ends (Murty's
/// rule for positive definite matrices), until fewer are wrong than ever before (Judice, Pires, Comput. Oper. Res. 21
/// (1994) 587).
#[derive(Default)]
pub(in crate::solver) struct Repair {
    /// The fewest that were wrong.
    fewest: Option<usize>,
    single: bool,
    /// Contact sets that were no progress.
    seen: HashSet<u64>,
}

impl Repair {
    pub(in crate::solver) fn apply(&mut self, active: &mut [bool], wrong: &[usize]) {
        let progress = self.fewest.is_none_or(|fewest| wrong.len() < fewest);
        self.single = !progress && (self.single || !self.seen.insert(fingerprint(active)));
        if progress {
            self.fewest = Some(wrong.len());
        }
        let repaired = if self.single { &wrong[wrong.len() - 1..] } else { wrong };
        repaired.iter().for_each(|&i| active[i] = !active[i]);
    }
}

/// Tells contact sets apart; two that are taken for one cost single repairs, no more.
fn fingerprint(active: &[bool]) -> u64 {
    let mut hasher = DefaultHasher::new();
    active.hash(&mut hasher);
    hasher.finish()
}
