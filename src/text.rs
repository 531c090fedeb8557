//! Numbers and names in messages.

mod names;
mod number;

#[cfg(feature = "cli")]
pub(crate) use names::beginning;
pub(crate) use names::{excerpt, meant, nearest};
pub(crate) use number::{Number, grouped};
