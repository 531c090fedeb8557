//! Results as files that people open with the tools they have.

mod checkpoint;
mod dual;
mod file;
mod flux;
mod rim;
mod stack;
mod summary;
mod vtu;

pub use checkpoint::{read_checkpoint, write_checkpoint};
pub use dual::write_dual_vtu;
pub use file::{FileSet, WriteSeek, discard_unfinished, prepare_folder, remove, write_atomically};
pub use flux::write_flux_vtu;
pub use rim::write_rim_vtp;
pub use stack::write_stack_vtu;
pub use summary::{ContactSummary, PolishSummary, ResidualSummary, Seconds, Summary};
pub use vtu::write_vtu;
