//! Numberings in which neighbours are near: a smoother that runs through the memory once needs them.

use crate::mesh::Parents;
use std::sync::Arc;

/// A numbering is left as it is when no neighbours are further apart than this many times the side of a square mesh.
const NEAR: f64 = 4.0;

/// Whether neighbours are near each other in a numbering of this bandwidth.
pub(crate) fn is_banded(vertices: usize, bandwidth: usize) -> bool {
    bandwidth as f64 <= NEAR * (vertices as f64).sqrt()
}

/// The vertices of each mesh of an ancestry in a banded order, from the coarsest mesh to the finest: layer by layer on the
/// coarsest, whose `edges` are given, and midpoints between their parents on the others.
pub(crate) fn banded_orders(vertices: usize, edges: &[[u32; 2]], ancestry: &[Arc<Parents>]) -> Vec<Vec<u32>> {
    let mut orders = vec![layers(vertices, edges)];
    for parents in ancestry {
        let coarse = &orders[orders.len() - 1];
        let position = super::inverse(coarse);
        let keys = parents.ends().iter().map(|&[a, b]| position[a as usize] + position[b as usize]);
        orders.push(sorted_by(2 * coarse.len(), keys));
    }
    orders
}

/// The numbers `0..` of the keys, sorted by them.
fn sorted_by(keys: usize, of: impl Iterator<Item = u32> + Clone) -> Vec<u32> {
    let mut start = vec![0u32; keys + 1];
    for key in of.clone() {
        start[key as usize + 1] += 1;
    }
    for key in 0..keys {
        start[key + 1] += start[key];
    }
    let mut order = vec![0; start[keys] as usize];
    for (i, key) in of.enumerate() {
        order[start[key as usize] as usize] = i as u32;
        start[key as usize] += 1;
    }
    order
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
