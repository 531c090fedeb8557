//! Numbers and names in messages.

mod names;
mod number;

pub(crate) use names::{excerpt, meant, nearest, path_excerpt};
pub(crate) use number::Number;
