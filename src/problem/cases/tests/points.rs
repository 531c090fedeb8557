//! Pseudo-random points of a domain, its boundary, and the interfaces of a solution.

use std::f64::consts::TAU;

use crate::geometry::Interface;
use crate::problem::Domain;

/// How far a point has to be from every interface and from the corner: a thousand steps of the differences.
const CLEARANCE: f64 = 1e-2;

/// Pseudo-random numbers in `(0, 1)`: a linear congruential generator, its high bits.
fn uniform(count: usize) -> impl Iterator<Item = f64> {
    let mut state = 42_u64;
    (0..count).map(move |_| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    })
}

/// Whether the disk of radius `margin` around a point lies in the domain.
fn inside(domain: &Domain, x: f64, y: f64, margin: f64) -> bool {
    match *domain {
        Domain::Rectangle { lower, upper } => {
            let within = |k: usize, t: f64| lower[k] + margin < t && t < upper[k] - margin;
            within(0, x) && within(1, y)
        }
        Domain::LShape { half_width } => {
            x.abs().max(y.abs()) < half_width - margin && (x < -margin || y > margin)
        }
        Domain::Disk { centre, radius } => (x - centre[0]).hypot(y - centre[1]) < radius - margin,
        Domain::Polygon { .. } => unreachable!("no case has a polygon"),
    }
}

/// Points of the domain away from its boundary (hence from the corner of an L) and from every interface.
pub(super) fn interior(domain: &Domain, curves: &[Interface]) -> Vec<[f64; 2]> {
    let numbers: Vec<f64> = uniform(2000).map(|t| 4.0 * t - 2.0).collect();
    let mut points: Vec<_> = numbers.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
    points.extend(numbers.chunks_exact(2).map(|pair| [(pair[0] + 2.0) / 4.0, (pair[1] + 2.0) / 4.0]));
    points.retain(|&[x, y]| {
        let smooth = |curve: &Interface| curve.signed_distance(x, y).abs() > CLEARANCE;
        inside(domain, x, y, CLEARANCE) && curves.iter().all(smooth)
    });
    assert!(points.len() > 200, "only {} points", points.len());
    points
}

/// Points of the boundary of the domain.
pub(super) fn boundary(domain: &Domain) -> Vec<[f64; 2]> {
    let along = |vertices: &[[f64; 2]]| {
        let mut points = Vec::new();
        for (k, from) in vertices.iter().enumerate() {
            let to = vertices[(k + 1) % vertices.len()];
            points.push(*from);
            points.extend(uniform(40).map(|t| [0, 1].map(|i| from[i] + t * (to[i] - from[i]))));
        }
        points
    };
    match *domain {
        Domain::Rectangle { lower: [x0, y0], upper: [x1, y1] } => {
            along(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
        }
        Domain::LShape { half_width: a } => {
            along(&[[0.0, 0.0], [a, 0.0], [a, a], [-a, a], [-a, -a], [0.0, -a]])
        }
        Domain::Disk { centre, radius } => {
            let at = |t: f64| [centre[0] + radius * (TAU * t).cos(), centre[1] + radius * (TAU * t).sin()];
            uniform(200).map(at).collect()
        }
        Domain::Polygon { .. } => unreachable!("no case has a polygon"),
    }
}

/// Points on the interfaces inside the domain, each with the normal of the curve.
pub(super) fn on_interfaces(domain: &Domain, curves: &[Interface]) -> Vec<([f64; 2], [f64; 2])> {
    let on = |&curve: &Interface| {
        uniform(60).map(move |t| match curve {
            Interface::Circle { centre, radius } => {
                let (sin, cos) = (TAU * t).sin_cos();
                ([centre[0] + radius * cos, centre[1] + radius * sin], [cos, sin])
            }
            Interface::VerticalLine { x } => ([x, t], [1.0, 0.0]),
        })
    };
    curves.iter().flat_map(on).filter(|([x, y], _)| inside(domain, *x, *y, CLEARANCE)).collect()
}
