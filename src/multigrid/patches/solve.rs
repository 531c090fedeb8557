//! One half of the decoupled problem on patches: the method of [`half`], where the finest levels are lattices.
//!
//! A matrix that has been assembled differs from the stencils by the rounding of the vertices. What decides is the assembled one: if its
//! residual is not within the tolerance yet, what it differs by is put on the side of the load, and the cycles go on.

use super::Patches;
use super::field::{Field, Inflow};
use super::finest::{Frozen, Iterate, Problem, Weight};
use super::grid::{Grid, Numbers};
use super::lanes::{LANES, Lanes};
use super::levels::Coarser;
use super::matrix::Matrix;
use super::transfer::{prolong_inside, prolong_interface, restrict_inside, restrict_interface};
use crate::fem::{StiffnessMatrix, row_of};
use crate::multigrid::cholesky::NotFactored;
use crate::multigrid::driver::{self, Cycle, Damped};
use crate::multigrid::half::{self, COARSE_CYCLES, HalfProblem, HalfSolution, MAX_CYCLES};
use crate::multigrid::sweep::{Found, ROUNDING, larger};
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;
use crate::qp::{Limits, Status};

/// How often the load takes what the assembled matrix differs by: each time the difference that is left falls by 1e-10 or so.
const REFINEMENTS: usize = 2;

/// Solves for a matrix and vectors over the vertices of the mesh.
pub(crate) fn solve(
    patches: &Patches,
    k: &StiffnessMatrix,
    problem: HalfProblem,
    limits: &Limits,
) -> Result<HalfSolution, NotFactored> {
    Solve::new(patches, k, problem)?.run(limits)
}

struct Solve<'p> {
    patches: &'p Patches,
    k: &'p StiffnessMatrix,
    problem: HalfProblem,
    /// The load on all grids.
    loads: Vec<Field<f64>>,
    /// The heights at the interface of all grids.
    heights: Vec<Vec<f64>>,
    coarser: Coarser<'p>,
}

impl<'p> Solve<'p> {
    fn new(patches: &'p Patches, k: &'p StiffnessMatrix, problem: HalfProblem) -> Result<Self, NotFactored> {
        let finest = patches.finest_grid();
        let height = |&a: &u32| if Numbers::is_one(a) { problem.height[a as usize] } else { 0.0 };
        let mut loads = vec![Field::of(finest, &patches.vertices, |a| problem.load[a])];
        let mut heights: Vec<Vec<f64>> = vec![patches.at_interface.iter().map(height).collect()];
        for (coarse, fine) in patches.grids.iter().zip(&patches.grids[1..]).rev() {
            let (load, height) = (&loads[loads.len() - 1], &heights[heights.len() - 1]);
            let injected = coarse.places_on(fine).map(|place| height[place]).collect();
            loads.push(restricted([coarse, fine], load));
            heights.push(injected);
        }
        loads.reverse();
        heights.reverse();
        let size = |values: &[f64]| values.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
        let load = size(&problem.load) + patches.largest_coupling() * size(&problem.height);
        let coarser = Coarser::new(patches, problem.lower.is_finite(), load)?;
        Ok(Self { patches, k, problem, loads, heights, coarser })
    }

    fn run(mut self, limits: &Limits) -> Result<HalfSolution, NotFactored> {
        let finest = self.patches.finest();
        let mut cycles = Vec::new();
        let x = match self.problem.start.take() {
            Some(start) => {
                let at = |a: usize| larger(start[a], self.problem.lower);
                let start = Field::of(self.patches.finest_grid(), &self.patches.vertices, at);
                self.with_heights(finest, start)
            }
            None => self.nested(limits, &mut cycles)?,
        };
        let mut found = self.cycles(finest, x, limits)?;
        let mut spent = found.history.len() - 1;
        let mut assembled = self.assembled(&found.x);
        for _ in 0..REFINEMENTS {
            if found.status != Status::Solved || assembled.violation <= 1.0 {
                break;
            }
            self.refine_load(&found.x, &assembled.residual);
            found = self.cycles(finest, found.x, &limits.after(spent))?;
            spent += found.history.len() - 1;
            assembled = self.assembled(&found.x);
        }
        if found.status == Status::Solved && assembled.violation > 1.0 {
            found.status = Status::Stalled;
        }
        cycles.push(spent);
        Ok(HalfSolution {
            y: self.multiplier(&assembled),
            x: assembled.x,
            status: found.status,
            cycles,
            energies: found.history.iter().map(|found| found.energy).collect(),
        })
    }

    /// A first guess on the finest grid, from the coarsest of the stored levels on; the cycles on each level are noted.
    fn nested(&mut self, limits: &Limits, cycles: &mut Vec<usize>) -> Result<Field<f64>, NotFactored> {
        let Patches { grids, stored, rows, .. } = self.patches;
        let limits = limits.with_iterations(COARSE_CYCLES);
        let count = stored.vertex().len();
        let mut problem = HalfProblem {
            load: vec![0.0; count],
            height: vec![0.0; count],
            lower: self.problem.lower,
            weight: vec![1.0; count],
            tolerance: 0.0,
            start: None,
        };
        self.loads[0].for_each(&grids[0], rows, |row, load| problem.load[row] = load);
        let heights = self.with_heights(0, Field::zero(&grids[0]));
        heights.for_each(&grids[0], rows, |row, height| problem.height[row] = height);
        let found = half::solve(stored, problem, &limits)?;
        cycles.extend(found.cycles);
        let mut x = self.with_heights(0, Field::of(&grids[0], rows, |row| found.x[row]));
        for l in 1..grids.len() {
            x = self.with_heights(l, prolonged([&grids[l - 1], &grids[l]], &mut x, self.problem.lower));
            if l < self.patches.finest() {
                let found = self.cycles(l, x, &limits)?;
                cycles.push(found.history.len() - 1);
                x = found.x;
            }
        }
        Ok(x)
    }

    /// With the heights where a value is held.
    fn with_heights(&self, l: usize, mut x: Field<f64>) -> Field<f64> {
        let held = self.patches.grids[l].is_held.iter().zip(&self.heights[l]);
        for (x, (_, height)) in x.interface.iter_mut().zip(held).filter(|(_, (is_held, _))| **is_held) {
            *x = *height;
        }
        x
    }

    /// Cycles whose finest level is this one.
    fn cycles(&mut self, l: usize, x: Field<f64>, limits: &Limits) -> Result<Cycled, NotFactored> {
        let Self { patches, problem, loads, coarser, .. } = self;
        let grid = &patches.grids[l];
        let is_finest = l == patches.finest();
        let is_bounded = problem.lower.is_finite();
        coarser.restart(l)?;
        let problem = Problem {
            grid,
            matrix: Matrix::new(grid, &patches.stencils, 1.0),
            b: &loads[l],
            is_bounded,
            weight: if is_finest { patches.weight(&problem.weight) } else { Weight::one(grid) },
            tolerance: if is_finest { problem.tolerance } else { 0.0 },
        };
        let iterate = Iterate { x, frozen: Frozen::nothing(grid) };
        Cycles {
            finest: l,
            last: iterate.clone(),
            iterate,
            inflow: Inflow::new(grid),
            changed: Vec::new(),
            problem,
            coarser,
        }
        .run(limits)
    }

    /// What an iterate is by the assembled matrix.
    fn assembled(&self, x: &Field<f64>) -> Assembled {
        let Self { patches, problem, .. } = self;
        let mut over_vertices = vec![0.0; patches.is_free.len()];
        x.for_each(patches.finest_grid(), &patches.vertices, |a, value| over_vertices[a] = value);
        let x = over_vertices;
        let row = |a: usize| {
            if !patches.is_free[a] {
                return (0.0, 0.0);
            }
            let (mut product, mut diagonal) = (0.0, 0.0);
            for (b, entry) in row_of(self.k, a) {
                product += entry * x[b];
                if a == b {
                    diagonal = entry;
                }
            }
            let residual = problem.load[a] - product;
            let is_free = x[a] > problem.lower;
            let defect = if is_free { residual.abs() - ROUNDING * diagonal * x[a].abs() } else { residual };
            (residual, defect * problem.weight[a])
        };
        let rows = (0..x.len()).into_par_iter().with_min_len(BLOCK);
        let rows: Vec<(f64, f64)> = rows.map(row).collect();
        let violation =
            rows.iter().fold(
                0.0,
                |worst: f64, &(_, defect)| {
                    if defect.is_nan() { f64::INFINITY } else { worst.max(defect) }
                },
            );
        let residual = rows.into_iter().map(|(residual, _)| residual).collect();
        Assembled { x, residual, violation }
    }

    /// `max(0, K x - b)` where `x` is at its bound, zero elsewhere.
    fn multiplier(&self, Assembled { x, residual, .. }: &Assembled) -> Vec<f64> {
        let at = |(x, r): (&f64, &f64)| if *x <= self.problem.lower { larger(-r, 0.0) } else { 0.0 };
        x.iter().zip(residual).map(at).collect()
    }

    /// Puts what the assembled matrix differs by on the side of the load.
    fn refine_load(&mut self, x: &Field<f64>, residual: &[f64]) {
        let patches = self.patches;
        let grid = patches.finest_grid();
        let load = &self.loads[patches.finest()];
        let by_stencils = Matrix::new(grid, &patches.stencils, 1.0).residual(grid, x, load);
        let by_rows = Field::of(grid, &patches.vertices, |a| residual[a]);
        let difference = by_rows.zip_with(&by_stencils, |rows, stencils| rows - stencils);
        let refined = load.zip_with(&difference, |load, difference| load + difference);
        self.loads[patches.finest()] = refined;
    }
}

impl Patches {
    /// The weights on the finest grid.
    fn weight(&self, over_vertices: &[f64]) -> Weight {
        let grid = self.finest_grid();
        let (points, inside) = (grid.lattice.points(), grid.lattice.at(1, 1));
        let weight = |number: u32| if Numbers::is_one(number) { over_vertices[number as usize] } else { 0.0 };
        let of_group = |numbers: &[[u32; LANES]]| Lanes(numbers[inside].map(weight));
        Weight {
            inside: self.vertices.0.chunks(points).map(of_group).collect(),
            interface: self.at_interface.iter().copied().map(weight).collect(),
        }
    }
}

impl Weight {
    fn one(grid: &Grid) -> Self {
        Self { inside: vec![Lanes::all(1.0); grid.groups()], interface: vec![1.0; grid.interface()] }
    }
}

/// What the assembled matrix makes of an iterate.
struct Assembled {
    x: Vec<f64>,
    /// `b - K x`, zero where a value is held.
    residual: Vec<f64>,
    /// The largest weighted residual of the optimality conditions.
    violation: f64,
}

/// What comes of cycles.
struct Cycled {
    x: Field<f64>,
    status: Status,
    history: Vec<Found>,
}

/// The cycles whose finest level is this one.
struct Cycles<'c, 'p> {
    finest: usize,
    problem: Problem<'c>,
    coarser: &'c mut Coarser<'p>,
    iterate: Iterate,
    /// The iterate before.
    last: Iterate,
    inflow: Inflow<f64>,
    /// The groups in which the frozen points have changed.
    changed: Vec<usize>,
}

impl Cycles<'_, '_> {
    /// Until the weighted residual is within the tolerance and the contact set stays.
    fn run(mut self, limits: &Limits) -> Result<Cycled, NotFactored> {
        let (tolerance, first) = (self.problem.tolerance, self.relax(false));
        let (status, history) = driver::run(&mut self, first, tolerance, MAX_CYCLES, limits)?;
        Ok(Cycled { x: self.iterate.x, status, history })
    }
}

impl Damped for Cycles<'_, '_> {
    fn relax(&mut self, is_corrected: bool) -> Found {
        std::mem::swap(&mut self.iterate, &mut self.last);
        let Self { problem, coarser, iterate, last, inflow, .. } = self;
        let below = &mut coarser.below(self.finest);
        let found = problem.correct_and_relax(last, is_corrected, iterate, below, inflow);
        if problem.is_bounded {
            self.changed = iterate.frozen.changed_groups(problem.grid, &last.frozen);
        }
        found
    }

    fn energy_change(&self) -> f64 {
        self.problem.energy_change(&self.last.x, &self.iterate.x)
    }

    fn damp(&mut self) {
        std::mem::swap(&mut self.iterate, &mut self.last);
        self.problem.line_search(&mut self.iterate, &mut self.coarser.below(self.finest));
    }
}

impl Cycle for Cycles<'_, '_> {
    fn cycle(&mut self, energy: f64) -> Result<Found, NotFactored> {
        if self.problem.is_bounded {
            self.coarser.truncate(self.finest, &self.iterate.frozen, &self.changed)?;
        }
        self.coarser.solve(self.finest, self.problem.is_bounded, self.has_changed())?;
        Ok(self.correct(energy))
    }

    fn has_changed(&self) -> bool {
        !self.changed.is_empty()
    }
}

/// `P' f` from one grid to the one below.
fn restricted(grids: [&Grid; 2], f: &Field<f64>) -> Field<f64> {
    let mut coarse = Field::zero(grids[0]);
    let mut sides = vec![Lanes::default(); grids[0].groups() * grids[0].on_sides()];
    let of_groups = sides.chunks_mut(grids[0].on_sides()).enumerate();
    for (g, on_sides) in of_groups {
        restrict_inside(grids, f.group(grids[1], g), 1.0, coarse.group_mut(grids[0], g), on_sides);
    }
    grids[0].add_sides(&sides, &mut coarse.interface);
    restrict_interface(grids, &f.interface, 1.0, &mut coarse);
    coarse
}

/// A function on the next grid, not below the bound.
fn prolonged(grids: [&Grid; 2], x: &mut Field<f64>, lower: f64) -> Field<f64> {
    let mut fine = Field::zero(grids[1]);
    prolong_interface(grids, &x.interface, |a, value| fine.interface[a] = larger(value, lower));
    x.gather(grids[0]);
    for g in 0..grids[1].groups() {
        let points = fine.group_mut(grids[1], g);
        prolong_inside(grids, x.group(grids[0], g), |at, value| {
            points[at] = Lanes(value.0.map(|value| larger(value, lower)))
        });
    }
    fine
}
