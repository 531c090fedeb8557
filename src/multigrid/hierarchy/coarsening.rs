//! Coarser levels without coarser meshes: classical algebraic multigrid (Ruge, Stueben 1987) on the matrix itself.
//!
//! Interpolation weights are not negative, so that a coarse function above the obstacle stays above it.

use std::collections::BinaryHeap;

use super::matrix::{Pattern, Values};
use super::transfer::Transfer;

/// A coupling is strong when it has at least this fraction of the strongest one of its row.
const STRONG: f64 = 0.25;

/// What weak couplings leave of a diagonal entry at least, as a fraction.
const LEAST_DIAGONAL: f64 = 0.1;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Undecided,
    Coarse,
    Fine,
}

/// The transfer from a coarser level, whose vertices are some of those of this one. Vertices that are held stay, so that
/// boundary values are known on every level.
pub(crate) fn coarsened(pattern: &Pattern, values: &Values) -> Transfer {
    let rows = pattern.rows();
    let kind = split(pattern, values);
    let mut number = vec![0; rows];
    let mut same_vertex = Vec::new();
    for i in (0..rows).filter(|&i| kind[i] == Kind::Coarse) {
        number[i] = same_vertex.len() as u32;
        same_vertex.push(i as u32);
    }
    let (mut start, mut index, mut weight) = (vec![0], Vec::new(), Vec::new());
    let mut interpolation = Interpolation::new(pattern, values, &kind);
    for i in 0..rows {
        if kind[i] == Kind::Coarse {
            index.push(number[i]);
            weight.push(1.0);
        } else {
            for &(j, share) in interpolation.row(i) {
                index.push(number[j]);
                weight.push(share);
            }
        }
        start.push(index.len() as u32);
    }
    Transfer::weighted(same_vertex, start, index, weight)
}

/// `-a_ij` of the strong couplings of row `i`.
fn strong<'a>(pattern: &'a Pattern, values: &'a Values, i: usize) -> impl Iterator<Item = (usize, f64)> + 'a {
    let off = &values.off_diagonal[pattern.range(i)];
    let strongest = off.iter().fold(0.0, |most: f64, a| most.max(-a));
    let couplings = pattern.row(i).iter().zip(off).map(|(&j, a)| (j as usize, -a));
    couplings.filter(move |&(_, a)| a > 0.0 && a >= STRONG * strongest)
}

/// Chooses coarse vertices that many others depend on, none of them next to each other as far as possible.
fn split(pattern: &Pattern, values: &Values) -> Vec<Kind> {
    let rows = pattern.rows();
    let held = |i: usize| values.diagonal[i] == 0.0;
    let mut kind: Vec<Kind> =
        (0..rows).map(|i| if held(i) { Kind::Coarse } else { Kind::Undecided }).collect();
    // The pattern is symmetric, so those that depend on a vertex are among its neighbours.
    let dependent = |i: usize| {
        let depends = move |&j: &usize| !held(j) && strong(pattern, values, j).any(|(k, _)| k == i);
        pattern.row(i).iter().map(|&j| j as usize).filter(depends)
    };
    let mut measure: Vec<u32> = (0..rows).map(|i| dependent(i).count() as u32).collect();
    let entry = |measure: &[u32], i: usize| (measure[i], std::cmp::Reverse(i));
    let mut queue: BinaryHeap<_> = (0..rows).filter(|&i| !held(i)).map(|i| entry(&measure, i)).collect();
    while let Some((value, std::cmp::Reverse(i))) = queue.pop() {
        if kind[i] != Kind::Undecided || value != measure[i] {
            continue;
        }
        kind[i] = Kind::Coarse;
        let fine: Vec<usize> = dependent(i).filter(|&j| kind[j] == Kind::Undecided).collect();
        for j in fine {
            kind[j] = Kind::Fine;
            for (k, _) in strong(pattern, values, j).filter(|&(k, _)| kind[k] == Kind::Undecided) {
                measure[k] += 1;
                queue.push(entry(&measure, k));
            }
        }
    }
    for i in 0..rows {
        if kind[i] == Kind::Fine && !strong(pattern, values, i).any(|(j, _)| kind[j] == Kind::Coarse) {
            kind[i] = Kind::Coarse;
        }
    }
    second_pass(pattern, values, &mut kind);
    kind
}

/// Fine vertices that depend on each other need a coarse one on which both depend: where there is none, one of the two
/// becomes coarse.
fn second_pass(pattern: &Pattern, values: &Values, kind: &mut [Kind]) {
    let mut depends_on = vec![u32::MAX; kind.len()];
    for i in 0..kind.len() {
        if kind[i] != Kind::Fine {
            continue;
        }
        for (k, _) in strong(pattern, values, i) {
            depends_on[k] = i as u32;
        }
        let shares = |kind: &[Kind], j: usize| {
            strong(pattern, values, j).any(|(k, _)| kind[k] == Kind::Coarse && depends_on[k] == i as u32)
        };
        let alone: Vec<usize> = strong(pattern, values, i)
            .map(|(j, _)| j)
            .filter(|&j| kind[j] == Kind::Fine && !shares(kind, j))
            .collect();
        match alone[..] {
            [] => {}
            [j] => kind[j] = Kind::Coarse,
            _ => kind[i] = Kind::Coarse,
        }
    }
}

/// Classical interpolation: what a fine vertex depends on is coarse, or a fine vertex whose own dependence on the coarse
/// ones takes its place; what is weak goes to the diagonal.
struct Interpolation<'a> {
    pattern: &'a Pattern,
    values: &'a Values,
    kind: &'a [Kind],
    /// Where a coarse vertex stands among the parents of the current row, plus one.
    place: Vec<u32>,
    parents: Vec<(usize, f64)>,
}

impl<'a> Interpolation<'a> {
    fn new(pattern: &'a Pattern, values: &'a Values, kind: &'a [Kind]) -> Self {
        Self { pattern, values, kind, place: vec![0; kind.len()], parents: Vec::new() }
    }

    /// The coarse vertices from which the fine vertex `i` takes its value, and their weights.
    fn row(&mut self, i: usize) -> &[(usize, f64)] {
        let Self { pattern, values, kind, place, parents } = self;
        for &(k, _) in parents.iter() {
            place[k] = 0;
        }
        parents.clear();
        for (k, a) in strong(pattern, values, i).filter(|&(k, _)| kind[k] == Kind::Coarse) {
            parents.push((k, a));
            place[k] = parents.len() as u32;
        }
        let mut diagonal = values.diagonal[i];
        for (&j, &a) in pattern.row(i).iter().zip(&values.off_diagonal[pattern.range(i)]) {
            let j = j as usize;
            if place[j] != 0 {
                continue;
            }
            let couplings = pattern.row(j).iter().zip(&values.off_diagonal[pattern.range(j)]);
            let shared = couplings.filter(|&(&k, &b)| place[k as usize] != 0 && b < 0.0);
            let total: f64 = shared.clone().map(|(_, b)| b).sum();
            if a < 0.0 && total < 0.0 {
                for (&k, b) in shared {
                    parents[place[k as usize] as usize - 1].1 -= a * b / total;
                }
            } else {
                diagonal += a;
            }
        }
        // Weak couplings could use up the diagonal.
        let diagonal = diagonal.max(LEAST_DIAGONAL * values.diagonal[i]);
        parents.iter_mut().for_each(|(_, weight)| *weight /= diagonal);
        parents
    }
}
