//! What was done to a mesh to make it one of plane triangles.

use std::fmt;

use crate::text::{Number, excerpt, grouped};

/// What was done to a mesh to make it one of plane triangles, to be told to whoever has made it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum GmshNote {
    /// Elements of higher order were taken by their corners.
    HigherOrder {
        /// Number of lines, triangles and quadrangles of higher order.
        elements: usize,
    },
    /// Quadrangles were cut in two.
    Quadrangles {
        /// Their number.
        quadrangles: usize,
    },
    /// The mesh lies in a plane `z = constant`; `x` and `y` were kept.
    Level {
        /// Its height.
        z: f64,
    },
    /// The mesh lies in another plane.
    Plane {
        /// Orthonormal axes of the plane: the new coordinates are the products of the old ones with these.
        axes: [[f64; 3]; 2],
    },
    /// Values of a data view at nodes, or on elements, that the mesh of triangles does not have.
    ValuesLeftOut {
        /// Name of the view.
        view: String,
        /// Their number.
        values: usize,
    },
}

impl fmt::Display for GmshNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::HigherOrder { elements } => {
                write!(f, "elements of higher order, read by their corners: {}", grouped(*elements))
            }
            Self::Quadrangles { quadrangles } => {
                write!(f, "quadrangles, cut in two along the shorter diagonal: {}", grouped(*quadrangles))
            }
            Self::Level { z } => write!(f, "the mesh lies in the plane z = {}: x and y are kept", Number(*z)),
            Self::Plane { axes: [x, y] } => {
                write!(
                    f,
                    "the mesh lies in a plane in space; its coordinates there: x is now {}, y is now {}",
                    Sum(x),
                    Sum(y)
                )
            }
            Self::ValuesLeftOut { view, values } => write!(
                f,
                "values of the view `{}` at what is no vertex or triangle of the mesh, left out: {}",
                excerpt(view),
                grouped(*values)
            ),
        }
    }
}

/// A sum of multiples of `x`, `y` and `z`.
struct Sum<'a>(&'a [f64; 3]);

impl fmt::Display for Sum<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        /// Smaller factors are not shown: they are those of rounding.
        const SHOWN: f64 = 5e-7;
        let mut is_first = true;
        for (factor, name) in self.0.iter().zip(["x", "y", "z"]).filter(|(factor, _)| factor.abs() >= SHOWN) {
            let sign = match (is_first, *factor < 0.0) {
                (true, true) => "-",
                (true, false) => "",
                (false, true) => " - ",
                (false, false) => " + ",
            };
            is_first = false;
            let size = format!("{:.6}", factor.abs());
            match size.trim_end_matches('0').trim_end_matches('.') {
                "1" => write!(f, "{sign}{name}")?,
                size => write!(f, "{sign}{size} {name}")?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_say_what_was_done() {
        let notes = [
            (
                GmshNote::HigherOrder { elements: 1234 },
                "elements of higher order, read by their corners: 1,234",
            ),
            (
                GmshNote::Quadrangles { quadrangles: 5 },
                "quadrangles, cut in two along the shorter diagonal: 5",
            ),
            (GmshNote::Level { z: 0.25 }, "the mesh lies in the plane z = 0.25: x and y are kept"),
            (
                GmshNote::Plane { axes: [[0.6, 1e-17, -0.8], [0.0, 1.0, 0.0]] },
                "the mesh lies in a plane in space; its coordinates there: x is now 0.6 x - 0.8 z, y is now y",
            ),
            (
                GmshNote::ValuesLeftOut { view: "p".into(), values: 3 },
                "values of the view `p` at what is no vertex or triangle of the mesh, left out: 3",
            ),
        ];
        for (note, text) in notes {
            assert_eq!(note.to_string(), text);
        }
    }
}
