//! Triangles by their corners.

/// Twice the area of a triangle, positive when its corners run counterclockwise.
pub(crate) fn twice_signed_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The square of the distance of two points.
pub(crate) fn distance_sq(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2)
}

#[cfg(feature = "pictures")]
/// The gradients of the three barycentric coordinates, `None` for a triangle without area.
pub(crate) fn barycentric_gradients(corners: [[f64; 2]; 3]) -> Option<[[f64; 2]; 3]> {
    let [a, b, c] = corners;
    let twice_area = twice_signed_area(corners);
    if !twice_area.is_normal() {
        return None;
    }
    let opposite =
        |from: [f64; 2], to: [f64; 2]| [(from[1] - to[1]) / twice_area, (to[0] - from[0]) / twice_area];
    Some([opposite(b, c), opposite(c, a), opposite(a, b)])
}
