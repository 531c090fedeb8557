//! The P1 element on one triangle.

use crate::mesh::twice_signed_area;

/// `K_ij = int grad phi_i . grad phi_j` on the triangle with these corners: `e_i . e_j / (4 |T|)`, where `e_i` is the
/// edge opposite to corner `i`. Symmetric to the last bit.
pub(crate) fn local_stiffness(corners: [[f64; 2]; 3]) -> [[f64; 3]; 3] {
    let edges = [0, 1, 2].map(|i| {
        let [from, to] = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
        [to[0] - from[0], to[1] - from[1]]
    });
    let scale = 0.5 / twice_signed_area(corners);
    edges.map(|e| edges.map(|f| scale * (e[0] * f[0] + e[1] * f[1])))
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
