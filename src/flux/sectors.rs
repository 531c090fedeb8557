//! The full reconstruction for one membrane that is fixed on a part of the boundary, or on curves inside, and free elsewhere.
//!
//! Around a vertex, the edges where the membrane is fixed cut the wedges into *sectors*: the flux need not be continuous across
//! them, for nothing that it is tested with lives there. At the ends of a sector where the membrane is free, the flux is what the line
//! load leaves; where it is fixed, any flux will do.

use std::collections::HashMap;

use super::fan::{Walk, wedge_of};
use super::field::{constant_outward, through};
use super::reconstruct::flux_on;
use super::wedges::{Change, Products};
use crate::mesh::Mesh;
use crate::parallel::prelude::*;
use crate::parallel::{BLOCK, blocks};

/// What a flux is made from: a displacement, and the forces that it has to balance.
pub(crate) struct Balanced<'a, 'b, S> {
    pub(crate) mesh: &'a Mesh,
    /// The tension on each triangle, as it is in the stiffness matrix.
    pub(crate) tension: &'b [f64],
    /// The displacement over vertices.
    pub(crate) displacement: &'a [f64],
    /// The force on the wedge of a triangle at a corner, but for the actions. Unit: force.
    pub(crate) wedge_force: S,
    /// `lambda_i - lambda_(i-1)` over vertices. Unit: force per area.
    pub(crate) action: &'b [f64],
    /// Whether the membrane is fixed at each vertex.
    pub(crate) is_fixed: Vec<bool>,
    /// The edges where it is fixed, sorted, the lower end of each first.
    pub(crate) fixed_edges: &'a [[usize; 2]],
    /// The forces on the halves of edges that carry a line load or an action along a line, by the ends of the edge, the lower one
    /// first. Unit: force.
    pub(crate) edge_force: HashMap<[usize; 2], [f64; 2]>,
}

/// A flux `sigma` in Raviart-Thomas on `S_h` with `div sigma` in balance on every triangle of it, continuous across all edges where the
/// membrane is not fixed, and as near to `-mu grad u` as that allows.
pub(crate) struct MembraneFlux<'a> {
    mesh: &'a Mesh,
    /// `-mu grad u_h` on the triangles.
    discrete: Vec<[f64; 2]>,
    /// In the order of the triangles around the vertices.
    changes: Vec<Change>,
    /// The action that closes the balance around each vertex where the membrane is free, less the one that was given: what the
    /// solver has left. Unit: force per area.
    pub(crate) rest: Vec<f64>,
}

/// A wedge of a sector.
struct Wedge {
    /// Its place among the triangles around the vertex.
    place: usize,
    area: f64,
    force: f64,
    flux: [f64; 2],
    /// From the midpoints of its first and last edge to the vertex.
    spokes: [[f64; 2]; 2],
    /// The forces on the halves of these edges.
    edge_force: [f64; 2],
    products: Products,
}

/// Where a sector ends.
#[derive(Debug, Clone, Copy, PartialEq)]
enum End {
    /// At an edge where the membrane is fixed.
    Fixed,
    /// At one on the boundary where it is free.
    Free,
    /// Nowhere: it goes all around.
    Closed,
}

/// Two parts of the domain meet at this vertex only, or a membrane is fixed there and on no edge: no flux balances them one by one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct MeetInAVertex(pub(crate) usize);

impl<'a, S: Fn(usize, usize) -> f64 + Sync> Balanced<'a, '_, S> {
    /// Linear time, in parallel; the result does not depend on the number of threads.
    ///
    /// # Errors
    /// [`MeetInAVertex`].
    pub(crate) fn flux(self) -> Result<MembraneFlux<'a>, MeetInAVertex> {
        let Self { mesh, tension, displacement, .. } = self;
        let around = mesh.around();
        let discrete = |k: usize| flux_on(mesh, k, tension[k], displacement);
        let discrete: Vec<_> =
            (0..mesh.triangles().len()).into_par_iter().with_min_len(BLOCK).map(discrete).collect();
        let mut changes = vec![Change::default(); 3 * mesh.triangles().len()];
        let mut rest = vec![0.0; mesh.points().len()];
        let (mut changes_left, mut rest_left) = (changes.as_mut_slice(), rest.as_mut_slice());
        let mut tasks = Vec::new();
        for block in blocks(mesh.points().len()) {
            let (rows, others) =
                changes_left.split_at_mut(around.row(block.end - 1).end - around.row(block.start).start);
            let (rests, other_rests) = rest_left.split_at_mut(block.len());
            tasks.push((block, rows, rests));
            (changes_left, rest_left) = (others, other_rests);
        }
        let of_task = |(vertices, mut rows, rests): (std::ops::Range<usize>, &mut [Change], &mut [f64])| {
            let mut patch = Patch::default();
            for (a, rest) in vertices.zip(rests) {
                let (row, others) = rows.split_at_mut(around.row(a).len());
                *rest = self.around_vertex(a, &discrete, &mut patch, row)?;
                rows = others;
            }
            Ok(())
        };
        tasks.into_par_iter().map(of_task).collect::<Vec<_>>().into_iter().collect::<Result<(), _>>()?;
        Ok(MembraneFlux { mesh, discrete, changes, rest })
    }

    /// Fills the row of changes of a vertex, and tells the action that closes the balance less the one that is given.
    fn around_vertex(
        &self,
        a: usize,
        discrete: &[[f64; 2]],
        patch: &mut Patch,
        row: &mut [Change],
    ) -> Result<f64, MeetInAVertex> {
        let Patch { sides, walk, sectors } = patch;
        let around = self.mesh.around();
        let triangles = around.of(a);
        sides.clear();
        sides.extend(around.triangles(a).map(|k| wedge_of(self.mesh, k, a).1));
        sectors.clear();
        walk.fans(sides, |fan, closed| self.add_sectors(a, sides, fan, closed, sectors));
        let is_one = sectors.len() == 1;
        let mut rest = 0.0;
        for (ends, places) in sectors {
            let wedges: Vec<Wedge> = places
                .iter()
                .map(|&place| self.wedge(a, triangles[place] as usize, place, discrete))
                .collect();
            let is_fixed = self.is_fixed[a];
            if (is_fixed || !is_one) && !ends.contains(&End::Fixed) {
                return Err(MeetInAVertex(a));
            }
            let given = (is_fixed && *ends != [End::Closed; 2]).then_some(self.action[a]);
            let action = balance(&wedges, *ends, given, row);
            if !is_fixed {
                rest = action - self.action[a];
            }
        }
        Ok(rest)
    }

    /// Cuts a fan at the edges where the membrane is fixed.
    fn add_sectors(
        &self,
        a: usize,
        sides: &[[usize; 2]],
        fan: &[usize],
        closed: bool,
        sectors: &mut Vec<([End; 2], Vec<usize>)>,
    ) {
        let is_fixed = |b: usize| {
            self.is_fixed[a]
                && self.is_fixed[b]
                && self.fixed_edges.binary_search(&[a.min(b), a.max(b)]).is_ok()
        };
        let end = |b: usize| if is_fixed(b) { End::Fixed } else { End::Free };
        let Some(cut) = fan.iter().position(|&place| is_fixed(sides[place][1])) else {
            let ends = if closed {
                [End::Closed; 2]
            } else {
                [end(sides[fan[0]][0]), end(sides[fan[fan.len() - 1]][1])]
            };
            sectors.push((ends, fan.to_vec()));
            return;
        };
        // A closed fan begins behind a cut.
        let mut fan = fan.to_vec();
        if closed {
            fan.rotate_left(cut + 1);
        }
        for part in fan.split_inclusive(|&place| is_fixed(sides[place][1])) {
            let ends = [sides[part[0]][0], sides[part[part.len() - 1]][1]].map(end);
            sectors.push((ends, part.to_vec()));
        }
    }

    fn wedge(&self, a: usize, k: usize, place: usize, discrete: &[[f64; 2]]) -> Wedge {
        let (corner, [next, last]) = wedge_of(self.mesh, k, a);
        let [origin, p, q] = [a, next, last].map(|b| self.mesh.points()[b]);
        let area = self.mesh.triangle_area(k);
        let edge_force = |b: usize| {
            let of_edge = self.edge_force.get(&[a.min(b), a.max(b)]);
            of_edge.map_or(0.0, |force| force[usize::from(a > b)])
        };
        let spoke = |end: [f64; 2]| [0, 1].map(|axis| -0.5 * (end[axis] - origin[axis]));
        Wedge {
            place,
            area: area / 3.0,
            force: (self.wedge_force)(k, corner),
            flux: discrete[k],
            spokes: [p, q].map(spoke),
            edge_force: if self.edge_force.is_empty() { [0.0; 2] } else { [next, last].map(edge_force) },
            products: Products::new([origin, p, q], area),
        }
    }
}

/// Memory for the wedges around a vertex.
#[derive(Default)]
struct Patch {
    sides: Vec<[usize; 2]>,
    walk: Walk,
    sectors: Vec<([End; 2], Vec<usize>)>,
}

/// Balances each wedge of a sector, and chooses the circulation, where there is one, next to `-mu grad u_h`. The action is given, or
/// what closes the balance around the vertex; it is returned.
fn balance(wedges: &[Wedge], [first, last]: [End; 2], given: Option<f64>, row: &mut [Change]) -> f64 {
    let through_spoke = |flux: [f64; 2], spoke: [f64; 2]| through(flux, [0.0; 2], spoke);
    // What leaves a wedge enters the next one with this.
    let crossing = |k: usize| {
        let (here, there) = (&wedges[k], &wedges[(k + 1) % wedges.len()]);
        let jump = [0, 1].map(|axis| here.flux[axis] - there.flux[axis]);
        through_spoke(jump, here.spokes[1]) + here.edge_force[1]
    };
    let crossings = if first == End::Closed { wedges.len() } else { wedges.len() - 1 };
    let start = &wedges[0];
    let entering = if first == End::Free {
        start.edge_force[0] - through_spoke(start.flux, start.spokes[0])
    } else {
        0.0
    };
    let end = &wedges[wedges.len() - 1];
    let leaving = match last {
        End::Free => -end.edge_force[1] - through_spoke(end.flux, end.spokes[1]),
        End::Closed | End::Fixed => entering,
    };
    let action = given.unwrap_or_else(|| {
        let drift =
            wedges.iter().map(|wedge| wedge.force).sum::<f64>() + (0..crossings).map(crossing).sum::<f64>();
        (leaving - entering - drift) / wedges.iter().map(|wedge| wedge.area).sum::<f64>()
    });
    let mut flux = entering;
    let (mut with_circulation, mut circulation_sq) = (0.0, 0.0);
    for (k, wedge) in wedges.iter().enumerate() {
        let source = wedge.force + action * wedge.area;
        row[wedge.place] = Change { entering: flux, source };
        with_circulation += flux * wedge.products.cc + source * wedge.products.cs;
        circulation_sq += wedge.products.cc;
        flux += source + if k < crossings { crossing(k) } else { 0.0 };
    }
    let circulation = match [first, last] {
        [End::Free, _] => 0.0,
        [_, End::Free] => leaving - flux,
        _ => -with_circulation / circulation_sq,
    };
    wedges.iter().for_each(|wedge| row[wedge.place].entering += circulation);
    action
}

impl MembraneFlux<'_> {
    /// The outward fluxes through the edges of the two halves of the wedge of triangle `k` at a corner: (vertex, midpoint of
    /// the first edge, barycentre) and (vertex, barycentre, midpoint of the last edge), edge `j` opposite to corner `j`. Unit: force.
    pub(crate) fn outward(&self, k: usize, corner: usize, halves: [[[f64; 2]; 3]; 2]) -> [[f64; 3]; 2] {
        let a = self.mesh.triangles()[k][corner];
        let Change { entering, source } = self.changes[self.mesh.around().place(a, k)];
        let (across, leaving) = (entering + 0.5 * source, entering + source);
        let changes = [[0.0, across, -entering], [0.0, leaving, -across]];
        [0, 1].map(|half| {
            let discrete = constant_outward(halves[half], self.discrete[k]);
            [0, 1, 2].map(|j| discrete[j] + changes[half][j])
        })
    }
}
