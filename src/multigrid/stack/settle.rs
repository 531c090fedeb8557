//! What an iterate is worth: its residuals, and which membranes are pressed together.

use super::level::StackLevel;
use super::partition::{Blocks, Partition, PartitionChunk};
use super::sweep::{CHUNK, Sweeps};
use crate::multigrid::sweep::Found;

/// What rounding may leave of a residual, as a fraction of the diagonal terms in it.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// How residuals are measured.
#[derive(Clone, Copy)]
pub(super) struct Measure<'a> {
    /// What makes of the residual at a row a fraction of the tolerance.
    pub(super) weight: &'a [f64],
    /// The largest weighted residual that is as good as none.
    pub(super) tolerance: f64,
}

/// What is found on consecutive rows.
struct Chunk<'a> {
    partition: PartitionChunk<'a>,
    first: usize,
    found: Found,
    changed: Vec<u32>,
}

/// The residual `r = b - K x`; the partition by what is pressed together, and the rows where that has changed.
pub(super) fn settle(
    level: &StackLevel,
    sweeps: &Sweeps,
    x: &[f64],
    r: &mut [f64],
    partition: &mut Partition,
    measure: Measure,
) -> (Found, Vec<u32>) {
    let firsts = (0..).step_by(CHUNK);
    let chunk = |(partition, first)| Chunk { partition, first, found: Found::default(), changed: Vec::new() };
    let chunks: Vec<Chunk> = partition.chunks(CHUNK).zip(firsts).map(chunk).collect();
    let chunks = sweeps.residuals(x, &level.load, r, chunks, |chunk: &mut Chunk, a, x, r| {
        let mut violation: f64 = 0.0;
        let load = &level.load[level.entries(a)];
        chunk.found.energy -= 0.5 * x.iter().zip(r).zip(load).map(|((x, r), b)| x * (r + b)).sum::<f64>();
        let has_changed = chunk.partition.renew(a - chunk.first, |blocks| {
            let (weight, d) = (measure.weight[a], &level.matrix.diagonal[level.entries(a)]);
            level.for_chains(a, |start, end, bounds| {
                for_runs(x, start..end, bounds, |run| {
                    violation =
                        violation.max(weight * run.settle(x, r, d, measure.tolerance / weight, blocks));
                });
            });
        });
        if has_changed {
            chunk.changed.push(a as u32);
        }
        chunk.found.violation = larger(chunk.found.violation, violation);
    });
    let (mut all, mut changed) = (Found::default(), Vec::new());
    for chunk in chunks {
        all.energy += chunk.found.energy;
        all.violation = larger(all.violation, chunk.found.violation);
        changed.extend(chunk.changed);
    }
    (all, changed)
}

/// Membranes at one height.
struct Run {
    start: usize,
    end: usize,
    rests_above: bool,
    rests_below: bool,
}

fn for_runs(x: &[f64], chain: std::ops::Range<usize>, [lower, upper]: [f64; 2], mut visit: impl FnMut(Run)) {
    let mut start = chain.start;
    while start < chain.end {
        let end = (start + 1..chain.end).find(|&i| x[i] != x[start]).unwrap_or(chain.end);
        let rests_above = start == chain.start && x[start] >= upper;
        let rests_below = end == chain.end && x[start] <= lower;
        visit(Run { start, end, rests_above, rests_below });
        start = end;
    }
}

impl Run {
    /// Finds the actions between the members and at the ends from `r = y_(i-1) - y_i` (section 2 of the notes); the blocks are cut where
    /// an action is no more than `nothing`. Returns the largest residual: an action that pulls, or what nothing takes up.
    #[inline(always)]
    fn settle(&self, x: &[f64], r: &[f64], d: &[f64], nothing: f64, blocks: &mut Blocks) -> f64 {
        let &Run { start, end, rests_above, rests_below } = self;
        if rests_above && rests_below {
            return 0.0;
        }
        let rounding = ROUNDING * x[start].abs() * d[start..end].iter().sum::<f64>();
        let mut violation: f64 = 0.0;
        if rests_above {
            // From the free bottom; the action above the last member first.
            let mut last = end;
            let mut action = 0.0;
            for i in (start..end).rev() {
                action += r[i];
                violation = larger(violation, -action - rounding);
                if action <= nothing {
                    blocks.add(i, last);
                    last = i;
                }
            }
            return violation;
        }
        let mut first = start;
        let mut action = 0.0;
        for (i, r) in (start..end).zip(&r[start..end]) {
            action -= r;
            let is_last = i + 1 == end;
            if is_last && !rests_below {
                violation = larger(violation, action.abs() - rounding);
                blocks.add(first, end);
            } else {
                violation = larger(violation, -action - rounding);
                if action <= nothing {
                    blocks.add(first, i + 1);
                    first = i + 1;
                }
            }
        }
        violation
    }
}

/// The larger of two numbers, a NaN before anything else.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
