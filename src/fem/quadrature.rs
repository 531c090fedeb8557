//! Quadrature on triangles.

/// A quadrature rule on a triangle: `int_T f = |T| sum_k weight_k f(point_k)`, points in barycentric coordinates.
#[derive(Debug, Clone, Copy)]
pub struct TriangleRule {
    /// Barycentric coordinates. Shape: `points x 3`.
    pub points: &'static [[f64; 3]],
    /// Weights; their sum is 1.
    pub weights: &'static [f64],
}

const A: f64 = 0.445_948_490_915_964_9;
const B: f64 = 0.091_576_213_509_770_74;
const WEIGHT_A: f64 = 0.223_381_589_678_011_5;
const WEIGHT_B: f64 = 0.109_951_743_655_321_9;

/// Six points, exact for polynomials of degree 4 (Dunavant, Int. J. Numer. Meth. Eng. 21 (1985) 1129). Loads are
/// integrated with it: `f phi_a` is exact for `f` of degree 3, and smooth `f` costs an error of order `h^5` per element,
/// well below the discretisation error.
pub const DEGREE_4: TriangleRule = TriangleRule {
    points: &[
        [A, A, 1.0 - 2.0 * A],
        [A, 1.0 - 2.0 * A, A],
        [1.0 - 2.0 * A, A, A],
        [B, B, 1.0 - 2.0 * B],
        [B, 1.0 - 2.0 * B, B],
        [1.0 - 2.0 * B, B, B],
    ],
    weights: &[WEIGHT_A, WEIGHT_A, WEIGHT_A, WEIGHT_B, WEIGHT_B, WEIGHT_B],
};

#[cfg(test)]
mod tests {
    use super::*;

    /// The abscissae are given to 16 digits.
    const ROUNDING: f64 = 1e-15;

    /// `int x^p y^q` over the reference triangle, `p! q! / (p + q + 2)!`, less what the rule gives.
    fn defect(rule: TriangleRule, p: i32, q: i32) -> f64 {
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        let exact = factorial(p) * factorial(q) / factorial(p + q + 2);
        let terms = rule.points.iter().zip(rule.weights);
        exact - 0.5 * terms.map(|(b, w)| w * b[0].powi(p) * b[1].powi(q)).sum::<f64>()
    }

    #[test]
    fn the_rule_is_exact_to_its_degree_and_not_beyond() {
        for p in 0..=4 {
            for q in 0..=4 - p {
                assert!(defect(DEGREE_4, p, q).abs() < ROUNDING, "x^{p} y^{q}: {}", defect(DEGREE_4, p, q));
            }
        }
        assert!((0..=5).any(|p| defect(DEGREE_4, p, 5 - p).abs() > 1e4 * ROUNDING));
    }
}
