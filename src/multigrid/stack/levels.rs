//! The problem of a stack on all levels.

use super::level::{Free, StackLevel};
use super::matrix::BlockMatrix;
use crate::discretization::StackDiscretization;
use crate::fem::StiffnessMatrix;
use crate::multigrid::hierarchy::{Genealogy, Hierarchy, Pattern, Rows, Values, assemble, galerkin};
use crate::parallel::blocks;
use crate::parallel::prelude::*;

/// An entry that cancels in the sum over all membranes to less than this fraction of its terms couples rows nevertheless.
const CANCELLED: f64 = 1e-6;

/// A stack on a hierarchy that all membranes share. Level 0 is that of the hierarchy, where systems are solved directly; it has no problem
/// of its own.
pub(crate) struct StackLevels {
    hierarchy: Hierarchy,
    /// From level 1.
    problems: Vec<StackLevel>,
    membranes: usize,
    /// The coarsest level on which every membrane is held where it is so on the finest one: nested iteration starts there.
    first: usize,
}

impl StackLevels {
    /// Makes the levels of a stack on a mesh with this genealogy.
    pub(crate) fn new(d: &StackDiscretization, genealogy: &Genealogy) -> Self {
        let n = d.membranes();
        let is_free: Vec<bool> =
            (0..d.mesh().points().len()).map(|a| (1..=n).any(|i| d.unknown(i, a).is_some())).collect();
        let hierarchy = Hierarchy::over(&common_matrix(d), &is_free, genealogy);
        let problems = problems(d, &hierarchy);
        let mut levels = Self { hierarchy, problems, membranes: n, first: 1 };
        levels.first = (1..=levels.finest())
            .rev()
            .take_while(|&l| levels.is_held_on(l))
            .last()
            .unwrap_or(levels.finest());
        levels
    }

    pub(crate) fn hierarchy(&self) -> &Hierarchy {
        &self.hierarchy
    }

    pub(crate) fn membranes(&self) -> usize {
        self.membranes
    }

    pub(crate) fn finest(&self) -> usize {
        self.hierarchy.finest()
    }

    /// The level on which nested iteration starts.
    pub(super) fn first(&self) -> usize {
        self.first
    }

    /// The problem of level `l`, from 1.
    pub(super) fn problem(&self, l: usize) -> &StackLevel {
        &self.problems[l - 1]
    }

    /// Which entries are held on level `l`.
    pub(super) fn held(&self, l: usize) -> &[bool] {
        &self.problem(l.max(1)).held
    }

    /// From a value for each membrane (from 0) and vertex to a vector over the entries of the finest level.
    pub(crate) fn to_entries(&self, value: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        let of = |&a: &u32| (0..self.membranes).map(move |i| (i, a as usize));
        self.hierarchy.vertex().iter().flat_map(of).map(|(i, a)| value(i, a)).collect()
    }

    /// Whether on level `l` the membranes are held that are so on the finest one, in every part of the mesh.
    fn is_held_on(&self, l: usize) -> bool {
        let fine = self.problem(self.finest());
        let part = parts(fine);
        let n = self.membranes;
        // The vertex of the finest level that a row of level `l` is.
        let finest_row = |a: usize| {
            (l + 1..=self.finest()).fold(a, |a, l| self.hierarchy.levels()[l].transfer.same_vertex(a))
        };
        let mut is_held = vec![false; fine.held.len()];
        let level = self.problem(l);
        for a in 0..level.rows() {
            for i in (0..n).filter(|&i| level.held[a * n + i]) {
                is_held[part[finest_row(a)] as usize * n + i] = true;
            }
        }
        (0..fine.rows()).all(|a| (0..n).all(|i| !fine.held[a * n + i] || is_held[part[a] as usize * n + i]))
    }
}

/// A row that stands for the connected part in which each one lies. Rows where all membranes are held belong to one beside them.
fn parts(level: &StackLevel) -> Vec<u32> {
    let mut part: Vec<u32> = (0..level.rows() as u32).collect();
    let mut is_seen = vec![false; level.rows()];
    let mut open = Vec::new();
    for first in (0..level.rows()).filter(|&a| level.free[a] != Free::None) {
        if is_seen[first] {
            continue;
        }
        is_seen[first] = true;
        open.push(first);
        while let Some(a) = open.pop() {
            part[a] = first as u32;
            for b in level.matrix.neighbours(a).iter().map(|&b| b as usize) {
                if !std::mem::replace(&mut is_seen[b], true) {
                    open.push(b);
                }
            }
        }
    }
    part
}

/// One row of the stiffness matrices of some membranes, without foundations: where any of them has an entry.
#[derive(Default)]
struct CommonRow {
    columns: Vec<usize>,
    /// Those of all membranes at each column.
    entries: Vec<f64>,
}

impl CommonRow {
    fn read(&mut self, d: &StackDiscretization, a: usize, membranes: &[usize]) {
        let Self { columns, entries } = self;
        columns.clear();
        for &i in membranes {
            columns.extend(d.stiffness_row(i, a).filter(|&(_, k)| k != 0.0).map(|(b, _)| b));
        }
        columns.sort_unstable();
        columns.dedup();
        entries.clear();
        entries.resize(columns.len() * membranes.len(), 0.0);
        for (g, &i) in membranes.iter().enumerate() {
            for (b, k) in d.stiffness_row(i, a).filter(|&(_, k)| k != 0.0) {
                let at = columns.binary_search(&b).expect("its columns are among them");
                entries[at * membranes.len() + g] = k;
            }
        }
    }

    fn entries(&self, membranes: usize) -> impl Iterator<Item = (usize, &[f64])> {
        self.columns.iter().copied().zip(self.entries.chunks_exact(membranes))
    }
}

/// `sum_i K_i / trace K_i`: what all membranes have in common.
fn common_matrix(d: &StackDiscretization) -> StiffnessMatrix {
    let vertices = d.mesh().points().len();
    let membranes: Vec<usize> = (1..=d.membranes()).collect();
    let trace = |&i: &usize| (0..vertices).map(|a| d.diagonal(i, a)).sum::<f64>();
    let scale: Vec<f64> = membranes.iter().map(|i| trace(i).recip()).collect();
    let (mut start, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    let mut row = CommonRow::default();
    for a in 0..vertices {
        row.read(d, a, &membranes);
        for (b, entries) in row.entries(membranes.len()) {
            let on_foundation = |i: usize| if a == b { d.foundation(i, a) } else { 0.0 };
            let parts = || {
                let all = membranes.iter().zip(entries).zip(&scale);
                all.map(|((&i, entry), scale)| scale * (entry + on_foundation(i)))
            };
            let [sum, terms] = [parts().sum::<f64>(), parts().map(f64::abs).sum()];
            columns.push(b as u32);
            values.push(if sum.abs() < CANCELLED * terms { terms } else { sum });
        }
        start.push(columns.len() as u32);
    }
    StiffnessMatrix::new((vertices, vertices), start, columns, values)
}

/// What the levels are made from, on one of them.
struct Data {
    pattern: Pattern,
    /// Of each profile.
    profiles: Vec<Values>,
    foundation: Vec<f64>,
    load: Vec<f64>,
    held: Vec<bool>,
    height: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

fn problems(d: &StackDiscretization, hierarchy: &Hierarchy) -> Vec<StackLevel> {
    let n = d.membranes();
    // The profiles that there are, each with a membrane that has it.
    let mut seen: Vec<(usize, usize)> = Vec::new();
    let membranes: Vec<(f64, usize)> = (1..=n)
        .map(|i| {
            let (factor, profile) = d.profile(i);
            let known = seen.iter().position(|&(other, _)| other == profile);
            (
                factor,
                known.unwrap_or_else(|| {
                    seen.push((profile, i));
                    seen.len() - 1
                }),
            )
        })
        .collect();
    let first: Vec<(f64, usize)> = seen.iter().map(|&(_, i)| (d.profile(i).0, i)).collect();
    let mut data = finest(d, hierarchy, &first);
    let mut problems = Vec::new();
    for l in (1..=hierarchy.finest()).rev() {
        let coarser = (l > 1).then(|| coarser(&data, hierarchy, l, n));
        problems.push(problem(data, &membranes, hierarchy, l));
        match coarser {
            Some(coarser) => data = coarser,
            None => break,
        }
    }
    problems.reverse();
    problems
}

/// `profiles` are the factors and membranes whose matrices are made.
fn finest(d: &StackDiscretization, hierarchy: &Hierarchy, profiles: &[(f64, usize)]) -> Data {
    let n = d.membranes();
    let vertex = hierarchy.vertex();
    let mut row_of = vec![0u32; vertex.len()];
    (0..).zip(vertex).for_each(|(row, &a)| row_of[a as usize] = row);
    let level = &hierarchy.levels()[hierarchy.finest()];
    let of_profile: Vec<usize> = profiles.iter().map(|&(_, i)| i).collect();
    let block = |block: std::ops::Range<usize>| {
        let mut rows: Vec<Rows> = profiles.iter().map(|_| Rows::with_capacity(block.len())).collect();
        let mut common = CommonRow::default();
        for row in block {
            let a = vertex[row] as usize;
            let mut diagonal = vec![0.0; profiles.len()];
            if !level.is_held(row) {
                common.read(d, a, &of_profile);
                for (b, entries) in common.entries(profiles.len()) {
                    for (g, (k, (factor, _))) in entries.iter().zip(profiles).enumerate() {
                        if a == b {
                            diagonal[g] = k / factor;
                        } else {
                            rows[g].column.push(row_of[b]);
                            rows[g].off_diagonal.push(k / factor);
                        }
                    }
                }
            }
            for (rows, diagonal) in rows.iter_mut().zip(diagonal) {
                rows.diagonal.push(diagonal);
                rows.ends.push(rows.column.len());
            }
        }
        rows
    };
    let of_blocks: Vec<Vec<Rows>> = blocks(vertex.len()).into_par_iter().map(block).collect();
    let mut of_profiles: Vec<Vec<Rows>> = profiles.iter().map(|_| Vec::new()).collect();
    for rows in of_blocks {
        of_profiles.iter_mut().zip(rows).for_each(|(of_profile, rows)| of_profile.push(rows));
    }
    let (patterns, values): (Vec<Pattern>, Vec<Values>) = of_profiles.into_iter().map(assemble).unzip();
    let entries = |value: &(dyn Fn(usize, usize) -> f64 + Sync)| -> Vec<f64> {
        vertex.iter().flat_map(|&a| (1..=n).map(move |i| value(i, a as usize))).collect()
    };
    let [ceiling, floor] = d.obstacles();
    let bound = |heights: Option<&[f64]>, none: f64| {
        vertex.iter().map(|&a| heights.map_or(none, |heights| heights[a as usize])).collect()
    };
    Data {
        pattern: patterns.into_iter().next().expect("there is a membrane"),
        profiles: values,
        foundation: entries(&|i, a| d.foundation(i, a)),
        load: entries(&|i, a| d.load(i)[a]),
        held: vertex.iter().flat_map(|&a| (1..=n).map(move |i| d.unknown(i, a as usize).is_none())).collect(),
        height: entries(&|i, a| d.height(i, a).unwrap_or(0.0)),
        lower: bound(floor, f64::NEG_INFINITY),
        upper: bound(ceiling, f64::INFINITY),
    }
}

/// On the level below `l`. Foundations are lumped there too.
fn coarser(fine: &Data, hierarchy: &Hierarchy, l: usize, n: usize) -> Data {
    let transfer = &hierarchy.levels()[l].transfer;
    let below = &hierarchy.levels()[l - 1];
    let products: Vec<(Pattern, Values)> = fine
        .profiles
        .iter()
        .map(|values| galerkin((&fine.pattern, values), transfer, |a| below.is_held(a)))
        .collect();
    let (patterns, profiles): (Vec<Pattern>, Vec<Values>) = products.into_iter().unzip();
    let restricted = |fine: &[f64]| -> Vec<f64> {
        let at = |a: usize| {
            (0..n).map(move |i| transfer.children(a).map(|(b, weight)| weight * fine[b * n + i]).sum::<f64>())
        };
        (0..transfer.coarse_rows()).flat_map(at).collect()
    };
    let same = |a: usize| transfer.same_vertex(a);
    let rows = || 0..transfer.coarse_rows();
    Data {
        pattern: patterns.into_iter().next().expect("there is a membrane"),
        profiles,
        foundation: restricted(&fine.foundation),
        load: restricted(&fine.load),
        held: rows()
            .flat_map(|a| (0..n).map(move |i| (a, i)))
            .map(|(a, i)| fine.held[same(a) * n + i])
            .collect(),
        height: rows()
            .flat_map(|a| (0..n).map(move |i| (a, i)))
            .map(|(a, i)| fine.height[same(a) * n + i])
            .collect(),
        lower: transfer.inject(&fine.lower),
        upper: transfer.inject(&fine.upper),
    }
}

fn problem(data: Data, membranes: &[(f64, usize)], hierarchy: &Hierarchy, l: usize) -> StackLevel {
    let Data { pattern, profiles, foundation, mut load, mut held, height, lower, upper } = data;
    let n = membranes.len();
    let matrix = BlockMatrix::new(pattern, &profiles, membranes, &foundation);
    // Nothing moves where no membrane has an entry.
    held.iter_mut().zip(&matrix.diagonal).for_each(|(held, &diagonal)| *held |= diagonal == 0.0);
    let mut products = vec![0.0; n];
    for a in 0..matrix.rows() {
        matrix.off_diagonal_products(a, &height, &mut products);
        for (i, product) in products.iter().enumerate() {
            let load = &mut load[a * n + i];
            *load = if held[a * n + i] { 0.0 } else { *load - product };
        }
    }
    let free = |a: usize| match held[a * n..(a + 1) * n].iter().filter(|&&held| held).count() {
        0 => Free::All,
        all if all == n => Free::None,
        _ => Free::Some,
    };
    let free = (0..matrix.rows()).map(free).collect();
    StackLevel {
        matrix,
        coloring: hierarchy.levels()[l].coloring.clone(),
        load,
        held,
        height,
        lower,
        upper,
        free,
    }
}
