//! The dual mesh `D_h` of section 4.2 and the triangulation `S_h` between it and `T_h`.

use super::topology::Midpoints;
use super::triangulation::corner_of;
use super::{Mesh, MeshError, VertexKind};
use crate::geometry::twice_signed_area;

/// `S_h` on all of `omega`: every triangle `K` divided into six by its medians.
///
/// Sub-triangles `6 K + 2 i` and `6 K + 2 i + 1` lie in the dual cell of corner `i` of `K` and have it as their first
/// vertex; run through counterclockwise they are (corner, midpoint towards corner `i + 1`, barycentre) and (corner,
/// barycentre, midpoint towards corner `i - 1`). Each has the area `|K| / 6`.
#[derive(Debug, Clone)]
pub struct SubTriangulation {
    mesh: Mesh,
    vertices: usize,
    edges: usize,
}

impl SubTriangulation {
    /// Divides the triangles of `mesh`. Linear time.
    ///
    /// # Errors
    /// [`MeshError::TooSmall`] when parts of a triangle are too small to be told apart.
    pub fn new(mesh: &Mesh) -> Result<Self, MeshError> {
        let vertices = mesh.points.len();
        let midpoints = Midpoints::new(mesh);
        let edges = midpoints.points.len();
        let mut points = [mesh.points.as_slice(), &midpoints.points].concat();
        let mut triangles = Vec::with_capacity(6 * mesh.triangles.len());
        for (k, corners) in mesh.triangles.iter().enumerate() {
            let midpoints = midpoints.of_triangle(k);
            let [a, b, c] = mesh.corners(k);
            let barycentre = points.len();
            points.push([(a[0] + b[0] + c[0]) / 3.0, (a[1] + b[1] + c[1]) / 3.0]);
            for i in 0..3 {
                let (towards_next, towards_previous) = (midpoints[i], midpoints[(i + 2) % 3]);
                triangles.push([corners[i], towards_next, barycentre]);
                triangles.push([corners[i], barycentre, towards_previous]);
            }
        }
        // Parts of a triangulation are one, up to rounding.
        let divided = Mesh::new(points, triangles)
            .map_err(|error| mesh.too_small(error.triangle().map_or(0, |part| part / 6)))?;
        Ok(Self { mesh: divided, vertices, edges })
    }

    /// The sub-triangles as a mesh. Its points are the vertices of `T_h`, the midpoints of its edges, its barycentres.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The triangle of `T_h` that contains sub-triangle `t`.
    pub fn triangle_of(&self, t: usize) -> usize {
        t / 6
    }

    /// The vertex of `T_h` whose dual cell contains sub-triangle `t`.
    pub fn vertex_of(&self, t: usize) -> usize {
        self.mesh.triangles[t][0]
    }

    /// The barycentre of triangle `k` of `T_h`, as a point of [`mesh`](Self::mesh).
    pub fn barycentre(&self, k: usize) -> usize {
        self.vertices + self.edges + k
    }
}

/// The dual mesh `D_h`: around each interior vertex `a` the polygon `D_a` through the midpoints of the edges at `a` and
/// the barycentres of the triangles between them.
#[derive(Debug, Clone)]
pub struct DualMesh {
    points: Vec<[f64; 2]>,
    vertices: Vec<usize>,
    start: Vec<usize>,
    corners: Vec<usize>,
}

impl DualMesh {
    /// Collects the polygons from the sub-triangulation of `mesh`. Linear time.
    pub fn new(mesh: &Mesh, sub: &SubTriangulation) -> Self {
        let around = mesh.around();
        let vertices: Vec<usize> =
            (0..mesh.points.len()).filter(|&a| mesh.kind[a] == VertexKind::Interior).collect();
        let (mut start, mut corners) = (vec![0], Vec::new());
        // leaves[m]: barycentre and next midpoint, counterclockwise, of the triangle at a that begins with midpoint m
        let mut leaves = vec![(0, 0); sub.mesh.points.len()];
        for &a in &vertices {
            let mut midpoint = 0;
            for k in around.triangles(a) {
                let i = corner_of(mesh.triangles[k], a);
                let [_, first, barycentre] = sub.mesh.triangles[6 * k + 2 * i];
                let [_, _, next] = sub.mesh.triangles[6 * k + 2 * i + 1];
                leaves[first] = (barycentre, next);
                midpoint = first;
            }
            for _ in around.of(a) {
                let (barycentre, next) = leaves[midpoint];
                corners.extend([midpoint, barycentre]);
                midpoint = next;
            }
            start.push(corners.len());
        }
        Self { points: sub.mesh.points.clone(), vertices, start, corners }
    }

    /// The points of the polygons; those of the sub-triangulation. Shape: `points x 2`.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// The vertex `a` of each cell: the interior vertices in increasing order.
    pub fn vertices(&self) -> &[usize] {
        &self.vertices
    }

    /// The corners of cell `k`, counterclockwise, as numbers of points: `2 n` for a vertex of `n` triangles.
    pub fn cell(&self, k: usize) -> &[usize] {
        &self.corners[self.start[k]..self.start[k + 1]]
    }

    /// The area of cell `k` as a polygon; by (4.17) it is `|Delta_a| / 3`.
    pub fn area(&self, k: usize) -> f64 {
        let cell = self.cell(k);
        let corner = |i: usize| self.points[cell[i]];
        (1..cell.len() - 1).map(|i| 0.5 * twice_signed_area([corner(0), corner(i), corner(i + 1)])).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Pattern, polygon, rectangle};

    /// Areas are sums of a few rounded terms.
    const ROUNDING: f64 = 1e-14;

    fn meshes() -> Vec<Mesh> {
        let square = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let hole = vec![[0.4, 0.4], [0.6, 0.5], [0.5, 0.7]];
        vec![
            rectangle([0.0, 0.0], [2.0, 1.0], [5, 3], Pattern::Right).unwrap(),
            rectangle([0.0, 0.0], [1.0, 1.0], [3, 3], Pattern::Crossed).unwrap(),
            polygon(&square, &[hole], 0.1, 20.0).unwrap(),
        ]
    }

    #[test]
    fn dual_cells_have_a_third_of_the_patch_and_two_edges_a_triangle() {
        for mesh in meshes() {
            let sub = SubTriangulation::new(&mesh).unwrap();
            let dual = DualMesh::new(&mesh, &sub);
            let around = mesh.around();
            assert!(!dual.vertices().is_empty());
            for (k, &a) in dual.vertices().iter().enumerate() {
                assert_eq!(mesh.kind()[a], VertexKind::Interior);
                assert_eq!(dual.cell(k).len(), 2 * around.of(a).len());
                let patch: f64 = around.triangles(a).map(|t| mesh.triangle_area(t)).sum();
                assert!((dual.area(k) - patch / 3.0).abs() < ROUNDING, "(4.17)");
                assert!((dual.area(k) - patch / 4.0).abs() > ROUNDING, "and not another fraction");
            }
        }
    }

    #[test]
    fn sub_triangles_are_sixths_that_lie_where_they_say() {
        for mesh in meshes() {
            let sub = SubTriangulation::new(&mesh).unwrap();
            assert_eq!(sub.mesh().triangles().len(), 6 * mesh.triangles().len());
            assert!((sub.mesh().area() - mesh.area()).abs() < ROUNDING);
            for t in 0..sub.mesh().triangles().len() {
                let k = sub.triangle_of(t);
                assert!((sub.mesh().triangle_area(t) - mesh.triangle_area(k) / 6.0).abs() < ROUNDING);
                assert!(mesh.triangles()[k].contains(&sub.vertex_of(t)));
                assert!(sub.mesh().triangles()[t].contains(&sub.barycentre(k)));
            }
        }
    }

    #[test]
    fn cells_of_neighbours_share_an_edge_point_and_do_not_overlap() {
        for mesh in meshes() {
            let sub = SubTriangulation::new(&mesh).unwrap();
            let dual = DualMesh::new(&mesh, &sub);
            let total: f64 = (0..dual.vertices().len()).map(|k| dual.area(k)).sum();
            let by_sub: f64 = (0..sub.mesh().triangles().len())
                .filter(|&t| mesh.kind()[sub.vertex_of(t)] == VertexKind::Interior)
                .map(|t| sub.mesh().triangle_area(t))
                .sum();
            assert!((total - by_sub).abs() < ROUNDING, "omega_h is covered once");
            assert!(total < mesh.area(), "it is omega less a neighbourhood of the boundary");
        }
    }
}
