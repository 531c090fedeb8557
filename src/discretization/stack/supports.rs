//! How a membrane is held on a mesh: heights at vertices, line loads along edges.

use std::collections::HashMap;

use super::error::{StackError, known};
use super::fields::at_vertices;
use crate::geometry::distance_sq;
use crate::mesh::{Mesh, boundary_edges};
use crate::numeric::largest;
use crate::problem::{Field, Function, Membrane, Support};

/// Heights at a common vertex of two curves that differ by no more than this fraction of the largest one are the same, rounded.
const SAME_HEIGHT: f64 = 1e-9;

/// The two points of Gauss' rule on an edge, as the parts of it where they lie: exact for cubic line loads times hat functions.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// What holds a membrane.
pub(super) struct Held {
    /// The height at vertices where it is fixed. Shape: `vertices`.
    pub(super) height: Vec<Option<f64>>,
    /// `int t phi_a` over the free edges. Shape: `vertices`; unit: force.
    pub(super) line_load: Vec<f64>,
    /// The edges where it is free on the boundary, and those that carry a line load.
    pub(super) free_edges: Vec<[usize; 2]>,
}

impl Held {
    /// Of membrane `i`, counted from 1. The named curves may also lie inside the domain. At a common end point of a fixed and a
    /// free part, the fixed one wins.
    pub(super) fn new(mesh: &Mesh, membrane: &Membrane, i: usize) -> Result<Self, StackError> {
        let parts = edges_of_parts(mesh, membrane, i)?;
        let height_of = format!("height g{i}");
        let mut height: Vec<Option<f64>> = vec![None; mesh.points().len()];
        let mut candidates = Vec::new();
        for (support, edges) in &parts {
            if let Support::Fixed(field) = support {
                candidates.extend(heights(mesh, field, edges, &height_of)?);
            }
        }
        let same = SAME_HEIGHT * largest(candidates.iter().map(|(_, value)| value.abs()));
        for (a, value) in candidates {
            let first = *height[a].get_or_insert(value);
            if (first - value).abs() > same {
                return Err(StackError::HeightJumps {
                    membrane: i,
                    vertex: a,
                    point: mesh.points()[a],
                    values: [first, value],
                });
            }
        }
        let mut held = Self { height, line_load: vec![0.0; mesh.points().len()], free_edges: Vec::new() };
        for (support, edges) in &parts {
            if let Support::Free { traction } = support {
                held.add_line_load(mesh, traction, edges, i)?;
                held.free_edges.extend(edges);
            }
        }
        Ok(held)
    }

    /// `int_E t phi_a` for the ends of each edge.
    fn add_line_load(
        &mut self,
        mesh: &Mesh,
        traction: &Function,
        edges: &[[usize; 2]],
        i: usize,
    ) -> Result<(), StackError> {
        let at = |&[a, b]: &[usize; 2], part: f64, axis: usize| {
            let [from, to] = [mesh.points()[a][axis], mesh.points()[b][axis]];
            from + part * (to - from)
        };
        for (part, other) in [(GAUSS[0], GAUSS[1]), (GAUSS[1], GAUSS[0])] {
            let [x, y] =
                [0, 1].map(|axis| edges.iter().map(|edge| at(edge, part, axis)).collect::<Vec<f64>>());
            let mut values = vec![0.0; edges.len()];
            traction
                .eval_many(&x, &y, &mut values)
                .map_err(|source| StackError::Evaluation { datum: format!("line load t{i}"), source })?;
            for (&[a, b], value) in edges.iter().zip(values) {
                let half = 0.5 * distance_sq(mesh.points()[a], mesh.points()[b]).sqrt() * value;
                self.line_load[a] += other * half;
                self.line_load[b] += part * half;
            }
        }
        Ok(())
    }
}

/// The height at the ends of the edges, each vertex once.
fn heights(
    mesh: &Mesh,
    field: &Field,
    edges: &[[usize; 2]],
    datum: &str,
) -> Result<Vec<(usize, f64)>, StackError> {
    let mut vertices: Vec<usize> = edges.iter().flatten().copied().collect();
    vertices.sort_unstable();
    vertices.dedup();
    let values = at_vertices(mesh, field, &vertices, datum, f64::max)?;
    Ok(vertices.into_iter().zip(values).collect())
}

fn sorted([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// How a membrane is held on some edges, the lower end of each first.
type Part<'m> = (&'m Support, Vec<[usize; 2]>);

/// The edges that each part of the data is for; those of the boundary that no part names belong to the rest.
fn edges_of_parts<'m>(mesh: &Mesh, membrane: &'m Membrane, i: usize) -> Result<Vec<Part<'m>>, StackError> {
    let groups = mesh.groups();
    let datum = || format!("the support of membrane {i}");
    let mut part_of: HashMap<[usize; 2], usize> = HashMap::new();
    let mut parts = Vec::new();
    for (k, (name, support)) in membrane.parts.iter().enumerate() {
        let curve = groups.curve(name).ok_or_else(|| StackError::UnknownCurve {
            datum: datum(),
            name: name.clone(),
            known: known(groups.curves().iter(), "curve"),
        })?;
        let edges: Vec<[usize; 2]> = curve.collect();
        for &edge in &edges {
            let other = *part_of.entry(edge).or_insert(k);
            let both_fixed = [support, &membrane.parts[other].1].map(|s| matches!(s, Support::Fixed(_)));
            // Two heights are compared where they meet; a free part can only be one.
            if other != k && both_fixed != [true; 2] {
                let names = [membrane.parts[other].0.clone(), name.clone()];
                return Err(StackError::Overlap { datum: datum(), names, point: mesh.points()[edge[0]] });
            }
        }
        parts.push((support, edges));
    }
    let rest =
        boundary_edges(mesh).into_iter().map(sorted).filter(|edge| !part_of.contains_key(edge)).collect();
    parts.push((&membrane.elsewhere, rest));
    Ok(parts)
}
