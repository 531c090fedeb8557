//! Prolongation and restriction between two levels of the patches.

use super::field::Field;
use super::grid::Grid;
use super::lanes::{Lanes, Real};

/// Calls `put` with the place of each point inside the patches of a group and the values of a coarse function there. The coarse
/// patches have been given the values at the interface.
#[inline(always)]
pub(super) fn prolong_inside<T: Real>(
    [coarse, fine]: [&Grid; 2],
    c: &[Lanes<T>],
    mut put: impl FnMut(usize, Lanes<T>),
) {
    let (m, half) = (fine.segments(), Lanes::all(T::of(0.5)));
    for j in 1..m - 1 {
        let here = fine.lattice.at(0, j);
        let [down, up] = [j / 2, j.div_ceil(2)].map(|j| &c[coarse.lattice.at(0, j)..]);
        for i in 1..m - j {
            // The midpoint of a slanted edge has its first end one point further on.
            let [first, second] = if j % 2 == 0 { [i / 2, i.div_ceil(2)] } else { [i.div_ceil(2), i / 2] };
            put(here + i, half * (down[first] + up[second]));
        }
    }
}

/// Calls `put` with each place in the interface of the finer level and the value of a coarse function there.
pub(super) fn prolong_interface<T: Real>([coarse, fine]: [&Grid; 2], c: &[T], mut put: impl FnMut(usize, T)) {
    let (m, partition, half) = (fine.segments(), &fine.partition, T::of(0.5));
    (0..partition.vertices).for_each(|a| put(a, c[a]));
    for edge in 0..partition.edges.len() {
        let at = |t: usize| c[partition.on_edge(edge, t, coarse.segments())];
        let first = partition.first_on_edge(edge, m);
        for t in 1..m {
            put(first + t - 1, half * (at(t / 2) + at(t.div_ceil(2))));
        }
    }
}

/// The restriction of residuals inside the patches of a group, times a factor: inside the coarse patches, and what it adds at the points
/// on their sides.
#[inline(always)]
pub(super) fn restrict_inside<T: Real, U: Real>(
    [coarse, fine]: [&Grid; 2],
    r: &[Lanes<T>],
    factor: f64,
    inside: &mut [Lanes<U>],
    on_sides: &mut [Lanes<U>],
) {
    let (half, m) = (Lanes::all(T::of(0.5)), coarse.segments());
    for j in 1..m - 1 {
        let out = coarse.lattice.at(0, j);
        let [down, row, up] = fine.lattice.rows(2 * j).map(|start| &r[start..]);
        for i in 1..m - j {
            let k = 2 * i;
            let beside = (row[k + 1] + row[k - 1]) + ((up[k] + down[k]) + (down[k + 1] + up[k - 1]));
            inside[out + i] = (row[k] + half * beside).scaled(factor);
        }
    }
    for side in 0..3 {
        let points = fine.lattice.rim[side * (2 * m - 1)..][..2 * m - 1].iter().skip(1).step_by(2);
        for (sum, point) in on_sides[side * (m - 1)..].iter_mut().zip(points) {
            let [a, b] = point.inward.map(|to| r[to.to]);
            *sum = (half * (a + b)).scaled(factor);
        }
    }
}

/// Adds the restriction of residuals at the interface, times a factor, to a coarse functional.
pub(super) fn restrict_interface<T: Real, U: Real>(
    [coarse, fine]: [&Grid; 2],
    r: &[T],
    factor: f64,
    c: &mut Field<U>,
) {
    let (m, partition) = (fine.segments(), &fine.partition);
    let c = &mut c.interface;
    for a in 0..partition.vertices {
        let beside: f64 =
            partition.spokes(a).iter().map(|&spoke| r[partition.nearest(spoke, m)].to_f64()).sum();
        c[a] += U::of(factor * (r[a].to_f64() + 0.5 * beside));
    }
    for edge in 0..partition.edges.len() {
        let r = &r[partition.first_on_edge(edge, m)..][..m - 1];
        let first = partition.first_on_edge(edge, coarse.segments());
        for (t, c) in c[first..][..coarse.segments() - 1].iter_mut().enumerate() {
            let [before, here, after] = [2 * t, 2 * t + 1, 2 * t + 2].map(|t| r[t].to_f64());
            *c += U::of(factor * (here + 0.5 * (before + after)));
        }
    }
}
