//! Errors against the mesh size.

use super::coordinates::Axes;
use super::curve::Curve;
use super::labels::decimal;
use super::panel::{Panel, SIZE};
use crate::pictures::drawing::axis::superscript;
use crate::pictures::drawing::canvas::Canvas;
use crate::pictures::drawing::encode::Drawing;
use crate::pictures::drawing::heading::heading;

/// Errors below this part of the greatest one, as a decimal logarithm, are those of solver and rounding: an error of zero
/// in exact arithmetic would squash all others.
const ROUNDING: f64 = -9.0;

/// Errors on a sequence of meshes, to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct RatesPicture<'a> {
    /// The heading; what does not fit into two lines is cut off.
    pub title: &'a str,
    /// The name of the abscissa, for example `h`.
    pub abscissa: &'a str,
    /// The abscissa of each level, from the coarsest mesh to the finest: a mesh size, or a number of vertices.
    pub h: &'a [f64],
    /// The errors.
    pub series: &'a [Series<'a>],
    /// The slopes to be drawn for comparison; what is not finite is left out.
    pub slopes: &'a [f64],
}

/// One error on all levels.
#[derive(Clone, Copy, Debug)]
pub struct Series<'a> {
    /// What it is called beside its curve; cut off if it is very long.
    pub name: &'a str,
    /// Its value on each level. Those that are not positive and finite have no logarithm and are left out.
    pub values: &'a [f64],
}

/// Why rates could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum RatesPictureError {
    /// A series has the wrong length.
    #[error("rates picture: {name:?} has {found} values for {expected} levels; pass one per level")]
    Length {
        /// The series.
        name: String,
        /// How many values it has.
        found: usize,
        /// The number of levels.
        expected: usize,
    },
}

/// Draws errors against `h` with the slopes of their last segments, the same for the same data, of 1800 x 1200 pixels.
/// Neighbouring levels are joined where both can be drawn. Errors below 1e-9 of the greatest are marked on the lower edge.
///
/// # Errors
/// See [`RatesPictureError`]; any values can be drawn, also none.
pub fn render_rates(picture: &RatesPicture) -> Result<Drawing, RatesPictureError> {
    let expected = picture.h.len();
    if let Some(series) = picture.series.iter().find(|series| series.values.len() != expected) {
        let found = series.values.len();
        return Err(RatesPictureError::Length { name: series.name.to_owned(), found, expected });
    }
    let (curves, floor) = curves(picture.h, picture.series);
    let slope = |curve: &Curve| match curve.last_slope() {
        _ if curve.ends_at_rounding() => "rounding".to_owned(),
        Some(slope) => decimal(slope),
        None => "–".to_owned(),
    };
    let panel = Panel {
        title: "",
        names: picture.series.iter().map(|series| series.name.to_owned()).collect(),
        other_names: &[],
        slopes: curves.iter().map(slope).collect(),
        curves: &curves,
        others: &[],
        axes: Axes::over(&curves),
        axis_names: [picture.abscissa, "error"],
        slope_name: "last slope",
        compared: picture.slopes,
        note: curves
            .iter()
            .any(|curve| curve.at_rounding().next().is_some())
            .then(|| format!("on this edge: rounding, below 10{}", superscript(floor.round() as i32))),
    };
    let mut canvas = Canvas::new(SIZE);
    heading(&mut canvas, picture.title);
    panel.draw_alone(&mut canvas);
    Ok(Drawing::new(canvas))
}

/// The curves, and the decimal logarithm below which there is rounding only.
pub(super) fn curves(h: &[f64], series: &[Series]) -> (Vec<Curve>, f64) {
    let curves: Vec<Curve> = series.iter().map(|series| Curve::new(h, series.values)).collect();
    let greatest =
        curves.iter().flat_map(Curve::points).map(|point| point[1]).fold(f64::NEG_INFINITY, f64::max);
    let floor = (greatest + ROUNDING).floor();
    (curves.into_iter().map(|curve| curve.above(floor)).collect(), floor)
}
