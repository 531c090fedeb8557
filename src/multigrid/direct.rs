//! The coarsest level, where systems are solved directly.

use sprs::CsMat;

use crate::multigrid::cholesky::{Cholesky, NotFactored};
use crate::multigrid::hierarchy::{Level, Values};

/// Truncated hat functions can depend on each other, and the matrix is singular then. With its diagonal raised by this
/// fraction it has a factor; the correction still lowers the energy, and is the same but for this fraction.
const SHIFT: f64 = 1e-10;

/// An entry of the diagonal, raised.
pub(super) fn raised(diagonal: f64) -> f64 {
    (1.0 + SHIFT) * diagonal
}

/// A Cholesky factor that follows the truncated matrix of a level.
pub(crate) struct Direct {
    cholesky: Cholesky,
    /// Where each stored entry comes from: among the entries off the diagonal, and after them the diagonal.
    source: Vec<usize>,
}

impl Direct {
    pub(crate) fn new(level: &Level) -> Result<Self, NotFactored> {
        let rows = level.pattern.rows();
        let entries = level.values.off_diagonal.len();
        let (mut start, mut columns, mut source) = (vec![0], Vec::new(), Vec::new());
        for i in 0..rows {
            let off =
                level.pattern.row(i).iter().zip(level.pattern.range(i)).map(|(&j, at)| (j as usize, at));
            // Couplings to held vertices have no counterpart in their empty rows.
            let mut row: Vec<(usize, usize)> = off.filter(|&(j, _)| !level.is_held(j)).collect();
            row.push((i, entries + i));
            row.sort_unstable();
            columns.extend(row.iter().map(|&(j, _)| j));
            source.extend(row.iter().map(|&(_, at)| at));
            start.push(columns.len());
        }
        let zeros = vec![0.0; columns.len()];
        let mut direct =
            Self { cholesky: Cholesky::symbolic(CsMat::new((rows, rows), start, columns, zeros))?, source };
        direct.refactor(&level.values)?;
        Ok(direct)
    }

    /// Follows a change of the matrix. Rows that are empty are solved for as zero.
    pub(crate) fn refactor(&mut self, values: &Values) -> Result<(), NotFactored> {
        let entries = values.off_diagonal.len();
        let value = |&at: &usize| match at.checked_sub(entries) {
            None => values.off_diagonal[at],
            Some(row) if values.diagonal[row] == 0.0 => 1.0,
            Some(row) => raised(values.diagonal[row]),
        };
        self.cholesky.refactor(self.source.iter().map(value))
    }

    pub(crate) fn solve(&self, b: &[f64]) -> Result<Vec<f64>, NotFactored> {
        self.cholesky.solve(b)
    }
}
