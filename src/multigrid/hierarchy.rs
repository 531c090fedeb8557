//! The levels of a discretization: its stiffness matrix on coarser and coarser spaces.
//!
//! They follow the refinements that made the mesh, as long as each halves the unknowns; below these, and on a mesh without
//! ancestors, they are algebraic. So the levels together are at most a few times the finest one, whatever the refinements were.

mod coarsening;
mod coloring;
mod galerkin;
mod genealogy;
mod matrix;
mod ordering;
mod runs;
mod transfer;
#[cfg(test)]
mod tests;

pub(crate) use coloring::Coloring;
pub(crate) use galerkin::{RowSum, galerkin};
pub(crate) use genealogy::{Genealogy, Mean};
pub(crate) use matrix::{Pattern, Rows, Values, assemble, row_product};
pub(crate) use runs::{LONGEST, Runs};
pub(crate) use transfer::Transfer;

use crate::discretization::PairDiscretization;
use crate::fem::{StiffnessMatrix, row_of};
use crate::mesh::{Mesh, VertexKind};
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;
use coarsening::coarsened;
use matrix::{compact_stiffness, reordered};
use ordering::{banded_order, inverse, is_banded};

/// An entry below this fraction of the diagonal does not couple two rows: rounding of a Galerkin product.
const UNCOUPLED: f64 = 1e-10;

/// Entries that differ by less than this fraction of the diagonal are the same for a correction: by the rounding of the
/// vertices of a uniform mesh. On the finest level, whose matrix decides on the answer, there is no such allowance.
const SAME_ENTRY: f64 = 1e-10;

/// As many unknowns are solved for directly.
const DIRECT: usize = 64;

/// A level that follows the refinements has at most this fraction of the unknowns of the finer one; else algebraic levels are
/// better, which need a quarter to a half of them.
const SLOW_REFINEMENT: f64 = 0.5;

/// An algebraic level that keeps more than this fraction of the unknowns is not worth having.
const SLOW_COARSENING: f64 = 0.9;

/// The stiffness matrix on a hierarchy of spaces, from the coarsest to that of the mesh. Level 0 repeats level 1: there
/// systems are solved directly.
pub(crate) struct Hierarchy {
    levels: Vec<Level>,
    /// The vertex of the mesh to which each row of the finest level belongs.
    vertex: Vec<u32>,
    refinements: usize,
}

/// One space. Rows belong to the vertices, in the numbering of the level; those of held vertices (where a membrane is fixed, or in
/// no triangle) are empty.
#[derive(Clone)]
pub(crate) struct Level {
    pub(crate) pattern: Pattern,
    pub(crate) values: Values,
    pub(crate) coloring: Coloring,
    pub(crate) runs: Runs,
    /// From the level below; that of level 0 has no rows.
    pub(crate) transfer: Transfer,
}

/// Which vertices are inside: those with an unknown when membranes are fixed all around.
pub(crate) fn inside(mesh: &Mesh) -> Vec<bool> {
    mesh.kind().iter().map(|&kind| kind == VertexKind::Interior).collect()
}

impl Hierarchy {
    /// Makes the levels of a discretization.
    pub(crate) fn new(d: &PairDiscretization) -> Self {
        Self::of_pair(d, &Genealogy::of(d.mesh()))
    }

    /// Likewise with another genealogy.
    pub(crate) fn of_pair(d: &PairDiscretization, genealogy: &Genealogy) -> Self {
        Self::over(d.stiffness(), &inside(d.mesh()), genealogy)
    }

    /// Makes the levels of a stiffness matrix over the vertices of a mesh with this genealogy; those with an unknown are `free`.
    pub(crate) fn over(k: &StiffnessMatrix, free: &[bool], genealogy: &Genealogy) -> Self {
        let banded = (!is_banded(k.rows(), bandwidth(k, |a| a))).then(|| banded_order(k, genealogy));
        let (coloring, vertex) = finest_coloring(k, free, banded.as_deref());
        let (pattern, values) = compact_stiffness(k, free, &vertex);
        let mut finest_first = vec![Level::new(pattern, values, coloring, 0.0)];
        let banded = banded.unwrap_or_else(|| (0..k.rows() as u32).collect());
        let refinements = follow_refinements(&mut finest_first, free, genealogy, banded, vertex.clone());
        coarsen(&mut finest_first);
        let coarsest = finest_first.last_mut().expect("there is a finest level");
        coarsest.transfer = Transfer::identity(coarsest.pattern.rows());
        let direct = Level { transfer: Transfer::default(), ..coarsest.clone() };
        finest_first.push(direct);
        finest_first.reverse();
        Self { levels: finest_first, vertex, refinements }
    }

    /// How many levels follow the refinements that made the mesh.
    pub(crate) fn refinements(&self) -> usize {
        self.refinements
    }

    pub(crate) fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// The number of the finest level.
    pub(crate) fn finest(&self) -> usize {
        self.levels.len() - 1
    }

    /// The vertex of the mesh to which each row of the finest level belongs.
    pub(crate) fn vertex(&self) -> &[u32] {
        &self.vertex
    }

    /// From a vector over the vertices of the mesh to one over the rows of the finest level.
    pub(crate) fn to_rows(&self, over_vertices: impl Fn(usize) -> f64 + Sync) -> Vec<f64> {
        self.vertex.par_iter().with_min_len(BLOCK).map(|&a| over_vertices(a as usize)).collect()
    }

    /// And back.
    pub(crate) fn to_vertices(&self, over_rows: &[f64]) -> Vec<f64> {
        let mut values = vec![0.0; self.vertex.len()];
        for (&a, &value) in self.vertex.iter().zip(over_rows) {
            values[a as usize] = value;
        }
        values
    }

    /// The functionals `b - K_IB g` of all levels, for `b` and `g` over the rows of the finest one; and `g` on all levels.
    pub(crate) fn lifted(&self, load: Vec<f64>, height: Vec<f64>) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let (mut loads, mut heights) = (vec![load], vec![height]);
        for level in self.levels[1..].iter().rev() {
            let [load, height] = [&loads, &heights].map(|finest_first| &finest_first[finest_first.len() - 1]);
            let injected = level.transfer.inject(height);
            loads.push(level.transfer.restrict(load));
            heights.push(injected);
        }
        loads.reverse();
        heights.reverse();
        for (level, (load, height)) in self.levels.iter().zip(loads.iter_mut().zip(&heights)) {
            level.lift(load, height);
        }
        (loads, heights)
    }
}

/// Makes levels that follow the refinements, below the finest one, whose rows belong to these vertices. `banded` are the vertices
/// in the order that the windows follow. Returns how many there are.
fn follow_refinements(
    finest_first: &mut Vec<Level>,
    free: &[bool],
    genealogy: &Genealogy,
    mut banded: Vec<u32>,
    mut of_row: Vec<u32>,
) -> usize {
    let unknowns =
        |vertices: &[u32]| vertices.par_iter().with_min_len(BLOCK).filter(|&&a| free[a as usize]).count();
    let mut fine_unknowns = unknowns(&banded);
    let mut number = vec![0; free.len()];
    for generation in 1.. {
        if !fixed_come_from_fixed(free, genealogy, generation, &banded) {
            return generation - 1;
        }
        banded.retain(|&a| genealogy.is_on_level(a, generation));
        let coarse_unknowns = unknowns(&banded);
        if coarse_unknowns as f64 > SLOW_REFINEMENT * fine_unknowns as f64 {
            return generation - 1;
        }
        fine_unknowns = coarse_unknowns;
        (0..).zip(&banded).for_each(|(i, &a)| number[a as usize] = i);
        let transfer = transfer(genealogy, generation, &of_row, banded.len(), &number);
        let Some(rows) = descend(finest_first, transfer) else { return generation - 1 };
        of_row = composed(Some(&banded), rows);
    }
    unreachable!("some generation is the last")
}

/// Whether the parents of all vertices that are fixed, and not on the level of this generation, are fixed as well. A coarse function
/// that is zero at fixed vertices would not be so on the finer level else: an edge may be fixed in part.
fn fixed_come_from_fixed(free: &[bool], genealogy: &Genealogy, generation: usize, vertices: &[u32]) -> bool {
    let is_fixed = |&a: &u32| !free[a as usize];
    let is_well = |a: &u32| {
        !is_fixed(a)
            || genealogy.is_on_level(*a, generation)
            || genealogy.parents(*a).vertices().iter().all(is_fixed)
    };
    vertices.par_iter().with_min_len(BLOCK).all(is_well)
}

/// From the vertices of a generation, which have these numbers, to those of the one before, in the order of its rows.
fn transfer(
    genealogy: &Genealogy,
    generation: usize,
    of_row: &[u32],
    coarse_rows: usize,
    number: &[u32],
) -> Transfer {
    let mean = |&a: &u32| {
        let is_kept = genealogy.is_on_level(a, generation);
        let vertices = if is_kept { Mean::of_one(a) } else { genealogy.parents(a) };
        vertices.renumbered(number)
    };
    let means: Vec<Mean> = of_row.par_iter().with_min_len(BLOCK).map(mean).collect();
    Transfer::from_means(coarse_rows, &means)
}

/// Makes algebraic levels until few unknowns are left.
fn coarsen(finest_first: &mut Vec<Level>) {
    let unknowns = |levels: &[Level]| levels[levels.len() - 1].unknowns();
    while unknowns(finest_first) > DIRECT {
        let coarsest = &finest_first[finest_first.len() - 1];
        let before = coarsest.unknowns();
        let transfer = coarsened(&coarsest.pattern, &coarsest.values);
        if descend(finest_first, transfer).is_none()
            || unknowns(finest_first) as f64 > SLOW_COARSENING * before as f64
        {
            return;
        }
    }
}

/// The largest distance of two neighbours that are in these places.
fn bandwidth(k: &StiffnessMatrix, place: impl Fn(usize) -> usize + Sync) -> usize {
    let reach = |a: usize| {
        let row = &k.indices()[k.indptr().outer_inds_sz(a)];
        row.iter().map(|&b| place(a).abs_diff(place(b as usize))).max().unwrap_or(0)
    };
    (0..k.rows()).into_par_iter().with_min_len(BLOCK).map(reach).max().unwrap_or(0)
}

/// Windows and colours of the finest level, and the vertices of its rows; `order` is the order that the windows follow.
fn finest_coloring(k: &StiffnessMatrix, free: &[bool], order: Option<&[u32]>) -> (Coloring, Vec<u32>) {
    let position = order.map(inverse);
    let vertex = |i: usize| order.map_or(i, |order| order[i] as usize);
    let row = |a: usize| row_of(k, a);
    let place = |b: usize| position.as_ref().map_or(b, |position| position[b] as usize);
    let coupled = |i: usize| {
        let a = vertex(i);
        let diagonal = row(a).find(|&(b, _)| b == a).map_or(0.0, |(_, value)| value);
        let is_free = free[a];
        let entries =
            row(a).filter(move |&(b, value)| is_free && b != a && value.abs() > UNCOUPLED * diagonal);
        entries.filter(|&(b, _)| free[b]).map(|(b, _)| place(b))
    };
    let (coloring, rows) = Coloring::new(k.rows(), bandwidth(k, place), coupled);
    (coloring, composed(order, rows))
}

/// Makes the level below the last one, unless nothing is left to solve for there. Returns the order of its rows.
fn descend(finest_first: &mut Vec<Level>, transfer: Transfer) -> Option<Vec<u32>> {
    let fine = finest_first.last_mut().expect("there is a finest level");
    let held = |a: usize| fine.is_held(transfer.same_vertex(a));
    if (0..transfer.coarse_rows()).all(held) {
        return None;
    }
    let (pattern, values) = galerkin((&fine.pattern, &fine.values), &transfer, held);
    let (coarse, rows) = Level::colored(pattern, values);
    fine.transfer = transfer.with_coarse_order(&rows, &inverse(&rows));
    finest_first.push(coarse);
    Some(rows)
}

impl Level {
    /// Orders the rows of a matrix by windows and colours: a level without its transfer, and the rows in their new order.
    fn colored(pattern: Pattern, values: Values) -> (Self, Vec<u32>) {
        let coupled = |i: usize| {
            let entries = pattern.row(i).iter().zip(&values.off_diagonal[pattern.range(i)]);
            let threshold = UNCOUPLED * values.diagonal[i];
            let coupled = entries.filter(move |(_, a)| a.abs() > threshold).map(|(&j, _)| j as usize);
            coupled.filter(|&j| values.diagonal[j] != 0.0)
        };
        let (coloring, rows) = Coloring::new(pattern.rows(), pattern.bandwidth(), coupled);
        let (pattern, values) = reordered((&pattern, &values), &rows, &inverse(&rows));
        (Self::new(pattern, values, coloring, SAME_ENTRY), rows)
    }

    /// A level without its transfer, its rows ordered by windows and colours; rows share stencils whose entries are the same up
    /// to a fraction `same_entry` of the diagonal.
    fn new(pattern: Pattern, mut values: Values, coloring: Coloring, same_entry: f64) -> Self {
        let (runs, shared) = Runs::new(&coloring, &pattern, &values, same_entry);
        values.replaced = vec![false; shared.len()];
        values.shared = shared;
        Self { pattern, values, coloring, runs, transfer: Transfer::default() }
    }

    /// Whether a vertex is fixed, or in no triangle.
    #[inline(always)]
    pub(crate) fn is_held(&self, i: usize) -> bool {
        self.values.diagonal[i] == 0.0
    }

    /// Vertices that are not held.
    pub(crate) fn unknowns(&self) -> usize {
        self.values.diagonal.iter().filter(|&&diagonal| diagonal != 0.0).count()
    }

    /// `b - K_IB g`; zero at held vertices.
    fn lift(&self, load: &mut [f64], height: &[f64]) {
        for (i, load) in load.iter_mut().enumerate() {
            if self.is_held(i) {
                *load = 0.0;
                continue;
            }
            for (&j, a) in self.pattern.row(i).iter().zip(&self.values.off_diagonal[self.pattern.range(i)]) {
                if self.is_held(j as usize) {
                    *load -= a * height[j as usize];
                }
            }
        }
    }
}

/// The vertices of the rows, when these are numbers in an order of the vertices.
fn composed(order: Option<&[u32]>, rows: Vec<u32>) -> Vec<u32> {
    match order {
        Some(order) => rows.into_iter().map(|row| order[row as usize]).collect(),
        None => rows,
    }
}
