//! The checked constructor: what it returns is a conforming triangulation.

use std::collections::HashMap;

use thiserror::Error;

use super::adjacency::{HalfEdge, HalfEdges};
use super::{Mesh, VertexKind, distance_sq, twice_signed_area};

/// A triangle whose doubled area is below this fraction of its longest edge squared is degenerate. Rounding of the
/// coordinates moves that fraction by about 1e-16; a sliver of 0.01 degrees has 1.7e-4.
const MIN_RELATIVE_AREA: f64 = 1e-12;

/// Two boundary edges from one vertex whose directions differ by less than this angle (radians) lie on each other.
const MIN_BOUNDARY_ANGLE: f64 = 1e-10;

/// Boundary vertices closer than this fraction of the mesh's extent are the same point, given twice.
const COINCIDENCE: f64 = 1e-12;

/// Why points and triangles are not a triangulation. Vertices and triangles are counted from 0.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MeshError {
    /// There is nothing to solve on.
    #[error("the mesh has no triangle: export the surface, not only its boundary")]
    Empty,
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has the coordinates ({}, {}): all must be finite", point[0], point[1])]
    NotFinite {
        /// The vertex.
        vertex: usize,
        /// Its coordinates.
        point: [f64; 2],
    },
    /// A triangle names a vertex that is not there.
    #[error(
        "triangle {triangle} names vertex {vertex}, but there are only {vertices} vertices (counted from 0)"
    )]
    NoSuchVertex {
        /// The triangle.
        triangle: usize,
        /// The vertex that it names.
        vertex: usize,
        /// How many there are.
        vertices: usize,
    },
    /// A triangle of no area.
    #[error("triangle {triangle} (vertices {}, {}, {}) is degenerate: its corners coincide or lie on one line; remove it and mesh again", corners[0], corners[1], corners[2])]
    Degenerate {
        /// The triangle.
        triangle: usize,
        /// Its corners.
        corners: [usize; 3],
    },
    /// The same triangle twice.
    #[error("triangles {first} and {second} are the same (vertices {}, {}, {}): remove one", corners[0], corners[1], corners[2])]
    Duplicate {
        /// The first.
        first: usize,
        /// The second.
        second: usize,
        /// Their corners.
        corners: [usize; 3],
    },
    /// Two triangles on the same side of their common edge, or more than two triangles at one edge.
    #[error("triangles {first} and {second} overlap at their common edge (vertices {}, {}): an edge has one triangle on each side", edge[0], edge[1])]
    Overlap {
        /// The first.
        first: usize,
        /// The second.
        second: usize,
        /// The ends of the edge.
        edge: [usize; 2],
    },
    /// A vertex lies inside the edge of a triangle: a hanging node.
    #[error("the mesh is not conforming: vertex {vertex} lies inside the edge ({}, {}) of triangle {triangle}; split that triangle there", edge[0], edge[1])]
    HangingVertex {
        /// The vertex.
        vertex: usize,
        /// The triangle that is not split.
        triangle: usize,
        /// The ends of its edge.
        edge: [usize; 2],
    },
    /// Two vertices at one place: the pieces of the mesh are not glued together.
    #[error(
        "the mesh is not conforming: vertices {first} and {second} (of triangle {triangle}) coincide; merge them (in Gmsh: Coherence Mesh, or BooleanFragments before meshing)"
    )]
    CoincidentVertices {
        /// The first.
        first: usize,
        /// The second.
        second: usize,
        /// A triangle at the second.
        triangle: usize,
    },
}

impl MeshError {
    /// The (first) triangle that the error names.
    pub fn triangle(&self) -> Option<usize> {
        match *self {
            Self::NoSuchVertex { triangle, .. }
            | Self::Degenerate { triangle, .. }
            | Self::HangingVertex { triangle, .. }
            | Self::CoincidentVertices { triangle, .. } => Some(triangle),
            Self::Duplicate { first, .. } | Self::Overlap { first, .. } => Some(first),
            Self::Empty | Self::NotFinite { .. } => None,
        }
    }
}

/// An edge with a triangle on one side only, run through with the domain on its left.
#[derive(Clone, Copy)]
struct BoundaryEdge {
    ends: [usize; 2],
    triangle: usize,
}

impl Mesh {
    /// Checks `points` (shape: vertices x 2) and `triangles` (shape: triangles x 3, vertex numbers from 0).
    ///
    /// Clockwise triangles are turned round. Vertices in no triangle are kept as [`VertexKind::Unused`]. Takes
    /// linear time (edges at one vertex are sorted among themselves).
    ///
    /// # Errors
    /// [`MeshError`], naming the triangle, for: no triangles, coordinates that are not finite, unknown vertices,
    /// degenerate or repeated triangles, overlaps at an edge, hanging vertices, unmerged coincident vertices.
    pub fn new(points: Vec<[f64; 2]>, mut triangles: Vec<[usize; 3]>) -> Result<Self, MeshError> {
        check_points(&points)?;
        orient(&points, &mut triangles)?;
        let boundary = boundary_edges(points.len(), &triangles)?;
        check_coincident(&points, &boundary)?;
        check_hanging(&points, &boundary)?;

        let mut kind = vec![VertexKind::Unused; points.len()];
        for &a in triangles.iter().flatten() {
            kind[a] = VertexKind::Interior;
        }
        for &a in boundary.iter().flat_map(|edge| &edge.ends) {
            kind[a] = VertexKind::Boundary;
        }
        Ok(Self { points, triangles, kind })
    }
}

fn check_points(points: &[[f64; 2]]) -> Result<(), MeshError> {
    match points.iter().position(|point| !point.iter().all(|x| x.is_finite())) {
        Some(vertex) => Err(MeshError::NotFinite { vertex, point: points[vertex] }),
        None => Ok(()),
    }
}

/// Checks each triangle by itself and turns it counterclockwise.
fn orient(points: &[[f64; 2]], triangles: &mut [[usize; 3]]) -> Result<(), MeshError> {
    if triangles.is_empty() {
        return Err(MeshError::Empty);
    }
    for (triangle, corners) in triangles.iter_mut().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&a| a >= points.len()) {
            return Err(MeshError::NoSuchVertex { triangle, vertex, vertices: points.len() });
        }
        let [a, b, c] = corners.map(|a| points[a]);
        let longest_sq = distance_sq(a, b).max(distance_sq(b, c)).max(distance_sq(c, a));
        let area = twice_signed_area([a, b, c]);
        if !(area.abs() > MIN_RELATIVE_AREA * longest_sq) {
            return Err(MeshError::Degenerate { triangle, corners: *corners });
        }
        if area < 0.0 {
            corners.swap(1, 2);
        }
    }
    Ok(())
}

/// The edges with one triangle; those with two must have one on each side.
fn boundary_edges(vertices: usize, triangles: &[[usize; 3]]) -> Result<Vec<BoundaryEdge>, MeshError> {
    let mut boundary = Vec::new();
    for (lower, upper, sides) in HalfEdges::new(vertices, triangles).edges() {
        match sides {
            [side] => {
                let ends = if side.reversed { [upper, lower] } else { [lower, upper] };
                boundary.push(BoundaryEdge { ends, triangle: side.triangle });
            }
            [left, right] if left.reversed != right.reversed => {}
            _ => return Err(overlap(triangles, [lower, upper], sides)),
        }
    }
    Ok(boundary)
}

/// Names two triangles on the same side of an edge (there are some: more than two sides, or two alike).
fn overlap(triangles: &[[usize; 3]], edge: [usize; 2], sides: &[HalfEdge]) -> MeshError {
    let (first, second) = sides
        .windows(2)
        .find(|pair| pair[0].reversed == pair[1].reversed)
        .map_or((sides[0].triangle, sides[1].triangle), |pair| (pair[0].triangle, pair[1].triangle));
    let apex = |t: usize| triangles[t].into_iter().find(|a| !edge.contains(a));
    if apex(first) == apex(second) {
        MeshError::Duplicate { first, second, corners: triangles[first] }
    } else {
        MeshError::Overlap { first, second, edge }
    }
}

/// A hanging vertex leaves, at an end of the edge on which it lies, two boundary edges in one direction: the long
/// one of the triangle that is not split and the short one of a triangle that is.
fn check_hanging(points: &[[f64; 2]], boundary: &[BoundaryEdge]) -> Result<(), MeshError> {
    let direction = |from: usize, to: usize| {
        let [p, q] = [points[from], points[to]];
        (q[1] - p[1]).atan2(q[0] - p[0])
    };
    // (vertex, direction, boundary edge) of both ends of every boundary edge.
    let mut rays: Vec<(usize, f64, usize)> = boundary
        .iter()
        .enumerate()
        .flat_map(|(e, &BoundaryEdge { ends: [a, b], .. })| {
            [(a, direction(a, b), e), (b, direction(b, a), e)]
        })
        .collect();
    rays.sort_unstable_by(|p, q| p.0.cmp(&q.0).then(p.1.total_cmp(&q.1)).then(p.2.cmp(&q.2)));

    for at_vertex in rays.chunk_by(|p, q| p.0 == q.0) {
        let last_to_first = [at_vertex[at_vertex.len() - 1], at_vertex[0]];
        for pair in at_vertex.windows(2).chain([last_to_first.as_slice()]) {
            let turn = (pair[1].1 - pair[0].1).rem_euclid(std::f64::consts::TAU);
            let [first, second] = [pair[0].2, pair[1].2];
            if first != second && turn.min(std::f64::consts::TAU - turn) < MIN_BOUNDARY_ANGLE {
                return Err(hanging(points, boundary[first], boundary[second]));
            }
        }
    }
    Ok(())
}

/// Of two boundary edges in one direction, the shorter one's far end hangs on the longer one.
fn hanging(points: &[[f64; 2]], first: BoundaryEdge, second: BoundaryEdge) -> MeshError {
    let length_sq = |edge: BoundaryEdge| distance_sq(points[edge.ends[0]], points[edge.ends[1]]);
    let (short, long) = if length_sq(first) <= length_sq(second) { (first, second) } else { (second, first) };
    let vertex = if long.ends.contains(&short.ends[0]) { short.ends[1] } else { short.ends[0] };
    MeshError::HangingVertex { vertex, triangle: long.triangle, edge: long.ends }
}

/// Pieces that are not glued have their common boundary vertices twice.
fn check_coincident(points: &[[f64; 2]], boundary: &[BoundaryEdge]) -> Result<(), MeshError> {
    let corners = || boundary.iter().flat_map(|edge| edge.ends).map(|a| points[a]);
    let lower = corners().fold([f64::INFINITY; 2], |l, p| [l[0].min(p[0]), l[1].min(p[1])]);
    let extent = corners().fold(0.0, |e: f64, p| e.max(p[0] - lower[0]).max(p[1] - lower[1]));
    let cell = extent * COINCIDENCE;

    // Each vertex is filed under a cell of the size of the tolerance; a twin lies there or in a neighbouring cell.
    let mut filed: HashMap<[i64; 2], usize> = HashMap::new();
    for edge in boundary {
        let vertex = edge.ends[0];
        let place = [0, 1].map(|axis| ((points[vertex][axis] - lower[axis]) / cell).round() as i64);
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
