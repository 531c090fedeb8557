//! The boundary of a triangulation meets itself in common vertices only.

use std::collections::HashMap;
use std::f64::consts::TAU;

use super::boxes::{Bounds, BoxIndex};
use super::error::MeshError;
use super::size::resolution;
use crate::geometry::{distance_sq, twice_signed_area};

/// Two boundary edges from one vertex whose directions differ by less than this angle (radians) lie on each other.
const MIN_ANGLE: f64 = 1e-10;

/// An edge with a triangle on one side only, run through with the domain on its left.
#[derive(Clone, Copy)]
pub(super) struct BoundaryEdge {
    pub(super) ends: [usize; 2],
    pub(super) triangle: usize,
}

/// The boundary edges and the points of the mesh.
pub(super) struct Boundary<'m> {
    pub(super) points: &'m [[f64; 2]],
    pub(super) edges: &'m [BoundaryEdge],
    /// Points closer than this are not told apart.
    pub(super) resolution: f64,
}

impl<'m> Boundary<'m> {
    pub(super) fn new(points: &'m [[f64; 2]], edges: &'m [BoundaryEdge]) -> Self {
        let ends = edges.iter().flat_map(|edge| edge.ends).map(|a| points[a]);
        let bounds = Bounds::around(ends, 0.0);
        Self { points, edges, resolution: resolution(bounds.lower, bounds.upper) }
    }

    /// All checks; those with the most precise messages come first.
    pub(super) fn check(&self) -> Result<(), MeshError> {
        self.check_coincident()?;
        self.check_around_vertices()?;
        self.check_apart()
    }

    fn bounds(&self, edge: &BoundaryEdge) -> Bounds {
        Bounds::around(edge.ends.map(|a| self.points[a]), self.resolution)
    }

    fn length(&self, edge: BoundaryEdge) -> f64 {
        distance_sq(self.points[edge.ends[0]], self.points[edge.ends[1]]).sqrt()
    }
}

/// A boundary edge, seen from one of its ends.
struct Ray {
    vertex: usize,
    /// Its angle with the x axis, radians.
    direction: f64,
    edge: BoundaryEdge,
}

impl Ray {
    /// Whether the domain begins here, when one turns counterclockwise round the vertex; else it ends.
    fn begins(&self) -> bool {
        self.edge.ends[0] == self.vertex
    }
}

impl Boundary<'_> {
    /// Pieces that are not glued have their common boundary vertices twice.
    fn check_coincident(&self) -> Result<(), MeshError> {
        // Each vertex is filed under a cell of the size of the tolerance; a twin lies there or in a neighbouring cell.
        let mut filed: HashMap<[i64; 2], usize> = HashMap::new();
        for edge in self.edges {
            let vertex = edge.ends[0];
            let place = self.points[vertex].map(|x| (x / self.resolution).round() as i64);
            let neighbours = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [place[0] + i, place[1] + j]));
            for neighbour in neighbours {
                if let Some(&other) = filed.get(&neighbour)
                    && other != vertex
                {
                    let (first, second) = (other.min(vertex), other.max(vertex));
                    return Err(MeshError::CoincidentVertices { first, second, triangle: edge.triangle });
                }
            }
            filed.insert(place, vertex);
        }
        Ok(())
    }

    /// Around each vertex, domain and outside take turns. A hanging vertex leaves, at an end of the edge on which it lies,
    /// two boundary edges in one direction: the long one of the triangle that is not split and the short one of a
    /// triangle that is.
    fn check_around_vertices(&self) -> Result<(), MeshError> {
        let ray = |edge: &BoundaryEdge, vertex: usize, other: usize| {
            let [p, q] = [self.points[vertex], self.points[other]];
            Ray { vertex, direction: (q[1] - p[1]).atan2(q[0] - p[0]), edge: *edge }
        };
        let both = |edge: &BoundaryEdge| {
            let [from, to] = edge.ends;
            [ray(edge, from, to), ray(edge, to, from)]
        };
        let mut rays: Vec<Ray> = self.edges.iter().flat_map(both).collect();
        rays.sort_by(|p, q| p.vertex.cmp(&q.vertex).then(p.direction.total_cmp(&q.direction)));

        for around in rays.chunk_by(|p, q| p.vertex == q.vertex) {
            let pairs = || (0..around.len()).map(|k| (&around[k], &around[(k + 1) % around.len()]));
            if let Some((first, second)) = pairs().find(|(first, second)| self.on_each_other(first, second)) {
                return Err(self.hanging(first.edge, second.edge));
            }
            if let Some((_, second)) = pairs().find(|(first, second)| first.begins() == second.begins()) {
                let (vertex, triangle) = (second.vertex, second.edge.triangle);
                return Err(MeshError::OverlapAtVertex { vertex, triangle });
            }
        }
        Ok(())
    }

    fn on_each_other(&self, first: &Ray, second: &Ray) -> bool {
        let turn = (second.direction - first.direction).rem_euclid(TAU);
        let shorter = self.length(first.edge).min(self.length(second.edge));
        turn.min(TAU - turn) < MIN_ANGLE.max(self.resolution / shorter)
    }

    /// Of two boundary edges in one direction, the shorter one's far end hangs on the longer one.
    fn hanging(&self, first: BoundaryEdge, second: BoundaryEdge) -> MeshError {
        let (short, long) =
            if self.length(first) <= self.length(second) { (first, second) } else { (second, first) };
        let vertex = if long.ends.contains(&short.ends[0]) { short.ends[1] } else { short.ends[0] };
        MeshError::HangingVertex { vertex, triangle: long.triangle, edge: long.ends }
    }

    /// Edges without a common vertex do not touch.
    fn check_apart(&self) -> Result<(), MeshError> {
        let index = BoxIndex::new(self.edges.iter().map(|edge| self.bounds(edge)).collect());
        for &edge in self.edges {
            for other in index.larger_meeting(self.bounds(&edge)).map(|k| self.edges[k]) {
                if !other.ends.iter().any(|a| edge.ends.contains(a)) {
                    self.check_pair(edge, other)?;
                }
            }
        }
        Ok(())
    }

    fn check_pair(&self, first: BoundaryEdge, second: BoundaryEdge) -> Result<(), MeshError> {
        for (edge, other) in [(first, second), (second, first)] {
            for vertex in edge.ends {
                if self.distance(vertex, other) < self.resolution {
                    let BoundaryEdge { ends: edge, triangle } = other;
                    return Err(MeshError::HangingVertex { vertex, triangle, edge });
                }
            }
        }
        let left = |edge: BoundaryEdge, a: usize| {
            twice_signed_area([edge.ends[0], edge.ends[1], a].map(|a| self.points[a])) > 0.0
        };
        let separates = |edge: BoundaryEdge, [a, b]: [usize; 2]| left(edge, a) != left(edge, b);
        if separates(first, second.ends) && separates(second, first.ends) {
            return Err(MeshError::Crossing { first: first.triangle, second: second.triangle });
        }
        Ok(())
    }

    /// The distance of a vertex from an edge.
    fn distance(&self, vertex: usize, edge: BoundaryEdge) -> f64 {
        let [p, a, b] = [vertex, edge.ends[0], edge.ends[1]].map(|a| self.points[a]);
        let along = ((b[0] - a[0]) * (p[0] - a[0]) + (b[1] - a[1]) * (p[1] - a[1])) / distance_sq(a, b);
        let t = along.clamp(0.0, 1.0);
        distance_sq(p, [0, 1].map(|axis| a[axis] + t * (b[axis] - a[axis]))).sqrt()
    }
}
