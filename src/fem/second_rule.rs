//! A second look at a load, at other points than those of the quadrature.

use std::f64::consts::TAU;

/// So many points at least lie on a domain, where a triangle may have them.
const POINTS: f64 = 65_536.0;

/// Subdivisions of a triangle at most: `3 * 4^3` points.
const DEEPEST: usize = 3;

/// The three points of a rule of degree 2 lie, in barycentric coordinates, on the circle through the midpoints of the edges, at
/// equal distances; this angle from the point next to a corner keeps their coordinates from being fractions, at which
/// formulas tend to jump.
const ANGLE: f64 = 0.4;

/// Rules with equal weights: exact for polynomials of degree 2 on each of `4^k` parts of a triangle.
///
/// The large triangles of a mesh are divided, the small ones are not: so a coarse mesh is looked at more closely than its
/// own quadrature does, and the cost on a fine one is half of that.
pub(super) struct SecondRule {
    /// For each number of subdivisions.
    points: [Points; DEEPEST + 1],
    /// What a triangle that is not divided has at most.
    area: f64,
}

/// Points on a triangle.
pub(super) struct Points {
    /// Barycentric coordinates.
    pub(super) points: Vec<[f64; 3]>,
    /// All the same; their sum is one.
    pub(super) weights: Vec<f64>,
}

impl Points {
    fn new(points: Vec<[f64; 3]>) -> Self {
        Self { weights: vec![1.0 / points.len() as f64; points.len()], points }
    }

    /// These points in each of the four halves of a triangle in scale.
    fn in_quarters(&self) -> Self {
        let at_corner = |corner: usize| {
            let halfway =
                move |point: &[f64; 3]| [0, 1, 2].map(|i| 0.5 * (point[i] + f64::from(i == corner)));
            self.points.iter().map(halfway)
        };
        let in_the_middle = self.points.iter().map(|point| point.map(|coordinate| 0.5 * (1.0 - coordinate)));
        Self::new((0..3).flat_map(at_corner).chain(in_the_middle).collect())
    }
}

impl SecondRule {
    /// The rule for the triangles of a domain of this area.
    pub(super) fn new(domain_area: f64) -> Self {
        let coordinate = |turn: f64| (1.0 + (ANGLE + turn * TAU / 3.0).cos()) / 3.0;
        let [a, b, c] = [0.0, 1.0, 2.0].map(coordinate);
        let whole = Points::new(vec![[a, b, c], [c, a, b], [b, c, a]]);
        let half = whole.in_quarters();
        let quarter = half.in_quarters();
        let eighth = quarter.in_quarters();
        Self { points: [whole, half, quarter, eighth], area: 3.0 * domain_area / POINTS }
    }

    /// The points on a triangle of this area, as many as it needs.
    pub(super) fn on(&self, triangle_area: f64) -> &Points {
        let mut depth = 0;
        let mut part = triangle_area;
        while part > self.area && depth < DEEPEST {
            (depth, part) = (depth + 1, part / 4.0);
        }
        &self.points[depth]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fem::DEGREE_4;

    /// Of sums of up to 192 terms.
    const ROUNDING: f64 = 1e-14;

    /// The mean of `l0^p l1^q` over a triangle, `2 p! q! / (p + q + 2)!`, less what the points give.
    fn defect(points: &[[f64; 3]], p: i32, q: i32) -> f64 {
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        let exact = 2.0 * factorial(p) * factorial(q) / factorial(p + q + 2);
        let sum: f64 = points.iter().map(|l| l[0].powi(p) * l[1].powi(q)).sum();
        exact - sum / points.len() as f64
    }

    #[test]
    fn it_is_exact_for_parabolas_and_for_nothing_else() {
        let rule = SecondRule::new(1.0);
        for (k, Points { points, .. }) in rule.points.iter().enumerate() {
            assert_eq!(points.len(), 3 << (2 * k));
            for (p, q) in [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)] {
                assert!(defect(points, p, q).abs() < ROUNDING, "{k}: {p} {q}");
            }
            assert!(defect(points, 3, 0).abs() > 1e4 * ROUNDING);
        }
    }

    #[test]
    fn its_points_lie_inside_and_are_none_of_the_first_rule() {
        let rule = SecondRule::new(1.0);
        for point in rule.points.iter().flat_map(|rule| &rule.points) {
            assert!(point.iter().all(|&coordinate| coordinate > 0.005), "{point:?}");
            let apart = |other: &[f64; 3]| (0..3).any(|i| (point[i] - other[i]).abs() > 1e-3);
            assert!(DEGREE_4.points.iter().all(apart), "{point:?}");
        }
    }

    #[test]
    fn large_triangles_have_more_points() {
        let rule = SecondRule::new(2.0);
        let counts = [1.0, 1e-3, 1e-4, 1e-6].map(|area| rule.on(area).points.len());
        assert_eq!(counts, [192, 48, 12, 3]);
    }
}
