//! The checked constructor: what it returns is a conforming triangulation.

mod boundary;
mod boxes;
mod error;
mod pieces;
mod quality;
mod size;
#[cfg(test)]
mod tests;
mod winding;

use super::{Groups, Mesh, VertexKind, Views};
use crate::mesh::topology::{HalfEdge, HalfEdges};
pub use error::MeshError;
pub use quality::MeshQuality;

use boundary::{Boundary, BoundaryEdge};
use pieces::check_pieces;
pub(in crate::mesh) use quality::angles;
pub(in crate::mesh) use size::Smallest;
use size::{MAX_COORDINATE, Sense, sense};

/// What rounding may add to a full turn, radians.
const TURN_ROUNDING: f64 = 1e-9;

impl Mesh {
    /// Checks `points` (shape: vertices x 2) and `triangles` (shape: triangles x 3, vertex numbers from 0).
    ///
    /// Clockwise triangles are turned round. Vertices in no triangle are kept as [`VertexKind::Unused`]. No two triangles of
    /// the result overlap: they lie on opposite sides of inner edges, make at most one full turn around every vertex, and
    /// the boundary does not touch itself but at common vertices. No part of it has a name ([`Mesh::with_region`],
    /// [`Mesh::with_curve`]), and there are no data views. Takes linear time (the edges at one vertex are sorted among themselves, and boundary edges meet
    /// only those near them).
    ///
    /// # Errors
    /// [`MeshError`], naming the triangle, for: no triangles, coordinates out of range, unknown vertices, degenerate or
    /// repeated triangles, overlaps, hanging vertices, unmerged coincident vertices.
    pub fn new(points: Vec<[f64; 2]>, mut triangles: Vec<[usize; 3]>) -> Result<Self, MeshError> {
        check_points(&points)?;
        orient(&points, &mut triangles)?;
        let boundary_edges = boundary_edges(points.len(), &triangles)?;
        check_turns(&points, &triangles)?;
        let boundary = Boundary::new(&points, &boundary_edges);
        boundary.check()?;
        check_pieces(&boundary, &triangles)?;

        let mut kind = vec![VertexKind::Unused; points.len()];
        for &a in triangles.iter().flatten() {
            kind[a] = VertexKind::Interior;
        }
        for &a in boundary_edges.iter().flat_map(|edge| &edge.ends) {
            kind[a] = VertexKind::Boundary;
        }
        Ok(Self {
            points,
            triangles,
            kind,
            ancestry: Vec::new(),
            groups: Groups::default(),
            views: Views::default(),
        })
    }
}

fn check_points(points: &[[f64; 2]]) -> Result<(), MeshError> {
    match points.iter().position(|point| !point.iter().all(|x| x.abs() < MAX_COORDINATE)) {
        Some(vertex) => Err(MeshError::Coordinates { vertex, point: points[vertex] }),
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
        match sense(corners.map(|a| points[a])) {
            Sense::Counterclockwise => {}
            Sense::Clockwise => corners.swap(1, 2),
            Sense::Degenerate => return Err(MeshError::Degenerate { triangle, corners: *corners }),
            Sense::Tiny => return Err(MeshError::Tiny { triangle }),
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
    let pair = sides.windows(2).find(|pair| pair[0].reversed == pair[1].reversed);
    let [first, second] = [0, 1].map(|k| pair.expect("sides of one kind are neighbours")[k].triangle);
    let apex = |t: usize| triangles[t].into_iter().find(|a| !edge.contains(a));
    if apex(first) == apex(second) {
        MeshError::Duplicate { first, second, corners: triangles[first] }
    } else {
        MeshError::Overlap { first, second, edge }
    }
}

/// The triangles around an inner vertex make one full turn, those around a boundary vertex less.
fn check_turns(points: &[[f64; 2]], triangles: &[[usize; 3]]) -> Result<(), MeshError> {
    let mut turn = vec![0.0; points.len()];
    for (triangle, corners) in triangles.iter().enumerate() {
        for (&vertex, angle) in corners.iter().zip(angles(corners.map(|a| points[a]))) {
            turn[vertex] += angle;
            if turn[vertex] > std::f64::consts::TAU + TURN_ROUNDING {
                return Err(MeshError::OverlapAtVertex { vertex, triangle });
            }
        }
    }
    Ok(())
}
