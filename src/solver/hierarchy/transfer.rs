//! Prolongation and restriction between two neighbouring levels.

use rayon::prelude::*;

/// Rows that are gathered together.
const BLOCK: usize = 4096;

/// The prolongation `P` from a coarser level, by rows, and its transpose.
#[derive(Debug, Clone, Default)]
pub(in crate::solver) struct Transfer {
    parents: Weights,
    children: Weights,
    same_vertex: Vec<u32>,
}

/// Compressed rows of weights.
#[derive(Debug, Clone, Default)]
struct Weights {
    start: Vec<u32>,
    index: Vec<u32>,
    weight: Vec<f64>,
}

impl Weights {
    #[inline(always)]
    fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + Clone {
        let range = self.range(i);
        self.index[range.clone()].iter().zip(&self.weight[range]).map(|(&j, &weight)| (j as usize, weight))
    }

    #[inline(always)]
    fn range(&self, i: usize) -> std::ops::Range<usize> {
        self.start[i] as usize..self.start[i + 1] as usize
    }

    fn rows(&self) -> usize {
        self.start.len() - 1
    }
}

impl Transfer {
    /// From the rows of the prolongation: where each ends, and their entries. `same_vertex` are the rows of the finer level
    /// that are the coarse vertices themselves.
    pub(super) fn new(same_vertex: Vec<u32>, start: Vec<u32>, index: Vec<u32>, weight: Vec<f64>) -> Self {
        let parents = Weights { start, index, weight };
        let children = transposed(same_vertex.len(), &parents);
        Self { parents, children, same_vertex }
    }

    /// Each row takes the mean of its values at two vertices, or at one that is named twice.
    pub(super) fn from_midpoints(coarse_rows: usize, ends: impl Iterator<Item = [u32; 2]>) -> Self {
        let (mut start, mut index, mut weight) = (vec![0], Vec::new(), Vec::new());
        let mut same_vertex = vec![0; coarse_rows];
        for (i, [a, b]) in ends.enumerate() {
            if a == b {
                index.push(a);
                weight.push(1.0);
                same_vertex[a as usize] = i as u32;
            } else {
                index.extend([a, b]);
                weight.extend([0.5, 0.5]);
            }
            start.push(index.len() as u32);
        }
        Self::new(same_vertex, start, index, weight)
    }

    /// The level is its own coarser level.
    pub(super) fn identity(rows: usize) -> Self {
        Self::from_midpoints(rows, (0..rows as u32).map(|a| [a, a]))
    }

    /// The same with the coarse vertices in another order: number `order[k]` becomes `k`.
    pub(super) fn with_coarse_order(mut self, order: &[u32], position: &[u32]) -> Self {
        self.parents.index.par_iter_mut().for_each(|a| *a = position[*a as usize]);
        self.same_vertex = order.iter().map(|&a| self.same_vertex[a as usize]).collect();
        let mut children = Weights {
            start: vec![0],
            index: Vec::with_capacity(self.children.index.len()),
            weight: Vec::with_capacity(self.children.weight.len()),
        };
        for &a in order {
            let range = self.children.range(a as usize);
            children.index.extend_from_slice(&self.children.index[range.clone()]);
            children.weight.extend_from_slice(&self.children.weight[range]);
            children.start.push(children.index.len() as u32);
        }
        self.children = children;
        self
    }

    /// `(A, P_iA)`: what the row `i` of the prolongation takes from the coarser level.
    #[inline(always)]
    pub(in crate::solver) fn parents(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + Clone {
        self.parents.row(i)
    }

    /// `(i, P_iA)`: the values of the hat function of the coarse vertex `A` on the finer level.
    pub(in crate::solver) fn children(&self, a: usize) -> impl Iterator<Item = (usize, f64)> + Clone {
        self.children.row(a)
    }

    /// The row of the finer level that is the coarse vertex itself.
    pub(super) fn same_vertex(&self, a: usize) -> usize {
        self.same_vertex[a] as usize
    }

    pub(super) fn coarse_rows(&self) -> usize {
        self.same_vertex.len()
    }

    /// `(P c)_i`.
    #[inline(always)]
    pub(in crate::solver) fn prolong(&self, i: usize, coarse: &[f64]) -> f64 {
        self.parents(i).map(|(a, weight)| weight * coarse[a]).sum()
    }

    /// Adds `P' r` of the single entry `r_i` to the functional on the coarser level.
    #[inline(always)]
    pub(in crate::solver) fn spread(&self, i: usize, r: f64, coarse: &mut [f64]) {
        for (a, weight) in self.parents(i) {
            coarse[a] += weight * r;
        }
    }

    /// The values of a function at the coarse vertices.
    pub(super) fn inject(&self, fine: &[f64]) -> Vec<f64> {
        self.same_vertex.iter().map(|&i| fine[i as usize]).collect()
    }

    /// `P' f`.
    pub(in crate::solver) fn restrict(&self, fine: &[f64]) -> Vec<f64> {
        let at = |a: usize| self.children(a).map(|(i, weight)| weight * fine[i]).sum();
        (0..self.coarse_rows()).into_par_iter().with_min_len(BLOCK).map(at).collect()
    }
}

fn transposed(columns: usize, rows: &Weights) -> Weights {
    let mut start = vec![0u32; columns + 1];
    for &j in &rows.index {
        start[j as usize + 1] += 1;
    }
    for j in 0..columns {
        start[j + 1] += start[j];
    }
    let mut next = start.clone();
    let (mut index, mut weight) = (vec![0; rows.index.len()], vec![0.0; rows.index.len()]);
    for i in 0..rows.rows() {
        for (j, value) in rows.row(i) {
            let at = next[j] as usize;
            index[at] = i as u32;
            weight[at] = value;
            next[j] += 1;
        }
    }
    Weights { start, index, weight }
}
