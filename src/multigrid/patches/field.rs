//! Functions and functionals on a level of the patches.

use super::grid::{Grid, Numbers};
use super::lanes::{LANES, Lanes, Real};
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;

/// Values at the points of a level. Those of a functional on the sides of the patches count at the interface only.
#[derive(Debug, Clone)]
pub(super) struct Field<T> {
    /// At all points of the patches, group by group.
    pub(super) patches: Vec<Lanes<T>>,
    /// At the interface.
    pub(super) interface: Vec<T>,
}

impl<T: Real> Field<T> {
    pub(super) fn zero(grid: &Grid) -> Self {
        Self {
            patches: vec![Lanes::default(); grid.groups() * grid.lattice.points()],
            interface: vec![T::default(); grid.interface()],
        }
    }

    pub(super) fn fill_zero(&mut self) {
        self.patches.fill(Lanes::default());
        self.interface.fill(T::default());
    }

    /// The values by the numbers of the points.
    pub(super) fn of(grid: &Grid, numbers: &Numbers, value: impl Fn(usize) -> f64 + Sync) -> Self {
        let mut field = Self::zero(grid);
        let of_point = |&number: &u32| {
            if Numbers::is_one(number) { T::of(value(number as usize)) } else { T::default() }
        };
        let points = field.patches.par_iter_mut().zip(numbers.0.par_iter());
        points.with_min_len(BLOCK.div_ceil(LANES)).for_each(|(lanes, numbers)| {
            for (lane, number) in lanes.0.iter_mut().zip(numbers) {
                *lane = of_point(number);
            }
        });
        for (g, patches) in field.patches.chunks(grid.lattice.points()).enumerate() {
            grid.give_rim(g, patches, &mut field.interface);
        }
        field
    }

    /// Calls `put` with the number of each point and the value there.
    pub(super) fn for_each(&self, grid: &Grid, numbers: &Numbers, mut put: impl FnMut(usize, f64)) {
        let points = grid.lattice.points();
        for g in 0..grid.groups() {
            let numbers = &numbers.0[g * points..][..points];
            for [i, j] in grid.lattice.inside() {
                let at = grid.lattice.at(i, j);
                let values = self.patches[g * points + at];
                for (&number, value) in numbers[at].iter().zip(values.0) {
                    if Numbers::is_one(number) {
                        put(number as usize, value.to_f64());
                    }
                }
            }
            for (at, places) in grid.rim(g) {
                for (&number, &place) in numbers[at].iter().zip(places) {
                    if Numbers::is_one(number) {
                        put(number as usize, self.interface[place as usize].to_f64());
                    }
                }
            }
        }
    }

    /// Gives the values at the interface to all patches.
    pub(super) fn gather(&mut self, grid: &Grid) {
        for (g, patches) in self.patches.chunks_mut(grid.lattice.points()).enumerate() {
            grid.gather(g, &self.interface, patches);
        }
    }

    /// The points of a group.
    #[inline(always)]
    pub(super) fn group(&self, grid: &Grid, g: usize) -> &[Lanes<T>] {
        let points = grid.lattice.points();
        &self.patches[g * points..][..points]
    }

    #[inline(always)]
    pub(super) fn group_mut(&mut self, grid: &Grid, g: usize) -> &mut [Lanes<T>] {
        let points = grid.lattice.points();
        &mut self.patches[g * points..][..points]
    }
}

impl Field<f64> {
    /// The sum of the products at all points, each once.
    pub(super) fn dot(&self, grid: &Grid, other: &Self) -> f64 {
        let mut sum = 0.0;
        for g in 0..grid.groups() {
            let (x, y) = (self.group(grid, g), other.group(grid, g));
            for [i, j] in grid.lattice.inside() {
                let at = grid.lattice.at(i, j);
                sum += (x[at] * y[at]).0.iter().sum::<f64>();
            }
        }
        sum + self.interface.iter().zip(&other.interface).map(|(x, y)| x * y).sum::<f64>()
    }

    /// Combined with another one, value by value.
    pub(super) fn zip_with(&self, other: &Self, combine: impl Fn(f64, f64) -> f64) -> Self {
        let lanes = |(x, y): (&Lanes<f64>, &Lanes<f64>)| {
            Lanes(std::array::from_fn(|lane| combine(x.0[lane], y.0[lane])))
        };
        Self {
            patches: self.patches.iter().zip(&other.patches).map(lanes).collect(),
            interface: self.interface.iter().zip(&other.interface).map(|(x, y)| combine(*x, *y)).collect(),
        }
    }
}

/// What the patches have for the points on their sides.
#[derive(Debug)]
pub(super) struct Inflow<T> {
    /// Group by group.
    pub(super) sides: Vec<Lanes<T>>,
    /// Summed up over the patches that meet.
    pub(super) interface: Vec<T>,
}

impl<T: Real> Inflow<T> {
    pub(super) fn new(grid: &Grid) -> Self {
        Self {
            sides: vec![Lanes::default(); grid.groups() * grid.on_sides()],
            interface: vec![T::default(); grid.interface()],
        }
    }

    pub(super) fn sum_up(&mut self, grid: &Grid) {
        self.interface.fill(T::default());
        grid.add_sides(&self.sides, &mut self.interface);
    }
}
