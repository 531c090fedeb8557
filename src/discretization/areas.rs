//! The areas of the dual cells.

use crate::mesh::Mesh;
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;

/// `|D_a| = |Delta_a| / 3` (4.17), over vertices.
pub(super) fn dual_areas(mesh: &Mesh) -> Vec<f64> {
    let at = |a: usize| mesh.around().triangles(a).map(|t| mesh.triangle_area(t)).sum::<f64>() / 3.0;
    (0..mesh.points().len()).into_par_iter().with_min_len(BLOCK).map(at).collect()
}
