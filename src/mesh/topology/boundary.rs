//! The edges of the boundary of a mesh that is checked.

use crate::mesh::{Mesh, VertexKind};

/// The edges of the boundary, each from the vertex to that at which its triangle, run through counterclockwise, comes
/// later; in increasing order of their lower and upper ends.
///
/// Only edges between vertices of the boundary are looked at: of a fine mesh few.
pub(crate) fn boundary_edges(mesh: &Mesh) -> Vec<[usize; 2]> {
    let on_boundary = |a: usize| mesh.kind[a] == VertexKind::Boundary;
    let sides = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut candidates: Vec<[usize; 2]> = sides.filter(|&[a, b]| on_boundary(a) && on_boundary(b)).collect();
    let key = |&[a, b]: &[usize; 2]| [a.min(b), a.max(b)];
    candidates.sort_unstable_by_key(key);
    // An edge inside is there twice, once in either direction.
    let same_edge = candidates.chunk_by(|one, other| key(one) == key(other));
    same_edge.filter(|sides| sides.len() == 1).map(|sides| sides[0]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::HalfEdges;
    use crate::mesh::samples::{assorted, renumbered};

    #[test]
    fn they_are_those_with_one_triangle() {
        for (seed, mesh) in (0..).zip(assorted()) {
            let (mesh, _) = renumbered(&mesh, seed);
            let half_edges = HalfEdges::new(mesh.points().len(), mesh.triangles());
            let directed = |(lower, upper, reversed)| if reversed { [upper, lower] } else { [lower, upper] };
            let alone = half_edges.edges().filter(|(_, _, sides)| sides.len() == 1);
            let expected: Vec<[usize; 2]> =
                alone.map(|(lower, upper, sides)| directed((lower, upper, sides[0].is_reversed()))).collect();
            assert_eq!(boundary_edges(&mesh), expected);
            assert!(!expected.is_empty());
        }
    }
}
