//! Uniform refinement: each triangle into four, by the midpoints of its edges.

use std::sync::OnceLock;

use crate::mesh::check::Smallest;
use crate::mesh::topology::Midpoints;
use crate::mesh::{Mesh, MeshError, VertexKind};
use crate::parallel::prelude::*;

/// A refined mesh and where its vertices come from.
#[derive(Debug, Clone)]
pub struct Refinement {
    /// The refined mesh. Its first vertices are those of the coarse mesh, in their order.
    pub mesh: Mesh,
    /// For each further vertex the ends of the coarse edge whose midpoint it is: the prolongation of a P1 function
    /// takes the mean of its values there. Shape: new vertices x 2.
    pub parents: Vec<[usize; 2]>,
}

impl Mesh {
    /// Divides every triangle into four similar ones. Children and halves of edges are called like their parents. Linear time.
    ///
    /// Curved boundaries are not followed: the domain stays the polygon that the coarse mesh covers.
    ///
    /// # Errors
    /// [`MeshError::TooSmall`] when edges would become shorter than about 1e-10 of the size of the mesh (3e-13 of its largest
    /// coordinate, if that is more): what is returned, [`Mesh::new`] accepts.
    pub fn refine(&self) -> Result<Refinement, MeshError> {
        let midpoints = Midpoints::new(self);
        let points = [self.points.as_slice(), &midpoints.points].concat();
        let kind_of_midpoint = |edge: usize| match midpoints.edges.on_boundary(edge) {
            true => VertexKind::Boundary,
            false => VertexKind::Interior,
        };
        let kind =
            self.kind.iter().copied().chain((0..midpoints.points.len()).map(kind_of_midpoint)).collect();
        let quarters = |t: usize| {
            let ([a, b, c], [ab, bc, ca]) = (self.triangles[t], midpoints.of_triangle(t));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        let triangles: Vec<_> = (0..self.triangles.len()).into_par_iter().map(quarters).collect();
        let triangles = triangles.into_flattened();
        let parents = midpoints.edges.ends;
        let ancestry = self.ancestry_of_refinement(&parents);
        let groups = self.groups.inherited(|t| 4 * t..4 * t + 4, self.points.len(), &parents);
        let origins = (0..4 * self.triangles.len()).map(|t| t / 4);
        let views = self.views.inherited(origins, self.points.len(), &parents);
        let mesh = Mesh { points, triangles, kind, ancestry, groups, views, around: OnceLock::new() };
        self.check_parts(&mesh)?;
        Ok(Refinement { mesh, parents })
    }

    /// Demands that the parts of all triangles, four each, are large enough.
    ///
    /// # Errors
    /// [`MeshError::TooSmall`], naming the triangle.
    pub(super) fn check_parts(&self, fine: &Self) -> Result<(), MeshError> {
        let smallest = Smallest::of(self);
        let is_allowed = |part: &usize| smallest.allows(fine.corners(*part));
        let parts = 0..fine.triangles.len();
        if parts.clone().into_par_iter().all(|part| is_allowed(&part)) {
            return Ok(());
        }
        let part = parts.into_iter().find(|part| !is_allowed(part)).expect("one is too small");
        Err(self.too_small(part / 4))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::mesh::HalfEdges;
    use crate::mesh::samples::{assorted, irregular, renumbered, square};
    use crate::mesh::{Pattern, l_shape};

    /// Rounding of sums over the triangles of small meshes of size one.
    const ROUNDING: f64 = 1e-12;

    fn count(mesh: &Mesh, kind: VertexKind) -> usize {
        mesh.kind().iter().filter(|&&k| k == kind).count()
    }

    #[test]
    fn triangles_vertices_and_boundary_are_counted_by_eulers_formula() {
        for coarse in assorted() {
            let Refinement { mesh: fine, parents } = coarse.refine().unwrap();
            let (vertices, triangles) = (coarse.points().len(), coarse.triangles().len());
            // Each vertex of the boundary starts as many edges of it as there are sectors of the domain at it.
            let boundary =
                HalfEdges::new(vertices, coarse.triangles()).edges().filter(|edge| edge.2.len() == 1).count();
            let edges = (3 * triangles + boundary) / 2;
            assert_eq!(fine.triangles().len(), 4 * triangles);
            assert_eq!(fine.points().len(), vertices + edges);
            assert_eq!(parents.len(), edges);
            assert_eq!(count(&fine, VertexKind::Boundary), count(&coarse, VertexKind::Boundary) + boundary);
            assert_eq!(count(&fine, VertexKind::Unused), count(&coarse, VertexKind::Unused));
        }
    }

    #[test]
    fn the_result_is_a_mesh_with_the_same_area_and_angles() {
        for coarse in assorted() {
            let fine = coarse.refine().unwrap().mesh;
            let checked = Mesh::new(fine.points().to_vec(), fine.triangles().to_vec()).unwrap();
            assert_eq!(checked.triangles(), fine.triangles(), "counterclockwise");
            assert_eq!(checked.kind(), fine.kind());
            assert!((fine.area() - coarse.area()).abs() < ROUNDING);
            let (before, after) = (coarse.quality(), fine.quality());
            assert!((after.min_angle / before.min_angle - 1.0).abs() < ROUNDING);
            assert!((after.max_angle / before.max_angle - 1.0).abs() < ROUNDING);
            assert!((2.0 * after.h_max / before.h_max - 1.0).abs() < ROUNDING);
            assert!((2.0 * after.h_min / before.h_min - 1.0).abs() < ROUNDING);
        }
        assert_ne!(square(2).refine().unwrap().mesh.quality(), square(2).quality());
    }

    #[test]
    fn old_vertices_stay_and_new_ones_are_the_midpoints_of_their_parents() {
        for coarse in assorted() {
            let Refinement { mesh: fine, parents } = coarse.refine().unwrap();
            let (old, new) = fine.points().split_at(coarse.points().len());
            assert_eq!(old, coarse.points());
            assert_eq!(fine.kind()[..old.len()], *coarse.kind());
            for (&[a, b], &midpoint) in parents.iter().zip(new) {
                let [p, q] = [old[a], old[b]];
                assert_eq!(midpoint, [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]);
                assert!(coarse.triangles().iter().any(|t| t.contains(&a) && t.contains(&b)), "an edge");
            }
            let mut different = parents.clone();
            different.sort_unstable();
            different.dedup();
            assert_eq!(different.len(), parents.len(), "each edge once");
        }
    }

    #[test]
    fn one_triangle_becomes_four() {
        let corners = vec![[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]];
        let Refinement { mesh, parents } = Mesh::new(corners, vec![[0, 1, 2]]).unwrap().refine().unwrap();
        assert_eq!(parents, [[0, 1], [0, 2], [1, 2]]);
        assert_eq!(mesh.points()[3..], [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]);
        assert_eq!(mesh.triangles(), [[0, 3, 4], [3, 1, 5], [4, 5, 2], [3, 5, 4]]);
    }

    /// The triangles as points, in an order that does not depend on the numbering.
    fn triangles_as_points(mesh: &Mesh) -> Vec<[[u64; 2]; 3]> {
        let bits = |t: usize| {
            let mut corners = mesh.corners(t).map(|point| point.map(f64::to_bits));
            corners.sort_unstable();
            corners
        };
        let mut triangles: Vec<_> = (0..mesh.triangles().len()).map(bits).collect();
        triangles.sort_unstable();
        triangles
    }

    #[test]
    fn what_is_too_small_to_be_told_apart_is_not_made() {
        // Edges of 4^-15 = 9e-10 at the corner of a domain of the size 2: they can be halved twice.
        let mut mesh = l_shape(1.0, 4, Pattern::Right).unwrap().graded([0.0, 0.0], 15.0).unwrap();
        for _ in 0..2 {
            mesh = mesh.refine().unwrap().mesh;
            assert!(Mesh::new(mesh.points().to_vec(), mesh.triangles().to_vec()).is_ok());
        }
        let Err(MeshError::TooSmall { corners, .. }) = mesh.refine() else { panic!("too small") };
        let edges = [0, 1, 2].map(|i| {
            let [p, q] = [corners[i], corners[(i + 1) % 3]].map(|a| mesh.points()[a]);
            (p[0] - q[0]).hypot(p[1] - q[1])
        });
        assert!(edges.iter().any(|&edge| edge < 4e-10), "halved, one is below 2e-10: {edges:?}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn refining_commutes_with_renumbering(cells in 1..6usize, seed: u64) {
            let mesh = irregular(cells);
            let (other, _) = renumbered(&mesh, seed);
            let (fine, other_fine) = (mesh.refine().unwrap().mesh, other.refine().unwrap().mesh);
            prop_assert!(triangles_as_points(&fine) == triangles_as_points(&other_fine));
            prop_assert!(triangles_as_points(&fine) != triangles_as_points(&mesh.refine().unwrap().mesh.refine().unwrap().mesh));
        }
    }
}
