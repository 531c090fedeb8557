//! The P1 element on one triangle.

use crate::geometry::twice_signed_area;

/// The row `K_ij = int grad phi_i . grad phi_j`, `j = 0, 1, 2`, of corner `i` of the triangle with these corners: `e_i . e_j / (4 |T|)`,
/// where `e_i` is the edge opposite to corner `i`. Symmetric to the last bit.
pub(crate) fn local_stiffness_row(corners: [[f64; 2]; 3], i: usize) -> [f64; 3] {
    let edges = [0, 1, 2].map(|i| {
        let [from, to] = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
        [to[0] - from[0], to[1] - from[1]]
    });
    let (scale, e) = (0.5 / twice_signed_area(corners), edges[i]);
    edges.map(|f| scale * (e[0] * f[0] + e[1] * f[1]))
}

/// The gradient of the affine function with these values at the corners.
pub(crate) fn gradient(corners: [[f64; 2]; 3], values: [f64; 3]) -> [f64; 2] {
    let [a, b, c] = corners;
    let scale = 1.0 / twice_signed_area(corners);
    let [rise_b, rise_c] = [scale * (values[1] - values[0]), scale * (values[2] - values[0])];
    [rise_b * (c[1] - a[1]) - rise_c * (b[1] - a[1]), rise_c * (b[0] - a[0]) - rise_b * (c[0] - a[0])]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn local_stiffness(corners: [[f64; 2]; 3]) -> [[f64; 3]; 3] {
        [0, 1, 2].map(|i| local_stiffness_row(corners, i))
    }

    #[test]
    fn reference_triangle_has_the_textbook_stiffness() {
        let local = local_stiffness([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(local, [[1.0, -0.5, -0.5], [-0.5, 0.5, 0.0], [-0.5, 0.0, 0.5]]);
        // Stretched, it is another one: the formula sees the shape of the triangle.
        assert_ne!(local, local_stiffness([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]]));
    }

    #[test]
    fn it_does_not_depend_on_size_and_place() {
        let corners = [[0.25, 0.5], [1.0, 0.75], [0.5, 2.0]];
        let scaled = corners.map(|[x, y]| [4.0 * x + 8.0, 4.0 * y - 16.0]);
        assert_eq!(local_stiffness(corners), local_stiffness(scaled));
    }

    #[test]
    fn the_gradient_is_that_of_the_affine_function() {
        let corners = [[0.25, 0.5], [1.0, 0.75], [0.5, 2.0]];
        let found = gradient(corners, corners.map(|[x, y]| 3.0 - 2.0 * x + 5.0 * y));
        // Rounding of a few operations on numbers of order ten.
        assert!((found[0] + 2.0).abs() < 1e-13 && (found[1] - 5.0).abs() < 1e-13);
        assert!((gradient(corners, corners.map(|[x, y]| x * y))[0] - 0.5).abs() > 1e-3, "of no other");
    }
}
