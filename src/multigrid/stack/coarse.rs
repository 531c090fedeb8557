//! The coarser levels: a linear cycle for what moves as one.

use sprs::CsMat;

use super::galerkin::Galerkin;
use super::level::StackLevel;
use super::levels::StackLevels;
use super::matrix::BlockMatrix;
use super::partition::Partition;
use super::reduced::Reduced;
use crate::multigrid::cholesky::{Cholesky, NotFactored};
use crate::multigrid::direct::raised;
use crate::multigrid::hierarchy::Transfer;

/// The coarser levels with their vectors, over the entries of each; those that are no blocks stay zero.
pub(super) struct CoarseLevels<'l> {
    levels: &'l StackLevels,
    partitions: Vec<Partition>,
    matrices: Vec<Reduced>,
    direct: Option<Direct>,
    x: Vec<Vec<f64>>,
    b: Vec<Vec<f64>>,
}

impl<'l> CoarseLevels<'l> {
    pub(super) fn new(levels: &'l StackLevels) -> Self {
        let n = levels.membranes();
        let rows = |l: usize| levels.hierarchy().levels()[l].pattern.rows();
        let zeros = || (0..levels.finest()).map(|l| vec![0.0; rows(l) * n]).collect();
        Self {
            levels,
            partitions: (0..levels.finest()).map(|_| Partition::default()).collect(),
            matrices: vec![Reduced::default(); levels.finest()],
            direct: None,
            x: zeros(),
            b: zeros(),
        }
    }

    /// Another level becomes the finest one, on which nothing moves yet.
    pub(super) fn restart(&mut self, finest: usize) {
        let n = self.levels.membranes();
        for l in 0..finest {
            let rows = self.levels.hierarchy().levels()[l].pattern.rows();
            self.partitions[l] = Partition::new(rows, n);
            self.matrices[l] = Reduced::new(rows, n);
            self.x[l].fill(0.0);
        }
        self.direct = None;
    }

    /// Follows the partition of the level `finest`, which has `changed`.
    ///
    /// A row changes with the blocks at its own vertex and its neighbours, and with the finer rows that it is made of.
    pub(super) fn follow(
        &mut self,
        finest: usize,
        problem: &StackLevel,
        partition: &Partition,
        changed: &[u32],
    ) -> Result<(), NotFactored> {
        let n = self.levels.membranes();
        let mut marks = Marks::default();
        let mut changed = changed.to_vec();
        let mut rows = marks.with_neighbours(&changed, &problem.matrix);
        for l in (0..finest).rev() {
            let transfer = &self.levels.hierarchy().levels()[l + 1].transfer;
            let touched = marks.parents(&changed, transfer);
            let (below, above) = self.partitions.split_at_mut(l + 1);
            let fine = if l + 1 == finest { partition } else { &above[0] };
            changed = below[l].follow(fine, transfer, self.levels.held(l), &touched);
            for &a in &changed {
                self.x[l][a as usize * n..][..n].fill(0.0);
            }
            let mut dirty = marks.parents(&rows, transfer);
            dirty.extend(marks.with_neighbours(&changed, &self.levels.problem(l.max(1)).matrix));
            dirty.sort_unstable();
            dirty.dedup();
            let coarse = &below[l];
            let (reduced, finer) = self.matrices.split_at_mut(l + 1);
            if l + 1 == finest {
                Galerkin { matrix: &problem.matrix, fine, transfer, coarse }.renew(&mut reduced[l], &dirty);
            } else {
                Galerkin { matrix: &finer[0], fine, transfer, coarse }.renew(&mut reduced[l], &dirty);
            }
            rows = dirty;
        }
        if self.direct.is_none() || !rows.is_empty() {
            self.direct = Some(Direct::new(&self.matrices[0], n)?);
        }
        Ok(())
    }

    /// The matrices of all levels.
    #[cfg(test)]
    pub(super) fn clone_matrices(&self) -> Vec<Reduced> {
        self.matrices.clone()
    }

    /// Adds to `c` the correction for the functional `r`, of which no part is on blocks that do not move.
    pub(super) fn correct(
        &mut self,
        finest: usize,
        partition: &Partition,
        r: &[f64],
        c: &mut [f64],
    ) -> Result<(), NotFactored> {
        let transfer = &self.levels.hierarchy().levels()[finest].transfer;
        let n = partition.membranes();
        let (below, b) = (&self.partitions[finest - 1], &mut self.b[finest - 1]);
        b.fill(0.0);
        for (a, r) in r.chunks_exact(n).enumerate() {
            for_blocks(partition, a, |block, len| {
                let mean = r[block..block + len].iter().sum::<f64>() / len as f64;
                transfer.for_each_parent(a, |parent, weight| {
                    (block..block + len).for_each(|i| b[below.block(parent, i)] += weight * mean);
                });
            });
        }
        self.cycle(finest - 1)?;
        let (below, x) = (&self.partitions[finest - 1], &self.x[finest - 1]);
        for (a, c) in c.chunks_exact_mut(n).enumerate() {
            for_blocks(partition, a, |block, len| {
                let mut sum = 0.0;
                transfer.for_each_parent(a, |parent, weight| {
                    sum += (block..block + len).map(|i| weight * x[below.block(parent, i)]).sum::<f64>();
                });
                c[block..block + len].iter_mut().for_each(|c| *c += sum / len as f64);
            });
        }
        Ok(())
    }

    /// A symmetric cycle on level `l` from zero.
    fn cycle(&mut self, l: usize) -> Result<(), NotFactored> {
        if l == 0 {
            return self.direct.as_ref().expect("there are matrices").solve(&self.b[0], &mut self.x[0]);
        }
        let n = self.levels.membranes();
        let transfer = &self.levels.hierarchy().levels()[l].transfer;
        let (partition, below) = (&self.partitions[l], &self.partitions[l - 1]);
        let (b_below, b) = self.b.split_at_mut(l);
        let (b_below, b) = (&mut b_below[l - 1], &b[0]);
        let (matrix, x) = (&self.matrices[l], &mut self.x[l]);
        matrix.relax_from_zero(b, x);
        b_below.fill(0.0);
        matrix.for_residuals(b, x, |block, r| {
            let (a, len) = (block / n, partition.len(block));
            let mean = r / len as f64;
            transfer.for_each_parent(a, |parent, weight| {
                (block - a * n..).take(len).for_each(|i| b_below[below.block(parent, i)] += weight * mean);
            });
        });
        self.cycle(l - 1)?;
        let (x_below, x) = self.x.split_at_mut(l);
        let (x_below, x) = (&x_below[l - 1], &mut x[0]);
        let (partition, below) = (&self.partitions[l], &self.partitions[l - 1]);
        for (a, x) in x.chunks_exact_mut(n).enumerate() {
            for_blocks(partition, a, |block, len| {
                transfer.for_each_parent(a, |parent, weight| {
                    let sum: f64 = (block..block + len).map(|i| x_below[below.block(parent, i)]).sum();
                    x[block] += weight * sum / len as f64;
                });
            });
        }
        self.matrices[l].relax_backwards(&self.b[l], &mut self.x[l]);
        Ok(())
    }
}

/// The blocks at a row that move, each by its first member and its length.
#[inline(always)]
fn for_blocks(partition: &Partition, a: usize, mut visit: impl FnMut(usize, usize)) {
    for (block, &len) in partition.lens(a).iter().enumerate().filter(|(_, len)| **len != 0) {
        visit(block, len as usize);
    }
}

/// Sets of rows, in order.
#[derive(Default)]
struct Marks(Vec<bool>);

impl Marks {
    /// Those that `visit` names.
    fn collect(&mut self, count: usize, visit: impl FnOnce(&mut dyn FnMut(usize))) -> Vec<u32> {
        self.0.clear();
        self.0.resize(count, false);
        visit(&mut |a| self.0[a] = true);
        (0..count as u32).filter(|&a| self.0[a as usize]).collect()
    }

    /// These rows, and those that are coupled to them.
    fn with_neighbours(&mut self, rows: &[u32], matrix: &BlockMatrix) -> Vec<u32> {
        self.collect(matrix.rows(), |mark| {
            for &a in rows {
                mark(a as usize);
                matrix.neighbours(a as usize).iter().for_each(|&b| mark(b as usize));
            }
        })
    }

    /// The rows of the coarser level that depend on these.
    fn parents(&mut self, rows: &[u32], transfer: &Transfer) -> Vec<u32> {
        self.collect(transfer.coarse_rows(), |mark| {
            rows.iter().for_each(|&i| transfer.for_each_parent(i as usize, |a, _| mark(a)));
        })
    }
}

/// The rows of the coarsest matrix that are not empty, factored.
struct Direct {
    cholesky: Option<Cholesky>,
    entries: Vec<u32>,
}

impl Direct {
    fn new(matrix: &Reduced, n: usize) -> Result<Self, NotFactored> {
        let diagonal = |entry: usize| matrix.diagonal(entry / n, entry);
        let entries: Vec<u32> =
            (0..matrix.entries() as u32).filter(|&i| diagonal(i as usize) != 0.0).collect();
        let mut number = vec![0; matrix.entries()];
        (0..).zip(&entries).for_each(|(k, &i)| number[i as usize] = k);
        let (mut start, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        for (k, entry) in entries.iter().map(|&entry| entry as usize).enumerate() {
            let of_row = matrix.row(entry / n, entry).filter(|&(j, _)| diagonal(j) != 0.0);
            let mut row: Vec<(usize, f64)> = of_row.map(|(j, value)| (number[j], value)).collect();
            row.push((k, raised(diagonal(entry))));
            row.sort_unstable_by_key(|&(j, _)| j);
            columns.extend(row.iter().map(|&(j, _)| j));
            values.extend(row.iter().map(|&(_, value)| value));
            start.push(columns.len());
        }
        let size = entries.len();
        let cholesky = match size {
            0 => None,
            _ => Some(Cholesky::new(CsMat::new((size, size), start, columns, values))?),
        };
        Ok(Self { cholesky, entries })
    }

    fn solve(&self, b: &[f64], x: &mut [f64]) -> Result<(), NotFactored> {
        let Some(cholesky) = &self.cholesky else { return Ok(()) };
        let b: Vec<f64> = self.entries.iter().map(|&i| b[i as usize]).collect();
        for (&i, value) in self.entries.iter().zip(cholesky.solve(&b)?) {
            x[i as usize] = value;
        }
        Ok(())
    }
}
