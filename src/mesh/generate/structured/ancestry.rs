//! Structured meshes with an even number of cells are refinements of the mesh with half as many.

use std::sync::Arc;

use super::numbering::GridNumbering;
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
        let unlike = |(i, j): (usize, usize)| fine.is_inside(i, j) != coarse.is_inside(i / 2, j / 2);
        if (0..ny).any(|j| (0..nx).any(|i| unlike((i, j)))) {
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
    let mut ends = vec![[0; 2]; fine.vertices];
    for (i, j, a) in fine.corners() {
        let parents = if pattern == Pattern::Crossed && i % 2 == 1 && j % 2 == 1 {
            [coarse.centre(i / 2, j / 2); 2]
        } else {
            // A corner, or the midpoint of a side or of the diagonal from the lower left to the upper right.
            [coarse.corner(i / 2, j / 2), coarse.corner(i.div_ceil(2), j.div_ceil(2))]
        };
        ends[a] = parents.map(|parent| parent as u32);
    }
    if pattern == Pattern::Crossed {
        for (i, j) in fine.cells() {
            let corner = coarse.corner(i.div_ceil(2), j.div_ceil(2));
            ends[fine.centre(i, j)] = [coarse.centre(i / 2, j / 2), corner].map(|parent| parent as u32);
        }
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
