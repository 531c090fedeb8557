//! Closed polygons.

/// The area inside a closed polygon, in either orientation.
pub(crate) fn ring_area(ring: &[[f64; 2]]) -> f64 {
    signed_ring_area(ring).abs()
}

/// The area inside a closed polygon, negative when it is clockwise: the sum of the signed triangles from its first vertex.
pub(crate) fn signed_ring_area(ring: &[[f64; 2]]) -> f64 {
    let Some(&[x, y]) = ring.first() else { return 0.0 };
    let corner = |[x1, y1]: [f64; 2], [x2, y2]: [f64; 2]| (x1 - x) * (y2 - y) - (x2 - x) * (y1 - y);
    0.5 * ring.windows(2).map(|edge| corner(edge[0], edge[1])).sum::<f64>()
}
