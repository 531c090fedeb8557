//! What the solver has left, carried to where the membrane is held.
//!
//! A rest `rho` that is constant on dual cells is balanced by a flux in Raviart-Thomas on the mesh itself: all of a triangle's rest goes
//! to a neighbour that is nearer to an edge where the membrane is fixed, and out there. What that leaves has the mean zero on each
//! triangle. So the norm of `rho` that counts is bounded on every domain, wherever the membrane is fixed; where it rests on a
//! foundation alone, the flux ends in a triangle that takes it up.

use crate::discretization::StackDiscretization;
use crate::flux::inner_product;
use crate::geometry::poincare;
use crate::mesh::HalfEdges;

/// Where the rest of a triangle goes.
#[derive(Debug, Clone, Copy)]
enum Way {
    /// Out of the domain through the edge opposite to this corner, where the membrane is fixed.
    Out(usize),
    /// To the neighbour across the edge opposite to this corner.
    Through(usize),
    /// Into the foundation.
    Foundation,
}

/// `(sup_v int rho v / |||v|||)^2` or more, for membrane `i` of a stack with at least this tension on each triangle; `rho`, over
/// vertices, is constant on dual cells. Linear time.
pub(super) fn norm_sq(d: &StackDiscretization, i: usize, least_tension: &[f64], rho: &[f64]) -> f64 {
    let mesh = d.mesh();
    if rho.iter().all(|&rho| rho == 0.0) {
        return 0.0;
    }
    let neighbours = neighbours(d);
    let area = |t: usize| mesh.triangle_area(t);
    let mut carried: Vec<f64> = (0..mesh.triangles().len())
        .map(|t| mesh.triangles()[t].iter().map(|&a| rho[a]).sum::<f64>() * area(t) / 3.0)
        .collect();
    let own = carried.clone();
    let mut outward = vec![[0.0; 3]; carried.len()];
    let mut taken_up = vec![0.0; carried.len()];
    for &(t, way) in ways(d, i, &neighbours).iter().rev() {
        match way {
            Way::Out(corner) => outward[t][corner] += carried[t],
            Way::Through(corner) => {
                let (next, opposite) = neighbours[t][corner].expect("a way leads to a neighbour");
                outward[t][corner] += carried[t];
                outward[next][opposite] -= carried[t];
                carried[next] += carried[t];
            }
            Way::Foundation => taken_up[t] = carried[t],
        }
    }
    let on_triangle = |t: usize| {
        let flux = inner_product(mesh.corners(t), outward[t], outward[t]).max(0.0);
        let spread: f64 =
            mesh.triangles()[t].iter().map(|&a| area(t) / 3.0 * (rho[a] - own[t] / area(t)).powi(2)).sum();
        let into_foundation = if taken_up[t] == 0.0 {
            0.0
        } else {
            taken_up[t].abs() / (area(t) * d.foundation_on(i, t)).sqrt()
        };
        let norm =
            (flux.sqrt() + poincare(mesh.diameter_sq(t).sqrt()) * spread.sqrt()) / least_tension[t].sqrt();
        (norm + into_foundation).powi(2)
    };
    (0..own.len()).map(on_triangle).sum()
}

/// Across the edge opposite to each corner: the triangle there, and which of its corners lies opposite.
type Neighbours = Vec<[Option<(usize, usize)>; 3]>;

fn neighbours(d: &StackDiscretization) -> Neighbours {
    let mesh = d.mesh();
    let mut neighbours = vec![[None; 3]; mesh.triangles().len()];
    let opposite = |t: usize, ends: [usize; 2]| {
        mesh.triangles()[t].iter().position(|corner| !ends.contains(corner)).expect("a corner off the edge")
    };
    for (a, b, sides) in HalfEdges::new(mesh.points().len(), mesh.triangles()).edges() {
        let [one, other] = sides else { continue };
        let [p, q] = [one, other].map(|side| (side.triangle, opposite(side.triangle, [a, b])));
        neighbours[p.0][p.1] = Some(q);
        neighbours[q.0][q.1] = Some(p);
    }
    neighbours
}

/// The triangles in the order of their distance from where the membrane is held, and the way out of each.
fn ways(d: &StackDiscretization, i: usize, neighbours: &Neighbours) -> Vec<(usize, Way)> {
    let triangles = d.mesh().triangles();
    let mut known = vec![false; triangles.len()];
    let mut order = Vec::with_capacity(triangles.len());
    let fixed = &d.held(i).fixed_edges;
    for (t, corners) in triangles.iter().enumerate() {
        let is_fixed = |&j: &usize| {
            let (a, b) = (corners[(j + 1) % 3], corners[(j + 2) % 3]);
            fixed.binary_search(&[a.min(b), a.max(b)]).is_ok()
        };
        if let Some(corner) = (0..3).find(is_fixed) {
            known[t] = true;
            order.push((t, Way::Out(corner)));
        }
    }
    spread(neighbours, &mut order, &mut known, 0);
    // Parts of the domain that a foundation alone holds.
    for t in 0..triangles.len() {
        if !known[t] && d.foundation_on(i, t) > 0.0 {
            known[t] = true;
            order.push((t, Way::Foundation));
            let from = order.len() - 1;
            spread(neighbours, &mut order, &mut known, from);
        }
    }
    order
}

/// All triangles that can be reached from those in the order, from the one at `from` on.
fn spread(neighbours: &Neighbours, order: &mut Vec<(usize, Way)>, known: &mut [bool], from: usize) {
    let mut next = from;
    while next < order.len() {
        for (neighbour, corner) in neighbours[order[next].0].into_iter().flatten() {
            if !known[neighbour] {
                known[neighbour] = true;
                order.push((neighbour, Way::Through(corner)));
            }
        }
        next += 1;
    }
}
