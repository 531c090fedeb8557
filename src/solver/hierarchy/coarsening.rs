//! Coarser levels without coarser meshes: classical algebraic multigrid (Ruge, Stueben 1987) on the matrix itself.
//!
//! Interpolation weights are not negative, so that a coarse function above the obstacle stays above it.

use std::collections::BinaryHeap;

use super::matrix::{Pattern, Values};
use super::transfer::Transfer;

/// A coupling is strong when it has at least this fraction of the strongest one of its row.
const STRONG: f64 = 0.25;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Undecided,
    Coarse,
    Fine,
}

/// The transfer from a coarser level, whose vertices are some of those of this one. Vertices that are held stay, so that
/// boundary values are known on every level.
pub(super) fn coarsened(pattern: &Pattern, values: &Values) -> Transfer {
    let rows = pattern.rows();
    let kind = split(pattern, values);
    let mut number = vec![0; rows];
    let mut same_vertex = Vec::new();
    for i in (0..rows).filter(|&i| kind[i] == Kind::Coarse) {
        number[i] = same_vertex.len() as u32;
        same_vertex.push(i as u32);
    }
    let (mut start, mut index, mut weight) = (vec![0], Vec::new(), Vec::new());
    for i in 0..rows {
        if kind[i] == Kind::Coarse {
            index.push(number[i]);
            weight.push(1.0);
        } else {
            for (j, share) in interpolation(pattern, values, &kind, i) {
                index.push(number[j]);
                weight.push(share);
            }
        }
        start.push(index.len() as u32);
    }
    Transfer::new(same_vertex, start, index, weight)
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
    kind
}

/// What a fine vertex takes from its strong coarse neighbours: their couplings, raised so that all of them are there. The
/// weights of a row without positive couplings add up to what the row adds up to: one, away from vertices that pull.
fn interpolation<'a>(
    pattern: &'a Pattern,
    values: &'a Values,
    kind: &'a [Kind],
    i: usize,
) -> impl Iterator<Item = (usize, f64)> + 'a {
    let off = &values.off_diagonal[pattern.range(i)];
    let [negative, positive] =
        off.iter().fold([0.0, 0.0], |[n, p], &a| if a < 0.0 { [n - a, p] } else { [n, p + a] });
    let coarse = move || strong(pattern, values, i).filter(|&(j, _)| kind[j] == Kind::Coarse);
    let raise = negative / coarse().map(|(_, a)| a).sum::<f64>() / (values.diagonal[i] + positive);
    coarse().map(move |(j, a)| (j, a * raise))
}
