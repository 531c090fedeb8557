//! The bound triangle by triangle.

use std::collections::HashMap;

use super::actions::{Actions, GapAction};
use super::error::NoBound;
use crate::discretization::{Samples, StackDiscretization, at_samples};
use crate::fem::{DEGREE_4, gradient};
use crate::flux::{Balanced, MeetInAVertex, MembraneFlux, constant_outward, inner_product, value};
use crate::geometry::{poincare, twice_signed_area};
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;

/// Of the [samples](Samples) on a triangle those at the corners of the two halves of the wedge at each corner: the vertex, the midpoint
/// of the first edge, the barycentre; the vertex, the barycentre, the midpoint of the last edge.
const HALVES: [[[usize; 3]; 2]; 3] = [[[0, 3, 6], [0, 6, 5]], [[1, 4, 6], [1, 6, 3]], [[2, 5, 6], [2, 6, 4]]];

/// `int (v - v_a)^2 / |K|` over the wedge of `a` for an affine `v` with the differences `v_b - v_a` and `v_c - v_a`: the coefficients of
/// their squares, and of twice their product.
const LUMPED: [f64; 2] = [23.0 / 1296.0, 7.0 / 1296.0];

/// What the bound is made from.
pub(super) struct Cells<'a> {
    d: &'a StackDiscretization,
    layers: Vec<LayerData<'a>>,
    /// Ceiling and floor at the points of each triangle, where they are not affine on it.
    obstacles: [Option<Vec<Samples>>; 2],
    gaps: Vec<GapCells<'a>>,
}

/// One membrane.
pub(super) struct LayerData<'a> {
    displacement: &'a [f64],
    pub(super) flux: MembraneFlux<'a>,
    /// At the points of each triangle, where it varies there.
    tension: Option<Vec<Samples>>,
    /// Over triangles.
    pub(super) least_tension: Vec<f64>,
    /// The oscillation of line loads, in the triangles beside them.
    line_oscillation: HashMap<usize, f64>,
}

/// The action in one gap.
struct GapCells<'a> {
    number: usize,
    lambda: &'a [f64],
    /// The densities along lines by triangle and corner from which the edge leads to the next: at this corner and at the next. Of the
    /// two triangles beside a line, one has it.
    lines: HashMap<(usize, usize), [f64; 2]>,
}

/// Sums over triangles.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    pub(super) eta_sq: f64,
    /// `sum_k (lt_k, wt_k)`.
    pub(super) contact: f64,
    pub(super) flux_sq: f64,
    pub(super) oscillation_sq: f64,
    /// `|||ut - u_h|||^2`.
    pub(super) moved_sq: f64,
    /// `|||u_h|||^2`.
    pub(super) energy_sq: f64,
}

impl Sums {
    fn plus(self, other: Self) -> Self {
        Self {
            eta_sq: self.eta_sq + other.eta_sq,
            contact: self.contact + other.contact,
            flux_sq: self.flux_sq + other.flux_sq,
            oscillation_sq: self.oscillation_sq + other.oscillation_sq,
            moved_sq: self.moved_sq + other.moved_sq,
            energy_sq: self.energy_sq + other.energy_sq,
        }
    }

    /// What a triangle adds to the square of the bound.
    fn indicator_sq(&self) -> f64 {
        self.eta_sq + 2.0 * self.contact + self.moved_sq
    }
}

/// A triangle, divided as `S_h` divides it.
struct Cell {
    k: usize,
    area: f64,
    diameter: f64,
    points: [[f64; 2]; 7],
}

impl Cell {
    fn new(d: &StackDiscretization, k: usize) -> Self {
        let at = |axis: usize| at_samples(d.mesh().corners(k).map(|corner| corner[axis]));
        let (x, y) = (at(0), at(1));
        Self {
            k,
            area: d.mesh().triangle_area(k),
            diameter: d.mesh().diameter_sq(k).sqrt(),
            points: std::array::from_fn(|point| [x[point], y[point]]),
        }
    }

    /// The six triangles of `S_h`: corner, half, the numbers of their points.
    fn halves() -> impl Iterator<Item = (usize, usize, [usize; 3])> {
        (0..3).flat_map(|corner| (0..2).map(move |half| (corner, half, HALVES[corner][half])))
    }

    fn corners(&self, points: [usize; 3]) -> [[f64; 2]; 3] {
        points.map(|point| self.points[point])
    }

    /// `int v^2` for a function that is affine on each of the six triangles.
    fn square(&self, v: &Samples) -> f64 {
        let on_half = |(_, _, points): (usize, usize, [usize; 3])| {
            let [a, b, c] = points.map(|point| v[point]);
            a * a + b * b + c * c + a * b + b * c + c * a
        };
        self.area / 36.0 * Self::halves().map(on_half).sum::<f64>()
    }
}

impl<'a> Cells<'a> {
    pub(super) fn new(
        d: &'a StackDiscretization,
        displacement: &'a [Vec<f64>],
        actions: &'a Actions,
    ) -> Result<Self, NoBound> {
        let beside = |ends: [usize; 2]| {
            let corner = |k: usize| {
                let corners = d.mesh().triangles()[k];
                (0..3).find(|&j| {
                    let (a, b) = (corners[j], corners[(j + 1) % 3]);
                    [a.min(b), a.max(b)] == ends
                })
            };
            let found = d.mesh().around().triangles(ends[0]).find_map(|k| Some((k, corner(k)?)));
            found.expect("an edge belongs to a triangle")
        };
        let layer = |(i, u): (usize, &'a Vec<f64>)| LayerData::new(d, i, u, actions, &beside);
        let gap = |gap: &'a GapAction| {
            let lines = gap.lines.iter().map(|&(ends, [lower, upper])| {
                let (k, corner) = beside(ends);
                let runs_up = d.mesh().triangles()[k][corner] == ends[0];
                ((k, corner), if runs_up { [lower, upper] } else { [upper, lower] })
            });
            GapCells { number: gap.number, lambda: &gap.lambda, lines: lines.collect() }
        };
        Ok(Self {
            d,
            layers: (1..).zip(displacement).map(layer).collect::<Result<_, _>>()?,
            obstacles: [d.obstacle_samples(0)?, d.obstacle_samples(1)?],
            gaps: actions.gaps.iter().map(gap).collect(),
        })
    }

    /// The membranes, counted from 1.
    pub(super) fn layers(&self) -> impl Iterator<Item = (usize, &LayerData<'a>)> {
        (1..).zip(&self.layers)
    }

    /// The sums over all triangles, added in an order that does not depend on the number of threads, and the squared indicators.
    pub(super) fn sum(&self) -> (Sums, Vec<f64>) {
        let mut indicators = vec![0.0; self.d.mesh().triangles().len()];
        let on_block = |(block, indicators): (usize, &mut [f64])| {
            let mut sums = Sums::default();
            for (k, indicator) in indicators.iter_mut().enumerate() {
                let on_triangle = self.on_triangle(block * BLOCK + k);
                *indicator = on_triangle.indicator_sq();
                sums = sums.plus(on_triangle);
            }
            sums
        };
        let blocks: Vec<Sums> = indicators.par_chunks_mut(BLOCK).enumerate().map(on_block).collect();
        (blocks.into_iter().fold(Sums::default(), Sums::plus), indicators)
    }

    fn on_triangle(&self, k: usize) -> Sums {
        let cell = Cell::new(self.d, k);
        let obstacles = [0, 1].map(|which| self.obstacle(which, k));
        let [ceiling, floor] = &obstacles;
        let mut sums = Sums::default();
        // The layers from the ceiling to the floor.
        let mut feasible = Vec::with_capacity(self.layers.len() + 2);
        feasible.push(*ceiling);
        for (i, layer) in self.layers() {
            let u = self.d.at_samples(k, layer.displacement);
            let ut = within(&u, ceiling.as_ref(), floor.as_ref());
            feasible.push(Some(ut));
            sums = sums.plus(self.on_membrane(&cell, i, layer, [&u, &ut]));
        }
        feasible.push(*floor);
        for gap in &self.gaps {
            if let [Some(upper), Some(lower)] = [gap.number, gap.number + 1].map(|layer| feasible[layer]) {
                let w = std::array::from_fn(|point| upper[point] - lower[point]);
                sums.contact += gap.product(self.d.mesh().triangles()[k], &cell, &w);
            }
        }
        sums
    }

    /// The ceiling (0) or the floor (1) on triangle `k`.
    fn obstacle(&self, which: usize, k: usize) -> Option<Samples> {
        let heights = self.d.obstacles()[which]?;
        Some(
            self.obstacles[which]
                .as_ref()
                .map_or_else(|| self.d.at_samples(k, heights), |samples| samples[k]),
        )
    }

    fn on_membrane(&self, cell: &Cell, i: usize, layer: &LayerData, [u, ut]: [&Samples; 2]) -> Sums {
        let k = cell.k;
        let corners = self.d.mesh().corners(k);
        let slope = gradient(corners, [u[0], u[1], u[2]]);
        let c = self.d.foundation_on(i, k);
        let moved = u != ut;
        let difference: Samples = std::array::from_fn(|point| ut[point] - u[point]);
        let (mut flux_sq, mut moved_sq, mut energy_sq) = (0.0, 0.0, 0.0);
        for (corner, of_wedge) in HALVES.iter().enumerate() {
            let halves = of_wedge.map(|points| cell.corners(points));
            let outward = layer.flux.outward(k, corner, halves);
            for half in 0..2 {
                let (points, triangle) = (of_wedge[half], halves[half]);
                let mu = layer.tension(self.d, i, k, points);
                let change = if moved { gradient(triangle, points.map(|p| difference[p])) } else { [0.0; 2] };
                let of_feasible = [0, 1].map(|axis| slope[axis] + change[axis]);
                flux_sq += distance_sq(triangle, outward[half], of_feasible, mu, layer.tension.is_some());
                let mean = cell.area / 6.0 * (mu[0] + mu[1] + mu[2]) / 3.0;
                moved_sq += mean * (change[0] * change[0] + change[1] * change[1]);
                energy_sq += mean * (slope[0] * slope[0] + slope[1] * slope[1]);
            }
        }
        let moved_on_foundation = if moved && c > 0.0 { c * cell.square(&difference) } else { 0.0 };
        let oscillation = self.residual(cell, i, layer, u);
        Sums {
            eta_sq: (flux_sq.sqrt() + oscillation + moved_on_foundation.sqrt()).powi(2),
            contact: 0.0,
            flux_sq,
            oscillation_sq: oscillation * oscillation,
            moved_sq: moved_sq + moved_on_foundation,
            energy_sq: energy_sq + if c > 0.0 { c * cell.square(u) } else { 0.0 },
        }
    }

    /// `m_K ||r_i||_K`, and the oscillation of line loads: on the wedge at `a` the residual is `f_i` less its share `f_a|_K`, of
    /// which `||f_i - p||_K` and `||p - f_a||_K` for an affine `p` are known, and `c_i (u_a - u_h)`.
    fn residual(&self, cell: &Cell, i: usize, layer: &LayerData, u: &Samples) -> f64 {
        let k = cell.k;
        let c = self.d.foundation_on(i, k);
        let root = layer.least_tension[k].sqrt();
        let by_diameter = poincare(cell.diameter) / root;
        let m = if c > 0.0 { by_diameter.min(1.0 / c.sqrt()) } else { by_diameter };
        let lumped_sq: f64 = (0..3)
            .map(|a| {
                let [b, c] = [1, 2].map(|j| u[(a + j) % 3] - u[a]);
                LUMPED[0] * (b * b + c * c) + 2.0 * LUMPED[1] * b * c
            })
            .sum();
        let oscillation = self.d.moments(i).on(self.d.mesh(), k).oscillation(cell.area);
        let residual = oscillation + c * (cell.area * lumped_sq.max(0.0)).sqrt();
        m * residual + layer.line_oscillation.get(&k).copied().unwrap_or(0.0) / root
    }
}

/// `u`, moved to the obstacles where it lies beyond them.
fn within(u: &Samples, ceiling: Option<&Samples>, floor: Option<&Samples>) -> Samples {
    std::array::from_fn(|point| {
        let above = floor.map_or(u[point], |floor| u[point].max(floor[point]));
        ceiling.map_or(above, |ceiling| above.min(ceiling[point]))
    })
}

/// `||mu^(1/2) grad v + mu^(-1/2) sigma||^2` on a triangle of `S_h`: `mu` at its corners, `1 / mu` affine between them.
fn distance_sq(
    triangle: [[f64; 2]; 3],
    outward: [f64; 3],
    slope: [f64; 2],
    mu: [f64; 3],
    varies: bool,
) -> f64 {
    if !varies {
        let of_slope = constant_outward(triangle, slope.map(|slope| mu[0] * slope));
        let sum = [0, 1, 2].map(|j| outward[j] + of_slope[j]);
        return (inner_product(triangle, sum, sum) / mu[0]).max(0.0);
    }
    let area = 0.5 * twice_signed_area(triangle);
    let at = |point: &[f64; 3]| {
        let mix = |values: [f64; 3]| (0..3).map(|j| point[j] * values[j]).sum::<f64>();
        let (mu, inverse) = (mix(mu), mix(mu.map(f64::recip)));
        let x = [0, 1].map(|axis| mix(triangle.map(|corner| corner[axis])));
        let sigma = value(triangle, outward, x);
        let sum = [0, 1].map(|axis| sigma[axis] + mu * slope[axis]);
        (sum[0] * sum[0] + sum[1] * sum[1]) / mu
            + (inverse - 1.0 / mu).max(0.0) * (sigma[0] * sigma[0] + sigma[1] * sigma[1])
    };
    area * DEGREE_4.points.iter().zip(DEGREE_4.weights).map(|(point, weight)| weight * at(point)).sum::<f64>()
}

impl<'a> LayerData<'a> {
    fn new(
        d: &'a StackDiscretization,
        i: usize,
        displacement: &'a [f64],
        actions: &Actions,
        beside: &impl Fn([usize; 2]) -> (usize, usize),
    ) -> Result<Self, NoBound> {
        let mesh = &**d.mesh();
        let (held, triangles) = (d.held(i), mesh.triangles().len());
        let tension: Vec<f64> = (0..triangles).map(|k| d.tension_on(i, k)).collect();
        let mut edge_force: HashMap<[usize; 2], [f64; 2]> = HashMap::new();
        let mut add = |ends: [usize; 2], force: [f64; 2]| {
            let sum = edge_force.entry(ends).or_default();
            (0..2).for_each(|j| sum[j] += force[j]);
        };
        held.line_loads.iter().for_each(|load| add(load.ends, load.force));
        for (ends, density) in actions.lines_on(i) {
            add(ends, density.map(|density| 0.5 * d.edge_length(ends) * density));
        }
        let wedge_force = |k: usize, corner: usize| {
            let on_foundation = d.foundation_on(i, k) * displacement[mesh.triangles()[k][corner]];
            d.moments(i).on(mesh, k).integrals[corner] - on_foundation * mesh.triangle_area(k) / 3.0
        };
        let balanced = Balanced {
            mesh,
            tension: &tension,
            displacement,
            wedge_force,
            action: &actions.on_membrane(i, displacement.len()),
            is_fixed: held.height.iter().map(Option::is_some).collect(),
            fixed_edges: &held.fixed_edges,
            edge_force,
        };
        let flux = balanced
            .flux()
            .map_err(|MeetInAVertex(vertex)| NoBound::MeetInAVertex { vertex, membrane: i })?;
        let mut line_oscillation = HashMap::new();
        for load in held.line_loads.iter().filter(|load| load.deviation > 0.0) {
            let (k, _) = beside(load.ends);
            let (h, edge) = (mesh.diameter_sq(k).sqrt(), d.edge_length(load.ends));
            // int_E v^2 = |E| / |K| int_K v^2 + v (x - p) . grad v, p the corner opposite to E, and Poincare.
            let trace = (edge / mesh.triangle_area(k) * poincare(h) * (poincare(h) + h)).sqrt();
            *line_oscillation.entry(k).or_insert(0.0) += load.deviation * trace;
        }
        let samples = d.tension_samples(i)?;
        let least_tension = match &samples {
            None => tension.clone(),
            Some(samples) => {
                let least = |samples: &Samples| samples.iter().copied().fold(f64::INFINITY, f64::min);
                samples.iter().map(least).collect()
            }
        };
        Ok(Self { displacement, flux, tension: samples, least_tension, line_oscillation })
    }

    /// The tension of membrane `i` at these points of triangle `k`.
    fn tension(&self, d: &StackDiscretization, i: usize, k: usize, points: [usize; 3]) -> [f64; 3] {
        match &self.tension {
            None => [d.tension_on(i, k); 3],
            Some(samples) => points.map(|point| samples[k][point]),
        }
    }
}

impl GapCells<'_> {
    /// `(lt, w)_K`, along lines too, for a gap that is affine on each of the six triangles.
    fn product(&self, corners: [usize; 3], cell: &Cell, w: &Samples) -> f64 {
        let on_area: f64 = Cell::halves()
            .map(|(corner, _, points)| {
                let mean = points.iter().map(|&point| w[point]).sum::<f64>() / 3.0;
                self.lambda[corners[corner]] * cell.area / 6.0 * mean
            })
            .sum();
        if self.lines.is_empty() {
            return on_area;
        }
        let along_lines = (0..3).filter_map(|corner| {
            let density = self.lines.get(&(cell.k, corner))?;
            let ends = [corner, (corner + 1) % 3];
            let [from, to] = ends.map(|end| cell.points[end]);
            let half = 0.5 * (to[0] - from[0]).hypot(to[1] - from[1]);
            let on_half = |j: usize| density[j] * half * 0.5 * (w[ends[j]] + w[3 + corner]);
            Some(on_half(0) + on_half(1))
        });
        on_area + along_lines.sum::<f64>()
    }
}
