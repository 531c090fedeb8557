//! Results as files that people open with the tools they have.

mod file;
pub mod picture;
mod summary;
mod vtu;

pub use file::{WriteSeek, write_atomically};
pub use summary::{PolishSummary, ResidualSummary, Seconds, Summary};
pub use vtu::write_vtu;
