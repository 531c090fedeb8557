//! The sweeps of a cycle over one level, fused: what they read stays in the cache between the stages.
//!
//! A window of rows sees its two neighbours only. So a stage may follow the one before it at the distance of one window, in
//! one pass over the memory, with the same result as a pass for each stage.

use std::ops::Range;

use crate::multigrid::hierarchy::{LONGEST, Level, Values};

/// Sweeps between two corrections on the finest level.
const SWEEPS: usize = 2;

/// Sweeps before and after the correction on a coarser level: they cost little there, and save cycles.
const COARSE_SWEEPS: usize = 2;

/// What rounding may leave of a residual, as a fraction of the diagonal term in it: a quarter of what the certificate allows, for
/// either half.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The problem on a level: minimise `1/2 x'A x - b'x` subject to `x >= lower`.
#[derive(Clone, Copy)]
pub(crate) struct Bounded<'a> {
    pub(crate) level: &'a Level,
    pub(crate) b: &'a [f64],
    /// Zero for the gap, minus infinity without an obstacle.
    pub(crate) lower: f64,
    /// What makes of a residual a fraction of the tolerance.
    pub(crate) weight: &'a [f64],
    /// The largest weighted residual that is as good as none.
    pub(crate) tolerance: f64,
}

/// What a sweep over the finest level of a cycle has found.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Found {
    /// The largest weighted residual of the optimality conditions.
    pub(crate) violation: f64,
    /// `1/2 x'A x - b'x`.
    pub(crate) energy: f64,
    /// How often the correction was cut off at the bound.
    pub(crate) cut: usize,
}

/// Where a sweep over the finest level of a cycle leaves its results.
pub(crate) struct Iterate<'a> {
    pub(crate) x: &'a mut [f64],
    /// Whether `x` is pressed against its bound. At the bound without a force, it may leave it by the next correction: a wide
    /// region of such vertices would take a sweep for each layer.
    pub(crate) frozen: &'a mut [bool],
    /// The vertices where that has changed.
    pub(crate) changed: &'a mut Vec<u32>,
    /// `P' r` of the residual where `x` is not frozen.
    pub(crate) coarse: &'a mut [f64],
}

impl Iterate<'_> {
    #[inline(always)]
    fn freeze(&mut self, i: usize, frozen: bool) {
        if frozen != self.frozen[i] {
            self.frozen[i] = frozen;
            self.changed.push(i as u32);
        }
    }
}

impl Bounded<'_> {
    /// `x = max(lower, old + P c)` where `old` is not frozen, projected Gauss-Seidel sweeps through the colours, the
    /// residual and its restriction. (Rows of the last colour have no residual then, unless they are at the bound.)
    pub(crate) fn correct_and_relax(
        &self,
        old: &[f64],
        correction: Option<&[f64]>,
        mut iterate: Iterate,
    ) -> Found {
        let coloring = &self.level.coloring;
        let colors = coloring.colors();
        let relaxations = SWEEPS * colors;
        iterate.coarse.fill(0.0);
        let mut found = Found::default();
        coloring.pipeline(relaxations + 2, |stage, window| {
            if stage == 0 {
                found.cut += self.correct(coloring.window(window), old, correction, &mut iterate);
            } else if stage <= relaxations {
                self.relax(self.level.runs.of(window, (stage - 1) % colors), iterate.x);
            } else {
                for color in 0..colors - 1 {
                    self.settle(self.level.runs.of(window, color), &mut iterate, &mut found);
                }
                self.settle_last(coloring.rows(window, colors - 1), &mut iterate, &mut found);
            }
        });
        found
    }

    /// The correction of some rows: how often it was cut off.
    fn correct(
        &self,
        rows: Range<usize>,
        old: &[f64],
        correction: Option<&[f64]>,
        iterate: &mut Iterate,
    ) -> usize {
        let Some(correction) = correction else {
            iterate.x[rows.clone()].copy_from_slice(&old[rows]);
            return 0;
        };
        let mut cut = 0;
        for i in rows {
            let (corrected, is_cut) = self.corrected(i, old[i], correction, iterate.frozen[i]);
            cut += usize::from(is_cut);
            iterate.x[i] = corrected;
        }
        cut
    }

    /// `max(lower, old + P c)` where it is not frozen, and whether that was cut off.
    #[inline(always)]
    fn corrected(&self, i: usize, old: f64, correction: &[f64], frozen: bool) -> (f64, bool) {
        if frozen {
            return (old, false);
        }
        let corrected = old + self.level.transfer.prolong(i, correction);
        (larger(corrected, self.lower), corrected < self.lower)
    }

    fn relax(&self, runs: Range<usize>, x: &mut [f64]) {
        let Level { pattern, values, runs: all, .. } = self.level;
        let mut products = [0.0; LONGEST];
        for run in runs {
            let off = values.off_diagonal_products((pattern, all), run, x, &mut products);
            let rows = all.rows(run);
            let (b, inverse) = (&self.b[rows.clone()], &values.inverse[rows.clone()]);
            for (((x, b), off), inverse) in x[rows].iter_mut().zip(b).zip(off).zip(inverse) {
                *x = larger((b - off) * inverse, self.lower);
            }
        }
    }

    /// Residual, energy, contact and restriction of the rows of some runs.
    fn settle(&self, runs: Range<usize>, iterate: &mut Iterate, found: &mut Found) {
        let Level { pattern, values, runs: all, .. } = self.level;
        let mut products = [0.0; LONGEST];
        let (mut energy, mut violation) = (0.0, found.violation);
        for run in runs {
            let off = values.off_diagonal_products((pattern, all), run, iterate.x, &mut products);
            for (i, off) in all.rows(run).zip(off) {
                let x = iterate.x[i];
                let r = self.b[i] - values.diagonal[i] * x - off;
                energy -= 0.5 * x * (r + self.b[i]);
                let mut defect = r;
                let mut pressed = false;
                if x > self.lower {
                    defect = r.abs() - ROUNDING * values.diagonal[i] * x.abs();
                } else {
                    pressed = self.is_pressed(i, r);
                }
                violation = larger(violation, defect * self.weight[i]);
                iterate.freeze(i, pressed);
                if !pressed {
                    self.level.transfer.spread(i, r, iterate.coarse);
                }
            }
        }
        found.energy += energy;
        found.violation = violation;
    }

    /// The same for rows that were relaxed last: where `x` is free they have no residual.
    fn settle_last(&self, rows: Range<usize>, iterate: &mut Iterate, found: &mut Found) {
        let mut energy = 0.0;
        for i in rows {
            let x = iterate.x[i];
            energy -= 0.5 * x * self.b[i];
            let pressed = x <= self.lower && self.is_pressed(i, self.residual(i, iterate.x));
            iterate.freeze(i, pressed);
        }
        found.energy += energy;
    }

    /// Whether the force on a row at its bound is more than nothing.
    #[inline(always)]
    fn is_pressed(&self, i: usize, r: f64) -> bool {
        r * self.weight[i] < -self.tolerance
    }

    /// Zero at held vertices and nowhere below the bound.
    pub(crate) fn feasible(&self, mut x: Vec<f64>) -> Vec<f64> {
        for (i, x) in x.iter_mut().enumerate() {
            *x = if self.level.is_held(i) { 0.0 } else { larger(*x, self.lower) };
        }
        x
    }

    /// `max(0, A x - b)` where `x` is at its bound, zero elsewhere.
    pub(crate) fn multiplier(&self, x: &[f64]) -> Vec<f64> {
        let at = |i: usize| if x[i] <= self.lower { larger(-self.residual(i, x), 0.0) } else { 0.0 };
        (0..x.len()).map(at).collect()
    }

    /// By how much the energy is larger after a step than before it, as exactly as the step is known: the step times the mean
    /// of the residuals.
    pub(crate) fn energy_change(&self, before: &[f64], after: &[f64]) -> f64 {
        let mut change = 0.0;
        for i in (0..after.len()).filter(|&i| before[i] != after[i]) {
            change -= 0.5 * (after[i] - before[i]) * (self.residual(i, before) + self.residual(i, after));
        }
        change
    }

    /// Adds the part of the correction, cut off at the bound, that lowers the energy most: `t d`, `0 <= t <= 1`. Leaves `d`.
    pub(crate) fn line_search(&self, x: &mut [f64], correction: &[f64], frozen: &[bool], d: &mut [f64]) {
        for (i, (d, &x)) in d.iter_mut().zip(&*x).enumerate() {
            *d = self.corrected(i, x, correction, frozen[i]).0 - x;
        }
        let (mut slope, mut curvature) = (0.0, 0.0);
        let Level { pattern, values, .. } = self.level;
        for i in (0..x.len()).filter(|&i| d[i] != 0.0) {
            slope += self.residual(i, x) * d[i];
            curvature += (values.diagonal[i] * d[i] + values.off_diagonal_product(pattern, i, d)) * d[i];
        }
        let step = if curvature > 0.0 { (slope / curvature).clamp(0.0, 1.0) } else { 0.0 };
        for (x, d) in x.iter_mut().zip(d) {
            *x = larger(*x + step * *d, self.lower);
        }
    }

    /// `(b - A x)_i`.
    #[inline(always)]
    pub(crate) fn residual(&self, i: usize, x: &[f64]) -> f64 {
        let Level { pattern, values, .. } = self.level;
        self.b[i] - values.diagonal[i] * x[i] - values.off_diagonal_product(pattern, i, x)
    }
}

/// On a coarser level: Gauss-Seidel sweeps from zero for `A x = b`, the residual and its restriction.
pub(crate) fn descend(level: &Level, values: &Values, b: &[f64], x: &mut [f64], coarse: &mut [f64]) {
    let coloring = &level.coloring;
    let colors = coloring.colors();
    let relaxations = COARSE_SWEEPS * colors;
    x.fill(0.0);
    coarse.fill(0.0);
    coloring.pipeline(relaxations + 1, |stage, window| {
        if stage == 0 {
            relax_from_zero(level, values, b, level.runs.of(window, 0), x);
        } else if stage < relaxations {
            relax(level, values, b, level.runs.of(window, stage % colors), x);
        } else {
            restrict_residual(level, values, b, window, x, coarse);
        }
    });
}

/// On a coarser level: the correction from the level below, Gauss-Seidel sweeps, and for another correction the residual
/// and its restriction.
pub(crate) fn ascend(
    level: &Level,
    values: &Values,
    b: &[f64],
    correction: &[f64],
    x: &mut [f64],
    coarse: Option<&mut [f64]>,
) {
    let Level { coloring, transfer, .. } = level;
    let colors = coloring.colors();
    let relaxations = COARSE_SWEEPS * colors;
    let mut coarse = coarse;
    if let Some(coarse) = &mut coarse {
        coarse.fill(0.0);
    }
    coloring.pipeline(relaxations + 1 + usize::from(coarse.is_some()), |stage, window| {
        if stage == 0 {
            for i in coloring.window(window) {
                if values.inverse[i] != 0.0 {
                    x[i] += transfer.prolong(i, correction);
                }
            }
        } else if stage <= relaxations {
            relax(level, values, b, level.runs.of(window, (stage - 1) % colors), x);
        } else if let Some(coarse) = &mut coarse {
            restrict_residual(level, values, b, window, x, coarse);
        }
    });
}

/// Adds the restriction of the residual of a window. Rows of its last colour have no residual, unless truncation has coupled them
/// to others of that colour, which were relaxed after them.
fn restrict_residual(
    level: &Level,
    values: &Values,
    b: &[f64],
    window: usize,
    x: &[f64],
    coarse: &mut [f64],
) {
    let Level { pattern, coloring, runs, transfer, .. } = level;
    let mut products = [0.0; LONGEST];
    let mut restrict = |run: usize| {
        let off = values.off_diagonal_products((pattern, runs), run, x, &mut products);
        for (i, off) in runs.rows(run).zip(off) {
            transfer.spread(i, b[i] - values.diagonal[i] * x[i] - off, coarse);
        }
    };
    let last = coloring.colors() - 1;
    (0..last).flat_map(|color| runs.of(window, color)).for_each(&mut restrict);
    runs.of(window, last).filter(|&run| values.is_replaced(run)).for_each(&mut restrict);
}

/// Gauss-Seidel for the rows of some runs.
fn relax(level: &Level, values: &Values, b: &[f64], runs: Range<usize>, x: &mut [f64]) {
    let mut products = [0.0; LONGEST];
    for run in runs {
        if values.is_replaced(run) {
            relax_in_turn(level, values, b, run, x);
            continue;
        }
        let off = values.off_diagonal_products((&level.pattern, &level.runs), run, x, &mut products);
        let rows = level.runs.rows(run);
        let (b, inverse) = (&b[rows.clone()], &values.inverse[rows.clone()]);
        for (((x, b), off), inverse) in x[rows].iter_mut().zip(b).zip(off).zip(inverse) {
            *x = (b - off) * inverse;
        }
    }
}

/// Likewise where `x` is zero but for rows of this colour, which are not coupled unless truncation has done so.
fn relax_from_zero(level: &Level, values: &Values, b: &[f64], runs: Range<usize>, x: &mut [f64]) {
    for run in runs {
        if values.is_replaced(run) {
            relax_in_turn(level, values, b, run, x);
            continue;
        }
        for i in level.runs.rows(run) {
            x[i] = b[i] * values.inverse[i];
        }
    }
}

/// Likewise for rows that may be coupled to each other: each after the one before.
fn relax_in_turn(level: &Level, values: &Values, b: &[f64], run: usize, x: &mut [f64]) {
    for i in level.runs.rows(run) {
        x[i] = (b[i] - values.off_diagonal_product(&level.pattern, i, x)) * values.inverse[i];
    }
}

/// The larger of two numbers that are not NaN; a NaN as the first one is kept.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a < b { b } else { a }
}
