//! What the solver has left, carried to where the membrane is held.
//!
//! A rest `rho` that is constant on dual cells is balanced by a flux in Raviart-Thomas on the mesh itself: all of a triangle's rest goes,
//! in equal parts, to the neighbours that are nearer to an edge where the membrane is fixed, and out there. What that leaves has the mean
//! zero on each triangle. So the norm of `rho` that counts is bounded on every domain, wherever the membrane is fixed; where it rests
//! on a foundation alone, the flux ends in a triangle that takes it up.

use crate::discretization::StackDiscretization;
use crate::flux::inner_product;
use crate::geometry::poincare;
use crate::mesh::HalfEdges;

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
    let Ways { order, distance, fixed } = Ways::new(d, i, &neighbours);
    for &t in order.iter().rev() {
        let is_nearer = |&j: &usize| neighbours[t][j].is_some_and(|(next, _)| distance[next] < distance[t]);
        let ways = || (0..3).filter(|j| if distance[t] == 0 { fixed[t][*j] } else { is_nearer(j) });
        let count = ways().count();
        if count == 0 {
            taken_up[t] = carried[t];
            continue;
        }
        let part = carried[t] / count as f64;
        for j in ways() {
            outward[t][j] += part;
            if let Some((next, opposite)) = neighbours[t][j].filter(|_| distance[t] > 0) {
                outward[next][opposite] -= part;
                carried[next] += part;
            }
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
        let [p, q] = [one, other].map(|side| (side.triangle(), opposite(side.triangle(), [a, b])));
        neighbours[p.0][p.1] = Some(q);
        neighbours[q.0][q.1] = Some(p);
    }
    neighbours
}

/// How the rest of each triangle leaves it.
struct Ways {
    /// The triangles in the order of their distance.
    order: Vec<usize>,
    /// How many edges lie between a triangle and one where the membrane is held.
    distance: Vec<usize>,
    /// Whether the membrane is fixed on the edge opposite to each corner.
    fixed: Vec<[bool; 3]>,
}

impl Ways {
    fn new(d: &StackDiscretization, i: usize, neighbours: &Neighbours) -> Self {
        let triangles = d.mesh().triangles();
        let edges = &d.held(i).fixed_edges;
        let is_fixed = |corners: &[usize; 3], j: usize| {
            let (a, b) = (corners[(j + 1) % 3], corners[(j + 2) % 3]);
            edges.binary_search(&[a.min(b), a.max(b)]).is_ok()
        };
        let fixed: Vec<[bool; 3]> =
            triangles.iter().map(|corners| [0, 1, 2].map(|j| is_fixed(corners, j))).collect();
        let mut ways = Self { order: Vec::new(), distance: vec![usize::MAX; triangles.len()], fixed };
        for t in 0..triangles.len() {
            if ways.fixed[t].contains(&true) {
                ways.start(t);
            }
        }
        ways.spread(neighbours, 0);
        // Parts of the domain that a foundation alone holds.
        for t in 0..triangles.len() {
            if ways.distance[t] == usize::MAX && d.foundation_on(i, t) > 0.0 {
                let from = ways.order.len();
                ways.start(t);
                ways.spread(neighbours, from);
            }
        }
        ways
    }

    fn start(&mut self, t: usize) {
        self.distance[t] = 0;
        self.order.push(t);
    }

    /// Finds all triangles that can be reached from those in the order, from the one at `from` on.
    fn spread(&mut self, neighbours: &Neighbours, from: usize) {
        let mut next = from;
        while next < self.order.len() {
            let t = self.order[next];
            for (neighbour, _) in neighbours[t].into_iter().flatten() {
                if self.distance[neighbour] == usize::MAX {
                    self.distance[neighbour] = self.distance[t] + 1;
                    self.order.push(neighbour);
                }
            }
            next += 1;
        }
    }
}
