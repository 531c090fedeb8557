//! The kinds of elements.

use crate::formats::gmsh::error::GmshError;
use crate::formats::gmsh::scanner::Scanner;

/// What an element is, whatever its order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    Point,
    Line,
    Triangle,
    Quadrangle,
}

impl Shape {
    /// Number of corners.
    pub(crate) fn corners(self) -> usize {
        match self {
            Self::Point => 1,
            Self::Line => 2,
            Self::Triangle => 3,
            Self::Quadrangle => 4,
        }
    }

    /// The dimension of an element.
    pub(crate) fn dimension(self) -> u8 {
        match self {
            Self::Point => 0,
            Self::Line => 1,
            Self::Triangle | Self::Quadrangle => 2,
        }
    }
}

/// A kind of elements that may be in the file of a plane mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Kind {
    pub(crate) shape: Shape,
    /// Number of nodes, of which the corners come first.
    pub(crate) nodes: usize,
}

impl Kind {
    /// Number of nodes between the corners.
    pub(crate) fn between(self) -> usize {
        self.nodes - self.shape.corners()
    }

    /// Reads the number that Gmsh gives to a kind of elements.
    pub(crate) fn read(scanner: &mut Scanner) -> Result<Self, GmshError> {
        let code = scanner.int("an element type")?;
        if let Some((shape, nodes)) = known(code) {
            return Ok(Self { shape, nodes });
        }
        let (shape, remedy) = match code {
            4..=7 | 11..=14 | 17..=19 | 29..=33 | 71..=75 | 79..=83 | 90..=132 | 137 => {
                ("volume elements", "mesh a plane surface only (`gmsh -2`)")
            }
            _ => ("such elements", "mesh a plane surface with triangles or quadrangles"),
        };
        Err(GmshError::Element { place: scanner.place(), shape, code, remedy })
    }
}

/// The shape and the number of nodes of a kind (`GmshDefines.h`; the numbers of nodes are those of `getElementProperties`).
fn known(code: i32) -> Option<(Shape, usize)> {
    use Shape::{Line, Point, Quadrangle, Triangle};
    Some(match code {
        15 => (Point, 1),
        1 => (Line, 2),
        8 => (Line, 3),
        26..=28 => (Line, code as usize - 22),
        62..=66 => (Line, code as usize - 55),
        2 => (Triangle, 3),
        9 => (Triangle, 6),
        // Complete ones of the orders 3 to 10, and those without nodes inside.
        21 => (Triangle, 10),
        23 => (Triangle, 15),
        25 => (Triangle, 21),
        42..=46 => (Triangle, [28, 36, 45, 55, 66][code as usize - 42]),
        20 => (Triangle, 9),
        22 => (Triangle, 12),
        24 => (Triangle, 15),
        52..=56 => (Triangle, 3 * (code as usize - 46)),
        3 => (Quadrangle, 4),
        10 => (Quadrangle, 9),
        36..=38 => (Quadrangle, [16, 25, 36][code as usize - 36]),
        47..=51 => (Quadrangle, [49, 64, 81, 100, 121][code as usize - 47]),
        16 => (Quadrangle, 8),
        39..=41 => (Quadrangle, 4 * (code as usize - 36)),
        57..=61 => (Quadrangle, 4 * (code as usize - 51)),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_have_the_nodes_of_their_order() {
        let of =
            |shape: Shape| (0..140).filter_map(known).filter(move |kind| kind.0 == shape).map(|kind| kind.1);
        let sorted = |shape: Shape| {
            let mut nodes: Vec<usize> = of(shape).collect();
            nodes.sort_unstable();
            nodes
        };
        let mut triangles: Vec<usize> =
            (1..=10).map(|p| (p + 1) * (p + 2) / 2).chain((3..=10).map(|p| 3 * p)).collect();
        let mut quadrangles: Vec<usize> =
            (1..=10).map(|p| (p + 1) * (p + 1)).chain((2..=10).map(|p| 4 * p)).collect();
        triangles.sort_unstable();
        quadrangles.sort_unstable();
        assert_eq!(sorted(Shape::Line), (2..=11).collect::<Vec<_>>());
        assert_eq!(sorted(Shape::Triangle), triangles);
        assert_eq!(sorted(Shape::Quadrangle), quadrangles);
        assert_eq!((known(4), known(34), known(-1)), (None, None, None));
    }
}
