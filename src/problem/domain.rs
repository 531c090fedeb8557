//! The domain `omega`, a bounded set of the plane.

/// The shape on which the two membranes are stretched. Lengths are in the unit of the coordinates.
#[derive(Debug, Clone, PartialEq)]
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
        /// The outer boundary, in either orientation, first vertex not repeated.
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
}
