//! The patterns of grids.

/// How a rectangular cell is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Pattern {
    /// Into two right triangles, by the diagonal from the lower left to the upper right corner.
    #[default]
    Right,
    /// Into four triangles, by both diagonals.
    Crossed,
}
