//! Quadrature that follows the curves where a function is less smooth, and a singular corner.

use super::DEGREE_4;
use crate::geometry::Interface;
use crate::geometry::{distance_sq, twice_signed_area};

/// Levels of subdivision towards a singular corner for each level along the curves: the mass of a squared gradient
/// `r^(-2/3)` that is left in the last triangle is the fraction `2^(-4/3)` per level.
const GRADING: usize = 4;

/// A triangle is divided towards the corner while that lies within this many of its radii from its barycentre.
const CORNER_REACH: f64 = 3.0;

type Triangle = [[f64; 2]; 3];

/// Triangles that a curve may cross are divided into four, `depth` times; where it still crosses, along its chord. What
/// lies between chord and curve is integrated with the wrong side: an area of order `(h / 2^depth)^2` in all.
///
/// All points lie inside triangles: an infinite gradient at a corner is never sampled.
#[derive(Debug, Clone)]
pub(crate) struct CutRule {
    interfaces: Vec<Interface>,
    corner: Option<[f64; 2]>,
    depth: usize,
}

impl CutRule {
    /// A rule for functions that are smooth but across `interfaces` and at `corner`.
    pub(crate) fn new(interfaces: Vec<Interface>, corner: Option<[f64; 2]>, depth: usize) -> Self {
        Self { interfaces, corner, depth }
    }

    /// The rule with one subdivision less, to see what the last one changes.
    pub(crate) fn shallower(&self) -> Self {
        Self { depth: self.depth - 1, ..self.clone() }
    }

    /// Whether the rule on this triangle does not depend on the depth.
    pub(crate) fn is_plain(&self, triangle: Triangle) -> bool {
        let is_smooth = self.interfaces.is_empty() && self.corner.is_none();
        is_smooth || !(self.crosses(triangle) || self.has_corner_near(triangle))
    }

    /// Calls `visit(point, weight)` for the points of the rule; the weights sum to the area of the triangle.
    pub(crate) fn visit(&self, triangle: Triangle, visit: &mut impl FnMut([f64; 2], f64)) {
        self.divide(triangle, 0, visit);
    }

    fn divide(&self, triangle: Triangle, level: usize, visit: &mut impl FnMut([f64; 2], f64)) {
        let towards_corner = level < GRADING * self.depth && self.has_corner_near(triangle);
        if towards_corner || (level < self.depth && self.crosses(triangle)) {
            for quarter in quarters(triangle) {
                self.divide(quarter, level + 1, visit);
            }
        } else {
            cut(triangle, &self.interfaces, visit);
        }
    }

    /// Whether a curve may pass through the triangle: exact up to the circle around its barycentre.
    fn crosses(&self, triangle: Triangle) -> bool {
        let ([x, y], radius) = around(triangle);
        self.interfaces.iter().any(|interface| interface.signed_distance(x, y).abs() <= radius)
    }

    fn has_corner_near(&self, triangle: Triangle) -> bool {
        let (centre, radius) = around(triangle);
        self.corner.is_some_and(|corner| distance_sq(corner, centre) <= (CORNER_REACH * radius).powi(2))
    }
}

/// The circle around the barycentre through the farthest corner: centre and radius.
fn around(triangle: Triangle) -> ([f64; 2], f64) {
    let [a, b, c] = triangle;
    let centre = [(a[0] + b[0] + c[0]) / 3.0, (a[1] + b[1] + c[1]) / 3.0];
    let radius_sq = triangle.iter().map(|&corner| distance_sq(corner, centre)).fold(0.0, f64::max);
    (centre, radius_sq.sqrt())
}

fn quarters([a, b, c]: Triangle) -> [Triangle; 4] {
    let [ab, bc, ca] = [between(a, b, 0.5), between(b, c, 0.5), between(c, a, 0.5)];
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

fn between(a: [f64; 2], b: [f64; 2], t: f64) -> [f64; 2] {
    [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
}

/// Cuts the triangle along the lines on which the interpolated distances from the curves vanish.
fn cut(triangle: Triangle, interfaces: &[Interface], visit: &mut impl FnMut([f64; 2], f64)) {
    let Some((interface, others)) = interfaces.split_first() else {
        return apply(triangle, visit);
    };
    let side = triangle.map(|[x, y]| interface.signed_distance(x, y));
    // The corner that the curve separates from one other, which is not on the side of the third.
    let apart = (0..3).find(|&i| {
        let [own, next, last] = [side[i], side[(i + 1) % 3], side[(i + 2) % 3]];
        (own * next < 0.0 || own * last < 0.0) && next * last >= 0.0
    });
    let Some(i) = apart else {
        return cut(triangle, others, visit);
    };
    let [j, k] = [(i + 1) % 3, (i + 2) % 3];
    let [a, b, c] = [triangle[i], triangle[j], triangle[k]];
    let ab = between(a, b, side[i] / (side[i] - side[j]));
    let ac = between(a, c, side[i] / (side[i] - side[k]));
    for part in [[a, ab, ac], [ab, b, c], [ab, c, ac]] {
        cut(part, others, visit);
    }
}

fn apply(triangle: Triangle, visit: &mut impl FnMut([f64; 2], f64)) {
    let area = 0.5 * twice_signed_area(triangle);
    for (barycentric, weight) in DEGREE_4.points.iter().zip(DEGREE_4.weights) {
        let at = |axis: usize| (0..3).map(|i| barycentric[i] * triangle[i][axis]).sum();
        visit([at(0), at(1)], area * weight);
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_4, PI};

    use super::*;

    const TRIANGLE: Triangle = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]];

    /// Rounding of sums of some thousand terms.
    const ROUNDING: f64 = 1e-13;

    fn rule(interfaces: &[Interface], corner: Option<[f64; 2]>, depth: usize) -> CutRule {
        CutRule::new(interfaces.to_vec(), corner, depth)
    }

    fn integral(rule: &CutRule, f: impl Fn(f64, f64) -> f64) -> f64 {
        let mut sum = 0.0;
        rule.visit(TRIANGLE, &mut |[x, y], weight| sum += weight * f(x, y));
        sum
    }

    #[test]
    fn a_jump_across_a_line_is_integrated_exactly_when_it_is_cut() {
        // Through the triangle, through two of its corners, along an edge of its parts, outside.
        for position in [1.0 / 3.0, 0.9, 0.0, 1.0, 0.5, 2.0] {
            let step = |x: f64, y: f64| if x < position { x * x * y } else { 1.0 };
            let x = position.min(1.0);
            let exact = x.powi(5) / 10.0 + 0.5 * (1.0 - x * x);
            let line = [Interface::VerticalLine { x: position }];
            for depth in [0, 3] {
                assert!((integral(&rule(&line, None, depth), step) - exact).abs() < ROUNDING, "{position}");
            }
            if position == 0.9 {
                let uncut = integral(&rule(&[], None, 3), step);
                assert!((uncut - exact).abs() > 1e-3, "uncut quadrature differs: {uncut}, not {exact}");
            }
        }
    }

    #[test]
    fn the_area_of_a_sector_converges_with_the_square_of_the_depth() {
        let radius = 0.7;
        let circle = [Interface::Circle { centre: [0.0, 0.0], radius }];
        let inside = |x: f64, y: f64| f64::from(x.hypot(y) < radius);
        let exact = FRAC_PI_4 / 2.0 * radius * radius;
        let error = |depth: usize| (integral(&rule(&circle, None, depth), inside) - exact).abs();
        assert!(error(6) < 2e-5 && error(6) < error(4) / 10.0 && error(4) < error(2) / 10.0);
        let shallower = integral(&rule(&circle, None, 4).shallower(), inside);
        assert!(error(4) < (shallower - integral(&rule(&circle, None, 4), inside)).abs(), "the estimate");
    }

    #[test]
    fn two_curves_cut_one_triangle() {
        let lines = [0.5, 0.52].map(|x| Interface::VerticalLine { x });
        let strip = |x: f64, _: f64| f64::from((0.5..0.52).contains(&x));
        let exact = 0.5 * (0.52f64.powi(2) - 0.25);
        assert!((integral(&rule(&lines, None, 0), strip) - exact).abs() < ROUNDING);
        assert!((integral(&rule(&lines[..1], None, 0), strip) - exact).abs() > 1e-3);
    }

    #[test]
    fn the_singularity_of_a_corner_is_integrated_and_never_sampled() {
        let singular = |x: f64, y: f64| {
            assert!(x.hypot(y) > 0.0);
            x.hypot(y).powf(-2.0 / 3.0)
        };
        // int r^(-2/3) = 3/4 int_0^{pi/4} sec^{4/3}, the latter by Simpson's rule.
        let panels = 2000;
        let sec = |k: usize| (FRAC_PI_4 * k as f64 / panels as f64).cos().powf(-4.0 / 3.0);
        let weight = |k: usize| {
            if k == 0 || k == panels {
                1.0
            } else if k % 2 == 1 {
                4.0
            } else {
                2.0
            }
        };
        let simpson: f64 = (0..=panels).map(|k| weight(k) * sec(k)).sum();
        let exact = 0.75 * simpson * PI / 4.0 / (3.0 * panels as f64);
        let graded = (integral(&rule(&[], Some([0.0, 0.0]), 4), singular) - exact).abs() / exact;
        let plain = (integral(&rule(&[], None, 4), singular) - exact).abs() / exact;
        assert!(graded < 1e-5 && plain > 1e-2, "{graded:e} {plain:e}");
    }

    #[test]
    fn plain_triangles_do_not_depend_on_the_depth() {
        let far = rule(&[Interface::VerticalLine { x: 3.0 }], Some([9.0, 0.0]), 4);
        assert!(far.is_plain(TRIANGLE));
        assert!(!rule(&[Interface::VerticalLine { x: 0.9 }], None, 4).is_plain(TRIANGLE));
        assert!(!rule(&[], Some([1.0, 0.0]), 4).is_plain(TRIANGLE));
        let mut points = 0;
        far.visit(TRIANGLE, &mut |_, _| points += 1);
        assert_eq!(points, DEGREE_4.points.len());
    }
}
