//! Why a stack cannot be posed on a mesh.

use thiserror::Error;

use crate::discretization::scales::LARGEST;
use crate::problem::EvaluationError;
use crate::text::{Number, excerpt};

/// Why a stack cannot be posed on a mesh.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum StackError {
    /// A datum that cannot be evaluated.
    #[error("{datum} {source}: it must be finite where it is needed")]
    Evaluation {
        /// Which datum.
        datum: String,
        /// Where, or why.
        source: EvaluationError,
    },
    /// A region that the mesh does not have.
    #[error("{datum} is given in the region `{}`, which the mesh does not have: {known}", excerpt(name))]
    UnknownRegion {
        /// Which datum.
        datum: String,
        /// The name.
        name: String,
        /// Those that there are, in words.
        known: String,
    },
    /// A curve that the mesh does not have.
    #[error("{datum} is given on the curve `{}`, which the mesh does not have: {known}", excerpt(name))]
    UnknownCurve {
        /// Which datum.
        datum: String,
        /// The name.
        name: String,
        /// Those that there are, in words.
        known: String,
    },
    /// A data view that the mesh does not have.
    #[error("{datum} is the data view `{}`, which the mesh does not have: {known}", excerpt(name))]
    UnknownView {
        /// Which datum.
        datum: String,
        /// The name.
        name: String,
        /// Those that there are, in words.
        known: String,
    },
    /// A data view that is of no use as a datum.
    #[error("{datum} is the data view `{}`, which {why}", excerpt(name))]
    UselessView {
        /// Which datum.
        datum: String,
        /// The name.
        name: String,
        /// What is wrong with it, and what helps.
        why: String,
    },
    /// A data view without a value where the datum is needed.
    #[error("{datum} is the data view `{}`, which has no value at ({}, {}), {place}: save one, or name regions where it has values", excerpt(name), Number(point[0]), Number(point[1]))]
    NoValue {
        /// Which datum.
        datum: String,
        /// The name.
        name: String,
        /// A vertex or triangle, in words.
        place: String,
        /// The vertex, counted from 0, if it is one.
        vertex: Option<usize>,
        /// Its coordinates, or those of the barycentre.
        point: [f64; 2],
    },
    /// A part of the mesh in two of the regions or curves that a datum names.
    #[error("{datum} is given twice, in `{}` and in `{}`, which overlap at ({}, {}): name one of them", excerpt(&names[0]), excerpt(&names[1]), Number(point[0]), Number(point[1]))]
    Overlap {
        /// Which datum.
        datum: String,
        /// The two names.
        names: [String; 2],
        /// A point of both.
        point: [f64; 2],
    },
    /// A part of the domain in none of the regions that a datum names.
    #[error("{datum} is not given at ({}, {}), which is in none of its regions: add `elsewhere`", Number(point[0]), Number(point[1]))]
    NotCovered {
        /// Which datum.
        datum: String,
        /// A point without it.
        point: [f64; 2],
    },
    /// Values for another mesh.
    #[error("{datum} has {found} values, but the mesh has {expected} {of}: give one for each")]
    Length {
        /// Which datum.
        datum: String,
        /// How many there are.
        found: usize,
        /// How many there must be.
        expected: usize,
        /// Vertices or triangles.
        of: &'static str,
    },
    /// A datum that is needed at vertices is given by triangle.
    #[error(
        "{datum} is given by triangle, but it is needed at the vertices: give a formula or values at the vertices"
    )]
    NotAtVertices {
        /// Which datum.
        datum: String,
    },
    /// A tension or a foundation out of range.
    #[error("{datum} is {} on the triangle at ({}, {}): it must be {must}", Number(*value), Number(point[0]), Number(point[1]))]
    Coefficient {
        /// Which datum.
        datum: String,
        /// Its mean on the triangle.
        value: f64,
        /// The barycentre.
        point: [f64; 2],
        /// What is allowed.
        must: &'static str,
    },
    /// Two heights of one membrane at one vertex.
    #[error("the height of membrane {membrane} jumps at vertex {vertex} ({}, {}), from {} to {}: no membrane of finite energy does; let it be continuous there", Number(point[0]), Number(point[1]), Number(values[0]), Number(values[1]))]
    HeightJumps {
        /// Counted from 1 at the top.
        membrane: usize,
        /// The vertex, counted from 0.
        vertex: usize,
        /// Its coordinates.
        point: [f64; 2],
        /// The two heights.
        values: [f64; 2],
    },
    /// An upper layer that is held below a lower one.
    #[error("{upper} is at {} and {lower} above it at {}, at vertex {vertex} ({}, {}): put them in order", Number(values[0]), Number(values[1]), Number(point[0]), Number(point[1]))]
    Order {
        /// What should be above.
        upper: String,
        /// What should be below.
        lower: String,
        /// The vertex, counted from 0.
        vertex: usize,
        /// Its coordinates.
        point: [f64; 2],
        /// Where both are.
        values: [f64; 2],
    },
    /// A membrane that nothing holds.
    #[error("nothing holds membrane {membrane} on the part of the mesh at ({}, {}): fix it on a part of the boundary there, give it a foundation, or, if its neighbours hold it, say that it is pressed", Number(point[0]), Number(point[1]))]
    Unsupported {
        /// Counted from 1 at the top.
        membrane: usize,
        /// A vertex of that part.
        point: [f64; 2],
    },
    /// A membrane that is meant to be pressed against its neighbours, and is not.
    #[error("membrane {membrane} is held by nothing on the part of the mesh at ({}, {}), and the forces there do not press it, and those that go with it, against a neighbour that is held: change the loads, or fix it", Number(point[0]), Number(point[1]))]
    NotPressed {
        /// Counted from 1 at the top.
        membrane: usize,
        /// A vertex of that part.
        point: [f64; 2],
    },
    /// A size that leads to overflow.
    #[error("{quantity} {value:e}, out of the range from {:e} to {LARGEST:e}: choose other units", 1.0 / LARGEST)]
    OutOfRange {
        /// Whose size.
        quantity: String,
        /// The size.
        value: f64,
    },
}

impl StackError {
    /// The vertex that the error names.
    pub fn vertex(&self) -> Option<usize> {
        match self {
            Self::HeightJumps { vertex, .. } | Self::Order { vertex, .. } => Some(*vertex),
            Self::NoValue { vertex, .. } => *vertex,
            _ => None,
        }
    }
}

/// The names that there are, for a reader who has missed one.
pub(super) fn known<'n>(names: impl IntoIterator<Item = &'n str>, what: &str) -> String {
    let names: Vec<String> = names.into_iter().map(|name| format!("`{}`", excerpt(name))).collect();
    if names.is_empty() {
        format!("it has no named {what}s")
    } else {
        format!("its {what}s are {}", names.join(", "))
    }
}
