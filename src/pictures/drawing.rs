//! What all pictures draw with: a canvas, frames, axes, colours.

pub(crate) mod axis;
pub(crate) mod canvas;
pub(crate) mod color;
pub(crate) mod encode;
pub(crate) mod font;
pub(crate) mod frame;
pub(crate) mod heading;
pub(crate) mod log_axis;
pub(crate) mod outline;
pub(crate) mod raster;
#[cfg(test)]
pub(crate) mod samples;
