//! Gauss-Seidel on a level: inside the patches, and at the interface in between.
//!
//! Points at the interface see those inside by what the patches contribute to their rows, and are relaxed vertices first, then every
//! second point of the edges, then the others. Of those, the two next to a common vertex may be coupled through a patch; each sees the other's
//! value of before. That does not raise the energy either: in the matrix of a patch, which is semidefinite, the entry between two points is
//! at most the mean of their diagonals. (Three such points, as on the edges of a patch of two segments, may raise it.)

use super::field::{Field, Inflow};
use super::grid::{Grid, Lattice};
use super::lanes::{Lanes, Real};
use super::matrix::{Matrix, Rows};
use crate::parallel::prelude::*;

/// Sweeps between two corrections.
const SWEEPS: usize = 2;

/// The colours inside a patch: whether the numbers of the row and of the point are odd.
const COLORS: [[usize; 2]; 4] = [[0, 0], [1, 1], [0, 1], [1, 0]];

impl<T: Real> Matrix<T> {
    /// Sweeps, where `BOUNDED` with values of at least zero; `first` is done to each group before, and what it returns is added up.
    pub(super) fn smooth<const BOUNDED: bool>(
        &self,
        grid: &Grid,
        x: &mut Field<T>,
        b: &Field<T>,
        inflow: &mut Inflow<T>,
        first: impl Fn(usize, &mut [Lanes<T>]) -> usize + Sync + Send,
    ) -> usize {
        let count = self.in_groups(grid, x, inflow, |g, interface, x| {
            let count = first(g, x);
            grid.gather(g, interface, x);
            count
        });
        self.relax_interface::<BOUNDED>(grid, x, b, &inflow.interface);
        for _ in 0..SWEEPS {
            self.in_groups(grid, x, inflow, |g, interface, x| {
                grid.gather(g, interface, x);
                self.relax_inside::<BOUNDED>(grid, g, x, b.group(grid, g));
                0
            });
            self.relax_interface::<BOUNDED>(grid, x, b, &inflow.interface);
        }
        count
    }

    /// Works on all groups at once, by the values at the interface; then they contribute to its rows.
    fn in_groups(
        &self,
        grid: &Grid,
        x: &mut Field<T>,
        inflow: &mut Inflow<T>,
        work: impl Fn(usize, &[T], &mut [Lanes<T>]) -> usize + Sync + Send,
    ) -> usize {
        let Field { patches, interface } = x;
        let groups = patches.par_chunks_mut(grid.lattice.points());
        let groups = groups.zip(inflow.sides.par_chunks_mut(grid.on_sides())).enumerate();
        let count = groups
            .with_min_len(grid.task())
            .map(|(g, (x, sides))| {
                let count = work(g, interface, x);
                self.contribute(grid, g, x, sides);
                count
            })
            .reduce(|| 0, |a, b| a + b);
        inflow.sum_up(grid);
        count
    }

    #[inline(always)]
    fn relax_inside<const BOUNDED: bool>(&self, grid: &Grid, g: usize, x: &mut [Lanes<T>], b: &[Lanes<T>]) {
        match &self.truncated[g] {
            None => relax::<T, BOUNDED>(&grid.lattice, &self.uniform[g], x, b),
            Some(truncated) => relax::<T, BOUNDED>(&grid.lattice, &**truncated, x, b),
        }
    }

    /// Calls `take` with the place of each point inside the patches of a group and its residuals.
    #[inline(always)]
    pub(super) fn residuals_inside(
        &self,
        grid: &Grid,
        g: usize,
        x: &[Lanes<T>],
        b: &[Lanes<T>],
        take: impl FnMut(usize, Lanes<T>),
    ) {
        match &self.truncated[g] {
            None => residuals(&grid.lattice, &self.uniform[g], x, b, take),
            Some(truncated) => residuals(&grid.lattice, &**truncated, x, b, take),
        }
    }

    /// What the patches of a group contribute to the rows of the points on their sides, but for couplings along the sides.
    #[inline(always)]
    pub(super) fn contribute(&self, grid: &Grid, g: usize, x: &[Lanes<T>], sides: &mut [Lanes<T>]) {
        for (point, side) in grid.lattice.rim.iter().zip(sides) {
            let [a, b] =
                point.inward.map(|to| self.coupling(g, to.direction, to.from, T::of(1.0)) * x[to.to]);
            *side = a + b;
        }
    }

    fn relax_interface<const BOUNDED: bool>(
        &self,
        grid: &Grid,
        x: &mut Field<T>,
        b: &Field<T>,
        inflow: &[T],
    ) {
        let m = grid.segments();
        let (x, b, partition) = (&mut x.interface, &b.interface, &grid.partition);
        let bounded = |value: T| if BOUNDED && value < T::default() { T::default() } else { value };
        for a in (0..partition.vertices).filter(|&a| self.inverse[a] != T::default()) {
            let mut sum = b[a];
            for &spoke in partition.spokes(a) {
                sum += self.along[partition.piece(spoke, m)] * x[partition.nearest(spoke, m)];
            }
            x[a] = bounded(sum * self.inverse[a]);
        }
        for first in [1, 0] {
            for (edge, &[start, end]) in partition.edges.iter().enumerate() {
                let [start, end] = [x[start as usize], x[end as usize]];
                let points = partition.first_on_edge(edge, m)..partition.first_on_edge(edge + 1, m);
                let along = &self.along[edge * m..][..m];
                let (b, inflow) = (&b[points.clone()], &inflow[points.clone()]);
                let (inverse, x) = (&self.inverse[points.clone()], &mut x[points]);
                for t in (first..m - 1).step_by(2).filter(|&t| inverse[t] != T::default()) {
                    let before = if t == 0 { start } else { x[t - 1] };
                    let after = if t + 2 == m { end } else { x[t + 1] };
                    let sum = b[t] + inflow[t] + (along[t] * before + along[t + 1] * after);
                    x[t] = bounded(sum * inverse[t]);
                }
            }
        }
    }

    /// `(b - A x)` at the interface, held points included.
    pub(super) fn residuals_interface(
        &self,
        grid: &Grid,
        x: &Field<T>,
        b: &Field<T>,
        inflow: &[T],
        mut take: impl FnMut(usize, T),
    ) {
        let m = grid.segments();
        let (x, b, partition) = (&x.interface, &b.interface, &grid.partition);
        for a in 0..partition.vertices {
            let mut sum = b[a] - self.diagonal[a] * x[a];
            for &spoke in partition.spokes(a) {
                sum += self.along[partition.piece(spoke, m)] * x[partition.nearest(spoke, m)];
            }
            take(a, sum);
        }
        for (edge, &[start, end]) in partition.edges.iter().enumerate() {
            let [start, end] = [x[start as usize], x[end as usize]];
            let first = partition.first_on_edge(edge, m);
            let along = &self.along[edge * m..][..m];
            for t in 0..m - 1 {
                let at = first + t;
                let before = if t == 0 { start } else { x[at - 1] };
                let after = if t + 2 == m { end } else { x[at + 1] };
                let sum = b[at] + inflow[at] + (along[t] * before + along[t + 1] * after);
                take(at, sum - self.diagonal[at] * x[at]);
            }
        }
    }
}

impl Matrix<f64> {
    /// `b - A x` at the points that are not held, zero at the others.
    pub(super) fn residual(&self, grid: &Grid, x: &Field<f64>, b: &Field<f64>) -> Field<f64> {
        let mut x = x.clone();
        x.gather(grid);
        let mut residual = Field::zero(grid);
        let mut inflow = Inflow::new(grid);
        for (g, sides) in inflow.sides.chunks_mut(grid.on_sides()).enumerate() {
            let (x, r) = (x.group(grid, g), residual.group_mut(grid, g));
            self.residuals_inside(grid, g, x, b.group(grid, g), |at, value| r[at] = value);
            self.contribute(grid, g, x, sides);
        }
        inflow.sum_up(grid);
        self.residuals_interface(grid, &x, b, &inflow.interface, |a, value| {
            residual.interface[a] = if grid.is_held[a] { 0.0 } else { value };
        });
        residual
    }
}

/// A sweep inside the patches of a group, colour by colour; the rows of a colour follow those of the colour before closely through the memory.
#[inline(always)]
fn relax<T: Real, const BOUNDED: bool>(
    lattice: &Lattice,
    rows: &impl Rows<T>,
    x: &mut [Lanes<T>],
    b: &[Lanes<T>],
) {
    let m = lattice.segments;
    for step in 1..m + 2 {
        for (stage, &[odd_row, odd_point]) in COLORS.iter().enumerate().take(step) {
            let j = step - stage;
            if j + 2 > m || j % 2 != odd_row {
                continue;
            }
            let start = lattice.rows(j);
            let [below, here, above] = start;
            let length = m - j;
            let (before, rest) = x.split_at_mut(here);
            let (row, after) = rest.split_at_mut(above - here);
            let (down, row, up) = (&before[below..][..length + 2], &mut row[..length + 1], &after[..length]);
            let b = &b[here..][..length];
            let mut i = 2 - odd_point;
            while i < length {
                let value = (b[i] + rows.neighbours(start, i, down, row, up)) * rows.inverse(here + i);
                row[i] = if BOUNDED { value.positive() } else { value };
                i += 2;
            }
        }
    }
}

#[inline(always)]
fn residuals<T: Real>(
    lattice: &Lattice,
    rows: &impl Rows<T>,
    x: &[Lanes<T>],
    b: &[Lanes<T>],
    mut take: impl FnMut(usize, Lanes<T>),
) {
    let m = lattice.segments;
    for j in 1..m - 1 {
        let start = lattice.rows(j);
        let [below, here, above] = start;
        let length = m - j;
        let (down, row, up) = (&x[below..][..length + 2], &x[here..][..length + 1], &x[above..][..length]);
        let b = &b[here..][..length];
        for i in 1..length {
            let sum = b[i] + rows.neighbours(start, i, down, row, up);
            take(here + i, sum - rows.diagonal(here + i) * row[i]);
        }
    }
}
