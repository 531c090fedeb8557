//! How the vertices of a mesh come from those of a coarser one.

use crate::parallel::BLOCK;
use crate::parallel::prelude::*;

/// The vertices of a mesh as vertices of a coarser mesh and midpoints of its edges.
///
/// The prolongation of a P1 function takes the mean of its values at the two ends; on uniform and bisected meshes the
/// spaces are nested, and the prolongation changes nothing but the mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parents {
    coarse_vertices: usize,
    ends: Vec<[u32; 2]>,
}

impl Parents {
    /// # Panics
    /// When an end is no vertex of the coarser mesh.
    pub(in crate::mesh) fn new(coarse_vertices: usize, ends: Vec<[u32; 2]>) -> Self {
        let are_coarse = |ends: &[u32; 2]| ends.iter().all(|&end| (end as usize) < coarse_vertices);
        assert!(ends.par_iter().with_min_len(BLOCK).all(are_coarse), "parents are coarse vertices");
        Self { coarse_vertices, ends }
    }

    /// Those of a refinement that keeps the coarse vertices as the first ones; the others are midpoints.
    pub(in crate::mesh) fn of_refinement(coarse_vertices: usize, midpoints: &[[usize; 2]]) -> Self {
        let kept = (0..coarse_vertices).map(|a| [a, a]);
        let ends = kept.chain(midpoints.iter().copied()).map(|ends| ends.map(|a| a as u32)).collect();
        Self::new(coarse_vertices, ends)
    }

    /// The number of vertices of the coarser mesh.
    pub fn coarse_vertices(&self) -> usize {
        self.coarse_vertices
    }

    /// For each vertex the ends of the coarse edge whose midpoint it is; twice the same for a coarse vertex.
    /// Shape: `vertices x 2`.
    pub fn ends(&self) -> &[[u32; 2]] {
        &self.ends
    }

    /// The triangles of which those of a mesh that is refined uniformly are parts.
    ///
    /// All vertices of a part are corners of its triangle or midpoints of the edges: they do not lie on one line, so that their parents
    /// are the three corners. Each triangle is taken where it has the part along the edge from the first of its corners.
    pub(crate) fn coarser(&self, triangles: &[[usize; 3]]) -> Vec<[usize; 3]> {
        let ends = |v: usize| self.ends[v].map(|a| a as usize);
        let whole = |&[p, q, r]: &[usize; 3]| {
            [[p, q, r], [q, r, p], [r, p, q]].into_iter().find_map(|[p, q, r]| {
                let [a, same] = ends(p);
                let other = |[x, y]: [usize; 2]| if x == a { y } else { x };
                let along = ends(q);
                let b = other(along);
                let beside = ends(r);
                let c = if beside[0] == a || beside[0] == b { beside[1] } else { beside[0] };
                let on_edge = along[0] == along[1] || along.contains(&a);
                (a == same && on_edge && a < b && a < c).then_some([a, b, c])
            })
        };
        let parts = triangles.par_chunks(BLOCK);
        let wholes: Vec<Vec<[usize; 3]>> =
            parts.map(|part| part.iter().filter_map(whole).collect()).collect();
        wholes.concat()
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::samples::{ancestry_defect, irregular};
    use crate::mesh::{Pattern, disk, l_shape, rectangle};

    /// Coordinates of size one are rounded a few times.
    const ROUNDING: f64 = 1e-14;

    #[test]
    fn structured_meshes_are_refinements_of_coarser_ones() {
        for pattern in [Pattern::Right, Pattern::Crossed] {
            let square = |cells| rectangle([0.0, 1.0], [2.0, 4.0], cells, pattern).unwrap();
            let mesh = square([24, 40]);
            assert_eq!(mesh.ancestry().len(), 3, "24, 12, 6, 3 cells");
            assert!(ancestry_defect(&mesh, square([3, 5]).points()) < ROUNDING);
            assert!(
                ancestry_defect(&mesh, square([5, 3]).points()) > 0.1,
                "another coarsest mesh is noticed"
            );
            assert!(square([7, 8]).ancestry().is_empty(), "an odd number of cells");

            let mesh = l_shape(1.0, 12, pattern).unwrap();
            assert_eq!(mesh.ancestry().len(), 2, "12, 6, 3 cells");
            assert!(ancestry_defect(&mesh, l_shape(1.0, 3, pattern).unwrap().points()) < ROUNDING);
        }
    }

    #[test]
    fn parents_in_a_structured_mesh_are_ends_of_an_edge() {
        for pattern in [Pattern::Right, Pattern::Crossed] {
            let coarse = rectangle([0.0, 0.0], [1.0, 1.0], [4, 4], pattern).unwrap();
            let fine = rectangle([0.0, 0.0], [1.0, 1.0], [8, 8], pattern).unwrap();
            let is_edge =
                |a: usize, b: usize| coarse.triangles().iter().any(|t| t.contains(&a) && t.contains(&b));
            for &[a, b] in fine.ancestry().last().unwrap().ends() {
                assert!(is_edge(a as usize, b as usize));
            }
        }
    }

    #[test]
    fn a_disk_is_a_refinement_of_the_disk_with_half_the_rings() {
        // On a hexagon the midpoints are where they should be; on a disk the boundary is moved, the numbering is the same.
        let [coarse, fine] = [3, 6].map(|rings| disk([0.0, 0.0], 1.0, rings).unwrap());
        let parents = fine.ancestry().last().unwrap();
        assert_eq!((fine.ancestry().len(), parents.coarse_vertices()), (1, coarse.points().len()));
        let refined = coarse.refine().unwrap();
        let mut expected: Vec<[u32; 2]> = refined.mesh.ancestry()[0].ends().to_vec();
        let mut found: Vec<[u32; 2]> = parents.ends().iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        expected.sort_unstable();
        found.sort_unstable();
        assert_eq!(found, expected);
        assert!(ancestry_defect(&fine, coarse.points()) < 0.1, "and they lie near by");
    }

    #[test]
    fn refinements_add_to_the_ancestry() {
        let coarse = irregular(3);
        let fine = coarse.refine().unwrap().mesh.refine().unwrap().mesh;
        assert_eq!(fine.ancestry().len(), 2);
        assert!(ancestry_defect(&fine, coarse.points()) < ROUNDING);
    }
}
