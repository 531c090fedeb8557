//! The flux of one membrane of a stack: what it must be for any displacement.

use std::collections::HashMap;

use crate::fem::gradient;
use crate::flux::{Balanced, MeetInAVertex, constant_outward, inner_product};
use crate::mesh::samples::{irregular, square_without};
use crate::mesh::{Mesh, SubTriangulation, VertexKind};
use crate::numeric::Random;

/// Rounding of sums around a vertex.
const ROUNDING: f64 = 1e-12;

/// A membrane that is fixed on the boundary edges of which both ends are `fixed`, with forces drawn at random.
struct Sample {
    mesh: Mesh,
    displacement: Vec<f64>,
    tension: Vec<f64>,
    force: Vec<[f64; 3]>,
    action: Vec<f64>,
    fixed_edges: Vec<[usize; 2]>,
    edge_force: HashMap<[usize; 2], [f64; 2]>,
}

impl Sample {
    fn new(mesh: Mesh, fixed: impl Fn([f64; 2]) -> bool) -> Self {
        let mut random = Random::new(5);
        let mut fixed_edges: Vec<[usize; 2]> = Vec::new();
        let mut edge_force = HashMap::new();
        for [a, b] in crate::mesh::boundary_edges(&mesh) {
            let ends = [a.min(b), a.max(b)];
            if ends.iter().all(|&a| fixed(mesh.points()[a])) {
                fixed_edges.push(ends);
            } else {
                edge_force.insert(ends, [0, 1].map(|_| random.between(-1.0, 1.0)));
            }
        }
        fixed_edges.sort_unstable();
        let mut drawn = |count: usize| (0..count).map(|_| random.between(-1.0, 1.0)).collect::<Vec<f64>>();
        let displacement = drawn(mesh.points().len());
        let action = drawn(mesh.points().len());
        let tension = drawn(mesh.triangles().len()).into_iter().map(|mu| 2.0 + mu).collect();
        let force = (0..mesh.triangles().len()).map(|_| drawn(3).try_into().unwrap()).collect();
        Self { displacement, tension, force, action, fixed_edges, edge_force, mesh }
    }

    fn is_fixed(&self) -> Vec<bool> {
        let mut is_fixed = vec![false; self.mesh.points().len()];
        self.fixed_edges.iter().flatten().for_each(|&a| is_fixed[a] = true);
        is_fixed
    }

    fn balanced(&self) -> Balanced<'_, '_, impl Fn(usize, usize) -> f64 + Sync> {
        Balanced {
            mesh: &self.mesh,
            tension: &self.tension,
            displacement: &self.displacement,
            wedge_force: |k: usize, corner: usize| self.force[k][corner],
            action: &self.action,
            is_fixed: self.is_fixed(),
            fixed_edges: &self.fixed_edges,
            edge_force: self.edge_force.clone(),
        }
    }
}

fn samples() -> Vec<Sample> {
    let left = |[x, _]: [f64; 2]| x < 1e-9;
    let two_sides = |[x, y]: [f64; 2]| x < 1e-9 || y < 1e-9;
    let hole = || square_without(5, |i, j| (i, j) == (2, 2));
    vec![
        Sample::new(irregular(5), |_| true),
        Sample::new(irregular(5), left),
        Sample::new(irregular(4), two_sides),
        Sample::new(hole(), left),
        Sample::new(hole(), |_| true),
    ]
}

/// All outward fluxes, over sub-triangles in the order of `S_h`.
fn outward(sample: &Sample, sub: &SubTriangulation) -> (Vec<[f64; 3]>, Vec<f64>) {
    let flux = sample.balanced().flux().unwrap();
    let halves = |w: usize| [0, 1].map(|half| sub.mesh().corners(2 * w + half));
    let of_wedge = |w: usize| flux.outward(w / 3, w % 3, halves(w));
    ((0..3 * sample.mesh.triangles().len()).flat_map(of_wedge).collect(), flux.rest.clone())
}

#[test]
fn it_balances_every_half_wedge_and_passes_on_what_it_carries() {
    for sample in samples() {
        let sub = SubTriangulation::new(&sample.mesh).unwrap();
        let (outward, rest) = outward(&sample, &sub);
        let is_fixed = sample.is_fixed();
        for (t, fluxes) in outward.iter().enumerate() {
            let (k, corner) = (t / 6, t / 2 % 3);
            let a = sample.mesh.triangles()[k][corner];
            let action = sample.action[a] + rest[a];
            let source = 0.5 * (sample.force[k][corner] + action * sample.mesh.triangle_area(k) / 3.0);
            assert!((fluxes.iter().sum::<f64>() - source).abs() < ROUNDING);
            assert!(!is_fixed[a] || rest[a] == 0.0);
        }
        assert!(rest.iter().any(|&rest| rest.abs() > 0.1), "the displacement is no solution");
        // Through each segment of S_h, from both sides.
        let mut through: HashMap<[usize; 2], (f64, usize)> = HashMap::new();
        for (t, fluxes) in outward.iter().enumerate() {
            let corners = sub.mesh().triangles()[t];
            for j in 0..3 {
                let (p, q) = (corners[(j + 1) % 3], corners[(j + 2) % 3]);
                let sum = through.entry([p.min(q), p.max(q)]).or_default();
                *sum = (sum.0 + fluxes[j], sum.1 + 1);
            }
        }
        let vertices = sample.mesh.points().len();
        let mut free_halves = 0;
        for (&[p, q], &(sum, sides)) in &through {
            if sides == 2 {
                assert!(sum.abs() < ROUNDING, "{sum:e}");
                continue;
            }
            // A half of a boundary edge: a vertex and a midpoint.
            let a = p.min(q);
            assert!(a < vertices && sample.mesh.kind()[a] == VertexKind::Boundary);
            let midpoint = sub.mesh().points()[p.max(q)];
            let of_edge = |(ends, force): (&[usize; 2], &[f64; 2])| {
                let [b, c] = ends.map(|end| sample.mesh.points()[end]);
                let near = (0..2).all(|axis| (0.5 * (b[axis] + c[axis]) - midpoint[axis]).abs() < 1e-12);
                near.then(|| force[usize::from(a == ends[1])])
            };
            if let Some(force) = sample.edge_force.iter().find_map(of_edge) {
                assert!((sum + force).abs() < ROUNDING, "the line load: {sum} {force}");
                free_halves += 1;
            }
        }
        assert_eq!(free_halves, 2 * sample.edge_force.len());
    }
}

/// Around a vertex where the flux may circulate, any other circulation is further away.
#[test]
fn it_is_the_nearest_one() {
    let sample = &samples()[0];
    let sub = SubTriangulation::new(&sample.mesh).unwrap();
    let (outward, _) = outward(sample, &sub);
    let distance_sq = |outward: &[[f64; 3]]| -> f64 {
        let on = |(t, fluxes): (usize, &[f64; 3])| {
            let (corners, k) = (sub.mesh().corners(t), t / 6);
            let slope =
                gradient(sample.mesh.corners(k), sample.mesh.triangles()[k].map(|a| sample.displacement[a]));
            let of_slope = constant_outward(corners, slope.map(|slope| sample.tension[k] * slope));
            let sum = [0, 1, 2].map(|j| fluxes[j] + of_slope[j]);
            inner_product(corners, sum, sum)
        };
        outward.iter().enumerate().map(on).sum()
    };
    let nearest = distance_sq(&outward);
    let a = sample.mesh.kind().iter().position(|&kind| kind == VertexKind::Interior).unwrap();
    for circulation in [-0.1, 0.1] {
        let mut turned = outward.clone();
        for k in sample.mesh.around().triangles(a) {
            let corner = sample.mesh.triangles()[k].iter().position(|&b| b == a).unwrap();
            for half in 0..2 {
                let fluxes = &mut turned[6 * k + 2 * corner + half];
                (fluxes[1], fluxes[2]) = (fluxes[1] + circulation, fluxes[2] - circulation);
            }
        }
        assert!(distance_sq(&turned) > nearest);
    }
}

#[test]
fn where_parts_meet_in_a_vertex_there_is_none() {
    let mesh = square_without(4, |i, j| i == j && (i == 1 || i == 2));
    let touching = mesh.points().iter().position(|&point| point == [0.5, 0.5]).unwrap();
    let free = Sample::new(mesh.clone(), |[x, _]| x < 1e-9);
    assert_eq!(free.balanced().flux().map(|_| ()), Err(MeetInAVertex(touching)));
    assert!(Sample::new(mesh, |_| true).balanced().flux().is_ok());
}
