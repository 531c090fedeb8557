//! The sizes that the data of a stack give to its unknowns.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::error::StackError;
use super::membrane::MembraneData;
use crate::discretization::scales::{LARGEST, Scales};
use crate::geometry::distance_sq;
use crate::mesh::{Mesh, VertexKind};
use crate::numeric::largest;

/// [`Scales`] of a stack: the heights at which it is held, the obstacles as far as it may reach them, and the deflection of its
/// membranes.
pub(super) fn scales(
    mesh: &Mesh,
    membranes: &[MembraneData],
    tensions: &[Vec<f64>],
    obstacles: &[Option<Vec<f64>>; 2],
    dual_area: &[f64],
) -> Scales {
    let used: Vec<usize> = (0..dual_area.len()).filter(|&a| mesh.kind()[a] != VertexKind::Unused).collect();
    let density = |values: &[f64]| largest(used.iter().map(|&a| values[a].abs() / dual_area[a]));
    let deflections = membranes.iter().zip(tensions).map(|(membrane, tension)| {
        deflection_of(mesh, membrane, tension, dual_area, density(&membrane.load))
    });
    let deflection = largest(deflections);
    let heights = membranes.iter().flat_map(|membrane| membrane.held.height.iter().flatten());
    let held = largest(heights.map(|height| height.abs()));
    let obstacles = within_reach(obstacles, &used, held, deflection);

    let (lower, upper) = mesh.bounding_box();
    let width = (upper[0] - lower[0]).min(upper[1] - lower[1]);
    let bent_by_obstacles = largest(obstacles.iter().map(|heights| range(heights.iter().copied())));
    let force = |(membrane, tension): (&MembraneData, &Vec<f64>)| {
        let most = tension.iter().copied().fold(0.0, f64::max);
        let bent = range(membrane.held.height.iter().flatten().copied()).max(bent_by_obstacles);
        density(&membrane.load).max(most * bent / (width * width / 8.0))
    };
    // Without any load, and at a constant height, everything is at rest: any scale serves.
    let or_one = |scale: f64| if scale == 0.0 { 1.0 } else { scale };
    let raised = largest(obstacles.iter().flatten().map(|height| height.abs()));
    Scales {
        displacement: or_one(held.max(raised) + deflection),
        force_density: or_one(largest(membranes.iter().zip(tensions).map(force))),
        dual_area: dual_area.iter().copied().fold(0.0, f64::max),
    }
}

/// How far a load of this `density` bends a membrane, about: `f l^2 / (2 mu)` of a strip that is held at the distance `l`, the largest
/// one from where the membrane is fixed. All around, that is half the width of the domain, as for the pair. On a foundation, no
/// more than the strip from there, and its compression.
fn deflection_of(
    mesh: &Mesh,
    membrane: &MembraneData,
    tension: &[f64],
    dual_area: &[f64],
    density: f64,
) -> f64 {
    if density == 0.0 {
        return 0.0;
    }
    let least = tension.iter().copied().fold(f64::INFINITY, f64::min);
    let of_strip = |distance: f64| density / least * (0.5 * distance * distance);
    let is_fixed = |a: usize| membrane.held.height[a].is_some();
    let all_around = (0..dual_area.len()).all(|a| mesh.kind()[a] != VertexKind::Boundary || is_fixed(a));
    let (lower, upper) = mesh.bounding_box();
    let width = (upper[0] - lower[0]).min(upper[1] - lower[1]);
    let fixed = of_strip(if all_around { 0.5 * width } else { distance_to(mesh, is_fixed) });
    let Some(foundation) = &membrane.foundation else { return fixed };
    let stiffness: f64 = foundation.iter().sum();
    let compression = density * (dual_area.iter().sum::<f64>() / stiffness);
    fixed.min(of_strip(distance_to(mesh, |a| is_fixed(a) || foundation[a] > 0.0)) + compression)
}

/// The obstacles over the `used` vertices, where a membrane may come that is held at heights up to `held` and bends by `deflection`: what
/// lies beyond, as a floor that is meant to be none, says nothing of the size of displacements.
fn within_reach(
    [ceiling, floor]: &[Option<Vec<f64>>; 2],
    used: &[usize],
    held: f64,
    deflection: f64,
) -> Vec<Vec<f64>> {
    let of = |obstacle: &Option<Vec<f64>>, sign: f64| {
        obstacle.as_ref().map(|heights| used.iter().map(|&a| sign * heights[a]).collect::<Vec<f64>>())
    };
    // A floor raises the membranes; a ceiling, upside down, does the same.
    let obstacles: Vec<Vec<f64>> = [of(ceiling, -1.0), of(floor, 1.0)].into_iter().flatten().collect();
    let raised = largest(obstacles.iter().flatten().copied()).max(held) + deflection;
    obstacles
        .into_iter()
        .map(|heights| heights.into_iter().map(|height| height.max(-raised)).collect())
        .collect()
}

fn range(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let [least, most] =
        [values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max)];
    if most > least { most - least } else { 0.0 }
}

/// The largest distance of a vertex, along edges, from those that are held; the diameter of the domain where there are none, as for
/// membranes that their neighbours alone hold.
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
    let (lower, upper) = mesh.bounding_box();
    let diameter = distance_sq(lower, upper).sqrt();
    let used = (0..distance.len()).filter(|&a| mesh.kind()[a] != VertexKind::Unused);
    used.map(|a| if distance[a].is_finite() { distance[a] } else { diameter }).fold(0.0, f64::max)
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

#[cfg(test)]
mod tests {
    use crate::discretization::{Scales, StackDiscretization};
    use crate::mesh::{Pattern, rectangle};
    use crate::problem::{ContactProblem, Field, Function, Membrane};

    fn of(membrane: Membrane, floor: Option<Field>) -> Scales {
        let mesh = rectangle([0.0, 0.0], [2.0, 1.0], [16, 8], Pattern::Right).unwrap();
        let stack = ContactProblem::stack().membrane(membrane);
        let stack = floor.into_iter().fold(stack, |stack, floor| stack.floor(floor));
        StackDiscretization::new(&stack.build().unwrap(), mesh).unwrap().scales()
    }

    /// Distances are measured along edges, which are up to a factor of `sqrt(2)` longer.
    fn is_about(found: f64, expected: f64) -> bool {
        (0.99 * expected..=2.01 * expected).contains(&found)
    }

    #[test]
    fn a_membrane_bends_by_the_distance_from_where_it_is_held() {
        let sheet = || Membrane::new(2.0).load(-12.0);
        // f l^2 / (2 mu) with l = 1/2 all around, l = 2 from the left side.
        assert_eq!(of(sheet(), None).displacement, 0.75);
        let from_the_left = sheet().free().height_on("left", 0.0);
        assert!(is_about(of(from_the_left.clone(), None).displacement, 12.0));
        // f / c on a foundation, whatever holds it otherwise.
        assert!(is_about(of(sheet().free().foundation(6.0), None).displacement, 2.0));
        assert!(is_about(of(from_the_left.foundation(6.0), None).displacement, 2.0));
        assert_eq!(of(sheet().load(0.0), None), of(sheet().load(0.0).height(1.0), None));
    }

    #[test]
    fn an_obstacle_out_of_reach_says_nothing() {
        let sheet = || Membrane::new(2.0).load(-12.0);
        let without = of(sheet(), None);
        for far in [-10.0, -1e6, -1e20] {
            assert_eq!(of(sheet(), Some(far.into())).force_density, without.force_density);
            let holes = Function::from_fn(move |x, _| if x > 1.0 { far } else { -0.5 });
            assert!(of(sheet(), Some(holes.into())).force_density < 10.0 * without.force_density);
        }
        // One that raises the membrane counts, alone too.
        let hill = Function::from_fn(|x, y| 3.0 * x * (2.0 - x) * y * (1.0 - y));
        let raised = of(Membrane::new(2.0), Some(hill.into()));
        assert!(raised.displacement > 0.7 && raised.force_density > 5.0, "{raised:?}");
    }
}
