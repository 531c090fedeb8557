//! The levels below a finest one: lattices in single precision, and below them stored rows.

use super::Patches;
use super::field::{Field, Inflow};
use super::finest::{Below, Frozen};
use super::lanes::{LANES, Lanes};
use super::matrix::{Entries, Matrix, Truncated};
use super::transfer::{prolong_inside, prolong_interface, restrict_inside, restrict_interface};
use crate::multigrid::cholesky::NotFactored;
use crate::multigrid::correction::{CoarseLevels, twice_up_to, visits};
use crate::parallel::prelude::*;

/// The levels below a finest one, with their vectors.
///
/// Single precision is enough for a correction. It has few powers of ten, so that matrices are divided by the largest coupling, and
/// functionals by the size of the load.
pub(super) struct Coarser<'p> {
    patches: &'p Patches,
    levels: Vec<Level>,
    /// On the coarsest of the levels, whose rows are stored.
    stored: CoarseLevels<'p>,
    /// The entries of the groups that are truncated there.
    truncated: Vec<Option<Entries<f64>>>,
    /// The unit of functionals, and that of corrections.
    units: [f64; 2],
}

/// The rows of a group on each lattice, and its entries below.
type TruncatedEntries = (Vec<Option<Box<Truncated<f32>>>>, Option<Entries<f64>>);

struct Level {
    /// `None` where rows are stored.
    matrix: Option<Matrix<f32>>,
    x: Field<f32>,
    b: Field<f32>,
    inflow: Inflow<f32>,
}

impl<'p> Coarser<'p> {
    /// All levels below the finest of the patches; with an `obstacle` they can be truncated. The load has this size.
    pub(super) fn new(patches: &'p Patches, obstacle: bool, load: f64) -> Result<Self, NotFactored> {
        let largest = patches.largest_coupling();
        let load = if load > 0.0 && load.is_finite() { load } else { 1.0 };
        let levels = patches.grids[..patches.finest()].iter().enumerate().map(|(l, grid)| Level {
            matrix: (l > 0).then(|| Matrix::new(grid, &patches.stencils, 1.0 / largest)),
            x: Field::zero(grid),
            b: Field::zero(grid),
            inflow: Inflow::new(grid),
        });
        Ok(Self {
            patches,
            levels: levels.collect(),
            stored: CoarseLevels::new(&patches.stored, patches.stored.finest() + 1, obstacle)?,
            truncated: patches.stencils.iter().map(|_| None).collect(),
            units: [load, load / largest],
        })
    }

    /// Another level becomes the finest one, with nothing in contact yet.
    pub(super) fn restart(&mut self, finest: usize) -> Result<(), NotFactored> {
        for (level, grid) in self.levels[..finest].iter_mut().zip(&self.patches.grids) {
            if let Some(matrix) = &mut level.matrix {
                matrix.restore(grid);
            }
        }
        self.truncated.fill(None);
        self.stored.restart(self.patches.stored.finest() + 1)
    }

    /// The level below `finest`, with its correction, and for its functional.
    pub(super) fn below(&mut self, finest: usize) -> Below<'_> {
        let Level { x, b, inflow, .. } = &mut self.levels[finest - 1];
        let [b_unit, x_unit] = self.units;
        Below { grid: &self.patches.grids[finest - 1], x, b, inflow, x_unit, b_unit }
    }

    /// Cuts off the hat functions below the level `finest` where it is frozen, in the groups that have changed.
    pub(super) fn truncate(
        &mut self,
        finest: usize,
        frozen: &Frozen,
        changed: &[usize],
    ) -> Result<(), NotFactored> {
        if changed.is_empty() {
            return Ok(());
        }
        let points = self.patches.grids[finest].lattice.points();
        let entries = |&g: &usize| self.truncated_entries(finest, g, &frozen.patches[g * points..][..points]);
        let of_groups: Vec<_> = changed.par_iter().map(entries).collect();
        for (&g, (rows, entries)) in changed.iter().zip(of_groups) {
            for (level, rows) in self.levels[1..finest].iter_mut().zip(rows) {
                level.matrix.as_mut().expect("a lattice has a matrix").truncated[g] = rows;
            }
            self.truncated[g] = entries;
        }
        for (level, grid) in self.levels[..finest].iter_mut().zip(&self.patches.grids) {
            if let Some(matrix) = &mut level.matrix {
                matrix.assemble_interface(grid);
            }
        }
        let (diagonal, off_diagonal) = self.patches.stored_entries(&self.truncated);
        self.stored.replace(&diagonal, &off_diagonal)
    }

    /// The rows of a group on the lattices below `finest`, from the coarsest, and the entries on the level of the stored rows; nothing where
    /// nothing is frozen.
    fn truncated_entries(&self, finest: usize, g: usize, frozen: &[[bool; LANES]]) -> TruncatedEntries {
        let Patches { grids, stencils, galerkin, .. } = self.patches;
        if frozen.iter().all(|lanes| lanes == &[false; LANES]) {
            return ((1..finest).map(|_| None).collect(), None);
        }
        let mut entries = Entries::without(&stencils[g], &grids[finest].lattice, |at| frozen[at]);
        let mut rows = Vec::new();
        for l in (0..finest).rev() {
            entries = galerkin[l].apply(&entries);
            entries.clean(&stencils[g]);
            if l > 0 {
                rows.push(Some(Box::new(Truncated::new(&entries, self.scale()))));
            }
        }
        rows.reverse();
        (rows, Some(entries))
    }

    /// The factor of the matrices.
    pub(super) fn scale(&self) -> f64 {
        self.units[1] / self.units[0]
    }

    /// One cycle below the level `finest` for its functional. Smooth errors have to be smaller where the contact set has changed.
    pub(super) fn solve(
        &mut self,
        finest: usize,
        obstacle: bool,
        has_changed: bool,
    ) -> Result<(), NotFactored> {
        let of_stored = self.patches.stored.levels().iter().map(|level| level.pattern.rows());
        let of_grids = self.patches.grids[1..=finest].iter().map(|grid| grid.vertices());
        let rows: Vec<usize> = of_stored.chain(of_grids).collect();
        let twice = if obstacle { twice_up_to(rows.len() - 1, has_changed) } else { 0 };
        self.cycle(finest - 1, &visits(&rows, twice))
    }

    fn cycle(&mut self, l: usize, visits: &[usize]) -> Result<(), NotFactored> {
        let stored = self.patches.stored.finest();
        if l == 0 {
            return self.cycle_on_stored(&visits[..=stored]);
        }
        self.descend(l);
        self.cycle(l - 1, visits)?;
        if visits[stored + l - 1] > visits[stored + l] {
            self.ascend(l, true);
            self.cycle(l - 1, visits)?;
        }
        self.ascend(l, false);
        Ok(())
    }

    fn cycle_on_stored(&mut self, visits: &[usize]) -> Result<(), NotFactored> {
        let Patches { grids, rows, .. } = self.patches;
        let [b_unit, x_unit] = self.units;
        let Level { x, b, .. } = &mut self.levels[0];
        let functional = self.stored.functional(visits.len() - 1);
        b.for_each(&grids[0], rows, |row, value| functional[row] = b_unit * value);
        let correction = self.stored.cycle(visits.len() - 1, visits)?;
        *x = Field::of(&grids[0], rows, |row| correction[row] / x_unit);
        Ok(())
    }

    /// From zero to the functional on the level below.
    fn descend(&mut self, l: usize) {
        self.levels[l].x.fill_zero();
        self.relax_and_restrict(l, false, true);
    }

    /// The correction from the level below, and with `again` the functional for another one.
    fn ascend(&mut self, l: usize, again: bool) {
        let grids = [&self.patches.grids[l - 1], &self.patches.grids[l]];
        let (below, above) = self.levels.split_at_mut(l);
        let Level { matrix, x, .. } = &mut above[0];
        let matrix = matrix.as_ref().expect("a lattice has a matrix");
        prolong_interface(grids, &below[l - 1].x.interface, |a, correction| {
            if matrix.inverse[a] != 0.0 {
                x.interface[a] += correction;
            }
        });
        self.relax_and_restrict(l, true, again);
    }

    /// Sweeps; before them the correction from the level below inside the patches, after them the functional for it.
    fn relax_and_restrict(&mut self, l: usize, correct: bool, restrict: bool) {
        let [coarse, grid] = [&self.patches.grids[l - 1], &self.patches.grids[l]];
        let (below, above) = self.levels.split_at_mut(l);
        let (below, level) = (&mut below[l - 1], &mut above[0]);
        let Level { matrix, x, b, inflow } = level;
        let matrix = matrix.as_ref().expect("a lattice has a matrix");
        if correct {
            below.x.gather(coarse);
        }
        matrix.smooth::<false>(grid, x, b, inflow, |g, x| {
            let correction = below.x.group(coarse, g);
            match matrix.truncated[g].as_deref() {
                _ if !correct => {}
                None => prolong_inside([coarse, grid], correction, |at, c| x[at] = x[at] + c),
                Some(rows) => {
                    prolong_inside([coarse, grid], correction, |at, c| x[at] = rows.corrected(at, x[at], c));
                }
            }
            0
        });
        if !restrict {
            return;
        }
        let [points, coarse_points] = [grid, coarse].map(|grid| grid.lattice.points());
        let groups = x.patches.par_chunks_mut(points).zip(inflow.sides.par_chunks_mut(grid.on_sides()));
        let coarse_sides = below.inflow.sides.par_chunks_mut(coarse.on_sides());
        let groups = groups.zip(below.b.patches.par_chunks_mut(coarse_points).zip(coarse_sides)).enumerate();
        let interface = &x.interface;
        let of_group = |r: &mut Vec<Lanes<f32>>, (g, ((x, sides), (inside, on_sides)))| {
            let x: &mut [Lanes<f32>] = x;
            grid.gather(g, interface, x);
            matrix.residuals_inside(grid, g, x, b.group(grid, g), |at, value| r[at] = value);
            restrict_inside([coarse, grid], r, 1.0, inside, on_sides);
            matrix.contribute(grid, g, x, sides);
        };
        let residuals = || vec![Lanes::default(); points];
        groups.with_min_len(grid.task()).map_init(residuals, of_group).for_each(drop);
        inflow.sum_up(grid);
        below.b.interface.fill(0.0);
        coarse.add_sides(&below.inflow.sides, &mut below.b.interface);
        let mut at_interface = vec![0.0; grid.interface()];
        matrix.residuals_interface(grid, x, b, &inflow.interface, |a, r| {
            at_interface[a] = if matrix.inverse[a] == 0.0 { 0.0 } else { r };
        });
        restrict_interface([coarse, grid], &at_interface, 1.0, &mut below.b);
    }
}

#[cfg(test)]
impl Coarser<'_> {
    /// `1/2 x'A x` on one of the levels, in units of the finest matrix.
    pub(super) fn energy(&mut self, l: usize, x: &Field<f32>) -> f64 {
        let grid = &self.patches.grids[l];
        let (mut x, mut sum) = (x.clone(), 0.0);
        let Some(matrix) = &self.levels[l].matrix else {
            let mut rows = vec![0.0; self.patches.stored.vertex().len()];
            x.for_each(grid, &self.patches.rows, |row, value| rows[row] = value);
            return self.stored.energy(&rows);
        };
        let (zero, mut inflow) = (Field::zero(grid), Inflow::new(grid));
        x.gather(grid);
        for (g, sides) in inflow.sides.chunks_mut(grid.on_sides()).enumerate() {
            let points = x.group(grid, g);
            matrix.residuals_inside(grid, g, points, zero.group(grid, g), |at, r| {
                sum -= 0.5 * (r.scaled::<f64>(1.0) * points[at].scaled(1.0)).0.iter().sum::<f64>();
            });
            matrix.contribute(grid, g, points, sides);
        }
        inflow.sum_up(grid);
        matrix.residuals_interface(grid, &x, &zero, &inflow.interface, |a, r| {
            sum -= 0.5 * f64::from(r) * f64::from(x.interface[a]);
        });
        sum / self.scale()
    }
}
