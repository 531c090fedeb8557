//! The checked constructor: what it returns is a conforming triangulation.

mod around;
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
use crate::mesh::triangulation::{HalfEdge, HalfEdges, VertexTriangles};
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;
pub use error::MeshError;
pub use quality::MeshQuality;

use around::{Around, TURN_ROUNDING};
use boundary::Boundary;
use pieces::check_pieces;
pub(in crate::mesh) use quality::angles;
pub(in crate::mesh) use size::Smallest;
use size::{MAX_COORDINATE, Sense, sense};

/// More triangles have corners that 32 bits cannot count.
const MAX_TRIANGLES: usize = u32::MAX as usize / 3;

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
        let around = VertexTriangles::new(points.len(), &triangles);
        let boundary_edges = Around { points: &points, triangles: &triangles, around: &around }
            .boundary_edges()
            .ok_or_else(|| overlap_of(&points, &triangles))?;
        let boundary = Boundary::new(&points, &boundary_edges);
        boundary.check()?;
        check_pieces(&boundary, &triangles)?;

        let kind_inside = |a| if around.of(a).is_empty() { VertexKind::Unused } else { VertexKind::Interior };
        let mut kind: Vec<VertexKind> = (0..points.len()).map(kind_inside).collect();
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
            around: around.into(),
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
    if triangles.len() > MAX_TRIANGLES {
        return Err(MeshError::TooLarge { triangles: triangles.len() });
    }
    let block = |(block, triangles): (usize, &mut [[usize; 3]])| {
        let mut numbered = triangles.iter_mut().zip(block * BLOCK..);
        numbered.try_for_each(|(corners, triangle)| orient_one(points, triangle, corners))
    };
    let blocks: Vec<_> = triangles.par_chunks_mut(BLOCK).enumerate().map(block).collect();
    blocks.into_iter().collect()
}

fn orient_one(points: &[[f64; 2]], triangle: usize, corners: &mut [usize; 3]) -> Result<(), MeshError> {
    if let Some(&vertex) = corners.iter().find(|&&a| a >= points.len()) {
        return Err(MeshError::NoSuchVertex { triangle, vertex, vertices: points.len() });
    }
    match sense(corners.map(|a| points[a])) {
        Sense::Counterclockwise => {}
        Sense::Clockwise => corners.swap(1, 2),
        Sense::Degenerate => return Err(MeshError::Degenerate { triangle, corners: *corners }),
        Sense::Tiny => return Err(MeshError::Tiny { triangle }),
    }
    Ok(())
}

/// Names triangles that overlap (there are some): two on one side of an edge, else the first that goes beyond a full turn.
fn overlap_of(points: &[[f64; 2]], triangles: &[[usize; 3]]) -> MeshError {
    let half_edges = HalfEdges::new(points.len(), triangles);
    let is_wrong = |sides: &[HalfEdge]| match sides {
        [_] => false,
        [left, right] => left.is_reversed() == right.is_reversed(),
        _ => true,
    };
    let at_edge = half_edges.edges().find(|(_, _, sides)| is_wrong(sides));
    match at_edge {
        Some((lower, upper, sides)) => overlap(triangles, [lower, upper], sides),
        None => overlap_at_vertex(points, triangles),
    }
}

/// Names two triangles on the same side of an edge (there are some: more than two sides, or two alike).
fn overlap(triangles: &[[usize; 3]], edge: [usize; 2], sides: &[HalfEdge]) -> MeshError {
    let pair = sides.windows(2).find(|pair| pair[0].is_reversed() == pair[1].is_reversed());
    let [first, second] = [0, 1].map(|k| pair.expect("sides of one kind are neighbours")[k].triangle());
    let apex = |t: usize| triangles[t].into_iter().find(|a| !edge.contains(a));
    if apex(first) == apex(second) {
        MeshError::Duplicate { first, second, corners: triangles[first] }
    } else {
        MeshError::Overlap { first, second, edge }
    }
}

/// The first triangle with which those around a vertex make more than one turn (there is one).
fn overlap_at_vertex(points: &[[f64; 2]], triangles: &[[usize; 3]]) -> MeshError {
    let mut turn = vec![0.0; points.len()];
    let corners = |(triangle, corners): (usize, &[usize; 3])| {
        let angles = angles(corners.map(|a| points[a]));
        [0, 1, 2].map(|i| (triangle, corners[i], angles[i]))
    };
    let mut corners = triangles.iter().enumerate().flat_map(corners);
    let found = corners.find(|&(_, vertex, angle)| {
        turn[vertex] += angle;
        turn[vertex] > std::f64::consts::TAU + TURN_ROUNDING
    });
    let (triangle, vertex, _) = found.expect("some vertex has more than one turn");
    MeshError::OverlapAtVertex { vertex, triangle }
}
