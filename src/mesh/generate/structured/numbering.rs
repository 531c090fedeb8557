//! The numbering of the vertices of a grid.

use super::pattern::Pattern;
use crate::parallel::concat;
use crate::parallel::prelude::*;

/// No vertex is there.
const OUTSIDE: u32 = u32::MAX;

/// The vertices of the cells of a grid that belong to the domain: corners along `x` first, then the centres of the
/// crossed pattern in the order of the cells.
pub(in crate::mesh) struct GridNumbering {
    /// Cells along either axis.
    pub(in crate::mesh) cells: [usize; 2],
    pub(in crate::mesh) vertices: usize,
    corners: usize,
    /// `None` where all cells belong to the domain: then numbers follow from the place.
    parts: Option<Parts>,
}

/// The numbers of the corners and cells of a part of a grid.
struct Parts {
    corner: Vec<u32>,
    cell: Vec<u32>,
}

impl GridNumbering {
    pub(in crate::mesh) fn new(
        [nx, ny]: [usize; 2],
        pattern: Pattern,
        inside: &impl Fn(usize, usize) -> bool,
    ) -> Self {
        let parts = Parts::new([nx, ny], inside);
        let (corners, cells) = match &parts {
            None => ((nx + 1) * (ny + 1), nx * ny),
            Some(parts) => (count(&parts.corner), count(&parts.cell)),
        };
        let centres = if pattern == Pattern::Crossed { cells } else { 0 };
        Self { cells: [nx, ny], vertices: corners + centres, corners, parts }
    }

    /// The number of the corner `(i, j)`, which must be there.
    pub(in crate::mesh) fn corner(&self, i: usize, j: usize) -> usize {
        let at = j * (self.cells[0] + 1) + i;
        self.parts.as_ref().map_or(at, |parts| parts.corner[at] as usize)
    }

    /// The number of the centre of the cell `(i, j)`, which must be there.
    pub(in crate::mesh) fn centre(&self, i: usize, j: usize) -> usize {
        let at = j * self.cells[0] + i;
        self.corners + self.parts.as_ref().map_or(at, |parts| parts.cell[at] as usize)
    }

    /// Whether all cells belong to the domain.
    pub(in crate::mesh) fn is_whole(&self) -> bool {
        self.parts.is_none()
    }

    /// Whether the cell `(i, j)` belongs to the domain.
    pub(in crate::mesh) fn is_inside(&self, i: usize, j: usize) -> bool {
        self.parts.as_ref().is_none_or(|parts| parts.cell[j * self.cells[0] + i] != OUTSIDE)
    }

    /// The cells of row `j` that belong to the domain.
    pub(in crate::mesh) fn cells(&self, j: usize) -> impl Iterator<Item = usize> {
        (0..self.cells[0]).filter(move |&i| self.is_inside(i, j))
    }

    /// The corners of these cells on the line `j`, in the order of their numbers.
    pub(in crate::mesh) fn corners(&self, j: usize) -> impl Iterator<Item = usize> {
        let first = j * (self.cells[0] + 1);
        let is_there =
            move |&i: &usize| self.parts.as_ref().is_none_or(|parts| parts.corner[first + i] != OUTSIDE);
        (0..=self.cells[0]).filter(is_there)
    }
}

impl Parts {
    /// Those of the cells inside; `None` where these are all.
    fn new([nx, ny]: [usize; 2], inside: &impl Fn(usize, usize) -> bool) -> Option<Self> {
        if (0..ny).all(|j| (0..nx).all(|i| inside(i, j))) {
            return None;
        }
        let (mut corner, mut cell) = (vec![OUTSIDE; (nx + 1) * (ny + 1)], vec![OUTSIDE; nx * ny]);
        for (at, cell) in cell.iter_mut().enumerate() {
            let (i, j) = (at % nx, at / nx);
            if inside(i, j) {
                *cell = 0;
                let first = j * (nx + 1) + i;
                for at in [first, first + 1, first + nx + 1, first + nx + 2] {
                    corner[at] = 0;
                }
            }
        }
        for numbers in [&mut corner, &mut cell] {
            numbers
                .iter_mut()
                .filter(|number| **number != OUTSIDE)
                .zip(0..)
                .for_each(|(number, k)| *number = k);
        }
        Some(Self { corner, cell })
    }
}

/// What belongs to each row of a grid, put together.
pub(in crate::mesh) fn rows<T: Copy + Default + Send + Sync>(
    count: usize,
    row: impl Fn(usize) -> Vec<T> + Send + Sync,
) -> Vec<T> {
    let rows: Vec<Vec<T>> = (0..count).into_par_iter().map(row).collect();
    concat(rows.iter().map(Vec::as_slice).collect())
}

/// How many there are.
fn count(numbers: &[u32]) -> usize {
    numbers.iter().filter(|&&number| number != OUTSIDE).count()
}
