//! The pair, which decouples exactly.

pub(super) mod active_set;
mod decoupled;
pub(super) mod multigrid;
mod unknowns;

pub(super) use unknowns::unknowns;
