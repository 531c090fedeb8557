//! The outline of a mesh.

/// The edges that belong to one triangle only, in a fixed order.
pub(crate) fn boundary_edges(triangles: &[[usize; 3]]) -> Vec<[usize; 2]> {
    let ends = |&[a, b, c]: &[usize; 3]| [[a, b], [b, c], [c, a]].map(|[p, q]| [p.min(q), p.max(q)]);
    let mut edges: Vec<[usize; 2]> = triangles.iter().flat_map(ends).collect();
    edges.sort_unstable();
    edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0]).collect()
}
