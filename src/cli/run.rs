//! What every command needs: the case set up, its folder, its limits, and who watches over them.

pub(super) mod clock;
pub(super) mod files;
pub(super) mod folder;
pub(super) mod input;
pub(super) mod levels;
pub(super) mod memory;
mod notes;
pub(super) mod pictures;
pub(super) mod progress;
pub(super) mod setup;
pub(super) mod watch;
