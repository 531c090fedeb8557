//! The domain `omega`, a bounded set of the plane.

use std::f64::consts::PI;

use crate::geometry::ring_area;

/// The shape on which the two membranes are stretched. Lengths are in the unit of the coordinates.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Domain {
    /// `(lower[0], upper[0]) x (lower[1], upper[1])`.
    Rectangle {
        /// Lower left corner.
        lower: [f64; 2],
        /// Upper right corner.
        upper: [f64; 2],
    },
    /// `(-a, a)^2` without `[0, a] x [-a, 0]`: re-entrant corner of 270 degrees at the origin.
    LShape {
        /// The half width `a`.
        half_width: f64,
    },
    /// A disk.
    Disk {
        /// Centre.
        centre: [f64; 2],
        /// Radius.
        radius: f64,
    },
    /// A polygon with polygonal holes.
    Polygon {
        /// The outer boundary, in either orientation; the last vertex may repeat the first.
        vertices: Vec<[f64; 2]>,
        /// The boundaries of the holes, likewise.
        holes: Vec<Vec<[f64; 2]>>,
    },
}

impl Domain {
    /// The unit square `(0, 1)^2`.
    pub fn unit_square() -> Self {
        Self::Rectangle { lower: [0.0, 0.0], upper: [1.0, 1.0] }
    }

    /// The area; of a polygon whose boundaries cross, some number.
    pub fn area(&self) -> f64 {
        match self {
            Self::Rectangle { lower, upper } => (upper[0] - lower[0]) * (upper[1] - lower[1]),
            Self::LShape { half_width } => 3.0 * half_width * half_width,
            Self::Disk { radius, .. } => PI * radius * radius,
            Self::Polygon { vertices, holes } => {
                ring_area(vertices) - holes.iter().map(|hole| ring_area(hole)).sum::<f64>()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_are_those_of_the_shapes() {
        let square = |x: f64, side: f64| vec![[x, x], [x + side, x], [x + side, x + side], [x, x + side]];
        let mut clockwise = square(1.0, 1.0);
        clockwise.reverse();
        let framed = Domain::Polygon { vertices: square(0.0, 3.0), holes: vec![clockwise] };
        assert_eq!(framed.area(), 8.0);
        assert_eq!(Domain::unit_square().area(), 1.0);
        assert_eq!(Domain::LShape { half_width: 2.0 }.area(), 12.0);
        assert_eq!(Domain::Disk { centre: [5.0, 5.0], radius: 2.0 }.area(), 4.0 * PI);
        assert_eq!(Domain::Polygon { vertices: vec![], holes: vec![] }.area(), 0.0);
    }
}
