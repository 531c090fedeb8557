//! Errors against the mesh size, and seconds against vertices, on two logarithmic axes.

mod coordinates;
mod curve;
mod errors;
mod labels;
mod marker;
mod panel;
mod slopes;
mod times;

pub use errors::{RatesPicture, RatesPictureError, Series, render_rates};
pub use times::{Times, TimesPicture, render_times};

#[cfg(test)]
mod tests;
