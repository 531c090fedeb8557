//! The names of the curves with their slopes, at the curves' ends.

use super::coordinates::Coordinates;
use super::curve::Curve;
use super::marker::{self, MARKER, color};
use crate::pictures::drawing::canvas::{Anchor, Canvas};
use crate::pictures::drawing::color::{INK, PAPER, mix};
use crate::pictures::drawing::frame::{NORMAL, SMALL};

/// Names are cut off at this part of the width of the picture, or of the panel.
const LONGEST: f64 = 0.31;
/// From the plot to the markers.
const LEADER: f64 = 46.0;
/// From the middle of a marker to its name.
const NAME: f64 = 26.0;
/// Between the columns, and at the edge of the picture.
const GAP: f64 = 36.0;
/// The distance of neighbouring labels.
const LINE: f64 = 36.0;

/// Leaders begin at a curve that ends right of this part of the plot, else at the edge of the plot.
const NEAR_THE_END: f64 = 0.85;

/// A column of names and one of slopes.
pub(super) struct Labels {
    names: Vec<String>,
    slopes: Vec<String>,
    /// What stands over the slopes.
    heading: String,
    left: f64,
    right: f64,
}

impl Labels {
    /// The labels, against the right one of these edges, with room for all names of the picture: its plots are of one width.
    pub(super) fn new(
        canvas: &Canvas,
        [names, all_names]: [&[String]; 2],
        heading: &str,
        slopes: &[String],
        [left, right]: [f64; 2],
    ) -> Labels {
        let longest = LONGEST * (right - left);
        let names: Vec<String> = names.iter().map(|name| shortened(canvas, name, longest)).collect();
        let widest = |texts: &[String]| texts.iter().map(|t| canvas.width(t, NORMAL)).fold(0.0, f64::max);
        let all_names: Vec<String> = all_names.iter().map(|name| shortened(canvas, name, longest)).collect();
        let columns =
            widest(&names).max(widest(&all_names)) + GAP + widest(slopes).max(canvas.width(heading, SMALL));
        let right = right - GAP;
        let left = right - columns - NAME - LEADER;
        Labels { names, slopes: slopes.to_vec(), heading: heading.to_owned(), left, right }
    }

    /// Where the plot ends.
    pub(super) fn left(&self) -> f64 {
        self.left
    }

    /// Draws the labels at the heights of the curves' ends, with leaders where they had to give way.
    pub(super) fn draw(&self, canvas: &mut Canvas, plot: &Coordinates, curves: &[Curve]) {
        let ends: Vec<Option<[f64; 2]>> =
            curves.iter().map(|curve| curve.end().map(|end| plot.at(end))).collect();
        let (top, bottom) = (plot.frame.top + LINE / 2.0, plot.frame.bottom() - LINE / 2.0);
        let wanted: Vec<f64> = ends.iter().map(|end| end.map_or(bottom, |[_, y]| y)).collect();
        let right = self.right;
        for (k, y) in spread(&wanted, LINE, [top, bottom]).into_iter().enumerate() {
            let at = [self.left + LEADER, y];
            if let Some([x, end]) = ends[k] {
                let bend = [self.left + 6.0, end];
                let pale = mix(color(k), PAPER, 0.45);
                // Over more of the plot a leader would pass for a curve.
                let from = if x > plot.frame.at([NEAR_THE_END, 0.0])[0] { x } else { self.left };
                canvas.line([[from, end], bend], 1.5, pale);
                canvas.line([bend, at], 1.5, pale);
            }
            marker::draw(canvas, k, at, MARKER, color(k));
            canvas.text(&self.names[k], [at[0] + NAME, y], NORMAL, INK, Anchor::Left);
            canvas.text(&self.slopes[k], [right, y], NORMAL, INK, Anchor::Right);
        }
        if !self.names.is_empty() {
            canvas.text(&self.heading, [self.right, plot.frame.top - 34.0], SMALL, INK, Anchor::Right);
        }
    }
}

/// A number with two decimals and a true minus sign.
pub(super) fn decimal(value: f64) -> String {
    let value = format!("{value:.2}").replace('-', "−");
    if value == "−0.00" { "0.00".to_owned() } else { value }
}

/// A name on one line, ended by an ellipsis if it is too long.
fn shortened(canvas: &Canvas, name: &str, longest: f64) -> String {
    let letters: Vec<char> = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let fitting = canvas.fitting(&letters, NORMAL, longest);
    if fitting == letters.len() {
        return letters.into_iter().collect();
    }
    letters[..fitting.saturating_sub(1)].iter().collect::<String>() + "…"
}

/// The places next to the `wanted` ones, in the least-squares sense, that lie `gap` apart between two limits; closer where
/// there is no room.
pub(super) fn spread(wanted: &[f64], gap: f64, [low, high]: [f64; 2]) -> Vec<f64> {
    let steps = wanted.len().saturating_sub(1).max(1) as f64;
    let gap = gap.min((high - low) / steps);
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by(|&a, &b| wanted[a].total_cmp(&wanted[b]));
    // Without the gaps the places are to ascend: neighbours that descend are pooled at their mean.
    let mut pools: Vec<(f64, usize)> = Vec::new();
    let mean = |(sum, count): (f64, usize)| sum / count as f64;
    for (i, &k) in order.iter().enumerate() {
        let mut pool = (wanted[k] - i as f64 * gap, 1);
        while let Some(last) = pools.pop_if(|last| mean(*last) > mean(pool)) {
            pool = (pool.0 + last.0, pool.1 + last.1);
        }
        pools.push(pool);
    }
    let ascending = pools.into_iter().flat_map(|pool| std::iter::repeat_n(mean(pool), pool.1));
    let highest = (high - (wanted.len().max(1) - 1) as f64 * gap).max(low);
    let mut places = vec![0.0; wanted.len()];
    for (i, (&k, place)) in order.iter().zip(ascending).enumerate() {
        places[k] = place.clamp(low, highest) + i as f64 * gap;
    }
    places
}
