//! Lengths, areas and curves in the plane.

mod hausdorff;
mod inequalities;
mod interface;
mod ring;
mod triangle;

pub use hausdorff::Curve;
pub use interface::Interface;

pub(crate) use inequalities::{friedrichs, poincare};
pub(crate) use ring::{ring_area, signed_ring_area};
#[cfg(feature = "pictures")]
pub(crate) use triangle::barycentric_gradients;
pub(crate) use triangle::{distance_sq, twice_signed_area};
