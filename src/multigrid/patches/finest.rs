//! A cycle's work on its finest level: correction, projected Gauss-Seidel, residual, restriction.

use super::field::{Field, Inflow};
use super::grid::Grid;
use super::lanes::{LANES, Lanes};
use super::matrix::Matrix;
use super::transfer::{prolong_inside, prolong_interface, restrict_inside, restrict_interface};
use crate::multigrid::sweep::{Found, ROUNDING, larger};
use crate::parallel::prelude::*;

/// The problem on a level: minimise `1/2 x'A x - b'x` where `x` is not held, subject to `x >= 0` if it is bounded.
pub(super) struct Problem<'p> {
    pub(super) grid: &'p Grid,
    pub(super) matrix: Matrix<f64>,
    pub(super) b: &'p Field<f64>,
    pub(super) is_bounded: bool,
    pub(super) weight: Weight,
    /// The largest weighted residual that is as good as none.
    pub(super) tolerance: f64,
}

/// What makes of a residual a fraction of the tolerance.
pub(super) struct Weight {
    /// Inside the patches of each group, whose triangles are alike.
    pub(super) inside: Vec<Lanes<f64>>,
    pub(super) interface: Vec<f64>,
}

/// An iterate.
#[derive(Clone)]
pub(super) struct Iterate {
    pub(super) x: Field<f64>,
    /// Where it is pressed against its bound.
    pub(super) frozen: Frozen,
}

/// Whether a value is frozen.
#[derive(Clone)]
pub(super) struct Frozen {
    pub(super) patches: Vec<[bool; LANES]>,
    pub(super) interface: Vec<bool>,
}

/// The level below a finest one.
pub(super) struct Below<'l> {
    pub(super) grid: &'l Grid,
    /// The correction; and after the sweeps the functional for the next one.
    pub(super) x: &'l mut Field<f32>,
    pub(super) b: &'l mut Field<f32>,
    pub(super) inflow: &'l mut Inflow<f32>,
    /// The correction is in this unit.
    pub(super) x_unit: f64,
    /// And the functional in this one.
    pub(super) b_unit: f64,
}

impl Frozen {
    pub(super) fn nothing(grid: &Grid) -> Self {
        Self {
            patches: vec![[false; LANES]; grid.groups() * grid.lattice.points()],
            interface: vec![false; grid.interface()],
        }
    }

    /// The groups that differ from another state; the rims of their patches follow the interface.
    pub(super) fn changed_groups(&mut self, grid: &Grid, before: &Self) -> Vec<usize> {
        let points = grid.lattice.points();
        let changes = |g: &usize| {
            let of_group = g * points..(g + 1) * points;
            for (at, places) in grid.rim(*g) {
                self.patches[of_group.start + at] = places.map(|a| self.interface[a as usize]);
            }
            self.patches[of_group.clone()] != before.patches[of_group]
        };
        (0..grid.groups()).filter(changes).collect()
    }
}

impl Problem<'_> {
    /// The correction of `old` where it is not frozen, sweeps, the residual and its restriction.
    pub(super) fn correct_and_relax(
        &self,
        old: &Iterate,
        is_corrected: bool,
        new: &mut Iterate,
        below: &mut Below,
        inflow: &mut Inflow<f64>,
    ) -> Found {
        if self.is_bounded {
            self.pass::<true>(old, is_corrected, new, below, inflow)
        } else {
            self.pass::<false>(old, is_corrected, new, below, inflow)
        }
    }

    fn pass<const BOUNDED: bool>(
        &self,
        old: &Iterate,
        is_corrected: bool,
        new: &mut Iterate,
        below: &mut Below,
        inflow: &mut Inflow<f64>,
    ) -> Found {
        let Self { grid, matrix, b, .. } = self;
        let mut cut = 0;
        new.x.interface.copy_from_slice(&old.x.interface);
        if is_corrected {
            cut += self.correct_interface::<BOUNDED>(old, &mut new.x, below);
            below.x.gather(below.grid);
        }
        cut += matrix.smooth::<BOUNDED>(grid, &mut new.x, b, inflow, |g, x| {
            if is_corrected {
                return self.correct_group::<BOUNDED>(g, old, x, below);
            }
            x.copy_from_slice(old.x.group(grid, g));
            0
        });
        let mut found = self.settle::<BOUNDED>(new, below, inflow);
        found.cut = cut;
        found
    }

    fn correct_interface<const BOUNDED: bool>(
        &self,
        old: &Iterate,
        x: &mut Field<f64>,
        below: &Below,
    ) -> usize {
        let mut cut = 0;
        prolong_interface([below.grid, self.grid], &below.x.interface, |a, correction| {
            if self.grid.is_held[a] || (BOUNDED && old.frozen.interface[a]) {
                return;
            }
            let corrected = old.x.interface[a] + below.x_unit * f64::from(correction);
            let is_cut = BOUNDED && corrected < 0.0;
            cut += usize::from(is_cut);
            x.interface[a] = if is_cut { 0.0 } else { corrected };
        });
        cut
    }

    #[inline(always)]
    fn correct_group<const BOUNDED: bool>(
        &self,
        g: usize,
        old: &Iterate,
        x: &mut [Lanes<f64>],
        below: &Below,
    ) -> usize {
        let points = self.grid.lattice.points();
        let before = old.x.group(self.grid, g);
        let frozen = &old.frozen.patches[g * points..][..points];
        let correction = below.x.group(below.grid, g);
        let mut cut = [0u32; LANES];
        prolong_inside([below.grid, self.grid], correction, |at, correction| {
            let corrected = before[at] + correction.scaled(below.x_unit);
            if BOUNDED {
                for lane in 0..LANES {
                    let is_free = !frozen[at][lane];
                    cut[lane] += u32::from(is_free && corrected.0[lane] < 0.0);
                    let bounded = if corrected.0[lane] > 0.0 { corrected.0[lane] } else { 0.0 };
                    x[at].0[lane] = if is_free { bounded } else { before[at].0[lane] };
                }
            } else {
                x[at] = corrected;
            }
        });
        cut.iter().sum::<u32>() as usize
    }

    /// Residual, energy, contact and restriction.
    fn settle<const BOUNDED: bool>(
        &self,
        new: &mut Iterate,
        below: &mut Below,
        inflow: &mut Inflow<f64>,
    ) -> Found {
        let Self { grid, matrix, b, .. } = self;
        let coarse = below.grid;
        let [points, coarse_points] = [grid, coarse].map(|grid| grid.lattice.points());
        let factor = 1.0 / below.b_unit;
        let (patches, interface) = (&mut new.x.patches, &new.x.interface);
        let groups = patches.par_chunks_mut(points).zip(new.frozen.patches.par_chunks_mut(points));
        let groups = groups.zip(inflow.sides.par_chunks_mut(grid.on_sides()));
        let coarse_sides = below.inflow.sides.par_chunks_mut(coarse.on_sides());
        let groups = groups.zip(below.b.patches.par_chunks_mut(coarse_points).zip(coarse_sides)).enumerate();
        let of_group = |r: &mut Vec<Lanes<f64>>, (g, (((x, frozen), sides), (inside, on_sides)))| {
            let x: &mut [Lanes<f64>] = x;
            grid.gather(g, interface, x);
            let found = self.settle_group::<BOUNDED>(g, x, frozen, r);
            restrict_inside([coarse, grid], r, factor, inside, on_sides);
            matrix.contribute(grid, g, x, sides);
            found
        };
        let residuals = || vec![Lanes::default(); points];
        let of_groups: Vec<Found> = groups.with_min_len(grid.task()).map_init(residuals, of_group).collect();
        let mut found = of_groups.into_iter().fold(Found::default(), |all, group| Found {
            violation: larger(all.violation, group.violation),
            energy: all.energy + group.energy,
            cut: 0,
        });
        inflow.sum_up(grid);
        below.b.interface.fill(0.0);
        coarse.add_sides(&below.inflow.sides, &mut below.b.interface);
        let mut residual = vec![0.0; grid.interface()];
        matrix.residuals_interface(grid, &new.x, b, &inflow.interface, |a, r| {
            let x = new.x.interface[a];
            found.energy -= 0.5 * x * (r + b.interface[a]);
            if grid.is_held[a] {
                return;
            }
            let is_free = !BOUNDED || x > 0.0;
            let rounding = ROUNDING * matrix.diagonal[a] * x.abs();
            let defect = if is_free { r.abs() - rounding } else { r };
            found.violation = larger(found.violation, defect * self.weight.interface[a]);
            let is_pressed = !is_free && r * self.weight.interface[a] < -self.tolerance;
            if BOUNDED {
                new.frozen.interface[a] = is_pressed;
            }
            residual[a] = if is_pressed { 0.0 } else { r };
        });
        restrict_interface([below.grid, grid], &residual, factor, below.b);
        found
    }

    /// The residuals inside the patches of a group, zero where it is frozen.
    #[inline(always)]
    fn settle_group<const BOUNDED: bool>(
        &self,
        g: usize,
        values: &[Lanes<f64>],
        frozen: &mut [[bool; LANES]],
        r: &mut [Lanes<f64>],
    ) -> Found {
        let Self { grid, matrix, b, .. } = self;
        let weight = self.weight.inside[g].0;
        let rounding = matrix.uniform[g].diagonal.0.map(|diagonal| ROUNDING * diagonal);
        let loads = b.group(grid, g);
        let (mut worst, mut energy) = ([0.0; LANES], [0.0; LANES]);
        matrix.residuals_inside(grid, g, values, loads, |at, residual| {
            let (x, b) = (values[at].0, loads[at].0);
            for lane in 0..LANES {
                let residual = residual.0[lane];
                energy[lane] += x[lane] * (residual + b[lane]);
                let is_free = !BOUNDED || x[lane] > 0.0;
                let size = residual.abs() - rounding[lane] * x[lane].abs();
                let defect = if is_free { size } else { residual } * weight[lane];
                worst[lane] = larger(worst[lane], defect);
                let is_pressed = !is_free && residual * weight[lane] < -self.tolerance;
                r[at].0[lane] = if is_pressed { 0.0 } else { residual };
                if BOUNDED {
                    frozen[at][lane] = is_pressed;
                }
            }
        });
        Found {
            violation: worst.into_iter().fold(0.0, larger),
            energy: -0.5 * energy.iter().sum::<f64>(),
            cut: 0,
        }
    }

    /// By how much the energy is larger after a step than before it: the step times the mean of the residuals.
    pub(super) fn energy_change(&self, before: &Field<f64>, after: &Field<f64>) -> f64 {
        let residuals = [before, after].map(|x| self.matrix.residual(self.grid, x, self.b));
        let step = after.zip_with(before, |after, before| after - before);
        -0.5 * residuals.iter().map(|residual| step.dot(self.grid, residual)).sum::<f64>()
    }

    /// Adds the part of the correction, cut off at the bound, that lowers the energy most: `t d`, `0 <= t <= 1`.
    pub(super) fn line_search(&self, iterate: &mut Iterate, below: &mut Below) {
        let Self { grid, matrix, b, .. } = self;
        let mut corrected = iterate.x.clone();
        self.correct_interface::<true>(iterate, &mut corrected, below);
        below.x.gather(below.grid);
        for g in 0..grid.groups() {
            self.correct_group::<true>(g, iterate, corrected.group_mut(grid, g), below);
        }
        let d = corrected.zip_with(&iterate.x, |corrected, x| corrected - x);
        let slope = matrix.residual(grid, &iterate.x, b).dot(grid, &d);
        let curvature = -matrix.residual(grid, &d, &Field::zero(grid)).dot(grid, &d);
        let step = if curvature > 0.0 { (slope / curvature).clamp(0.0, 1.0) } else { 0.0 };
        iterate.x = iterate.x.zip_with(&d, |x, d| larger(x + step * d, 0.0));
    }
}
