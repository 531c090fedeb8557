//! Numbers and names in messages.

mod names;
mod number;

#[cfg(feature = "cli")]
pub(crate) use names::beginning;
pub(crate) use names::{excerpt, meant, nearest};
#[cfg(feature = "pictures")]
pub(crate) use number::grouped_by;
pub(crate) use number::{Number, grouped};
