//! Curves along which data jump.

/// A curve across which the action or a second or higher derivative of the gap may jump: the free boundary
/// and the borders of biactive sets. An error norm has to cut its quadrature there.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Interface {
    /// A circle.
    Circle {
        /// Centre.
        centre: [f64; 2],
        /// Radius.
        radius: f64,
    },
    /// The line of all points with this abscissa.
    VerticalLine {
        /// The abscissa.
        x: f64,
    },
}

impl Interface {
    /// The signed distance of a point from the curve: negative inside the circle or left of the line.
    pub fn signed_distance(&self, x: f64, y: f64) -> f64 {
        match *self {
            Self::Circle { centre, radius } => (x - centre[0]).hypot(y - centre[1]) - radius,
            Self::VerticalLine { x: position } => x - position,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_has_its_sign_and_size() {
        let circle = Interface::Circle { centre: [1.0, 2.0], radius: 2.5 };
        let line = Interface::VerticalLine { x: 0.25 };
        assert_eq!([(4.0, 6.0), (1.0, 2.0)].map(|(x, y)| circle.signed_distance(x, y)), [2.5, -2.5]);
        assert_eq!([(1.0, 9.0), (0.0, 9.0)].map(|(x, y)| line.signed_distance(x, y)), [0.75, -0.25]);
    }
}
