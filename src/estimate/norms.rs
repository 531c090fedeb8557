//! The norms of the error of a solution.

use super::MeasureError;
use super::lift::{DualNorm, dual_norm};
use crate::action::PairSolution;
use crate::discretization::{Displacement, PairDiscretization};
use crate::fem::{CutRule, gradient};
use crate::mesh::{Mesh, SubTriangulation, VertexKind};
use crate::parallel::prelude::*;
use crate::parallel::{blocks_of, join};
use crate::problem::{Domain, ExactSolution};

/// Subdivisions of the triangles of `S_h` that a curve crosses: their parts are smaller than `h / 30`.
pub(super) const DEPTH: usize = 4;

/// Uniform refinements of `S_h` on which the action is lifted.
const LIFT_REFINEMENTS: usize = 1;

/// Triangles that are integrated together: enough for all threads, few enough to need no memory.
const BATCH: usize = 1 << 16;

/// How far a discrete solution is from the exact one.
///
/// Integrals run over the mesh: where it covers a disk only up to an inscribed polygon, over that polygon. Triangles of
/// `S_h` are integrated by a rule of degree 4, divided where the exact solution is less smooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorNorms {
    /// `|u_i - u_ih|_{H1}`, the seminorm, of each membrane (3.5).
    pub h1: [f64; 2],
    /// `||u_i - u_ih||_{L2}` of each membrane.
    pub l2: [f64; 2],
    /// `sqrt(sum_i mu_i |u_i - u_ih|_{H1}^2)`.
    pub energy: f64,
    /// The largest `|u_i - u_ih|` of each membrane at a vertex. Unit: length.
    pub nodal_max: [f64; 2],
    /// The largest `|u_i - u_ih|` of each membrane at a vertex or a point of the quadrature. Unit: length.
    pub max: [f64; 2],
    /// `||lambda - lambda_h||_{L2}` (4.36), `lambda_h` constant on the dual cells and zero on those of the boundary.
    pub lambda_l2: f64,
    /// `||lambda - lambda_h||_{H^-1}` (4.34).
    pub lambda_dual: DualNorm,
    /// The areas of contact.
    pub contact: ContactAreas,
    /// The largest relative change that the last subdivision at curves and corner makes in the norms of `h1`, `l2`,
    /// `lambda_l2` and in the exact areas of contact: of the order of the quadrature error of what is not smooth there.
    pub quadrature: f64,
}

/// Areas of contact. Between the exact ones lies the biactive set, where the membranes touch without any action; on it
/// rounding decides what the discrete set is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactAreas {
    /// The dual cells of the vertices in contact.
    pub discrete: f64,
    /// Where the exact action is positive.
    pub pressed: f64,
    /// Where the exact gap is zero.
    pub contact: f64,
}

impl ContactAreas {
    /// The distance of the discrete area from the interval between the exact ones: without a biactive set, its error.
    pub fn error(&self) -> f64 {
        (self.pressed - self.discrete).max(self.discrete - self.contact).max(0.0)
    }
}

impl ErrorNorms {
    /// Measures a solution of `d` against the exact one, in linear time.
    ///
    /// # Errors
    /// [`MeasureError`] when the solution is not one of `d`, or the lift cannot be found.
    pub fn new(
        d: &PairDiscretization,
        solution: &PairSolution,
        exact: &ExactSolution,
    ) -> Result<Self, MeasureError> {
        let fields = Fields { displacement: solution.displacement(), lambda: solution.lambda() };
        Self::of_fields(d, fields, solution.contact_area(), &cut_rule(exact, DEPTH), exact)
    }

    /// The norms for any displacements and action.
    pub(super) fn of_fields(
        d: &PairDiscretization,
        fields: Fields,
        contact_area: f64,
        rule: &CutRule,
        exact: &ExactSolution,
    ) -> Result<Self, MeasureError> {
        MeasureError::check(d, [fields.lambda])?;
        let sub = SubTriangulation::new(d.mesh())?;
        let rho = |t: usize, [x, y]: [f64; 2]| exact.lambda(x, y) - fields.lambda[sub.vertex_of(t)];
        // The spaces of the lift are made by one core, for the most part.
        let (lambda_dual, [sums, shallow]) = join(
            || dual_norm(d, &sub, rule, LIFT_REFINEMENTS, rho),
            || integrate(d.mesh(), &sub, fields, rule, exact),
        );
        let lambda_dual = lambda_dual?;
        let nodal_max = nodal_max(d.mesh(), fields.displacement, exact);
        sums.check_finite(exact)?;
        Ok(Self {
            h1: sums.h1_sq.map(f64::sqrt),
            l2: sums.l2_sq.map(f64::sqrt),
            energy: sums.energy(exact.tension()),
            nodal_max,
            max: [0, 1].map(|i| nodal_max[i].max(sums.max[i])),
            lambda_l2: sums.lambda_sq.sqrt(),
            lambda_dual,
            contact: ContactAreas { discrete: contact_area, pressed: sums.pressed, contact: sums.contact },
            quadrature: sums.largest_change(&shallow),
        })
    }
}

/// `|||u - u_h||| = (sum_i mu_i |u_i - u_ih|_{H1}^2)^(1/2)` of any displacements over vertices: the same figure as
/// [`ErrorNorms::energy`], without the others. Linear time.
///
/// # Errors
/// [`MeasureError`] when the displacements are not over the vertices, or the triangles cannot be divided.
pub fn energy_error(
    d: &PairDiscretization,
    displacement: &Displacement,
    exact: &ExactSolution,
) -> Result<f64, MeasureError> {
    MeasureError::check(d, displacement)?;
    let sub = SubTriangulation::new(d.mesh())?;
    let fields = Fields { displacement, lambda: &vec![0.0; d.mesh().points().len()] };
    let [sums, _] = integrate(d.mesh(), &sub, fields, &cut_rule(exact, DEPTH), exact);
    sums.check_finite(exact)?;
    Ok(sums.energy(exact.tension()))
}

/// The rule that follows the curves and the corner at which an exact solution is less smooth.
pub(super) fn cut_rule(exact: &ExactSolution, depth: usize) -> CutRule {
    let corner = matches!(exact.domain(), Domain::LShape { .. }).then_some([0.0, 0.0]);
    CutRule::new(exact.interfaces(), corner, depth)
}

/// What is measured, over vertices.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fields<'a> {
    pub(super) displacement: &'a Displacement,
    pub(super) lambda: &'a [f64],
}

/// Integrals over a part of the domain.
#[derive(Debug, Clone, Copy, Default)]
struct Integrals {
    h1_sq: [f64; 2],
    l2_sq: [f64; 2],
    max: [f64; 2],
    lambda_sq: f64,
    pressed: f64,
    contact: f64,
}

impl Integrals {
    fn add(&mut self, other: &Self) {
        for i in 0..2 {
            self.h1_sq[i] += other.h1_sq[i];
            self.l2_sq[i] += other.l2_sq[i];
            self.max[i] = self.max[i].max(other.max[i]);
        }
        self.lambda_sq += other.lambda_sq;
        self.pressed += other.pressed;
        self.contact += other.contact;
    }

    fn energy(&self, [mu1, mu2]: [f64; 2]) -> f64 {
        (mu1 * self.h1_sq[0] + mu2 * self.h1_sq[1]).sqrt()
    }

    /// Maxima lose a NaN, sums do not.
    fn check_finite(&self, exact: &ExactSolution) -> Result<(), MeasureError> {
        let sum = self.energy(exact.tension()) + self.l2_sq[0] + self.l2_sq[1] + self.lambda_sq;
        if sum.is_finite() { Ok(()) } else { Err(MeasureError::NotFinite) }
    }

    fn largest_change(&self, other: &Self) -> f64 {
        let figures = |sums: &Self| {
            let norms_sq = [sums.h1_sq[0], sums.h1_sq[1], sums.l2_sq[0], sums.l2_sq[1], sums.lambda_sq];
            norms_sq.into_iter().map(f64::sqrt).chain([sums.pressed, sums.contact])
        };
        let changes = figures(self).zip(figures(other)).filter(|(deep, _)| *deep > 0.0);
        changes.map(|(deep, shallow)| (deep - shallow).abs() / deep).fold(0.0, f64::max)
    }
}

/// An affine function, as its value at a point and its gradient.
#[derive(Clone, Copy)]
pub(super) struct Affine {
    origin: [f64; 2],
    value: f64,
    pub(super) gradient: [f64; 2],
}

impl Affine {
    /// The function with these values at the corners of a triangle.
    pub(super) fn through(corners: [[f64; 2]; 3], values: [f64; 3]) -> Self {
        Self { origin: corners[0], value: values[0], gradient: gradient(corners, values) }
    }

    pub(super) fn at(&self, [x, y]: [f64; 2]) -> f64 {
        self.value + self.gradient[0] * (x - self.origin[0]) + self.gradient[1] * (y - self.origin[1])
    }
}

/// The integrals over the domain, by the rule and with one subdivision less.
fn integrate(
    mesh: &Mesh,
    sub: &SubTriangulation,
    fields: Fields,
    rule: &CutRule,
    exact: &ExactSolution,
) -> [Integrals; 2] {
    let shallower = rule.shallower();
    let on_triangle = |k: usize| {
        let values = |i: usize| mesh.triangles()[k].map(|a| fields.displacement[i][a]);
        let u_h = [0, 1].map(|i| Affine::through(mesh.corners(k), values(i)));
        let mut sums = [Integrals::default(); 2];
        for t in 6 * k..6 * (k + 1) {
            let corners = sub.mesh().corners(t);
            let lambda_h = fields.lambda[sub.vertex_of(t)];
            let deep = integrals_on(corners, rule, &u_h, lambda_h, exact);
            let plain = rule.is_plain(corners);
            sums[0].add(&deep);
            sums[1].add(&if plain { deep } else { integrals_on(corners, &shallower, &u_h, lambda_h, exact) });
        }
        sums
    };
    let mut total = [Integrals::default(); 2];
    for batch in blocks_of(BATCH, mesh.triangles().len()) {
        let batch: Vec<_> = batch.into_par_iter().map(on_triangle).collect();
        // Added in one order, whatever the number of threads.
        for sums in &batch {
            (0..2).for_each(|depth| total[depth].add(&sums[depth]));
        }
    }
    total
}

/// The integrals over one triangle of `S_h`.
fn integrals_on(
    corners: [[f64; 2]; 3],
    rule: &CutRule,
    u_h: &[Affine; 2],
    lambda_h: f64,
    exact: &ExactSolution,
) -> Integrals {
    let mut sums = Integrals::default();
    rule.visit(corners, &mut |point, weight| {
        let [x, y] = point;
        let (u, grad_u, lambda) = (exact.u(x, y), exact.grad_u(x, y), exact.lambda(x, y));
        for i in 0..2 {
            let error = u[i] - u_h[i].at(point);
            let [dx, dy] = [0, 1].map(|axis| grad_u[i][axis] - u_h[i].gradient[axis]);
            sums.l2_sq[i] += weight * error * error;
            sums.h1_sq[i] += weight * (dx * dx + dy * dy);
            sums.max[i] = sums.max[i].max(error.abs());
        }
        sums.lambda_sq += weight * (lambda - lambda_h).powi(2);
        sums.pressed += weight * f64::from(lambda > 0.0);
        sums.contact += weight * f64::from(u[0] == u[1]);
    });
    sums
}

fn nodal_max(mesh: &Mesh, displacement: &Displacement, exact: &ExactSolution) -> [f64; 2] {
    let mut largest = [0.0f64; 2];
    for (a, [x, y]) in mesh.points().iter().enumerate().filter(|(a, _)| mesh.kind()[*a] != VertexKind::Unused)
    {
        let u = exact.u(*x, *y);
        (0..2).for_each(|i| largest[i] = largest[i].max((u[i] - displacement[i][a]).abs()));
    }
    largest
}
