//! Pictures of solutions, meshes and rates.

mod drawing;
mod plan;
pub mod membranes;
mod mesh;
mod rates;
pub mod stack;

pub use drawing::encode::{Drawing, EncodingError, Format};
pub use mesh::{MeshPicture, MeshPictureError, render_mesh, render_triangulation};
pub use rates::{RatesPicture, RatesPictureError, Series, Times, TimesPicture, render_rates, render_times};
