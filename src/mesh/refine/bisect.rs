//! Local refinement: newest-vertex bisection (Mitchell, ACM TOMS 15 (1989) 326).

#[cfg(test)]
mod tests;

use std::sync::{Arc, OnceLock};

use super::circle::Circle;
use crate::geometry::distance_sq;
use crate::mesh::check::Smallest;
use crate::mesh::topology::Edges;
use crate::mesh::{Mesh, MeshError, VertexKind};
use crate::problem::Domain;

/// A mesh that can be refined again and again where it is asked for, by newest-vertex bisection.
///
/// A bisection joins the midpoint of the *refinement edge* of a triangle with the opposite corner; the refinement edges of
/// the two halves are those opposite to the new vertex. So the triangles made from one belong to at most four classes of
/// similar ones, however many bisections there are, and angles stay away from zero (Mitchell; nearly similar ones at the
/// boundary of a disk). The *closure* bisects as
/// many other triangles as a conforming mesh needs. Over many steps these are at most a constant times the marked ones:
/// Binev, Dahmen, DeVore, Numer. Math. 97 (2004) 219; for refinement edges that are chosen without regard to each other
/// on the first mesh, as here: Karkulik, Pavlicek, Praetorius, Constr. Approx. 38 (2013) 213.
#[derive(Debug, Clone)]
pub struct Bisection {
    mesh: Arc<Mesh>,
    /// For each triangle the corner at which its refinement edge starts; the next corner is the end.
    refinement_edge: Vec<u8>,
    /// For each triangle the one of the mesh before the last step in which it lies.
    origin: Vec<usize>,
    /// What new vertices on the boundary follow; `None`: the polygon.
    circle: Option<Circle>,
    /// Smaller triangles are not made.
    smallest: Smallest,
}

impl Bisection {
    /// Bisections that keep the polygon that `mesh` covers.
    ///
    /// The refinement edge of a triangle is its longest edge; of several, the one with the largest vertex numbers, so that
    /// the two triangles at an edge do not disagree about the order of edges.
    pub fn new(mesh: impl Into<Arc<Mesh>>) -> Self {
        let mesh: Arc<Mesh> = mesh.into();
        let longest = |corners: &[usize; 3]| {
            let key = |&i: &u8| {
                let [a, b] = [corners[usize::from(i)], corners[(usize::from(i) + 1) % 3]];
                (distance_sq(mesh.points[a], mesh.points[b]), a.max(b), a.min(b))
            };
            let order = |i: &u8, j: &u8| key(i).partial_cmp(&key(j)).expect("coordinates are in range");
            (0..3).max_by(order).expect("three edges")
        };
        let refinement_edge = mesh.triangles.iter().map(longest).collect();
        let origin = (0..mesh.triangles.len()).collect();
        let smallest = Smallest::of(&mesh);
        Self { mesh, refinement_edge, origin, circle: None, smallest }
    }

    /// Bisections of a mesh of `domain`: on a disk, new vertices on the boundary are moved to its circle. Otherwise as
    /// [`Bisection::new`].
    pub fn of_domain(mesh: impl Into<Arc<Mesh>>, domain: &Domain) -> Self {
        Self { circle: Circle::of_domain(domain), ..Self::new(mesh) }
    }

    /// The current mesh.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// For each triangle the number that the triangle in which it lies had before the last [`Bisection::refine`]; each its
    /// own number when there was none. In increasing order. Shape: triangles.
    pub fn origin(&self) -> &[usize] {
        &self.origin
    }

    /// Divides every marked triangle into four, so that all its edges are halved, and others into two to four, so that the
    /// mesh is conforming. Linear time.
    ///
    /// `marked` are numbers of triangles of the current mesh, in any order; one may be there more than once. Returns the
    /// parents of the new vertices: the ends of the edge whose midpoint each is (moved to the circle, on the boundary of a
    /// disk), see [`Refinement`](crate::mesh::Refinement). Shape: new vertices x 2. Old vertices keep their numbers, and children
    /// take the place of their parent among the triangles; they, and halves of edges, are called like their parents. The ancestry of the mesh grows by one level. If nothing is marked,
    /// the mesh stays as it is, each triangle its own origin.
    ///
    /// # Errors
    /// [`MeshError::TooSmall`] when edges would become shorter than about 1e-10 of the size of the mesh (3e-13 of its largest
    /// coordinate, if that is more), below which [`Mesh::new`] does not tell points apart; others when the moved boundary of
    /// a disk meets itself. The mesh is then as before.
    ///
    /// # Panics
    /// When a marked triangle is not there: "a marked triangle is one of the mesh".
    pub fn refine(&mut self, marked: &[usize]) -> Result<Vec<[usize; 2]>, MeshError> {
        assert!(
            marked.iter().all(|&t| t < self.mesh.triangles.len()),
            "a marked triangle is one of the mesh"
        );
        if marked.is_empty() {
            self.origin = (0..self.mesh.triangles.len()).collect();
            return Ok(Vec::new());
        }
        let edges = Edges::new(&self.mesh);
        let halved = self.closure(&edges, marked);
        let parents: Vec<[usize; 2]> = halved.iter().map(|&edge| edges.ends[edge]).collect();
        let (points, kind) = self.vertices(&edges, &halved);
        let (triangles, refinement_edge, origin) = self.children(&edges, &halved);
        for (&corners, &triangle) in triangles.iter().zip(&origin) {
            let parent = self.mesh.triangles[triangle];
            if corners != parent && !self.smallest.allows(corners.map(|a| points[a])) {
                return Err(self.mesh.too_small(triangle));
            }
        }
        let ancestry = self.mesh.ancestry_of_refinement(&parents);
        let mut child = 0;
        let children = |t: usize| {
            child += origin[child..].iter().take_while(|&&parent| parent < t).count();
            child..child + origin[child..].iter().take_while(|&&parent| parent == t).count()
        };
        let groups = self.mesh.groups.inherited(children, self.mesh.points.len(), &parents);
        let views = self.mesh.views.inherited(origin.iter().copied(), self.mesh.points.len(), &parents);
        let mesh = Mesh { points, triangles, kind, ancestry, groups, views, around: OnceLock::new() };
        // On a polygon the new mesh covers exactly what the old one did; a moved boundary may meet another one.
        self.mesh = Arc::new(if self.circle.is_some() { mesh.checked()? } else { mesh });
        self.refinement_edge = refinement_edge;
        self.origin = origin;
        Ok(parents)
    }

    /// The edges to halve, in increasing order: those of marked triangles, and where any edge of a triangle is halved, its
    /// refinement edge. Each edge is halved once at most, so this ends, whatever the refinement edges are.
    fn closure(&self, edges: &Edges, marked: &[usize]) -> Vec<usize> {
        let mut halved = vec![false; edges.ends.len()];
        let mut open: Vec<usize> = marked.iter().flat_map(|&t| edges.of_triangle(t)).collect();
        while let Some(edge) = open.pop() {
            if !std::mem::replace(&mut halved[edge], true) {
                open.extend(edges.triangles(edge).map(|t| edges.of_triangle(t)[self.start(t)]));
            }
        }
        (0..halved.len()).filter(|&edge| halved[edge]).collect()
    }

    /// The corner of triangle `t` at which its refinement edge starts.
    fn start(&self, t: usize) -> usize {
        usize::from(self.refinement_edge[t])
    }

    /// The old vertices, and the midpoints of the halved edges.
    fn vertices(&self, edges: &Edges, halved: &[usize]) -> (Vec<[f64; 2]>, Vec<VertexKind>) {
        let mut points = self.mesh.points.clone();
        let mut kind = self.mesh.kind.clone();
        let old = points.len();
        for &edge in halved {
            points.push(self.mesh.midpoint(edges.ends[edge]));
            kind.push(if edges.on_boundary(edge) { VertexKind::Boundary } else { VertexKind::Interior });
        }
        if let Some(circle) = self.circle {
            circle.attract(&mut points[old..], &kind[old..]);
        }
        (points, kind)
    }

    /// The triangles of the new mesh, their refinement edges and origins.
    fn children(&self, edges: &Edges, halved: &[usize]) -> (Vec<[usize; 3]>, Vec<u8>, Vec<usize>) {
        let mut midpoint = vec![None; edges.ends.len()];
        for (k, &edge) in halved.iter().enumerate() {
            midpoint[edge] = Some(self.mesh.points.len() + k);
        }
        let (mut triangles, mut refinement_edge, mut origin) = (Vec::new(), Vec::new(), Vec::new());
        for (t, corners) in self.mesh.triangles.iter().enumerate() {
            let from_start = [0, 1, 2].map(|i| (self.start(t) + i) % 3);
            let before = triangles.len();
            match from_start.map(|i| midpoint[edges.of_triangle(t)[i]]) {
                [None, ..] => {
                    triangles.push(*corners);
                    refinement_edge.push(self.refinement_edge[t]);
                }
                [Some(new), others @ ..] => {
                    let [a, b, c] = from_start.map(|i| corners[i]);
                    // Their refinement edges are opposite to the new vertex: the first edge of each.
                    for (half, midpoint) in [[b, c, new], [c, a, new]].into_iter().zip(others) {
                        match midpoint {
                            None => triangles.push(half),
                            Some(newer) => {
                                let [a, b, c] = half;
                                triangles.extend([[b, c, newer], [c, a, newer]]);
                            }
                        }
                    }
                    refinement_edge.resize(triangles.len(), 0);
                }
            }
            origin.extend((before..triangles.len()).map(|_| t));
        }
        (triangles, refinement_edge, origin)
    }
}
