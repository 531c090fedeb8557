//! The numbering of the vertices of a grid.

use super::pattern::Pattern;

/// No vertex is there.
const OUTSIDE: usize = usize::MAX;

/// The vertices of the cells of a grid that belong to the domain: corners along `x` first, then the centres of the
/// crossed pattern in the order of the cells.
pub(in crate::mesh) struct GridNumbering {
    /// Cells along either axis.
    pub(in crate::mesh) cells: [usize; 2],
    pub(in crate::mesh) vertices: usize,
    corner: Vec<usize>,
    cell: Vec<usize>,
    corners: usize,
}

impl GridNumbering {
    pub(in crate::mesh) fn new(
        [nx, ny]: [usize; 2],
        pattern: Pattern,
        inside: &impl Fn(usize, usize) -> bool,
    ) -> Self {
        let mut corner = vec![OUTSIDE; (nx + 1) * (ny + 1)];
        let mut cell = vec![OUTSIDE; nx * ny];
        let mut cells = 0;
        for (index, cell) in cell.iter_mut().enumerate() {
            let (i, j) = (index % nx, index / nx);
            if inside(i, j) {
                *cell = cells;
                cells += 1;
                let first = j * (nx + 1) + i;
                for at in [first, first + 1, first + nx + 1, first + nx + 2] {
                    corner[at] = 0;
                }
            }
        }
        let mut corners = 0;
        for number in corner.iter_mut().filter(|number| **number != OUTSIDE) {
            *number = corners;
            corners += 1;
        }
        let centres = if pattern == Pattern::Crossed { cells } else { 0 };
        Self { cells: [nx, ny], vertices: corners + centres, corner, cell, corners }
    }

    /// The number of the corner `(i, j)`, which must be there.
    pub(in crate::mesh) fn corner(&self, i: usize, j: usize) -> usize {
        self.corner[j * (self.cells[0] + 1) + i]
    }

    /// The number of the centre of the cell `(i, j)`, which must be there.
    pub(in crate::mesh) fn centre(&self, i: usize, j: usize) -> usize {
        self.corners + self.cell[j * self.cells[0] + i]
    }

    /// Whether the cell `(i, j)` belongs to the domain.
    pub(in crate::mesh) fn is_inside(&self, i: usize, j: usize) -> bool {
        self.cell[j * self.cells[0] + i] != OUTSIDE
    }

    /// The cells of the domain.
    pub(in crate::mesh) fn cells(&self) -> impl Iterator<Item = (usize, usize)> {
        let [nx, ny] = self.cells;
        (0..ny).flat_map(move |j| (0..nx).map(move |i| (i, j))).filter(|&(i, j)| self.is_inside(i, j))
    }

    /// The corners of these cells with their numbers, in the order of the numbers.
    pub(in crate::mesh) fn corners(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        let width = self.cells[0] + 1;
        let numbered = self.corner.iter().enumerate().filter(|&(_, &number)| number != OUTSIDE);
        numbered.map(move |(at, &number)| (at % width, at / width, number))
    }
}
