//! Prolongation and restriction between two neighbouring levels.

use std::ops::Range;

use super::genealogy::Mean;
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;

/// The prolongation `P` from a coarser level and its transpose.
#[derive(Debug, Clone, Default)]
pub(crate) struct Transfer {
    parents: Prolongation,
    children: Rows,
    /// The rows of the finer level that are the coarse vertices themselves.
    same_vertex: Vec<u32>,
}

/// `P`, by rows.
#[derive(Debug, Clone)]
enum Prolongation {
    /// The mean of two coarse vertices, of which the row is the midpoint; or one, named twice.
    Edges(Vec<[u32; 2]>),
    Weighted(Rows),
}

/// Compressed rows. Those of midpoints have no weights: it is one for the vertex itself, one half for others.
#[derive(Debug, Clone, Default)]
struct Rows {
    start: Vec<u32>,
    index: Vec<u32>,
    weight: Vec<f64>,
}

impl Default for Prolongation {
    fn default() -> Self {
        Self::Edges(Vec::new())
    }
}

impl Prolongation {
    fn rows(&self) -> usize {
        match self {
            Self::Edges(ends) => ends.len(),
            Self::Weighted(rows) => rows.start.len() - 1,
        }
    }

    /// `(A, P_iA)` for the row `i`.
    #[inline(always)]
    fn for_each(&self, i: usize, mut take: impl FnMut(usize, f64)) {
        match self {
            Self::Edges(ends) => {
                let ends = ends[i];
                let (parents, weight) = if ends[0] == ends[1] { (1, 1.0) } else { (2, 0.5) };
                ends[..parents].iter().for_each(|&a| take(a as usize, weight));
            }
            Self::Weighted(rows) => rows.weighted(i).for_each(|(a, weight)| take(a, weight)),
        }
    }

    /// Where the children of each coarse vertex are, with their weights unless those are known.
    fn transposed(&self, columns: usize) -> Rows {
        let mut start = vec![0u32; columns + 1];
        (0..self.rows()).for_each(|i| self.for_each(i, |a, _| start[a + 1] += 1));
        for a in 0..columns {
            start[a + 1] += start[a];
        }
        let mut next = start.clone();
        let entries = start[columns] as usize;
        let mut index = vec![0; entries];
        let mut weight = if matches!(self, Self::Edges(_)) { Vec::new() } else { vec![0.0; entries] };
        for i in 0..self.rows() {
            self.for_each(i, |a, value| {
                let at = next[a] as usize;
                index[at] = i as u32;
                if !weight.is_empty() {
                    weight[at] = value;
                }
                next[a] += 1;
            });
        }
        Rows { start, index, weight }
    }
}

impl Rows {
    fn of_means(means: &[Mean]) -> Self {
        let mut rows = Self { start: vec![0], ..Self::default() };
        for vertices in means.iter().map(Mean::vertices) {
            rows.index.extend_from_slice(vertices);
            rows.weight.extend(std::iter::repeat_n(1.0 / vertices.len() as f64, vertices.len()));
            rows.start.push(rows.index.len() as u32);
        }
        rows
    }

    #[inline(always)]
    fn range(&self, i: usize) -> Range<usize> {
        self.start[i] as usize..self.start[i + 1] as usize
    }

    #[inline(always)]
    fn weighted(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.range(i);
        self.index[range.clone()].iter().zip(&self.weight[range]).map(|(&j, &weight)| (j as usize, weight))
    }

    /// The same in another order.
    fn reordered(&self, order: &[u32]) -> Self {
        let mut rows = Self {
            start: Vec::with_capacity(order.len() + 1),
            index: Vec::with_capacity(self.index.len()),
            weight: Vec::with_capacity(self.weight.len()),
        };
        rows.start.push(0);
        for &a in order {
            let range = self.range(a as usize);
            rows.index.extend_from_slice(&self.index[range.clone()]);
            if !self.weight.is_empty() {
                rows.weight.extend_from_slice(&self.weight[range]);
            }
            rows.start.push(rows.index.len() as u32);
        }
        rows
    }
}

impl Transfer {
    fn new(same_vertex: Vec<u32>, parents: Prolongation) -> Self {
        Self { children: parents.transposed(same_vertex.len()), parents, same_vertex }
    }

    /// From the rows of the prolongation: where each ends, and their entries. `same_vertex` are the rows of the finer level
    /// that are the coarse vertices themselves.
    pub(crate) fn weighted(
        same_vertex: Vec<u32>,
        start: Vec<u32>,
        index: Vec<u32>,
        weight: Vec<f64>,
    ) -> Self {
        Self::new(same_vertex, Prolongation::Weighted(Rows { start, index, weight }))
    }

    /// Each row takes the mean of its values at some coarse vertices.
    pub(crate) fn from_means(coarse_rows: usize, means: &[Mean]) -> Self {
        let mut same_vertex = vec![0; coarse_rows];
        for (mean, i) in means.iter().zip(0..) {
            if let [a] = mean.vertices() {
                same_vertex[*a as usize] = i;
            }
        }
        if means.iter().any(|mean| mean.vertices().len() > 2) {
            return Self::new(same_vertex, Prolongation::Weighted(Rows::of_means(means)));
        }
        let ends = |mean: &Mean| match *mean.vertices() {
            [a, b] => [a, b],
            [a, ..] => [a, a],
            [] => unreachable!("a mean is one of vertices"),
        };
        Self::new(same_vertex, Prolongation::Edges(means.iter().map(ends).collect()))
    }

    /// The level is its own coarser level.
    pub(crate) fn identity(rows: usize) -> Self {
        let means: Vec<_> = (0..rows as u32).map(Mean::of_one).collect();
        Self::from_means(rows, &means)
    }

    /// The same with the coarse vertices in another order: number `order[k]` becomes `k`.
    pub(crate) fn with_coarse_order(mut self, order: &[u32], position: &[u32]) -> Self {
        let place = |a: &mut u32| *a = position[*a as usize];
        match &mut self.parents {
            Prolongation::Edges(ends) => {
                ends.par_iter_mut().with_min_len(BLOCK).for_each(|ends| ends.iter_mut().for_each(place));
            }
            Prolongation::Weighted(rows) => rows.index.par_iter_mut().with_min_len(BLOCK).for_each(place),
        }
        self.same_vertex = order.iter().map(|&a| self.same_vertex[a as usize]).collect();
        self.children = self.children.reordered(order);
        self
    }

    /// `(A, P_iA)`: what the row `i` of the prolongation takes from the coarser level.
    #[inline(always)]
    pub(crate) fn for_each_parent(&self, i: usize, take: impl FnMut(usize, f64)) {
        self.parents.for_each(i, take);
    }

    /// `(i, P_iA)`: the values of the hat function of the coarse vertex `A` on the finer level.
    pub(crate) fn children(&self, a: usize) -> impl Iterator<Item = (usize, f64)> {
        let weight = move |at: usize, i: u32| match self.children.weight.get(at) {
            Some(&weight) => weight,
            None if i == self.same_vertex[a] => 1.0,
            None => 0.5,
        };
        let range = self.children.range(a);
        range.map(move |at| (at, self.children.index[at])).map(move |(at, i)| (i as usize, weight(at, i)))
    }

    /// The row of the finer level that is the coarse vertex itself.
    pub(crate) fn same_vertex(&self, a: usize) -> usize {
        self.same_vertex[a] as usize
    }

    pub(crate) fn coarse_rows(&self) -> usize {
        self.same_vertex.len()
    }

    /// `(P c)_i`.
    #[inline(always)]
    pub(crate) fn prolong(&self, i: usize, coarse: &[f64]) -> f64 {
        match &self.parents {
            Prolongation::Edges(ends) => {
                let [a, b] = ends[i];
                0.5 * (coarse[a as usize] + coarse[b as usize])
            }
            Prolongation::Weighted(rows) => rows.weighted(i).map(|(a, weight)| weight * coarse[a]).sum(),
        }
    }

    /// Adds `P' r` of the single entry `r_i` to the functional on the coarser level.
    #[inline(always)]
    pub(crate) fn spread(&self, i: usize, r: f64, coarse: &mut [f64]) {
        match &self.parents {
            Prolongation::Edges(ends) => {
                let [a, b] = ends[i];
                coarse[a as usize] += 0.5 * r;
                coarse[b as usize] += 0.5 * r;
            }
            Prolongation::Weighted(rows) => rows.weighted(i).for_each(|(a, weight)| coarse[a] += weight * r),
        }
    }

    /// The values of a function at the coarse vertices.
    pub(crate) fn inject(&self, fine: &[f64]) -> Vec<f64> {
        self.same_vertex.iter().map(|&i| fine[i as usize]).collect()
    }

    /// `P' f`.
    pub(crate) fn restrict(&self, fine: &[f64]) -> Vec<f64> {
        let at = |a: usize| self.children(a).map(|(i, weight)| weight * fine[i]).sum();
        (0..self.coarse_rows()).into_par_iter().with_min_len(BLOCK).map(at).collect()
    }
}
