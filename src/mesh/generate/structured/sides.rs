//! The sides of grids: edges of the boundary by their ends.

use super::numbering::GridNumbering;

/// An edge between two grid points.
fn edge(numbering: &GridNumbering, ends: [[usize; 2]; 2]) -> [usize; 2] {
    ends.map(|[i, j]| numbering.corner(i, j))
}

/// What belongs to the domain of the four sides of the box around the grid.
pub(super) fn sides_of_box(numbering: &GridNumbering) -> [(&'static str, Vec<[usize; 2]>); 4] {
    let [nx, ny] = numbering.cells;
    // The edges on the line of grid points `i`, at the cells of the column `column`; likewise along a row.
    let upright = |i: usize, column: usize| {
        let rows = (0..ny).filter(|&j| numbering.is_inside(column, j));
        rows.map(|j| edge(numbering, [[i, j], [i, j + 1]])).collect()
    };
    let level = |j: usize, row: usize| {
        let columns = (0..nx).filter(|&i| numbering.is_inside(i, row));
        columns.map(|i| edge(numbering, [[i, j], [i + 1, j]])).collect()
    };
    [
        ("left", upright(0, 0)),
        ("right", upright(nx, nx - 1)),
        ("bottom", level(0, 0)),
        ("top", level(ny, ny - 1)),
    ]
}

/// The two sides of an L-shape, `cells` cells along each, that meet at its re-entrant corner.
pub(super) fn re_entrant_sides(numbering: &GridNumbering, cells: usize) -> Vec<[usize; 2]> {
    let below = (0..cells).map(|j| edge(numbering, [[cells, j], [cells, j + 1]]));
    let beside = (cells..2 * cells).map(|i| edge(numbering, [[i, cells], [i + 1, cells]]));
    below.chain(beside).collect()
}
