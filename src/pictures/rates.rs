//! Errors against the mesh size, and seconds against vertices, on two logarithmic axes.

mod curve;
mod labels;
mod marker;
mod slopes;
mod times;

pub use times::{Times, TimesPicture, render_times};

use super::drawing::canvas::{Anchor, Canvas};
use super::drawing::color::{CURVES, INK, PAPER, RULE, Rgb};
use super::drawing::frame::{Frame, NORMAL};
use super::drawing::heading::heading;
use super::drawing::log_axis::LogAxis;
use curve::Curve;
use labels::Labels;
use slopes::Fan;

/// Width and height of the picture in pixels.
const SIZE: [usize; 2] = [1800, 1200];

const LEFT: f64 = 190.0;
const TOP: f64 = 150.0;
const BOTTOM: f64 = 1090.0;

/// Width of a curve in pixels.
const CURVE: f64 = 3.5;
/// The half width of a marker in pixels.
const MARKER: f64 = 11.0;

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
#[non_exhaustive]
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
    /// The image could not be encoded.
    #[error("rates picture: cannot encode the image: {0}; free memory and run again")]
    Encoding(#[from] png::EncodingError),
}

/// Draws errors against `h` with the slopes of their last segments: the bytes of a PNG file of 1800 x 1200 pixels, the same
/// for the same data. Neighbouring levels are joined where both can be drawn.
///
/// # Errors
/// See [`RatesPictureError`]; any values can be drawn, also none.
pub fn render_rates(picture: &RatesPicture) -> Result<Vec<u8>, RatesPictureError> {
    let expected = picture.h.len();
    if let Some(series) = picture.series.iter().find(|series| series.values.len() != expected) {
        let found = series.values.len();
        return Err(RatesPictureError::Length { name: series.name.to_owned(), found, expected });
    }
    let curves: Vec<Curve> =
        picture.series.iter().map(|series| Curve::new(picture.h, series.values)).collect();
    let names: Vec<&str> = picture.series.iter().map(|series| series.name).collect();
    let axes = Axes { names: [picture.abscissa, "error"], slope: "last slope", slopes: picture.slopes };
    let slopes: Vec<Option<f64>> = curves.iter().map(Curve::last_slope).collect();
    Ok(draw(picture.title, &axes, &names, &curves, &slopes)?)
}

/// What stands at the axes.
struct Axes<'a> {
    /// The names of the abscissa and the ordinate.
    names: [&'a str; 2],
    /// The heading of the curves' slopes.
    slope: &'a str,
    /// The slopes to compare with.
    slopes: &'a [f64],
}

/// The picture of curves with their names and slopes.
fn draw(
    title: &str,
    axes: &Axes,
    names: &[&str],
    curves: &[Curve],
    slopes: &[Option<f64>],
) -> Result<Vec<u8>, png::EncodingError> {
    let mut canvas = Canvas::new(SIZE);
    let labels = Labels::new(&canvas, names, axes.slope, slopes);
    let plot = Plot::new(curves, axes.slopes, labels.left());
    heading(&mut canvas, title);
    plot.axes(&mut canvas, axes.names);
    labels.draw(&mut canvas, &plot, curves);
    plot.draw(&mut canvas, curves);
    canvas.encode()
}

/// The colour of a curve: beside its marker, what tells it from the others.
fn color(index: usize) -> Rgb {
    CURVES[(index + index / marker::KINDS) % CURVES.len()]
}

/// The rectangle of the curves with its axes.
struct Plot {
    frame: Frame,
    x: LogAxis,
    y: LogAxis,
    fan: Option<Fan>,
}

impl Plot {
    /// The plot left of `right`, with room for curves and slopes.
    fn new(curves: &[Curve], slopes: &[f64], right: f64) -> Plot {
        let frame = Frame { left: LEFT, top: TOP, width: right - LEFT, height: BOTTOM - TOP };
        let all = |axis: usize| curves.iter().flat_map(Curve::points).map(move |point| point[axis]);
        let x = LogAxis::over(all(0)).widened([0.05, 0.05]);
        let y = LogAxis::over(all(1)).widened([0.06, 0.06]);
        let fan = Fan::new(slopes, &x, &y, curves);
        let y = fan.as_ref().map_or(y, |fan| y.lowered(fan.low()));
        Plot { frame, x, y, fan }
    }

    /// The point of the canvas of a pair of logarithms.
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        self.frame.at([self.x.place(x), self.y.place(y)])
    }

    fn axes(&self, canvas: &mut Canvas, [abscissa, ordinate]: [&str; 2]) {
        let (frame, [x, y]) = (&self.frame, [self.x.ticks(6), self.y.ticks(9)]);
        frame.rules_at(canvas, &y);
        for tick in &x {
            canvas.line([frame.at([tick.place, 0.0]), frame.at([tick.place, 1.0])], 1.0, RULE);
        }
        frame.bottom_ticks(canvas, &self.x.minor_ticks());
        frame.left_ticks(canvas, &self.y.minor_ticks());
        frame.outline(canvas);
        frame.bottom_ticks(canvas, &x);
        frame.left_ticks(canvas, &y);
        let below = [frame.left + frame.width / 2.0, frame.bottom() + 66.0];
        canvas.text(abscissa, below, NORMAL, INK, Anchor::Middle);
        canvas.text(ordinate, [frame.left - 14.0, frame.top - 34.0], NORMAL, INK, Anchor::Right);
    }

    fn draw(&self, canvas: &mut Canvas, curves: &[Curve]) {
        if let Some(fan) = &self.fan {
            fan.draw(canvas, self);
        }
        for (k, curve) in curves.iter().enumerate() {
            for ends in curve.segments() {
                canvas.line(ends.map(|point| self.at(point)), CURVE, color(k));
            }
        }
        for (k, curve) in curves.iter().enumerate() {
            for point in curve.points() {
                marker::draw(canvas, k, self.at(point), MARKER + 2.5, PAPER);
                marker::draw(canvas, k, self.at(point), MARKER, color(k));
            }
        }
        if curves.iter().all(|curve| curve.points().next().is_none()) {
            let middle = self.frame.at([0.5, 0.5]);
            canvas.text("no positive values", middle, NORMAL, INK, Anchor::Middle);
        }
    }
}

#[cfg(test)]
mod tests;
