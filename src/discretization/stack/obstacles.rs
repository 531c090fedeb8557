//! The obstacles on a mesh, and the order of all that is known of the layers.

use super::error::StackError;
use super::fields::at_vertices;
use super::membrane::MembraneData;
use crate::mesh::{Mesh, VertexKind};
use crate::problem::Field;

/// An obstacle that cuts through a height by no more than this fraction of the heights' size does so by rounding of a formula,
/// and is moved to it.
const ROUNDED_OBSTACLE: f64 = 1e-12;

/// An obstacle over vertices.
pub(super) fn obstacle(
    mesh: &Mesh,
    field: Option<&Field>,
    name: &str,
    stricter: fn(f64, f64) -> f64,
) -> Result<Option<Vec<f64>>, StackError> {
    let Some(field) = field else { return Ok(None) };
    let used: Vec<usize> =
        (0..mesh.points().len()).filter(|&a| mesh.kind()[a] != VertexKind::Unused).collect();
    let mut heights = vec![0.0; mesh.points().len()];
    let values = at_vertices(mesh, field, &used, name, stricter)?;
    used.iter().zip(values).for_each(|(&a, value)| heights[a] = value);
    Ok(Some(heights))
}

/// At every vertex, what is known of the layers comes in order from the top. An obstacle that cuts through by rounding, of heights of
/// this `size`, is moved.
pub(super) fn check_order(
    mesh: &Mesh,
    membranes: &[MembraneData],
    obstacles: &mut [Option<Vec<f64>>; 2],
    size: f64,
) -> Result<(), StackError> {
    let last = membranes.len() + 1;
    let name = |layer: usize| match layer {
        0 => "the ceiling".to_string(),
        _ if layer == last => "the floor".to_string(),
        _ => format!("membrane {layer}"),
    };
    for a in (0..mesh.points().len()).filter(|&a| mesh.kind()[a] != VertexKind::Unused) {
        let fixed =
            membranes.iter().enumerate().filter_map(|(k, membrane)| Some((k + 1, membrane.held.height[a]?)));
        let mut known: Vec<(usize, f64)> = fixed.collect();
        if let (Some(ceiling), Some(&(_, height))) = (&mut obstacles[0], known.first())
            && (0.0..=ROUNDED_OBSTACLE * size).contains(&(height - ceiling[a]))
        {
            ceiling[a] = height;
        }
        if let (Some(floor), Some(&(_, height))) = (&mut obstacles[1], known.last())
            && (0.0..=ROUNDED_OBSTACLE * size).contains(&(floor[a] - height))
        {
            floor[a] = height;
        }
        known.extend(obstacles[1].as_ref().map(|floor| (last, floor[a])));
        if let Some(ceiling) = &obstacles[0] {
            known.insert(0, (0, ceiling[a]));
        }
        if let Some(pair) = known.windows(2).find(|pair| !(pair[0].1 >= pair[1].1)) {
            return Err(StackError::Order {
                upper: name(pair[0].0),
                lower: name(pair[1].0),
                vertex: a,
                point: mesh.points()[a],
                values: [pair[0].1, pair[1].1],
            });
        }
    }
    Ok(())
}
