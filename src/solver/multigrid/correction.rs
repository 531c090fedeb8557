//! The linear V-cycle on the coarser levels, truncated.

use super::direct::Direct;
use super::sweep::{ascend, descend};
use super::truncation::Truncation;
use crate::solver::cholesky::NotFactored;
use crate::solver::hierarchy::Hierarchy;

/// The coarser levels with their vectors.
pub(super) struct CoarseLevels<'h> {
    hierarchy: &'h Hierarchy,
    truncation: Truncation<'h>,
    direct: Direct,
    x: Vec<Vec<f64>>,
    b: Vec<Vec<f64>>,
}

impl<'h> CoarseLevels<'h> {
    pub(super) fn new(hierarchy: &'h Hierarchy) -> Result<Self, NotFactored> {
        let coarser = || hierarchy.levels()[..hierarchy.finest()].iter();
        let zeros = || coarser().map(|level| vec![0.0; level.pattern.rows()]).collect();
        let direct = Direct::new(&hierarchy.levels()[0])?;
        Ok(Self { hierarchy, truncation: Truncation::new(hierarchy), direct, x: zeros(), b: zeros() })
    }

    /// Another level becomes the finest one, with nothing in contact yet.
    pub(super) fn restart(&mut self, finest: usize) -> Result<(), NotFactored> {
        self.truncation.reset(finest);
        self.direct.refactor(self.truncation.values(0))
    }

    /// The correction that [`solve`](Self::solve) has found.
    pub(super) fn correction(&self, finest: usize) -> &[f64] {
        &self.x[finest - 1]
    }

    /// That correction, and the functional on the level below `finest`, to be filled by restriction.
    pub(super) fn exchange(&mut self, finest: usize) -> (&[f64], &mut [f64]) {
        (&self.x[finest - 1], &mut self.b[finest - 1])
    }

    /// One V-cycle below the level `finest` for its functional, truncated where the vertices are `frozen`; those that have
    /// changed since the last time are named.
    pub(super) fn solve(
        &mut self,
        finest: usize,
        frozen: &[bool],
        changed: &[u32],
    ) -> Result<(), NotFactored> {
        if self.truncation.update(finest, frozen, changed) {
            self.direct.refactor(self.truncation.values(0))?;
        }
        let levels = self.hierarchy.levels();
        for l in (1..finest).rev() {
            let (below, above) = self.b.split_at_mut(l);
            descend(&levels[l], self.truncation.values(l), &above[0], &mut self.x[l], &mut below[l - 1]);
        }
        self.x[0] = self.direct.solve(&self.b[0])?;
        for l in 1..finest {
            let (below, above) = self.x.split_at_mut(l);
            ascend(&levels[l], self.truncation.values(l), &self.b[l], &below[l - 1], &mut above[0]);
        }
        Ok(())
    }
}
