//! The sizes that the data of a stack give to its unknowns.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::error::StackError;
use super::membrane::MembraneData;
use crate::discretization::{LARGEST, Scales};
use crate::geometry::distance_sq;
use crate::mesh::{Mesh, VertexKind};
use crate::numeric::largest;

/// The largest height or obstacle.
pub(super) fn largest_height(membranes: &[MembraneData], obstacles: &[Option<Vec<f64>>; 2]) -> f64 {
    let heights = membranes.iter().flat_map(|membrane| membrane.height.iter().flatten());
    largest(heights.chain(obstacles.iter().flatten().flatten()).map(|height| height.abs()))
}

/// [`Scales`] of a stack: heights, obstacles, and the deflection `f l^2 / (2 mu)` of a strip that is fixed at the distance `l`,
/// the largest one from the fixed edges of a membrane. All around, that is half the width of the domain, as for the pair.
pub(super) fn scales(
    mesh: &Mesh,
    membranes: &[MembraneData],
    tensions: &[Vec<f64>],
    obstacles: &[Option<Vec<f64>>; 2],
    dual_area: &[f64],
) -> Scales {
    let used = |&a: &usize| mesh.kind()[a] != VertexKind::Unused;
    let (lower, upper) = mesh.bounding_box();
    let width = (upper[0] - lower[0]).min(upper[1] - lower[1]);
    let (mut deflection, mut force_density): (f64, f64) = (0.0, 0.0);
    for (membrane, tension) in membranes.iter().zip(tensions) {
        let density =
            largest((0..dual_area.len()).filter(used).map(|a| membrane.load[a].abs() / dual_area[a]));
        let least = tension.iter().copied().fold(f64::INFINITY, f64::min);
        let most = tension.iter().copied().fold(0.0, f64::max);
        let is_fixed = |a: usize| membrane.height[a].is_some();
        let all_around = (0..dual_area.len()).all(|a| mesh.kind()[a] != VertexKind::Boundary || is_fixed(a));
        let distance = if all_around { 0.5 * width } else { distance_to(mesh, is_fixed) };
        let on_foundation = membrane.foundation.as_ref().map(|foundation| {
            let densities = (0..dual_area.len()).filter(used).map(|a| foundation[a] / dual_area[a]);
            1.0 / densities.fold(f64::INFINITY, f64::min)
        });
        let of_strip = density / least * (0.5 * distance * distance);
        deflection = deflection.max(of_strip.min(on_foundation.map_or(f64::INFINITY, |c| density * c)));
        let obstacles = obstacles.iter().flatten();
        let ranges = obstacles.map(|heights| range((0..dual_area.len()).filter(used).map(|a| heights[a])));
        let bent = ranges.fold(range(membrane.height.iter().flatten().copied()), f64::max);
        force_density = force_density.max(density).max(most * bent / (width * width / 8.0));
    }
    // Without any load, and at a constant height, everything is at rest: any scale serves.
    let or_one = |scale: f64| if scale == 0.0 { 1.0 } else { scale };
    Scales {
        displacement: or_one(largest_height(membranes, obstacles) + deflection),
        force_density: or_one(force_density),
        dual_area: dual_area.iter().copied().fold(0.0, f64::max),
    }
}

fn range(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let [least, most] =
        [values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max)];
    if most > least { most - least } else { 0.0 }
}

/// The largest distance of a vertex, along edges, from those that are fixed; zero when there are none.
fn distance_to(mesh: &Mesh, is_fixed: impl Fn(usize) -> bool) -> f64 {
    /// Distances are not negative, so their bits are in their order.
    fn key(distance: f64) -> u64 {
        distance.to_bits()
    }
    let mut neighbours: Vec<[usize; 2]> = mesh
        .triangles()
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, a], [b, c], [c, b], [c, a], [a, c]])
        .collect();
    neighbours.sort_unstable();
    neighbours.dedup();
    let of = |a: usize| {
        let start = neighbours.partition_point(|edge| edge[0] < a);
        neighbours[start..].iter().take_while(move |edge| edge[0] == a).map(|edge| edge[1])
    };
    let mut distance = vec![f64::INFINITY; mesh.points().len()];
    let mut open = BinaryHeap::new();
    for a in (0..distance.len()).filter(|&a| is_fixed(a)) {
        distance[a] = 0.0;
        open.push(Reverse((key(0.0), a)));
    }
    while let Some(Reverse((at, a))) = open.pop() {
        if at > key(distance[a]) {
            continue;
        }
        for b in of(a) {
            let further = distance[a] + distance_sq(mesh.points()[a], mesh.points()[b]).sqrt();
            if further < distance[b] {
                distance[b] = further;
                open.push(Reverse((key(further), b)));
            }
        }
    }
    distance.into_iter().filter(|distance| distance.is_finite()).fold(0.0, f64::max)
}

/// Energies must not overflow.
pub(super) fn check_range(scales: &Scales, tensions: &[Vec<f64>]) -> Result<(), StackError> {
    let outside = |value: &f64| !(1.0 / LARGEST..=LARGEST).contains(value);
    let of_tension = tensions.iter().enumerate().find_map(|(k, tension)| {
        Some((format!("the tension mu{} is", k + 1), *tension.iter().find(|mu| outside(mu))?))
    });
    let sizes = [
        ("the forces per area have the size", scales.force_density),
        ("the displacements have the size", scales.displacement),
    ];
    let of_size =
        sizes.into_iter().find(|(_, value)| outside(value)).map(|(text, value)| (text.to_string(), value));
    match of_tension.or(of_size) {
        Some((quantity, value)) => Err(StackError::OutOfRange { quantity, value }),
        None => Ok(()),
    }
}
