//! The full reconstruction wedge by wedge: what guaranteed bounds need of it, without `S_h`.
//!
//! On a wedge `D_a cap K` the difference of `t_ih` and `-mu_i grad u_ih` has no flux through the boundary of `D_a`, so it is
//! known from what enters through the first half edge and from the source in the wedge; its square is a quadratic form of
//! the two.

use super::fan::{Walk, wedge_of};
use super::field::through;
use super::reconstruct::flux_on;
use crate::discretization::{Displacement, PairDiscretization};
use crate::fem::LoadMoments;
use crate::mesh::Mesh;
use crate::parallel::prelude::*;
use crate::parallel::{BLOCK, blocks};

/// Both fluxes `t_ih` of [`Reconstruction::Full`](super::Reconstruction::Full), by their difference to `-mu_i grad u_ih` on
/// the wedges. Linear time, in parallel; the result does not depend on the number of threads.
pub(crate) struct WedgeFluxes<'a> {
    data: Data<'a>,
    /// `int |t_ih + mu_i grad u_ih|^2` over the wedges, in the order of the triangles around the vertices.
    squares: Vec<[f64; 2]>,
}

/// What they are made from.
struct Data<'a> {
    mesh: &'a Mesh,
    load: &'a [LoadMoments; 2],
    lambda: &'a [f64],
    elements: Vec<Element>,
}

/// A triangle.
#[derive(Debug, Clone, Copy)]
struct Element {
    area: f64,
    /// `-mu_i grad u_ih`.
    flux: [[f64; 2]; 2],
}

/// `t_ih + mu_i grad u_ih` on a wedge, as fluxes: what enters through the half edge that comes first counterclockwise
/// around the vertex, and the source. What enters and what the source adds leaves through the other half edge.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Change {
    pub(super) entering: f64,
    pub(super) source: f64,
}

/// The products over a wedge of two fields: `c` circulates with the flux 1, `s` has the source 1, spread evenly, and
/// nothing enters it.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Products {
    pub(super) cc: f64,
    pub(super) cs: f64,
    ss: f64,
}

impl Products {
    /// Over `D_a cap K`, `K` with the corners `a, b, c` counterclockwise.
    pub(super) fn new([a, b, c]: [[f64; 2]; 3], area: f64) -> Self {
        let (p, q) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let dot = |u: [f64; 2], v: [f64; 2]| u[0] * v[0] + u[1] * v[1];
        let (pp, pq, qq) = (dot(p, p), dot(p, q), dot(q, q));
        Self {
            cc: (5.0 * pp - 8.0 * pq + 5.0 * qq) / (24.0 * area),
            cs: (4.0 * pp - 4.0 * pq + qq) / (24.0 * area),
            ss: (9.0 * pp - 4.0 * pq + qq) / (64.0 * area),
        }
    }

    /// `int |entering c + source s|^2`.
    fn square(self, Change { entering, source }: Change) -> f64 {
        entering * entering * self.cc + source * (2.0 * entering * self.cs + source * self.ss)
    }
}

/// A wedge while its fan is worked on.
#[derive(Debug, Clone, Copy)]
struct Wedge {
    area: f64,
    load: [f64; 2],
    flux: [[f64; 2]; 2],
    /// From the midpoint of the second half edge to the vertex.
    spoke: [[f64; 2]; 2],
    products: Products,
}

impl<'a> WedgeFluxes<'a> {
    /// For the displacements `[u1, u2]` over vertices. Around an interior vertex the action follows from the balance; on the dual cell of a boundary vertex
    /// it may be chosen, and is that of `lambda`, over vertices.
    pub(crate) fn new(d: &'a PairDiscretization, displacement: &Displacement, lambda: &'a [f64]) -> Self {
        let mesh = d.mesh();
        let around = mesh.around();
        let element = |k: usize| Element {
            area: mesh.triangle_area(k),
            flux: [0, 1].map(|i| flux_on(mesh, k, d.tension()[i], &displacement[i])),
        };
        let elements = (0..mesh.triangles().len()).into_par_iter().with_min_len(BLOCK).map(element).collect();
        let data = Data { mesh, load: &d.moments, lambda, elements };
        let vertices = mesh.points().len();
        let mut squares = vec![[0.0; 2]; 3 * mesh.triangles().len()];
        let mut rest = squares.as_mut_slice();
        let mut tasks = Vec::new();
        for block in blocks(vertices) {
            let (rows, others) =
                rest.split_at_mut(around.row(block.end - 1).end - around.row(block.start).start);
            tasks.push((block, rows));
            rest = others;
        }
        tasks.into_par_iter().for_each(|(vertices, mut rows)| {
            let mut patch = Patch::default();
            for a in vertices {
                let (row, others) = rows.split_at_mut(around.row(a).len());
                data.of_vertex(a, &mut patch);
                row.iter_mut().zip(patch.squares()).for_each(|(row, squares)| *row = squares);
                rows = others;
            }
        });
        Self { data, squares }
    }

    /// `int_K |t_ih + mu_i grad u_ih|^2` for both membranes.
    pub(crate) fn distance_sq(&self, k: usize) -> [f64; 2] {
        let mesh = self.data.mesh;
        let [a, b, c] = mesh.triangles()[k].map(|a| self.squares[mesh.around().place(a, k)]);
        [0, 1].map(|i| a[i] + b[i] + c[i])
    }

    /// `mu_i |u_ih|_{H1(K)}^2` of both membranes, of these tensions.
    pub(crate) fn energy(&self, k: usize, tension: [f64; 2]) -> [f64; 2] {
        let Element { area, flux } = self.data.elements[k];
        [0, 1].map(|i| area * (flux[i][0] * flux[i][0] + flux[i][1] * flux[i][1]) / tension[i])
    }

    /// The outward fluxes of `t_ih` through the halves of the edge of triangle `k` from corner `corner` to the next, which lies
    /// on the boundary: the half at this corner, then that at the next. Unit: force.
    pub(crate) fn boundary_outward(&self, membrane: usize, k: usize, corner: usize) -> [f64; 2] {
        let corners = self.data.mesh.corners(k);
        let q = self.data.elements[k].flux[membrane];
        let half = 0.5 * through(q, corners[corner], corners[(corner + 1) % 3]);
        let change = |corner: usize| self.data.change(k, corner)[membrane];
        let (first, last) = (change(corner), change((corner + 1) % 3));
        [half - first.entering, half + last.entering + last.source]
    }
}

impl Data<'_> {
    /// The change on the wedge of triangle `k` at a corner.
    fn change(&self, k: usize, corner: usize) -> [Change; 2] {
        let (around, a) = (self.mesh.around(), self.mesh.triangles()[k][corner]);
        let mut patch = Patch::default();
        self.of_vertex(a, &mut patch);
        patch.changes[around.place(a, k) - around.row(a).start]
    }

    /// The wedges around one vertex and the changes on them.
    fn of_vertex(&self, a: usize, patch: &mut Patch) {
        let Patch { wedges, changes, sides, walk } = patch;
        wedges.clear();
        sides.clear();
        for k in self.mesh.around().triangles(a) {
            let (corner, [next, last]) = wedge_of(self.mesh, k, a);
            wedges.push(self.wedge(k, corner, [a, next, last]));
            sides.push([next, last]);
        }
        changes.clear();
        changes.resize(wedges.len(), <[Change; 2]>::default());
        walk.fans(sides, |fan, closed| {
            for (membrane, sign) in [1.0, -1.0].into_iter().enumerate() {
                let action = (!closed).then_some(sign * self.lambda[a]);
                equilibrate(wedges, fan, action, membrane, changes);
            }
        });
    }

    /// The wedge at a corner of triangle `k`, whose corners are given from there.
    fn wedge(&self, k: usize, corner: usize, corners: [usize; 3]) -> Wedge {
        let [p, q, r] = corners.map(|b| self.mesh.points()[b]);
        let Element { area, flux } = self.elements[k];
        Wedge {
            area: area / 3.0,
            load: [0, 1].map(|i: usize| self.load[i].share(k, corner, area)),
            flux,
            spoke: [[0.5 * (p[0] + r[0]), 0.5 * (p[1] + r[1])], p],
            products: Products::new([p, q, r], area),
        }
    }
}

/// Memory for the wedges around a vertex, in the order of its triangles.
#[derive(Default)]
struct Patch {
    wedges: Vec<Wedge>,
    changes: Vec<[Change; 2]>,
    sides: Vec<[usize; 2]>,
    walk: Walk,
}

impl Patch {
    /// `int |t_ih + mu_i grad u_ih|^2` over the wedges.
    fn squares(&self) -> impl Iterator<Item = [f64; 2]> {
        self.wedges
            .iter()
            .zip(&self.changes)
            .map(|(wedge, changes)| changes.map(|change| wedge.products.square(change)))
    }
}

/// Balances each wedge of a fan, and chooses the circulation next to `-mu_i grad u_ih`. The action `-(-1)^i lambda_a` is given
/// where the fan is open; around an interior vertex, the last wedge must lead back to the first.
fn equilibrate(
    wedges: &[Wedge],
    fan: &[usize],
    action: Option<f64>,
    membrane: usize,
    row: &mut [[Change; 2]],
) {
    // What leaves a wedge enters the next one with this.
    let jump = |position: usize| {
        let after = if position + 1 < fan.len() { position + 1 } else { 0 };
        if after == 0 && action.is_some() {
            return 0.0;
        }
        let wedge = &wedges[fan[position]];
        let (here, there) = (wedge.flux[membrane], wedges[fan[after]].flux[membrane]);
        let [midpoint, a] = wedge.spoke;
        through([here[0] - there[0], here[1] - there[1]], midpoint, a)
    };
    let action = action.unwrap_or_else(|| {
        let (mut force, mut area) = (0.0, 0.0);
        for (position, &k) in fan.iter().enumerate() {
            force += wedges[k].load[membrane] + jump(position);
            area += wedges[k].area;
        }
        -force / area
    });
    let mut entering = 0.0;
    let (mut with_circulation, mut circulation_sq) = (0.0, 0.0);
    for (position, &k) in fan.iter().enumerate() {
        let Wedge { load, area, products, .. } = &wedges[k];
        let source = load[membrane] + action * area;
        row[k][membrane] = Change { entering, source };
        with_circulation += entering * products.cc + source * products.cs;
        circulation_sq += products.cc;
        entering += source + jump(position);
    }
    let alpha = -with_circulation / circulation_sq;
    fan.iter().for_each(|&k| row[k][membrane].entering += alpha);
}
