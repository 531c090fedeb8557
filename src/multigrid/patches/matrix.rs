//! The matrix of a level: one stencil for each patch, and rows of their own where hat functions are cut off.

mod entries;
mod galerkin;

pub(super) use entries::{Entries, Stencil};
pub(super) use galerkin::Galerkin;

use super::grid::{Grid, add_at};
use super::lanes::{LANES, Lanes, Real};

/// A matrix on a level.
#[derive(Debug)]
pub(super) struct Matrix<T> {
    pub(super) uniform: Vec<Uniform<T>>,
    /// The groups in which hat functions are cut off.
    pub(super) truncated: Vec<Option<Box<Truncated<T>>>>,
    /// At the interface.
    pub(super) diagonal: Vec<T>,
    /// The reciprocals; zero where a value is held, or a hat function is cut off everywhere.
    pub(super) inverse: Vec<T>,
    /// The couplings along the pieces of the edges.
    pub(super) along: Vec<T>,
}

/// The rows inside the patches of a group, all alike.
#[derive(Debug, Clone)]
pub(super) struct Uniform<T> {
    pub(super) couplings: [Lanes<T>; 3],
    pub(super) diagonal: Lanes<T>,
    inverse: Lanes<T>,
}

/// The rows inside the patches of a group, each by itself.
#[derive(Debug)]
pub(super) struct Truncated<T> {
    entries: Entries<T>,
    inverse: Vec<Lanes<T>>,
}

/// The rows inside the patches of a group.
pub(super) trait Rows<T> {
    /// The couplings of the point `i` of the middle of three rows, which start there, times its neighbours.
    fn neighbours(
        &self,
        start: [usize; 3],
        i: usize,
        down: &[Lanes<T>],
        row: &[Lanes<T>],
        up: &[Lanes<T>],
    ) -> Lanes<T>;

    fn diagonal(&self, at: usize) -> Lanes<T>;

    fn inverse(&self, at: usize) -> Lanes<T>;
}

impl<T: Real> Rows<T> for Uniform<T> {
    #[inline(always)]
    fn neighbours(
        &self,
        _: [usize; 3],
        i: usize,
        down: &[Lanes<T>],
        row: &[Lanes<T>],
        up: &[Lanes<T>],
    ) -> Lanes<T> {
        let [a, b, c] = self.couplings;
        a * (row[i + 1] + row[i - 1]) + (b * (up[i] + down[i]) + c * (down[i + 1] + up[i - 1]))
    }

    #[inline(always)]
    fn diagonal(&self, _: usize) -> Lanes<T> {
        self.diagonal
    }

    #[inline(always)]
    fn inverse(&self, _: usize) -> Lanes<T> {
        self.inverse
    }
}

impl<T: Real> Rows<T> for Truncated<T> {
    #[inline(always)]
    fn neighbours(
        &self,
        [below, here, above]: [usize; 3],
        i: usize,
        down: &[Lanes<T>],
        row: &[Lanes<T>],
        up: &[Lanes<T>],
    ) -> Lanes<T> {
        let [a, b, c] = &self.entries.couplings;
        let along = a[here + i] * row[i + 1] + a[here + i - 1] * row[i - 1];
        let across = b[here + i] * up[i] + b[below + i] * down[i];
        along + (across + (c[here + i] * down[i + 1] + c[above + i - 1] * up[i - 1]))
    }

    #[inline(always)]
    fn diagonal(&self, at: usize) -> Lanes<T> {
        self.entries.diagonal[at]
    }

    #[inline(always)]
    fn inverse(&self, at: usize) -> Lanes<T> {
        self.inverse[at]
    }
}

impl<T: Real> Uniform<T> {
    fn new(stencils: [Stencil; LANES], scale: f64) -> Self {
        let couplings = [0, 1, 2].map(|k| Lanes(stencils.map(|stencil| stencil[k])));
        let diagonal = couplings[0] + couplings[1] + couplings[2];
        let diagonal = diagonal + diagonal;
        Self {
            couplings: couplings.map(|couplings| couplings.scaled(scale)),
            diagonal: diagonal.scaled(scale),
            inverse: Lanes(diagonal.0.map(|diagonal| T::of(1.0 / (scale * diagonal)))),
        }
    }
}

impl<T: Real> Truncated<T> {
    /// The value with a correction, where its hat function is not cut off everywhere.
    #[inline(always)]
    pub(super) fn corrected(&self, at: usize, mut x: Lanes<T>, correction: Lanes<T>) -> Lanes<T> {
        for lane in 0..LANES {
            let is_free = self.inverse[at].0[lane] > T::default();
            x.0[lane] = if is_free { x.0[lane] + correction.0[lane] } else { T::default() };
        }
        x
    }

    pub(super) fn new(entries: &Entries<f64>, scale: f64) -> Self {
        let scaled = |lanes: &Vec<Lanes<f64>>| lanes.iter().map(|lanes| lanes.scaled(scale)).collect();
        let reciprocal = |diagonal: f64| if diagonal > 0.0 { 1.0 / (scale * diagonal) } else { 0.0 };
        let inverse = entries.diagonal.iter().map(|lanes| Lanes(lanes.0.map(|d| T::of(reciprocal(d)))));
        Self {
            inverse: inverse.collect(),
            entries: Entries {
                diagonal: scaled(&entries.diagonal),
                couplings: entries.couplings.each_ref().map(scaled),
            },
        }
    }
}

impl<T: Real> Matrix<T> {
    /// By the stencils of each group, times a factor.
    pub(super) fn new(grid: &Grid, stencils: &[[Stencil; LANES]], scale: f64) -> Self {
        let interface = grid.interface();
        let mut matrix = Self {
            uniform: stencils.iter().map(|&stencils| Uniform::new(stencils, scale)).collect(),
            truncated: stencils.iter().map(|_| None).collect(),
            diagonal: vec![T::default(); interface],
            inverse: vec![T::default(); interface],
            along: vec![T::default(); grid.partition.edges.len() * grid.segments()],
        };
        matrix.assemble_interface(grid);
        matrix
    }

    /// The whole matrix again.
    pub(super) fn restore(&mut self, grid: &Grid) {
        if self.truncated.iter().any(Option::is_some) {
            self.truncated.fill_with(|| None);
            self.assemble_interface(grid);
        }
    }

    /// The couplings of a group in a direction, at the point where it starts, which is on a side where `share` is one half.
    #[inline(always)]
    pub(super) fn coupling(&self, g: usize, direction: usize, from: usize, share: T) -> Lanes<T> {
        match &self.truncated[g] {
            None => Lanes::all(share) * self.uniform[g].couplings[direction],
            Some(truncated) => truncated.entries.couplings[direction][from],
        }
    }

    /// The diagonal at the interface and the couplings along the edges, from those of the patches.
    pub(super) fn assemble_interface(&mut self, grid: &Grid) {
        let (half, lattice, m) = (T::of(0.5), &grid.lattice, grid.segments());
        self.diagonal.fill(T::default());
        self.along.fill(T::default());
        for g in 0..grid.groups() {
            let [a, b, c] = self.uniform[g].couplings;
            let on_corners = [a + b, a + c, b + c].map(|twice| Lanes::all(half) * twice);
            let (corners, sides) = grid.places(g);
            for (k, places) in corners.iter().enumerate() {
                let whole = on_corners[k];
                let diagonal = self.own_diagonal(g, lattice.corners()[k]).unwrap_or(whole);
                add_at(&mut self.diagonal, places, diagonal);
            }
            for (point, places) in lattice.rim.iter().zip(sides) {
                let diagonal = self.own_diagonal(g, point.at).unwrap_or(a + b + c);
                add_at(&mut self.diagonal, places, diagonal);
            }
            for (lane, patch) in grid.partition.group(g) {
                for (side, piece) in (0..3).flat_map(|side| (0..m).map(move |piece| (side, piece))) {
                    // The third side runs against its direction.
                    let from = lattice.along_side(side, piece + usize::from(side == 2));
                    let coupling = self.coupling(g, side, from, half);
                    self.along[grid.partition.piece_of_side(patch, side, piece, m)] += coupling.0[lane];
                }
            }
        }
        for ((inverse, diagonal), is_held) in self.inverse.iter_mut().zip(&self.diagonal).zip(&grid.is_held) {
            let diagonal = diagonal.to_f64();
            *inverse = if *is_held || diagonal <= 0.0 { T::default() } else { T::of(1.0 / diagonal) };
        }
    }

    /// What a group in which hat functions are cut off contributes to the diagonal at a point.
    fn own_diagonal(&self, g: usize, at: usize) -> Option<Lanes<T>> {
        self.truncated[g].as_ref().map(|truncated| truncated.entries.diagonal[at])
    }
}
