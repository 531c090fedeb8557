//! Multigrid for `K x - y = b`, `x >= lower`, `y >= 0`, `y'(x - lower) = 0`: a hierarchy of levels, and cycles on it.

pub(crate) mod cholesky;
mod correction;
mod direct;
mod driver;
pub(crate) mod half;
pub(crate) mod hierarchy;
pub(crate) mod linear;
pub(crate) mod membrane;
pub(crate) mod patches;
pub(crate) mod stack;
pub(crate) mod sweep;
pub(crate) mod truncation;
