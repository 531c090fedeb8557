//! The coarser levels: a linear cycle for what moves as one.

use sprs::CsMat;

use super::galerkin::galerkin;
use super::level::StackLevel;
use super::levels::StackLevels;
use super::partition::Partition;
use super::reduced::Reduced;
use crate::multigrid::cholesky::{Cholesky, NotFactored};
use crate::multigrid::direct::raised;

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

    /// Follows the partition of the level `finest`.
    pub(super) fn update(
        &mut self,
        finest: usize,
        problem: &StackLevel,
        partition: &Partition,
    ) -> Result<(), NotFactored> {
        for l in (0..finest).rev() {
            let transfer = &self.levels.hierarchy().levels()[l + 1].transfer;
            let held = self.levels.held(l);
            if l + 1 == finest {
                self.partitions[l] = partition.coarsened(transfer, held);
                self.matrices[l] = galerkin((&problem.matrix, partition), transfer, &self.partitions[l]);
            } else {
                let (below, above) = self.partitions.split_at_mut(l + 1);
                below[l] = above[0].coarsened(transfer, held);
                self.matrices[l] = galerkin((&self.matrices[l + 1], &above[0]), transfer, &below[l]);
            }
            self.x[l].fill(0.0);
        }
        self.direct = Some(Direct::new(&self.matrices[0])?);
        Ok(())
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

/// The rows of the coarsest matrix that are not empty, factored.
struct Direct {
    cholesky: Option<Cholesky>,
    rows: Vec<u32>,
}

impl Direct {
    fn new(matrix: &Reduced) -> Result<Self, NotFactored> {
        let rows: Vec<u32> =
            (0..matrix.rows() as u32).filter(|&i| matrix.diagonal[i as usize] != 0.0).collect();
        let mut number = vec![0; matrix.rows()];
        (0..).zip(&rows).for_each(|(k, &i)| number[i as usize] = k);
        let (mut start, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        for (k, &i) in rows.iter().enumerate() {
            let of_row = matrix.row(i as usize).filter(|&(j, _)| matrix.diagonal[j] != 0.0);
            let mut row: Vec<(usize, f64)> = of_row.map(|(j, value)| (number[j], value)).collect();
            row.push((k, raised(matrix.diagonal[i as usize])));
            row.sort_unstable_by_key(|&(j, _)| j);
            columns.extend(row.iter().map(|&(j, _)| j));
            values.extend(row.iter().map(|&(_, value)| value));
            start.push(columns.len());
        }
        let size = rows.len();
        let cholesky = match size {
            0 => None,
            _ => Some(Cholesky::new(CsMat::new((size, size), start, columns, values))?),
        };
        Ok(Self { cholesky, rows })
    }

    fn solve(&self, b: &[f64], x: &mut [f64]) -> Result<(), NotFactored> {
        let Some(cholesky) = &self.cholesky else { return Ok(()) };
        let b: Vec<f64> = self.rows.iter().map(|&i| b[i as usize]).collect();
        for (&i, value) in self.rows.iter().zip(cholesky.solve(&b)?) {
            x[i as usize] = value;
        }
        Ok(())
    }
}
