//! How strongly a load acts, in the norm that is dual to the energy's.

use std::f64::consts::SQRT_2;
use std::ops::Range;

use crate::geometry::{friedrichs, poincare};
use crate::mesh::Mesh;
use crate::parallel::blocks;
use crate::parallel::prelude::*;

/// Squares on the finest level at most, about.
const SQUARES: usize = 1 << 16;

/// `int d v <= HALVES s ||d|| |v|_{H1}` on a square of side `s` for a function `d` that is 1 on one half and -1 on the other: the
/// best `v` has the slope of a hat, whose norm is `s^(3/2) / sqrt(12)`.
const HALVES: f64 = 0.288_675_134_594_812_9;

/// An estimate of `sup_v int d v / |v|_{H1}` over the functions `v` that vanish on the boundary, for a function `d` that is
/// constant on the triangles. Shape of `values`: `triangles`. Linear time; the result does not depend on the number of threads.
///
/// The domain is laid out with squares, of which four make one of the next level. With `d_l` the means of `d` on the squares of
/// side `s_l`, and `d_L` that on all, `d = (d - d_0) + sum_l (d_{l-1} - d_l) + d_L`: each difference has the mean zero on the
/// squares of level `l` and counts by their side, the last one by the constant of Friedrichs, the first by that of Poincare on a
/// triangle together with the square of its barycentre. The terms add up as if they were orthogonal, which they nearly are.
///
/// So what has one sign far and wide counts fully, and what changes its sign from triangle to triangle by the size of the
/// triangles alone.
pub(super) fn dual_norm(mesh: &Mesh, values: &[f64]) -> f64 {
    if values.iter().all(|&value| value == 0.0) {
        return 0.0;
    }
    let mut level = Squares::new(mesh, values.len());
    let on_triangle = |t: usize| {
        let mass = mesh.triangle_area(t) * values[t];
        let within = poincare(SQRT_2 * level.side + mesh.diameter_sq(t).sqrt()).powi(2) * mass * values[t];
        (level.with_barycentre_of(mesh.corners(t)), mass, within)
    };
    let of_block = |block: Range<usize>| block.map(on_triangle).collect();
    let blocks: Vec<Vec<_>> = blocks(values.len()).into_par_iter().map(of_block).collect();
    let mut norm_sq = 0.0;
    for (square, mass, within) in blocks.into_iter().flatten() {
        level.masses[square] += mass;
        norm_sq += within;
    }
    let mut square = level.square();
    while level.masses.len() > 1 {
        level = level.coarser();
        let coarse = level.square();
        // Rounding alone makes the difference negative.
        norm_sq += (HALVES * level.side).powi(2) * (square - coarse).max(0.0);
        square = coarse;
    }
    let (lower, upper) = mesh.bounding_box();
    let friedrichs = friedrichs([upper[0] - lower[0], upper[1] - lower[1]]);
    (norm_sq + friedrichs * friedrichs * square).sqrt()
}

/// The integrals over the squares of a level, row by row.
struct Squares {
    origin: [f64; 2],
    side: f64,
    counts: [usize; 2],
    masses: Vec<f64>,
}

impl Squares {
    fn new(mesh: &Mesh, triangles: usize) -> Self {
        let (lower, upper) = mesh.bounding_box();
        let sides = [upper[0] - lower[0], upper[1] - lower[1]];
        let squares = triangles.min(SQUARES) as f64;
        let side = (sides[0].sqrt() * sides[1].sqrt() / squares.sqrt()).max(sides[0].max(sides[1]) / squares);
        let counts = sides.map(|length| ((length / side).ceil() as usize).max(1));
        Self { origin: lower, side, counts, masses: vec![0.0; counts[0] * counts[1]] }
    }

    /// The number of the square with the barycentre of a triangle.
    fn with_barycentre_of(&self, corners: [[f64; 2]; 3]) -> usize {
        let [column, row] = [0, 1].map(|axis| {
            let barycentre = corners.iter().map(|corner| corner[axis]).sum::<f64>() / 3.0;
            (((barycentre - self.origin[axis]) / self.side) as usize).min(self.counts[axis] - 1)
        });
        row * self.counts[0] + column
    }

    /// The square of the norm of the means.
    fn square(&self) -> f64 {
        self.masses.iter().map(|mass| mass * mass).sum::<f64>() / (self.side * self.side)
    }

    fn coarser(&self) -> Self {
        let counts = self.counts.map(|count| count.div_ceil(2));
        let mut masses = vec![0.0; counts[0] * counts[1]];
        for (k, mass) in self.masses.iter().enumerate() {
            let (row, column) = (k / self.counts[0], k % self.counts[0]);
            masses[row / 2 * counts[0] + column / 2] += mass;
        }
        Self { side: 2.0 * self.side, counts, masses, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::mesh::samples::square;

    /// With one value for each triangle, by the place of its barycentre.
    fn norm(cells: usize, value: impl Fn(f64, f64) -> f64) -> f64 {
        let mesh = square(cells);
        let at = |t: usize| {
            let [x, y] = [0, 1].map(|axis| mesh.corners(t).iter().map(|p| p[axis]).sum::<f64>() / 3.0);
            value(x, y)
        };
        dual_norm(&mesh, &(0..mesh.triangles().len()).map(at).collect::<Vec<_>>())
    }

    /// On the unit square `sin(pi x) sin(pi y)` has the norm `1/2 / (sqrt(2) pi)`.
    #[test]
    fn it_is_of_the_size_of_the_norm() {
        let exact = 0.5 / (2.0f64.sqrt() * PI);
        for cells in [8, 32, 128] {
            let found = norm(cells, |x, y| (PI * x).sin() * (PI * y).sin());
            assert!((0.7 * exact..1.5 * exact).contains(&found), "{cells}: {found} for {exact}");
        }
        assert_eq!(norm(8, |_, _| 0.0), 0.0);
    }

    /// The sine of `k` periods has the norm of the first over `k`, as long as the mesh resolves it.
    #[test]
    fn what_oscillates_counts_less() {
        let of = |k: f64| norm(128, |x, y| (k * PI * x).sin() * (k * PI * y).sin());
        for k in [4.0, 16.0] {
            let ratio = of(1.0) / of(k);
            assert!((0.5 * k..2.0 * k).contains(&ratio), "{k}: {ratio}");
        }
    }

    /// What lies in one strip of triangles along a line falls with the mesh size, as the trace on the line does, and not with
    /// its square root, as the L2 norm.
    #[test]
    fn a_strip_along_a_line_counts_by_its_area() {
        let of = |cells: usize| norm(cells, |x, _| f64::from((x - 0.5).abs() < 1.0 / cells as f64));
        let ratio = of(32) / of(128);
        assert!(ratio > 3.0, "{ratio}, where 2 is the square root");
    }
}
