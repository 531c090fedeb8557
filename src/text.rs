//! Numbers and names in messages.

mod names;
mod number;

pub(crate) use names::{excerpt, meant, nearest};
pub(crate) use number::{Number, grouped};
