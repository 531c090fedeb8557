//! Structured meshes with an even number of cells are refinements of the mesh with half as many.

use std::sync::Arc;

use super::numbering::{GridNumbering, rows};
use super::pattern::Pattern;
use crate::mesh::Parents;

/// The ancestry of a grid, from the coarsest one; the cells `(i, j)` that belong to the domain are those `inside`.
pub(in crate::mesh) fn ancestry(
    finest: GridNumbering,
    pattern: Pattern,
    inside: &impl Fn(usize, usize) -> bool,
) -> Vec<Arc<Parents>> {
    let mut generations = Vec::new();
    let mut fine = finest;
    for scale in (1..).map(|generation| 1 << generation) {
        let [nx, ny] = fine.cells;
        if nx < 2 || ny < 2 || nx % 2 == 1 || ny % 2 == 1 {
            break;
        }
        let coarse = GridNumbering::new([nx / 2, ny / 2], pattern, &|i, j| inside(scale * i, scale * j));
        let alike = |i: usize, j: usize| fine.is_inside(i, j) == coarse.is_inside(i / 2, j / 2);
        let both_are_whole = fine.is_whole() && coarse.is_whole();
        if !both_are_whole && !(0..ny).all(|j| (0..nx).all(|i| alike(i, j))) {
            break;
        }
        generations.push(Arc::new(grid_parents(&fine, &coarse, pattern)));
        fine = coarse;
    }
    generations.reverse();
    generations
}

/// The parents of the vertices of `fine` in the grid with half as many cells along either axis.
fn grid_parents(fine: &GridNumbering, coarse: &GridNumbering, pattern: Pattern) -> Parents {
    let of_corner = |i: usize, j: usize| {
        if pattern == Pattern::Crossed && i % 2 == 1 && j % 2 == 1 {
            [coarse.centre(i / 2, j / 2); 2]
        } else {
            // A corner, or the midpoint of a side or of the diagonal from the lower left to the upper right.
            [coarse.corner(i / 2, j / 2), coarse.corner(i.div_ceil(2), j.div_ceil(2))]
        }
    };
    let numbers = |parents: [usize; 2]| parents.map(|parent| parent as u32);
    let [_, ny] = fine.cells;
    let mut ends = rows(ny + 1, |j| fine.corners(j).map(|i| numbers(of_corner(i, j))).collect());
    if pattern == Pattern::Crossed {
        let of_centre =
            |i: usize, j: usize| [coarse.centre(i / 2, j / 2), coarse.corner(i.div_ceil(2), j.div_ceil(2))];
        ends.extend(rows(ny, |j| fine.cells(j).map(|i| numbers(of_centre(i, j))).collect()));
    }
    Parents::new(coarse.vertices, ends)
}

/// The ancestry of a disk of rings, from the coarsest one.
pub(in crate::mesh) fn disk_ancestry(rings: usize) -> Vec<Arc<Parents>> {
    let halvings = rings.trailing_zeros();
    (0..halvings).rev().map(|k| Arc::new(disk_parents(rings >> k))).collect()
}

/// The parents of the vertices of a disk with an even number of rings in the one with half as many. Each sextant is a
/// triangle with a regular lattice: vertex `p` of ring `k` is the midpoint of the lattice's edge from `p/2` to `p/2`,
/// rounded down and up, in the rings `k/2`, rounded likewise.
fn disk_parents(rings: usize) -> Parents {
    let number = |ring: usize, sextant: usize, p: usize| match ring {
        0 => 0,
        _ => 1 + 3 * ring * (ring - 1) + (sextant * ring + p) % (6 * ring),
    };
    let mut ends = vec![[0, 0]];
    for k in 1..=rings {
        for sextant in 0..6 {
            for p in 0..k {
                let [lower, upper] = [(k / 2, p / 2), (k.div_ceil(2), p.div_ceil(2))];
                ends.push([lower, upper].map(|(ring, p)| number(ring, sextant, p) as u32));
            }
        }
    }
    Parents::new(1 + 3 * (rings / 2) * (rings / 2 + 1), ends)
}
