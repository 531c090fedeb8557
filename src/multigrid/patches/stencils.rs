//! Whether a matrix that has been assembled has one stencil in each patch.

use super::grid::{Grid, Lattice, Numbers, Partition};
use super::lanes::LANES;
use super::matrix::{Matrix, Stencil};
use crate::fem::{StiffnessMatrix, row_of};
use crate::parallel::prelude::*;

/// Two entries that differ by less than this fraction of the diagonal are the same but for the rounding of the vertices.
const SAME_ENTRY: f64 = 1e-10;

/// The stencil of each patch, in groups, from the row of a point inside; `None` unless all rows inside are like that, and free.
pub(super) fn stencils(
    partition: &Partition,
    lattice: &Lattice,
    numbers: &Numbers,
    k: &StiffnessMatrix,
    free: &[bool],
) -> Option<Vec<[Stencil; LANES]>> {
    let of_group = |(g, numbers): (usize, &[[u32; LANES]])| {
        let mut stencils = [[1.0; 3]; LANES];
        for (lane, _) in partition.group(g) {
            let number = |[i, j]: [usize; 2]| numbers[lattice.at(i, j)][lane] as usize;
            stencils[lane] = std::array::from_fn(|direction| {
                let neighbour = lattice.neighbour([1, 1], direction).expect("the point is inside");
                -entry(k, number([1, 1]), number(neighbour))
            });
            let stencil = stencils[lane];
            if !lattice
                .inside()
                .all(|point| free[number(point)] && has_stencil(k, lattice, point, number, stencil))
            {
                return None;
            }
        }
        Some(stencils)
    };
    numbers.0.par_chunks(lattice.points()).enumerate().map(of_group).collect()
}

/// Whether the row of a point inside a patch has these entries.
fn has_stencil(
    k: &StiffnessMatrix,
    lattice: &Lattice,
    [i, j]: [usize; 2],
    number: impl Fn([usize; 2]) -> usize,
    stencil: Stencil,
) -> bool {
    let here = number([i, j]);
    let neighbours = [[i + 1, j], [i - 1, j], [i, j + 1], [i, j - 1], [i + 1, j - 1], [i - 1, j + 1]];
    debug_assert!(neighbours.iter().all(|[i, j]| i + j <= lattice.segments));
    let neighbours = neighbours.map(number);
    let diagonal = 2.0 * stencil.iter().sum::<f64>();
    let same = |a: f64, b: f64| (a - b).abs() <= SAME_ENTRY * diagonal;
    let expected = 2 * stencil.iter().filter(|&&c| !same(c, 0.0)).count();
    let mut found = 0;
    for (column, entry) in row_of(k, here) {
        let place = neighbours.iter().position(|&neighbour| neighbour == column);
        let of_stencil = match place {
            Some(place) => -stencil[place / 2],
            None if column == here => diagonal,
            None => 0.0,
        };
        if !same(entry, of_stencil) {
            return false;
        }
        found += usize::from(place.is_some() && !same(entry, 0.0));
    }
    found == expected
}

/// Whether the rows of a matrix at the interface, which are those of these vertices, are rows of `k`, too, where that is free.
pub(super) fn is_assembled(
    matrix: &Matrix<f64>,
    grid: &Grid,
    vertices: &[u32],
    k: &StiffnessMatrix,
    free: &[bool],
) -> bool {
    let (m, partition) = (grid.segments(), &grid.partition);
    let is_free = |place: usize| Numbers::is_one(vertices[place]) && free[vertices[place] as usize];
    let same = |place: usize, x: f64, y: f64| (x - y).abs() <= SAME_ENTRY * matrix.diagonal[place];
    let entry = |a: usize, b: usize| entry(k, vertices[a] as usize, vertices[b] as usize);
    let has_diagonal = |a: usize| !is_free(a) || same(a, entry(a, a), matrix.diagonal[a]);
    let has_couplings = |edge: usize| {
        (0..m).all(|piece| {
            let [a, b] = [piece, piece + 1].map(|t| partition.on_edge(edge, t, m));
            let has_row = is_free(a) || is_free(b);
            !has_row || same(a, -entry(a, b), matrix.along[edge * m + piece])
        })
    };
    (0..vertices.len()).all(has_diagonal) && (0..partition.edges.len()).all(has_couplings)
}

/// An entry; zero where none is stored.
fn entry(k: &StiffnessMatrix, a: usize, b: usize) -> f64 {
    row_of(k, a).find(|&(column, _)| column == b).map_or(0.0, |(_, entry)| entry)
}
