//! Levels inside the triangles of a coarse mesh that has been refined uniformly.
//!
//! Such a triangle is a *patch*: it becomes a lattice, whose points have one stencil. Of the finest levels nothing is stored but
//! the vectors, and eight patches are worked on at once; only along the edges of the coarse mesh are there lists of numbers. Below
//! 16 segments the sides of the patches outweigh their insides: there are the levels of a [`Hierarchy`], whose rows are stored.
//!
//! Compare Bergen, Hülsemann, *Hierarchical hybrid grids*, Numer. Linear Algebra Appl. 11 (2004) 279.

mod field;
mod finest;
mod grid;
mod lanes;
mod levels;
mod matrix;
mod relaxation;
mod solve;
mod stencils;
#[cfg(test)]
mod tests;
mod transfer;

pub(crate) use solve::solve;

use std::sync::Arc;

use sprs::TriMatI;

use self::grid::{Grid, Lattice, Numbers, Partition};
use self::lanes::LANES;
use self::matrix::{Entries, Galerkin, Matrix, Stencil};
use self::stencils::{is_assembled, stencils};
use crate::fem::StiffnessMatrix;
use crate::mesh::{Mesh, Parents};
use crate::multigrid::hierarchy::{Genealogy, Hierarchy};

/// Refinements of the patches on the coarsest level that is worked on patch by patch; its rows are those of the level below.
const STORED: usize = 3;

/// Refinements of the patches at most. Then two vectors over a group are half a megabyte, and stay in the cache of a core.
const MOST: usize = 6;

/// And at least: with 16 segments to a side, stored rows are as fast.
const FEWEST_REFINEMENTS: usize = 5;

/// Fewer patches are cut up once more: they would leave lanes empty.
const FEWEST_PATCHES: usize = 4 * LANES;

/// The levels of a discretization whose mesh has patches.
pub(crate) struct Patches {
    /// From the coarsest, which repeats the finest of the stored levels.
    grids: Vec<Grid>,
    stencils: Vec<[Stencil; LANES]>,
    /// From each grid but the first to the one below.
    galerkin: Vec<Galerkin>,
    /// The vertices of the mesh on the finest grid.
    vertices: Numbers,
    /// And at its interface.
    at_interface: Vec<u32>,
    stored: Hierarchy,
    /// The rows of the finest stored level on the coarsest grid.
    rows: Numbers,
    refinements: usize,
    /// Which vertices of the mesh have an unknown.
    is_free: Vec<bool>,
}

impl Patches {
    /// Finds them in a mesh, for a matrix over its vertices, those with an unknown being `free`; `None` where it has none, or few, or
    /// they have no common stencil: where the tension changes inside a patch, or vertices have been moved to a curve.
    pub(crate) fn new(mesh: &Mesh, k: &StiffnessMatrix, free: &[bool]) -> Option<Self> {
        Self::of_size(FEWEST_PATCHES, FEWEST_REFINEMENTS, mesh, k, free)
    }

    /// Likewise, at least so many, refined so many times.
    pub(crate) fn of_size(
        patches: usize,
        refinements: usize,
        mesh: &Mesh,
        k: &StiffnessMatrix,
        free: &[bool],
    ) -> Option<Self> {
        let ancestry = mesh.ancestry();
        let are_enough = |depth: &usize| mesh.triangles().len() >> (2 * depth) >= patches;
        let depth = (refinements..=MOST.min(ancestry.len())).rev().find(are_enough)?;
        let (older, refinements) = ancestry.split_at(ancestry.len() - depth);
        let triangles = coarsest(mesh, refinements)?;
        let partition = Arc::new(Partition::new(refinements[0].coarse_vertices(), &triangles));

        let mut numbers = Numbers::of_corners(&partition);
        let mut coarsest_numbers = None;
        for (level, refinement) in refinements.iter().enumerate() {
            let [coarse, fine] = [level, level + 1].map(|k| Lattice::new(1 << k));
            numbers = numbers.refined(&coarse, &fine, refinement)?;
            if level + 1 == STORED {
                coarsest_numbers = Some(numbers.clone());
            }
        }
        let stencils = stencils(&partition, &Lattice::new(1 << depth), &numbers, k, free)?;
        let mut grids: Vec<Grid> = (STORED..=depth).map(|k| Grid::new(&partition, 1 << k)).collect();
        hold(&mut grids, &numbers, free)?;
        let (rows, stored) = stored_levels(
            &grids[0],
            &stencils,
            coarsest_numbers?,
            [older, &refinements[..STORED]].concat().as_slice(),
        );
        let patches = Self {
            galerkin: grids[1..].iter().map(|grid| Galerkin::new(&grid.lattice)).collect(),
            at_interface: numbers_of_interface(&grids[grids.len() - 1], &numbers),
            grids,
            stencils,
            vertices: numbers,
            stored,
            rows,
            refinements: depth,
            is_free: free.to_vec(),
        };
        let matrix = Matrix::new(patches.finest_grid(), &patches.stencils, 1.0);
        is_assembled(&matrix, patches.finest_grid(), &patches.at_interface, k, free).then_some(patches)
    }

    /// How many levels follow the refinements that made the mesh.
    pub(crate) fn refinements(&self) -> usize {
        self.refinements - STORED + self.stored.refinements()
    }

    /// The number of the finest grid.
    fn finest(&self) -> usize {
        self.grids.len() - 1
    }

    fn finest_grid(&self) -> &Grid {
        &self.grids[self.finest()]
    }

    /// The largest of the couplings.
    fn largest_coupling(&self) -> f64 {
        self.stencils.iter().flatten().flatten().fold(f64::MIN_POSITIVE, |largest, c| largest.max(c.abs()))
    }

    /// The entries of the finest stored level, where those of some groups are truncated: of the diagonal, and off it in the order of
    /// the pattern.
    fn stored_entries(&self, truncated: &[Option<Entries<f64>>]) -> (Vec<f64>, Vec<f64>) {
        let level = &self.stored.levels()[self.stored.finest()];
        let (lattice, partition) = (&self.grids[0].lattice, &self.grids[0].partition);
        let mut diagonal = vec![0.0; level.pattern.rows()];
        let mut off_diagonal = vec![0.0; level.values.off_diagonal.len()];
        for (g, numbers) in self.rows.0.chunks(lattice.points()).enumerate() {
            let whole;
            let entries = match &truncated[g] {
                Some(entries) => entries,
                None => {
                    whole = Entries::without(&self.stencils[g], lattice, |_| [false; LANES]);
                    &whole
                }
            };
            for (lane, _) in partition.group(g) {
                entries.for_each(lattice, numbers, lane, |i, j, value| {
                    if level.is_held(i) {
                        return;
                    }
                    if i == j {
                        diagonal[i] += value;
                    } else {
                        let place = level.pattern.row(i).iter().position(|&column| column as usize == j);
                        off_diagonal[level.pattern.range(i).start + place.expect("they are neighbours")] +=
                            value;
                    }
                });
            }
        }
        (diagonal, off_diagonal)
    }
}

/// The triangles of the coarsest of some meshes, each of which is a uniform refinement of the one before.
fn coarsest(mesh: &Mesh, refinements: &[Arc<Parents>]) -> Option<Vec<[usize; 3]>> {
    let mut triangles = std::borrow::Cow::Borrowed(mesh.triangles());
    for refinement in refinements.iter().rev() {
        let coarser = refinement.coarser(&triangles);
        if 4 * coarser.len() != triangles.len() {
            return None;
        }
        triangles = coarser.into();
    }
    Some(triangles.into_owned())
}

/// Marks what is held on all grids; `None` where a value is held on an edge without those on both sides of it: a coarse function that is
/// zero there would not be so on the finer grid.
fn hold(grids: &mut [Grid], vertices: &Numbers, free: &[bool]) -> Option<()> {
    let (finest, coarser) = grids.split_last_mut()?;
    let is_held = |&a: &u32| !Numbers::is_one(a) || !free[a as usize];
    finest.is_held = numbers_of_interface(finest, vertices).iter().map(is_held).collect();
    let mut finer: &Grid = finest;
    for grid in coarser.iter_mut().rev() {
        if !finer.is_held_between_held() {
            return None;
        }
        grid.is_held = grid.places_on(finer).map(|place| finer.is_held[place]).collect();
        finer = grid;
    }
    Some(())
}

/// The finest of the levels with stored rows, and which of its rows the points of the coarsest grid are; it has this ancestry.
fn stored_levels(
    grid: &Grid,
    stencils: &[[Stencil; LANES]],
    vertices: Numbers,
    ancestry: &[Arc<Parents>],
) -> (Numbers, Hierarchy) {
    let count = ancestry.last().map_or(0, |parents| parents.ends().len());
    let mut entries = TriMatI::<f64, u32>::new((count, count));
    let (lattice, points) = (&grid.lattice, grid.lattice.points());
    let mut free = vec![false; count];
    for (g, numbers) in vertices.0.chunks(points).enumerate() {
        let of_group = Entries::without(&stencils[g], lattice, |_| [false; LANES]);
        for (lane, _) in grid.partition.group(g) {
            of_group.for_each(lattice, numbers, lane, |i, j, value| entries.add_triplet(i, j, value));
            lattice.inside().for_each(|[i, j]| free[numbers[lattice.at(i, j)][lane] as usize] = true);
        }
        for (at, places) in grid.rim(g) {
            for (&number, &place) in
                numbers[at].iter().zip(places).filter(|&(&number, _)| Numbers::is_one(number))
            {
                free[number as usize] = !grid.is_held[place as usize];
            }
        }
    }
    let mut genealogy = Genealogy::unknown(count);
    genealogy.follow(ancestry);
    let hierarchy = Hierarchy::over(&entries.to_csr(), &free, &genealogy);
    let mut row = vec![0; count];
    (0..).zip(hierarchy.vertex()).for_each(|(i, &a)| row[a as usize] = i);
    (vertices.map(|a| row[a as usize]), hierarchy)
}

/// The vertices at the interface of a grid.
fn numbers_of_interface(grid: &Grid, vertices: &Numbers) -> Vec<u32> {
    let mut number = vec![u32::MAX; grid.interface()];
    for (g, numbers) in vertices.0.chunks(grid.lattice.points()).enumerate() {
        for (at, places) in grid.rim(g) {
            for (&vertex, &place) in numbers[at].iter().zip(places) {
                if Numbers::is_one(vertex) {
                    number[place as usize] = vertex;
                }
            }
        }
    }
    number
}
