//! Seconds against vertices: curves that need not share their meshes.

use super::{Axes, Curve, RatesPictureError, draw};
use crate::study::exponent;

/// Times of several solvers, to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct TimesPicture<'a> {
    /// The heading; what does not fit into two lines is cut off.
    pub title: &'a str,
    /// The curves.
    pub curves: &'a [Times<'a>],
    /// The slopes to be drawn for comparison; what is not finite is left out.
    pub slopes: &'a [f64],
}

/// The times of one solver.
#[derive(Clone, Copy, Debug)]
pub struct Times<'a> {
    /// What it is called beside its curve; cut off if it is very long.
    pub name: &'a str,
    /// Vertices and seconds in any order. Those that are not positive and finite have no logarithm and are left out.
    pub points: &'a [[f64; 2]],
}

/// Draws seconds against vertices, beside each curve its slope by least squares: the bytes of a PNG file of 1800 x 1200
/// pixels, the same for the same data.
///
/// # Errors
/// When the image cannot be encoded; any values can be drawn, also none.
pub fn render_times(picture: &TimesPicture) -> Result<Vec<u8>, RatesPictureError> {
    let curves: Vec<Curve> = picture.curves.iter().map(|times| Curve::through(times.points)).collect();
    let names: Vec<&str> = picture.curves.iter().map(|times| times.name).collect();
    let fitted = |curve: &Curve| exponent(curve.points().map(|point| point.map(|log| 10f64.powf(log))));
    let slopes: Vec<Option<f64>> = curves.iter().map(fitted).collect();
    let axes = Axes { names: ["vertices", "seconds"], slope: "slope", slopes: picture.slopes };
    Ok(draw(picture.title, &axes, &names, &curves, &slopes)?)
}
