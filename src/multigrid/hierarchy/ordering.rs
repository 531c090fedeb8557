//! Numberings in which neighbours are near: a smoother that runs through the memory once needs them.

use super::genealogy::{Genealogy, NONE};
use crate::fem::StiffnessMatrix;
use crate::parallel::prelude::*;

/// A numbering is left as it is when no neighbours are further apart than this many times the side of a square mesh.
const NEAR: f64 = 4.0;

/// Whether neighbours are near each other in a numbering of this bandwidth.
pub(super) fn is_banded(vertices: usize, bandwidth: usize) -> bool {
    bandwidth as f64 <= NEAR * (vertices as f64).sqrt()
}

/// The vertices of a mesh in a banded order: layer by layer on the coarsest mesh known, and all others between their parents.
pub(super) fn banded_order(k: &StiffnessMatrix, genealogy: &Genealogy) -> Vec<u32> {
    let roots = genealogy.roots();
    let layers = layers(roots.len(), &edges_of_roots(k, genealogy));
    if roots.len() == k.rows() {
        return layers.into_iter().map(|root| roots[root as usize]).collect();
    }
    let mut place = vec![0.0; k.rows()];
    for (position, &root) in layers.iter().enumerate() {
        place[roots[root as usize] as usize] = position as f64;
    }
    for a in genealogy.eldest_first().into_iter().filter(|&a| !genealogy.is_root(a)) {
        let parents = genealogy.parents(a);
        let sum: f64 = parents.vertices().iter().map(|&b| place[b as usize]).sum();
        place[a as usize] = sum / parents.vertices().len() as f64;
    }
    let mut sorted: Vec<(f64, u32)> = place.into_iter().zip(0..).collect();
    sorted.par_sort_unstable_by(|(p, a), (q, b)| p.total_cmp(q).then(a.cmp(b)));
    sorted.into_iter().map(|(_, a)| a).collect()
}

/// The edges of the coarsest mesh known, by the numbers that vertices have there: those that are still edges, and those with a
/// midpoint.
fn edges_of_roots(k: &StiffnessMatrix, genealogy: &Genealogy) -> Vec<[u32; 2]> {
    let mut number = vec![NONE; k.rows()];
    for (root, &a) in (0..).zip(genealogy.roots()) {
        number[a as usize] = root;
    }
    let edge = |a: u32, b: u32| [number[a as usize], number[b as usize]];
    let entries = genealogy.roots().iter().flat_map(|&a| {
        let row = k.indptr().outer_inds_sz(a as usize);
        k.indices()[row].iter().map(move |&b| [a, b]).filter(|[a, b]| a < b)
    });
    let parents = (0..k.rows() as u32).map(|a| genealogy.parents(a));
    let ends = parents.filter_map(|parents| <[u32; 2]>::try_from(parents.vertices()).ok());
    let edges = entries.chain(ends).map(|[a, b]| edge(a, b));
    edges.filter(|ends| ends.iter().all(|&end| end != NONE)).collect()
}

/// The layers of neighbours around a vertex at the rim of each component (Cuthill, McKee 1969).
fn layers(vertices: usize, edges: &[[u32; 2]]) -> Vec<u32> {
    let ends = edges.iter().flat_map(|&[a, b]| [(a, b), (b, a)]);
    let mut start = vec![0u32; vertices + 1];
    for (a, _) in ends.clone() {
        start[a as usize + 1] += 1;
    }
    for a in 0..vertices {
        start[a + 1] += start[a];
    }
    let mut next = start.clone();
    let mut neighbours = vec![0; 2 * edges.len()];
    for (a, b) in ends {
        neighbours[next[a as usize] as usize] = b;
        next[a as usize] += 1;
    }
    let around = |a: u32| &neighbours[start[a as usize] as usize..start[a as usize + 1] as usize];

    let mut seen = vec![false; vertices];
    let mut order: Vec<u32> = Vec::with_capacity(vertices);
    for seed in 0..vertices as u32 {
        if seen[seed as usize] {
            continue;
        }
        // The last vertex that a first walk reaches lies at the rim.
        let first = order.len();
        walk(seed, &around, &mut seen, &mut order);
        let rim = order[order.len() - 1];
        for a in order.drain(first..) {
            seen[a as usize] = false;
        }
        walk(rim, &around, &mut seen, &mut order);
    }
    order
}

/// Appends the component of a vertex, nearest first.
fn walk<'n>(from: u32, around: &impl Fn(u32) -> &'n [u32], seen: &mut [bool], order: &mut Vec<u32>) {
    let mut at = order.len();
    seen[from as usize] = true;
    order.push(from);
    while at < order.len() {
        for &b in around(order[at]) {
            if !std::mem::replace(&mut seen[b as usize], true) {
                order.push(b);
            }
        }
        at += 1;
    }
}

/// Where each of the numbers `0..n` stands in an order of them.
pub(super) fn inverse(order: &[u32]) -> Vec<u32> {
    let mut position = vec![0; order.len()];
    for (i, &old) in order.iter().enumerate() {
        position[old as usize] = i as u32;
    }
    position
}
