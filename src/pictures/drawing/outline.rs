//! The outline of a mesh.

use crate::mesh::HalfEdges;

/// The edges that belong to one triangle only, in increasing order of their lower and upper ends. Linear time.
pub(crate) fn boundary_edges(vertices: usize, triangles: &[[usize; 3]]) -> Vec<[usize; 2]> {
    let half_edges = HalfEdges::new(vertices, triangles);
    let alone = half_edges.edges().filter(|(_, _, sides)| sides.len() == 1);
    alone.map(|(lower, upper, _)| [lower, upper]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::samples::{irregular, renumbered};

    #[test]
    fn they_are_the_edges_of_one_triangle_whichever_way_it_turns() {
        for (seed, cells) in [(1, 1), (2, 5), (3, 9)] {
            let (mesh, _) = renumbered(&irregular(cells), seed);
            let expected: Vec<[usize; 2]> =
                crate::mesh::boundary_edges(&mesh).into_iter().map(|[a, b]| [a.min(b), a.max(b)]).collect();
            let turned = mesh.triangles().iter().enumerate();
            let turned: Vec<[usize; 3]> =
                turned.map(|(t, &[a, b, c])| if t % 2 == 0 { [a, b, c] } else { [a, c, b] }).collect();
            // A vertex in no triangle has no edge.
            assert_eq!(boundary_edges(mesh.points().len() + 1, &turned), expected);
            assert_ne!(boundary_edges(mesh.points().len(), &turned[1..]), expected);
        }
    }
}
