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

/// The two points of Gauss' rule on an edge, as the parts of it where they lie.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// What holds a membrane.
#[derive(Debug, Clone)]
pub(crate) struct Held {
    /// The height at vertices where it is fixed. Shape: `vertices`.
    pub(crate) height: Vec<Option<f64>>,
    /// The edges where it is fixed, sorted, the lower end of each first.
    pub(crate) fixed_edges: Vec<[usize; 2]>,
    /// The edges where it is free on the boundary, and those that carry a line load, likewise.
    pub(crate) free_edges: Vec<[usize; 2]>,
    /// The line loads that are not zero, likewise.
    pub(crate) line_loads: Vec<LineLoad>,
    /// Whether a height is not affine along the edges.
    pub(crate) bends: bool,
}

/// A line load `t` on an edge `E`, affine as two points see it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LineLoad {
    /// The ends, the lower one first.
    pub(crate) ends: [usize; 2],
    /// `int_E t phi_a` for both ends. Unit: force.
    pub(crate) force: [f64; 2],
    /// The distance of `t` in `L2` from what has these integrals and is constant on each half of the edge.
    pub(crate) deviation: f64,
}

impl LineLoad {
    /// Of the values at the two points of [`GAUSS`].
    fn new(ends: [usize; 2], length: f64, [first, last]: [f64; 2]) -> Self {
        // t = mean + slope xi on -1 < xi < 1; the halves carry mean -+ slope / 3.
        let (mean, slope) = (0.5 * (first + last), 0.5 * 3f64.sqrt() * (last - first));
        let force = [-1.0, 1.0].map(|side| 0.5 * length * (mean + side * slope / 3.0));
        Self { ends, force, deviation: length.sqrt() * slope.abs() / 3.0 }
    }
}

impl Held {
    /// Of membrane `i`, counted from 1. The named curves may also lie inside the domain. At a common end point of a fixed and a
    /// free part, the fixed one wins.
    pub(super) fn new(mesh: &Mesh, membrane: &Membrane, i: usize) -> Result<Self, StackError> {
        let parts = edges_of_parts(mesh, membrane, i)?;
        let height_of = format!("height g{i}");
        let mut held = Self {
            height: vec![None; mesh.points().len()],
            fixed_edges: Vec::new(),
            free_edges: Vec::new(),
            line_loads: Vec::new(),
            bends: false,
        };
        let mut candidates = Vec::new();
        for (support, edges) in &parts {
            match support {
                Support::Fixed(field) => {
                    candidates.extend(heights(mesh, field, edges, &height_of)?);
                    held.bends |= bends(mesh, field, edges);
                    held.fixed_edges.extend(edges);
                }
                Support::Free { traction } => {
                    held.line_loads.extend(line_loads(mesh, traction, edges, i)?);
                    held.free_edges.extend(edges);
                }
            }
        }
        let same = SAME_HEIGHT * largest(candidates.iter().map(|(_, value)| value.abs()));
        for (a, value) in candidates {
            let first = *held.height[a].get_or_insert(value);
            if (first - value).abs() > same {
                return Err(StackError::HeightJumps {
                    membrane: i,
                    vertex: a,
                    point: mesh.points()[a],
                    values: [first, value],
                });
            }
        }
        held.fixed_edges.sort_unstable();
        held.free_edges.sort_unstable();
        held.line_loads.sort_unstable_by_key(|load| load.ends);
        Ok(held)
    }
}

/// The point at a part of an edge.
fn along(mesh: &Mesh, [a, b]: [usize; 2], part: f64) -> [f64; 2] {
    [0, 1].map(|axis| {
        let [from, to] = [a, b].map(|end| mesh.points()[end][axis]);
        from + part * (to - from)
    })
}

/// The line loads on edges, where they are not zero.
fn line_loads(
    mesh: &Mesh,
    traction: &Function,
    edges: &[[usize; 2]],
    i: usize,
) -> Result<Vec<LineLoad>, StackError> {
    let points: Vec<[f64; 2]> =
        edges.iter().flat_map(|&edge| GAUSS.map(|part| along(mesh, edge, part))).collect();
    let [x, y] = [0, 1].map(|axis| points.iter().map(|point| point[axis]).collect::<Vec<f64>>());
    let mut values = vec![0.0; points.len()];
    traction
        .eval_many(&x, &y, &mut values)
        .map_err(|source| StackError::Evaluation { datum: format!("line load t{i}"), source })?;
    let length = |[a, b]: [usize; 2]| distance_sq(mesh.points()[a], mesh.points()[b]).sqrt();
    let loads = edges.iter().zip(values.chunks_exact(2)).filter(|(_, values)| **values != [0.0; 2]);
    Ok(loads.map(|(&edge, values)| LineLoad::new(edge, length(edge), [values[0], values[1]])).collect())
}

/// Whether a height is not affine along some edge, as its midpoint sees it; where it has no value there, it is not.
fn bends(mesh: &Mesh, field: &Field, edges: &[[usize; 2]]) -> bool {
    let Field::Everywhere(function) = field else { return !matches!(field, Field::PerVertex(_)) };
    let at = |edge: [usize; 2], part: f64| {
        let [x, y] = along(mesh, edge, part);
        function.eval(x, y).unwrap_or(f64::NAN)
    };
    let is_affine = |&edge: &[usize; 2]| {
        let [first, middle, last] = [0.0, 0.5, 1.0].map(|part| at(edge, part));
        let size = first.abs() + middle.abs() + last.abs();
        (middle - 0.5 * (first + last)).abs() <= SAME_HEIGHT * size
    };
    !matches!(function, Function::Constant(_)) && !edges.iter().all(is_affine)
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
