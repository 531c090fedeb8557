//! What patches contribute to a matrix.

use crate::multigrid::patches::grid::Lattice;
use crate::multigrid::patches::lanes::{LANES, Lanes};

/// A diagonal below this fraction of the whole one is what rounding has left of a hat function that is cut off everywhere.
const CUT_OFF: f64 = 1e-10;

/// The couplings in the three directions inside a patch: minus the entries of the matrix.
pub(in crate::multigrid) type Stencil = [f64; 3];

/// What the patches of a group contribute to the matrix: to its diagonal, and minus its entries in the three directions, each at the
/// point where the direction starts.
#[derive(Debug, Clone)]
pub(in crate::multigrid) struct Entries<T> {
    pub(in crate::multigrid) diagonal: Vec<Lanes<T>>,
    pub(in crate::multigrid) couplings: [Vec<Lanes<T>>; 3],
}

impl Entries<f64> {
    pub(in crate::multigrid) fn zero(lattice: &Lattice) -> Self {
        let zero = || vec![Lanes::default(); lattice.points()];
        Self { diagonal: zero(), couplings: [zero(), zero(), zero()] }
    }

    /// Those of the group with these stencils, without the rows and columns of frozen points.
    pub(in crate::multigrid) fn without(
        stencils: &[Stencil; LANES],
        lattice: &Lattice,
        is_frozen: impl Fn(usize) -> [bool; LANES],
    ) -> Self {
        let mut entries = Self::zero(lattice);
        for [i, j] in lattice.all() {
            let at = lattice.at(i, j);
            let here = is_frozen(at);
            for k in 0..3 {
                let Some(neighbour) = lattice.neighbour([i, j], k) else { continue };
                let to = lattice.at(neighbour[0], neighbour[1]);
                let there = is_frozen(to);
                // The other half of a coupling along a side is that of the patch beyond.
                let is_on_side = [j == 0, i == 0, i + j == lattice.segments][k];
                let share = if is_on_side { 0.5 } else { 1.0 };
                for lane in 0..LANES {
                    let coupling = share * stencils[lane][k];
                    let [here, there] = [here[lane], there[lane]].map(|is_frozen| f64::from(!is_frozen));
                    entries.diagonal[at].0[lane] += here * coupling;
                    entries.diagonal[to].0[lane] += there * coupling;
                    entries.couplings[k][at].0[lane] = here * there * coupling;
                }
            }
        }
        entries
    }

    /// Sets to zero what rounding has left of rows of nothing.
    pub(in crate::multigrid) fn clean(&mut self, stencils: &[Stencil; LANES]) {
        for (lane, stencil) in stencils.iter().enumerate() {
            let whole: f64 = 2.0 * stencil.iter().sum::<f64>();
            for diagonal in &mut self.diagonal {
                if diagonal.0[lane] < CUT_OFF * whole {
                    diagonal.0[lane] = 0.0;
                }
            }
        }
    }

    /// Calls `take` with the rows and columns of a patch, as they are numbered, and its entries.
    pub(in crate::multigrid) fn for_each(
        &self,
        lattice: &Lattice,
        numbers: &[[u32; LANES]],
        lane: usize,
        mut take: impl FnMut(usize, usize, f64),
    ) {
        let number = |at: usize| numbers[at][lane] as usize;
        for [i, j] in lattice.all() {
            let at = lattice.at(i, j);
            take(number(at), number(at), self.diagonal[at].0[lane]);
            for k in 0..3 {
                if let Some([p, q]) = lattice.neighbour([i, j], k) {
                    let (to, coupling) = (lattice.at(p, q), self.couplings[k][at].0[lane]);
                    take(number(at), number(to), -coupling);
                    take(number(to), number(at), -coupling);
                }
            }
        }
    }
}
