//! Curves of segments and arcs, and how far they are apart.

use std::f64::consts::TAU;

use super::Interface;
use super::triangle::distance_sq;

type Point = [f64; 2];

/// What may be missing in a distance, relative to it.
const RELATIVE: f64 = 1e-3;

/// What may be missing in a distance that is almost zero, relative to the extent of the curves.
const OF_EXTENT: f64 = 1e-6;

/// A curve of segments and circular arcs, in any number of pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve(Vec<Piece>);

#[derive(Debug, Clone, Copy, PartialEq)]
enum Piece {
    Segment(Point, Point),
    /// From one angle to a larger one, at most half a circle.
    Arc {
        centre: Point,
        radius: f64,
        from: f64,
        to: f64,
    },
}

impl Curve {
    /// The segments between successive points of each line.
    pub fn of_lines<'l>(lines: impl IntoIterator<Item = &'l [Point]>) -> Self {
        let segments = lines.into_iter().flat_map(|line| line.windows(2).map(|w| Piece::Segment(w[0], w[1])));
        Self(segments.collect())
    }

    /// A circle, or what a box has of a line: the box by its lower left and upper right corners.
    pub fn of_interface(interface: &Interface, (lower, upper): (Point, Point)) -> Self {
        Self(match *interface {
            Interface::Circle { centre, radius } => {
                let quarter = |k: usize| Piece::Arc {
                    centre,
                    radius,
                    from: 0.25 * TAU * k as f64,
                    to: 0.25 * TAU * (k + 1) as f64,
                };
                (0..4).map(quarter).collect()
            }
            Interface::VerticalLine { x } if (lower[0]..=upper[0]).contains(&x) => {
                vec![Piece::Segment([x, lower[1]], [x, upper[1]])]
            }
            Interface::VerticalLine { .. } => Vec::new(),
        })
    }

    /// The Hausdorff distance of two curves: the largest distance of a point of one of them from the other one. At most one
    /// thousandth of it is missing, or a millionth of the curves' extent; `None` when one of the curves is empty.
    pub fn hausdorff(&self, other: &Self) -> Option<f64> {
        if self.0.is_empty() || other.0.is_empty() {
            return None;
        }
        let ends = self.0.iter().chain(&other.0).flat_map(|piece| piece.ends());
        let from = self.0[0].ends()[0];
        let extent = ends.map(|end| distance_sq(end, from)).fold(0.0, f64::max).sqrt();
        let tolerance = OF_EXTENT * extent;
        Some(self.farthest_from(other, tolerance).max(other.farthest_from(self, tolerance)))
    }

    /// The largest distance of a point from `other`, by branch and bound.
    fn farthest_from(&self, other: &Self, tolerance: f64) -> f64 {
        let distance = |p: Point| other.0.iter().map(|piece| piece.distance(p)).fold(f64::INFINITY, f64::min);
        let mut largest = self.0.iter().map(|piece| distance(piece.ends()[0])).fold(0.0, f64::max);
        let mut open = self.0.clone();
        while let Some(piece) = open.pop() {
            let at_middle = distance(piece.middle());
            largest = largest.max(at_middle);
            let allowed = largest * (1.0 + RELATIVE) + tolerance;
            // The distance from a set changes at most as fast as the point moves.
            if at_middle + 0.5 * piece.length() <= allowed || other.is_near(&piece, allowed) {
                continue;
            }
            open.extend(piece.halves());
        }
        largest
    }

    /// Whether one segment is within `allowed` of the whole piece. The distance from a convex set is convex along the chord, and
    /// the piece is within its height of the chord.
    fn is_near(&self, piece: &Piece, allowed: f64) -> bool {
        let [start, end] = piece.ends();
        let chord = allowed - piece.height();
        let near = |segment: &Piece| segment.distance(start) <= chord && segment.distance(end) <= chord;
        self.0.iter().any(|other| matches!(other, Piece::Segment(..)) && near(other))
    }
}

impl Piece {
    fn at(&self, t: f64) -> Point {
        match *self {
            Self::Segment(a, b) => [0, 1].map(|k| a[k] + t * (b[k] - a[k])),
            Self::Arc { centre, radius, from, to } => {
                let (sin, cos) = (from + t * (to - from)).sin_cos();
                [centre[0] + radius * cos, centre[1] + radius * sin]
            }
        }
    }

    fn ends(&self) -> [Point; 2] {
        [self.at(0.0), self.at(1.0)]
    }

    fn middle(&self) -> Point {
        self.at(0.5)
    }

    fn length(&self) -> f64 {
        match *self {
            Self::Segment(a, b) => distance_sq(a, b).sqrt(),
            Self::Arc { radius, from, to, .. } => radius * (to - from),
        }
    }

    /// How far it is from its chord at most.
    fn height(&self) -> f64 {
        match *self {
            Self::Segment(..) => 0.0,
            Self::Arc { radius, from, to, .. } => radius * (1.0 - (0.5 * (to - from)).cos()),
        }
    }

    fn halves(&self) -> [Self; 2] {
        match *self {
            Self::Segment(a, b) => {
                let middle = self.middle();
                [Self::Segment(a, middle), Self::Segment(middle, b)]
            }
            Self::Arc { centre, radius, from, to } => {
                let middle = 0.5 * (from + to);
                [
                    Self::Arc { centre, radius, from, to: middle },
                    Self::Arc { centre, radius, from: middle, to },
                ]
            }
        }
    }

    fn distance(&self, p: Point) -> f64 {
        match *self {
            Self::Segment(a, b) => {
                let [direction, offset] = [b, p].map(|q| [q[0] - a[0], q[1] - a[1]]);
                let dot = |u: [f64; 2], v: [f64; 2]| u[0] * v[0] + u[1] * v[1];
                let length_sq = dot(direction, direction);
                let t =
                    if length_sq > 0.0 { (dot(offset, direction) / length_sq).clamp(0.0, 1.0) } else { 0.0 };
                distance_sq(self.at(t), p).sqrt()
            }
            Self::Arc { centre, radius, from, to } => {
                let angle = (p[1] - centre[1]).atan2(p[0] - centre[0]);
                // The angle in the turn that begins with the arc.
                let beyond = (angle - from).rem_euclid(TAU);
                if beyond <= to - from {
                    return (distance_sq(p, centre).sqrt() - radius).abs();
                }
                let [one, other] = self.ends().map(|end| distance_sq(end, p).sqrt());
                one.min(other)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Relative, twice what may be missing.
    const CLOSE: f64 = 2.0 * RELATIVE;

    const BOX: (Point, Point) = ([-2.0, -1.0], [2.0, 1.0]);

    #[track_caller]
    fn assert_distance(one: &Curve, other: &Curve, expected: f64) {
        let [there, back] = [one.hausdorff(other).unwrap(), other.hausdorff(one).unwrap()];
        assert_eq!(there, back);
        assert!((there - expected).abs() <= CLOSE * expected + 1e-5, "{there}, not {expected}");
    }

    fn polygon(corners: usize, radius: f64) -> Curve {
        let at = |k: usize| {
            let (sin, cos) = (TAU * k as f64 / corners as f64).sin_cos();
            [radius * cos, radius * sin]
        };
        let line: Vec<Point> = (0..=corners).map(at).collect();
        Curve::of_lines([line.as_slice()])
    }

    #[test]
    fn lines_and_circles_are_as_far_apart_as_they_are() {
        let line = |x: f64| Curve::of_interface(&Interface::VerticalLine { x }, BOX);
        assert_distance(&line(0.25), &line(0.75), 0.5);
        assert_distance(&line(0.25), &line(0.25), 0.0);
        let circle =
            |x: f64, radius: f64| Curve::of_interface(&Interface::Circle { centre: [x, 0.0], radius }, BOX);
        assert_distance(&circle(0.0, 1.0), &circle(0.0, 0.75), 0.25);
        assert_distance(&circle(0.0, 1.0), &circle(0.5, 1.0), 0.5);
        // The inner one of these is near to a part of the outer one only.
        assert_distance(&circle(0.0, 1.0), &circle(0.75, 0.25), 1.5);
    }

    #[test]
    fn an_inscribed_polygon_is_its_height_from_the_circle() {
        let circle = Curve::of_interface(&Interface::Circle { centre: [0.0; 2], radius: 1.0 }, BOX);
        for corners in [6, 48, 384] {
            assert_distance(&polygon(corners, 1.0), &circle, 1.0 - (PI / corners as f64).cos());
        }
        // A zigzag that leaves the line between its ends.
        let zigzag = [[0.0, -1.0], [0.1, 0.0], [0.0, 1.0]];
        let line = Curve::of_interface(&Interface::VerticalLine { x: 0.0 }, BOX);
        assert_distance(&Curve::of_lines([&zigzag[..]]), &line, 0.1);
    }

    #[test]
    fn every_piece_counts_and_nothing_is_far_from_nowhere() {
        let line = Curve::of_interface(&Interface::VerticalLine { x: 0.0 }, BOX);
        let segment = [[0.0, -1.0], [0.0, 1.0]];
        let speck = [[0.5, 0.0], [0.5, 1e-3]];
        assert_distance(&Curve::of_lines([&segment[..], &speck[..]]), &line, 0.5);
        assert_distance(&Curve::of_lines([&segment[..]]), &line, 0.0);
        let outside = Curve::of_interface(&Interface::VerticalLine { x: 3.0 }, BOX);
        assert_eq!((line.hausdorff(&outside), outside.hausdorff(&line)), (None, None));
    }
}
