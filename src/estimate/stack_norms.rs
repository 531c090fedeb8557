//! The norms of the error of a stack.

use super::norms::{Affine, DEPTH};
use super::{MeasureError, RimError};
use crate::action::{GapSolution, Rim, StackSolution};
use crate::discretization::StackDiscretization;
use crate::fem::CutRule;
use crate::mesh::{Mesh, SubTriangulation, VertexKind};
use crate::parallel::blocks;
use crate::parallel::prelude::*;
use crate::problem::ExactStack;

/// How far the discrete solution of a stack is from the exact one.
///
/// Integrals run over the mesh, as those of [`ErrorNorms`](super::ErrorNorms), by the same rule.
#[derive(Debug, Clone, PartialEq)]
pub struct StackNorms {
    /// `|u_i - u_ih|_{H1}`, the seminorm, of each membrane.
    pub h1: Vec<f64>,
    /// `||u_i - u_ih||_{L2}` of each membrane.
    pub l2: Vec<f64>,
    /// `|||u - u_h||| = sqrt(sum_i int mu_i |grad (u_i - u_ih)|^2 + c_i (u_i - u_ih)^2)`.
    pub energy: f64,
    /// The largest `|u_i - u_ih|` of each membrane at a vertex. Unit: length.
    pub nodal_max: Vec<f64>,
    /// What concerns each gap.
    pub gaps: Vec<GapError>,
    /// The largest relative change that the last subdivision at the interfaces makes in these norms: of the order of the
    /// quadrature error of what is not smooth there.
    pub quadrature: f64,
}

/// The errors in a gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GapError {
    /// `k`: the gap between layers `k` and `k + 1`.
    pub number: usize,
    /// `||lambda_k - lambda_kh||_{L2}`, `lambda_kh` constant on the dual cells and zero on those of held vertices; without the dual
    /// cells of the vertices of triangles that a line action of the exact solution passes: there, `lambda_kh` has it in itself.
    pub lambda_l2: f64,
    /// The distance of the area of the dual cells in contact from the interval between the areas where the exact action is
    /// positive and where the exact gap is zero.
    pub contact_area: f64,
    /// The error of the contact set, where a curve bounds the exact one.
    pub rim: Option<RimError>,
}

impl StackNorms {
    /// Measures a solution of `d` against the exact one. Linear time, but for the distances of the rims.
    ///
    /// # Errors
    /// [`MeasureError`] when the solution is not one of `d`, or something is not finite.
    pub fn new(
        d: &StackDiscretization,
        solution: &StackSolution,
        exact: &ExactStack,
    ) -> Result<Self, MeasureError> {
        let mesh = d.mesh();
        let vertices = mesh.points().len();
        let mut lengths = solution.displacement().iter().map(Vec::len);
        if let Some(values) = lengths.find(|&values| values != vertices) {
            return Err(MeasureError::OtherMesh { values, vertices });
        }
        let sub = SubTriangulation::new(mesh)?;
        let rule = CutRule::new(exact.interfaces(), None, DEPTH);
        let on_lines = solution.gaps().iter().map(|gap| on_lines(mesh, exact, gap.number)).collect();
        let integrand = Integrand { mesh, sub: &sub, solution, exact, on_lines };
        let [sums, shallow] = integrand.integrate(&rule);
        if !sums.0.iter().all(|sum| sum.is_finite()) {
            return Err(MeasureError::NotFinite);
        }
        let (membranes, gaps) = integrand.split(&sums);
        let root = |k: usize| membranes.iter().map(|sums| sums[k].sqrt()).collect();
        Ok(Self {
            h1: root(0),
            l2: root(1),
            energy: membranes.iter().map(|sums| sums[2]).sum::<f64>().sqrt(),
            nodal_max: (1..)
                .zip(solution.displacement())
                .map(|(i, u)| nodal_max(mesh, exact, i, u))
                .collect(),
            gaps: solution
                .gaps()
                .iter()
                .zip(gaps)
                .map(|(gap, sums)| gap_error(mesh, exact, gap, sums))
                .collect(),
            quadrature: sums.largest_change(&shallow),
        })
    }
}

/// Integrals of each membrane: `|grad e|^2`, `e^2`, energy; of each gap: `(lambda - lambda_h)^2`, and the areas where the exact
/// action is positive and where the exact gap is zero.
const EACH: usize = 3;

#[derive(Clone)]
struct Sums(Vec<f64>);

impl Sums {
    fn add(&mut self, other: &Self) {
        self.0.iter_mut().zip(&other.0).for_each(|(sum, term)| *sum += term);
    }

    /// Of the roots, as norms are: of areas half of what it is.
    fn largest_change(&self, other: &Self) -> f64 {
        let changes = self.0.iter().zip(&other.0).filter(|(deep, _)| **deep > 0.0);
        changes.map(|(deep, shallow)| (1.0 - (shallow / deep).sqrt()).abs()).fold(0.0, f64::max)
    }
}

struct Integrand<'a> {
    mesh: &'a Mesh,
    sub: &'a SubTriangulation,
    solution: &'a StackSolution,
    exact: &'a ExactStack,
    /// For each gap, whether the dual cell of a vertex is left out.
    on_lines: Vec<Vec<bool>>,
}

impl Integrand<'_> {
    fn zero(&self) -> Sums {
        Sums(vec![0.0; EACH * (self.solution.displacement().len() + self.solution.gaps().len())])
    }

    /// Those of the membranes and those of the gaps.
    fn split<'s>(&self, sums: &'s Sums) -> (Vec<&'s [f64]>, Vec<&'s [f64]>) {
        let mut membranes: Vec<&[f64]> = sums.0.chunks(EACH).collect();
        let gaps = membranes.split_off(self.solution.displacement().len());
        (membranes, gaps)
    }

    /// Over the domain, by the rule and with one subdivision less; added in one order, whatever the number of threads.
    fn integrate(&self, rule: &CutRule) -> [Sums; 2] {
        let shallower = rule.shallower();
        let of_block = |block: std::ops::Range<usize>| {
            let mut sums = [self.zero(), self.zero()];
            for t in block.flat_map(|k| 6 * k..6 * (k + 1)) {
                let mut part = self.zero();
                self.add_triangle(t, rule, &mut part);
                sums[0].add(&part);
                if !rule.is_plain(self.sub.mesh().corners(t)) {
                    part = self.zero();
                    self.add_triangle(t, &shallower, &mut part);
                }
                sums[1].add(&part);
            }
            sums
        };
        let parts: Vec<[Sums; 2]> =
            blocks(self.mesh.triangles().len()).into_par_iter().map(of_block).collect();
        let mut total = [self.zero(), self.zero()];
        for part in &parts {
            (0..2).for_each(|depth| total[depth].add(&part[depth]));
        }
        total
    }

    /// Over triangle `t` of `S_h`.
    fn add_triangle(&self, t: usize, rule: &CutRule, sums: &mut Sums) {
        let Self { mesh, sub, solution, exact, .. } = *self;
        let (whole, vertex) = (t / 6, sub.vertex_of(t));
        let corners = mesh.triangles()[whole];
        let u_h: Vec<Affine> = solution
            .displacement()
            .iter()
            .map(|u| Affine::through(mesh.corners(whole), corners.map(|a| u[a])))
            .collect();
        rule.visit(sub.mesh().corners(t), &mut |point, weight| {
            let [x, y] = point;
            let mut terms = sums.0.chunks_mut(EACH);
            for (i, u_h) in (1..).zip(&u_h) {
                let error = exact.u(i, x, y) - u_h.at(point);
                let grad_u = exact.grad_u(i, x, y);
                let slope_sq: f64 = (0..2).map(|k| (grad_u[k] - u_h.gradient[k]).powi(2)).sum();
                let energy = exact.tension(i, x, y) * slope_sq + exact.foundation(i) * error * error;
                add(&mut terms, weight, [slope_sq, error * error, energy]);
            }
            for (gap, on_lines) in solution.gaps().iter().zip(&self.on_lines) {
                let lambda = exact.lambda(gap.number, x, y);
                let error = if on_lines[vertex] { 0.0 } else { lambda - gap.lambda[vertex] };
                let touches = f64::from(exact.gap(gap.number, x, y) == 0.0);
                add(&mut terms, weight, [error * error, f64::from(lambda > 0.0), touches]);
            }
        });
    }
}

fn add<'s>(terms: &mut impl Iterator<Item = &'s mut [f64]>, weight: f64, values: [f64; EACH]) {
    let sums = terms.next().into_iter().flatten();
    sums.zip(values).for_each(|(sum, value)| *sum += weight * value);
}

/// The vertices of triangles that meet a line action in gap `k`.
fn on_lines(mesh: &Mesh, exact: &ExactStack, k: usize) -> Vec<bool> {
    let mut marked = vec![false; mesh.points().len()];
    for line in exact.line_actions(k) {
        for (t, corners) in mesh.triangles().iter().enumerate() {
            let sides = mesh.corners(t).map(|[x, y]| line.curve.signed_distance(x, y));
            // Also where an edge lies on it up to rounding.
            let rounding = 1e-9 * mesh.diameter_sq(t).sqrt();
            if sides.iter().any(|&side| side <= rounding) && sides.iter().any(|&side| side >= -rounding) {
                corners.iter().for_each(|&a| marked[a] = true);
            }
        }
    }
    marked
}

fn nodal_max(mesh: &Mesh, exact: &ExactStack, i: usize, u: &[f64]) -> f64 {
    let used = (0..u.len()).filter(|&a| mesh.kind()[a] != VertexKind::Unused);
    let error = |a: usize| {
        let [x, y] = mesh.points()[a];
        (exact.u(i, x, y) - u[a]).abs()
    };
    used.map(error).fold(0.0, f64::max)
}

fn gap_error(mesh: &Mesh, exact: &ExactStack, gap: &GapSolution, sums: &[f64]) -> GapError {
    let [lambda_sq, pressed, touching] = [sums[0], sums[1], sums[2]];
    let outside = (pressed - gap.contact_area).max(gap.contact_area - touching);
    let rim = exact
        .rim(gap.number)
        .map(|curve| RimError::new(mesh, &Rim::new(mesh, &gap.gap, &gap.contact), &curve));
    GapError { number: gap.number, lambda_l2: lambda_sq.sqrt(), contact_area: outside.max(0.0), rim }
}
