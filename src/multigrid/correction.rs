//! The linear cycle on the coarser levels, truncated.
//!
//! No part of it raises the energy `1/2 x'A x - b'x` of its level: a relaxation makes it least in one coordinate (where truncation
//! has coupled rows of a colour, one row after the other); the level below has the matrix `P'A P` and the whole residual
//! `P'(b - A x)`, so that a correction with an energy of at most zero there changes the energy here by as much; and the direct
//! solve at the bottom makes least an energy that is larger by a fraction of the diagonal, which is zero at zero. So the correction
//! lowers the energy of the finest level too, as long as the obstacle does not cut it off: only then it has to be looked at.

#[cfg(test)]
mod tests;

use super::direct::Direct;
use super::sweep::{ascend, descend};
use super::truncation::Truncation;
use crate::multigrid::cholesky::NotFactored;
use crate::multigrid::hierarchy::{Hierarchy, Values};

/// With truncated hat functions, levels that are this far below the finest one get two corrections. Such functions do not
/// fit smooth ones that vanish along the rim of the contact set; in a V-cycle the errors of all levels add up, and smooth ones
/// fall by 0.3 a cycle in place of 0.1.
const TWICE: usize = 3;

/// As long as the contact set changes. What the obstacle cuts off from a smooth error is rough, and its residual larger by the
/// square of the vertices it reached over: smooth errors have to be smaller then.
const UNSETTLED_TWICE: usize = 2;

/// The level whose corrections are exact already: it is solved directly below.
const EXACT: usize = 1;

/// All visits of a level in a cycle together are to more rows than those of the level above by this factor at most. So a cycle
/// costs a few times the finest level, whatever the levels are: if each had two corrections from a level with more than half of
/// its rows, the visits of the coarsest would decide, two to the power of the number of levels.
const SHRINKING: f64 = 0.75;

/// The coarser levels with their vectors.
pub(crate) struct CoarseLevels<'h> {
    hierarchy: &'h Hierarchy,
    matrices: Matrices<'h>,
    direct: Direct,
    x: Vec<Vec<f64>>,
    b: Vec<Vec<f64>>,
}

/// The matrices of the coarser levels.
enum Matrices<'h> {
    /// Without an obstacle.
    Whole(&'h Hierarchy),
    /// They follow the vertices in contact.
    Truncated(Truncation<'h>),
}

impl Matrices<'_> {
    fn values(&self, level: usize) -> &Values {
        match self {
            Self::Whole(hierarchy) => &hierarchy.levels()[level].values,
            Self::Truncated(truncation) => truncation.values(level),
        }
    }
}

impl<'h> CoarseLevels<'h> {
    /// The levels `0..levels`; with an `obstacle` they can be truncated.
    pub(crate) fn new(hierarchy: &'h Hierarchy, levels: usize, obstacle: bool) -> Result<Self, NotFactored> {
        let coarser = || hierarchy.levels()[..levels].iter();
        let zeros = || coarser().map(|level| vec![0.0; level.pattern.rows()]).collect();
        let matrices = match obstacle {
            true => Matrices::Truncated(Truncation::new(hierarchy, levels)),
            false => Matrices::Whole(hierarchy),
        };
        let direct = Direct::new(&hierarchy.levels()[0])?;
        Ok(Self { hierarchy, matrices, direct, x: zeros(), b: zeros() })
    }

    /// Another level becomes the finest one, with nothing in contact yet.
    pub(crate) fn restart(&mut self, finest: usize) -> Result<(), NotFactored> {
        if let Matrices::Truncated(truncation) = &mut self.matrices {
            truncation.reset(finest);
            self.direct.refactor(truncation.values(0))?;
        }
        Ok(())
    }

    /// The correction that [`solve`](Self::solve) has found.
    pub(crate) fn correction(&self, finest: usize) -> &[f64] {
        &self.x[finest - 1]
    }

    /// That correction, and the functional on the level below `finest`, to be filled by restriction.
    pub(crate) fn exchange(&mut self, finest: usize) -> (&[f64], &mut [f64]) {
        (&self.x[finest - 1], &mut self.b[finest - 1])
    }

    /// One cycle below the level `finest` for its functional, truncated where the vertices are `frozen`; those that have
    /// changed since the last time are named.
    pub(crate) fn solve(
        &mut self,
        finest: usize,
        frozen: &[bool],
        changed: &[u32],
    ) -> Result<(), NotFactored> {
        let mut twice = 0;
        if let Matrices::Truncated(truncation) = &mut self.matrices {
            if truncation.update(finest, frozen, changed) {
                self.direct.refactor(truncation.values(0))?;
            }
            twice = twice_up_to(finest, !changed.is_empty());
        }
        let levels = &self.hierarchy.levels()[..=finest];
        let rows: Vec<usize> = levels.iter().map(|level| level.pattern.rows()).collect();
        self.cycle(finest - 1, &visits(&rows, twice)).map(|_| ())
    }

    /// The matrix of the finest of these levels has these entries now: of the diagonal, and off it in the order of the pattern.
    pub(super) fn replace(&mut self, diagonal: &[f64], off_diagonal: &[f64]) -> Result<(), NotFactored> {
        if let Matrices::Truncated(truncation) = &mut self.matrices
            && truncation.replace(diagonal, off_diagonal)
        {
            self.direct.refactor(truncation.values(0))?;
        }
        Ok(())
    }

    /// The functional on a level, to be filled.
    pub(super) fn functional(&mut self, l: usize) -> &mut [f64] {
        &mut self.b[l]
    }

    /// `1/2 x'A x` on the finest of these levels.
    #[cfg(test)]
    pub(super) fn energy(&self, x: &[f64]) -> f64 {
        let l = self.x.len() - 1;
        let (level, values) = (&self.hierarchy.levels()[l], self.matrices.values(l));
        let product =
            |i: usize| values.diagonal[i] * x[i] + values.off_diagonal_product(&level.pattern, i, x);
        (0..x.len()).map(|i| 0.5 * x[i] * product(i)).sum()
    }

    /// A cycle on level `l` for the functional `b`, with one correction from each level below.
    pub(super) fn v_cycle(&mut self, l: usize, b: &[f64]) -> Result<&[f64], NotFactored> {
        self.b[l].copy_from_slice(b);
        self.cycle(l, &vec![1; l + 1])
    }

    /// A cycle on level `l` from zero, for the functional there, with so many visits of each level: the correction.
    pub(super) fn cycle(&mut self, l: usize, visits: &[usize]) -> Result<&[f64], NotFactored> {
        if l == 0 {
            self.x[0] = self.direct.solve(&self.b[0])?;
            return Ok(&self.x[0]);
        }
        self.descend(l);
        self.cycle(l - 1, visits)?;
        if visits[l - 1] > visits[l] {
            self.ascend(l, true);
            self.cycle(l - 1, visits)?;
        }
        self.ascend(l, false);
        Ok(&self.x[l])
    }

    /// From zero to the functional on the level below.
    fn descend(&mut self, l: usize) {
        let (below, b) = self.b.split_at_mut(l);
        let level = &self.hierarchy.levels()[l];
        descend(level, self.matrices.values(l), &b[0], &mut self.x[l], &mut below[l - 1]);
    }

    /// From the correction of the level below, and `again` to its functional.
    fn ascend(&mut self, l: usize, again: bool) {
        let (b_below, b) = self.b.split_at_mut(l);
        let (x_below, x) = self.x.split_at_mut(l);
        let functional = again.then_some(&mut b_below[l - 1][..]);
        let level = &self.hierarchy.levels()[l];
        ascend(level, self.matrices.values(l), &b[0], &x_below[l - 1], &mut x[0], functional);
    }
}

/// Levels up to this one may have two corrections; they have to be more where the contact set has changed.
pub(super) fn twice_up_to(finest: usize, has_changed: bool) -> usize {
    finest.saturating_sub(if has_changed { UNSETTLED_TWICE } else { TWICE })
}

/// How often a cycle below the last of these levels, which have so many rows, comes to each of the others: twice as often as to the
/// level above, or as often. Levels above `twice_up_to` have one correction, and so has every level at which two would be too much
/// work.
pub(super) fn visits(rows: &[usize], twice_up_to: usize) -> Vec<usize> {
    let finest = rows.len() - 1;
    let mut visits = vec![1; finest];
    let mut allowed = rows[finest] as f64;
    for l in (0..finest).rev() {
        allowed *= SHRINKING;
        if l + 1 < finest {
            let work = 2.0 * visits[l + 1] as f64 * rows[l] as f64;
            let twice = EXACT <= l && l < twice_up_to && work <= allowed;
            visits[l] = if twice { 2 * visits[l + 1] } else { visits[l + 1] };
        }
    }
    visits
}
