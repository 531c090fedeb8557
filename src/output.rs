//! Results as files that people open with the tools they have.

mod checkpoint;
mod drawing;
mod dual;
mod file;
mod flux;
mod mesh_picture;
pub mod picture;
mod rates_picture;
mod summary;
mod vtu;

pub use checkpoint::{read_checkpoint, write_checkpoint};
pub use dual::write_dual_vtu;
pub use file::{FileSet, WriteSeek, discard_unfinished, prepare_folder, remove, write_atomically};
pub use flux::write_flux_vtu;
pub use mesh_picture::{MeshPicture, MeshPictureError, render_mesh, render_triangulation};
pub use rates_picture::{
    RatesPicture, RatesPictureError, Series, Times, TimesPicture, render_rates, render_times,
};
pub use summary::{PolishSummary, ResidualSummary, Seconds, Summary};
pub use vtu::write_vtu;
