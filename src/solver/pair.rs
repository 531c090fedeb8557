//! The pair, which decouples exactly.

pub(super) mod active_set;
mod decoupled;
pub(super) mod multigrid;
mod polish;
mod unknowns;

pub(super) use polish::polish;
pub(super) use unknowns::unknowns;
