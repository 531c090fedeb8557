//! The areas of the dual cells.

use crate::mesh::{Mesh, VertexTriangles};

/// `|D_a| = |Delta_a| / 3` (4.17), over vertices.
pub(super) fn dual_areas(mesh: &Mesh, around: &VertexTriangles) -> Vec<f64> {
    let at = |a: usize| around.of(a).iter().map(|&t| mesh.triangle_area(t)).sum::<f64>() / 3.0;
    (0..mesh.points().len()).map(at).collect()
}
