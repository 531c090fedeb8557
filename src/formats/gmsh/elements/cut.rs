//! Quadrangles are cut in two triangles.

use super::{Cell, NO_NODE, number};
use crate::formats::gmsh::error::GmshError;
use crate::geometry::{distance_sq, twice_signed_area};

/// Two diagonals are equally long when the squares of their lengths differ by less than so much of their sum. Meshes of equal
/// cells, as printed by Gmsh, differ by 1e-12; so such a mesh is cut everywhere in the same way.
const EQUALLY_LONG: f64 = 1e-8;

/// Triangles, and where they come from.
pub(crate) struct Cut {
    /// The vertices of every triangle, as indices of nodes.
    pub(crate) triangles: Vec<[usize; 3]>,
    /// The tag of the element of which each is.
    pub(crate) tags: Vec<u64>,
    /// The number of the first triangle of each cell, and that of all triangles; empty where all cells are triangles.
    firsts: Vec<u32>,
}

impl Cut {
    /// The triangles of a cell.
    pub(crate) fn of_cell(&self, cell: u32) -> std::ops::Range<u32> {
        if self.firsts.is_empty() {
            return cell..cell + 1;
        }
        self.firsts[cell as usize]..self.firsts[cell as usize + 1]
    }

    /// Number of quadrangles that were cut.
    pub(crate) fn quadrangles(&self) -> usize {
        self.triangles.len() - self.firsts.len().checked_sub(1).unwrap_or(self.triangles.len())
    }
}

/// The triangles among the cells, and two for each quadrangle: see [`diagonal`].
///
/// # Errors
/// [`GmshError::Quadrangle`] for a quadrangle that neither diagonal divides.
pub(crate) fn cut(cells: &[Cell], tags: Vec<u64>, points: &[[f64; 2]]) -> Result<Cut, GmshError> {
    let corners = |[a, b, c, d]: Cell| [a, b, c, d].map(|a| a as usize);
    let quadrangles = cells.iter().filter(|cell| cell[3] != NO_NODE).count();
    if quadrangles == 0 {
        let triangles = cells.iter().map(|&cell| corners(cell)).map(|[a, b, c, _]| [a, b, c]).collect();
        return Ok(Cut { triangles, tags, firsts: Vec::new() });
    }
    let all = cells.len() + quadrangles;
    let (mut triangles, mut tags_of_triangles) = (Vec::with_capacity(all), Vec::with_capacity(all));
    let mut firsts = Vec::with_capacity(cells.len() + 1);
    for (&cell, &tag) in cells.iter().zip(&tags) {
        firsts.push(number(triangles.len()));
        let [a, b, c, d] = corners(cell);
        if cell[3] == NO_NODE {
            triangles.push([a, b, c]);
        } else {
            let halves = match diagonal([a, b, c, d].map(|a| points[a])) {
                Some(Diagonal::First) => [[a, b, c], [a, c, d]],
                Some(Diagonal::Second) => [[a, b, d], [b, c, d]],
                None => return Err(GmshError::Quadrangle { element: tag }),
            };
            triangles.extend(halves);
        }
        tags_of_triangles.resize(triangles.len(), tag);
    }
    firsts.push(number(triangles.len()));
    Ok(Cut { triangles, tags: tags_of_triangles, firsts })
}

/// From the first to the third corner, or from the second to the fourth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Diagonal {
    First,
    Second,
}

/// The diagonal along which a quadrangle is cut: the shorter one that lies inside; of two [equally long](EQUALLY_LONG) ones, that
/// which rises to the right, or the more level one where they are mirror images of each other in a level line. `None` when the
/// sides cross each other, or all corners lie on a line. It does not depend on the corner at which the element begins.
fn diagonal([a, b, c, d]: [[f64; 2]; 4]) -> Option<Diagonal> {
    let same_sign = |one: [[f64; 2]; 3], other: [[f64; 2]; 3]| {
        let areas = [one, other].map(twice_signed_area);
        areas.iter().all(|&area| area > 0.0) || areas.iter().all(|&area| area < 0.0)
    };
    match (same_sign([a, b, c], [a, c, d]), same_sign([a, b, d], [b, c, d])) {
        (true, false) => Some(Diagonal::First),
        (false, true) => Some(Diagonal::Second),
        // What is beyond all bounds, the mesh refuses.
        (false, false) => {
            [a, b, c, d].as_flattened().iter().any(|x| x.abs() > 1e100).then_some(Diagonal::First)
        }
        (true, true) => {
            let lengths = [distance_sq(a, c), distance_sq(b, d)];
            let differ =
                |values: [f64; 2]| (values[0] - values[1]).abs() > EQUALLY_LONG * (lengths[0] + lengths[1]);
            let rises = [[a, c], [b, d]].map(|[p, q]| (q[0] - p[0]) * (q[1] - p[1]));
            let widths = [[a, c], [b, d]].map(|[p, q]| (q[0] - p[0]).powi(2));
            let first = if differ(lengths) {
                lengths[0] < lengths[1]
            } else if differ(rises) {
                rises[0] > rises[1]
            } else {
                widths[0] > widths[1]
            };
            Some(if first { Diagonal::First } else { Diagonal::Second })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The two corners that the diagonal joins, from every corner at which the quadrangle may begin, and in both directions: the
    /// answer has to be the same.
    fn joined(quadrangle: [[f64; 2]; 4]) -> Option<[[f64; 2]; 2]> {
        let from = |mut q: [[f64; 2]; 4], start: usize, reversed: bool| {
            q.rotate_left(start);
            if reversed {
                q.reverse();
            }
            let mut ends = match diagonal(q)? {
                Diagonal::First => [q[0], q[2]],
                Diagonal::Second => [q[1], q[3]],
            };
            ends.sort_by(|p, q| p.partial_cmp(q).unwrap());
            Some(ends)
        };
        let expected = from(quadrangle, 0, false);
        for start in 0..4 {
            assert_eq!([false, true].map(|reversed| from(quadrangle, start, reversed)), [expected; 2]);
        }
        expected
    }

    #[test]
    fn the_shorter_diagonal_that_lies_inside_cuts() {
        let slanted = [[0.0, 0.0], [1.0, 0.0], [1.5, 1.0], [0.5, 1.0]];
        assert_eq!(joined(slanted), Some([[0.5, 1.0], [1.0, 0.0]]));
        assert_eq!(joined(slanted.map(|[x, y]| [-x, y])), Some([[-1.0, 0.0], [-0.5, 1.0]]));
        // The arrow head: the shorter diagonal lies outside.
        let arrow = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [0.5, 1.0]];
        assert_eq!(joined(arrow), Some([[0.5, 1.0], [2.0, 1.0]]));
        // A corner on a side.
        let flat = [[0.0, 0.0], [4.0, 0.0], [2.0, 1.0], [0.0, 2.0]];
        assert_eq!(joined(flat), Some([[0.0, 0.0], [2.0, 1.0]]));
    }

    #[test]
    fn equal_cells_are_cut_in_the_same_way_also_where_they_are_printed_inexactly() {
        for noise in [0.0, 1e-12, -1e-12] {
            let rectangle = [[0.0, 0.0], [1.0 + noise, 0.0], [1.0, 0.5], [0.0, 0.5]];
            assert_eq!(joined(rectangle), Some([[0.0, 0.0], [1.0, 0.5]]), "it rises to the right");
            let rhomb = [[1.0, 0.0], [2.0, 1.0 + noise], [1.0, 2.0], [0.0, 1.0]];
            assert_eq!(joined(rhomb), Some([[0.0, 1.0], [2.0, 1.0 + noise]]), "it is level");
        }
        let not_equal = [[0.0, 0.0], [1.0 - 1e-3, 0.0], [1.0, 0.5], [0.0, 0.5]];
        assert_eq!(joined(not_equal), Some([[0.0, 0.5], [1.0 - 1e-3, 0.0]]));
    }

    #[test]
    fn what_no_diagonal_divides_is_refused() {
        let crossed = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let line = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]];
        let twice = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]];
        assert_eq!([crossed, line, twice].map(joined), [None; 3]);
        let quadrangle = [0, 1, 2, 3];
        assert_eq!(cut(&[quadrangle], vec![7], &crossed).err(), Some(GmshError::Quadrangle { element: 7 }));
    }

    #[test]
    fn triangles_stand_in_the_order_of_the_cells() {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.5]];
        let found = cut(&[[1, 4, 2, NO_NODE], [0, 1, 2, 3]], vec![5, 9], &points).unwrap();
        assert_eq!(found.triangles, [[1, 4, 2], [0, 1, 2], [0, 2, 3]]);
        assert_eq!((found.tags.as_slice(), found.quadrangles()), ([5, 9, 9].as_slice(), 1));
        assert_eq!([found.of_cell(0), found.of_cell(1)], [0..1, 1..3]);
        let triangle = cut(&[[1, 4, 2, NO_NODE]], vec![5], &points).unwrap();
        assert_eq!((triangle.quadrangles(), triangle.of_cell(0)), (0, 0..1));
    }
}
