//! Why a solution cannot be drawn.

/// Why no picture could be drawn.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The mesh is empty.
    #[error("picture: the mesh has no triangles; pass at least one")]
    NoTriangles,
    /// A stack without membranes.
    #[error("picture: the stack has no membranes; pass at least one")]
    NoMembranes,
    /// A gap without a layer above or below.
    #[error(
        "picture: gap {number} does not lie between two layers; with {membranes} membranes pass gaps 1 to {last}, 0 under a ceiling and {membranes} over a floor",
        last = membranes - 1
    )]
    Gap {
        /// The gap.
        number: usize,
        /// The number of membranes.
        membranes: usize,
    },
    /// A triangle refers to a vertex that does not exist.
    #[error(
        "picture: triangle {triangle} has vertex {vertex}, but there are {count} vertices; number them from 0"
    )]
    Vertex {
        /// The triangle.
        triangle: usize,
        /// Its vertex.
        vertex: usize,
        /// The number of vertices.
        count: usize,
    },
    /// A slice has the wrong length.
    #[error("picture: {name} has {found} values for {expected} vertices; pass one per vertex")]
    Length {
        /// The quantity.
        name: String,
        /// How many values it has.
        found: usize,
        /// The number of vertices.
        expected: usize,
    },
    /// A value cannot be drawn.
    #[error("picture: {name} = {value} at vertex {vertex}; pass finite values below {limit:e} in magnitude")]
    Value {
        /// The quantity.
        name: String,
        /// The vertex.
        vertex: usize,
        /// The value.
        value: f64,
        /// The greatest magnitude that can be drawn.
        limit: f64,
    },
}
