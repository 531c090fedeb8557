//! The entries of the patches on a coarser level from those on the finer one.

use super::entries::Entries;
use crate::multigrid::patches::grid::{DIRECTIONS, Lattice, parents};
use crate::multigrid::patches::lanes::{LANES, Lanes};

/// `P' A P` in a patch, as a list of terms.
#[derive(Debug)]
pub(in crate::multigrid) struct Galerkin {
    terms: Vec<Term>,
    coarse: Lattice,
}

/// An entry of the finer level, times a factor, is part of one of the coarser level.
#[derive(Debug)]
struct Term {
    from: Entry,
    to: Entry,
    factor: f64,
}

/// An entry at a point: the diagonal, or the coupling in a direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    direction: Option<u8>,
    at: u32,
}

impl Galerkin {
    /// To lattices of half as many segments.
    pub(in crate::multigrid) fn new(fine: &Lattice) -> Self {
        let mut sums = Self { terms: Vec::new(), coarse: Lattice::new(fine.segments / 2) };
        for point in fine.all() {
            let at = fine.at(point[0], point[1]) as u32;
            sums.add_products(Entry { direction: None, at }, [point, point]);
            for direction in 0..DIRECTIONS.len() {
                if let Some(neighbour) = fine.neighbour(point, direction) {
                    let entry = Entry { direction: Some(direction as u8), at };
                    sums.add_products(entry, [point, neighbour]);
                }
            }
        }
        sums.terms.sort_by_key(|term| term.to);
        sums
    }

    /// `P_iA P_jB` for an entry between the points `i` and `j`.
    fn add_products(&mut self, from: Entry, [i, j]: [[usize; 2]; 2]) {
        for a in parents(i) {
            for b in parents(j) {
                self.add_product(from, [a, b]);
            }
        }
    }

    /// A quarter of an entry is part of that between the coarse points `a` and `b`. Couplings are minus the entries, and each stands
    /// for two of them.
    fn add_product(&mut self, from: Entry, [a, b]: [[usize; 2]; 2]) {
        let is_diagonal = from.direction.is_none();
        let number = |[i, j]: [usize; 2]| self.coarse.at(i, j) as u32;
        let towards = |from: [usize; 2], to: [usize; 2]| {
            (0..3u8).find(|&k| self.coarse.neighbour(from, usize::from(k)) == Some(to))
        };
        let (to, factor) = if a == b {
            (Entry { direction: None, at: number(a) }, if is_diagonal { 0.25 } else { -0.5 })
        } else if let Some(direction) = towards(a, b) {
            (Entry { direction: Some(direction), at: number(a) }, if is_diagonal { -0.25 } else { 0.25 })
        } else if is_diagonal {
            // The term of the same two points in the other order is counted.
            return;
        } else {
            let direction = towards(b, a).expect("parents of neighbours are neighbours");
            (Entry { direction: Some(direction), at: number(b) }, 0.25)
        };
        self.terms.push(Term { from, to, factor });
    }

    /// The coarser entries.
    pub(in crate::multigrid) fn apply(&self, fine: &Entries<f64>) -> Entries<f64> {
        let mut coarse = Entries::zero(&self.coarse);
        for Term { from, to, factor } in &self.terms {
            let from = match from.direction {
                None => fine.diagonal[from.at as usize],
                Some(direction) => fine.couplings[usize::from(direction)][from.at as usize],
            };
            let to = match to.direction {
                None => &mut coarse.diagonal[to.at as usize],
                Some(direction) => &mut coarse.couplings[usize::from(direction)][to.at as usize],
            };
            *to = *to + Lanes([*factor; LANES]) * from;
        }
        coarse
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::multigrid::patches::matrix::Stencil;
    use crate::numeric::Random;

    const ROUNDING: f64 = 1e-13;

    /// `x' A x` in a lane.
    fn energy(lattice: &Lattice, entries: &Entries<f64>, x: &[f64], lane: usize) -> f64 {
        let mut sum = 0.0;
        for [i, j] in lattice.all() {
            let at = lattice.at(i, j);
            sum += entries.diagonal[at].0[lane] * x[at] * x[at];
            for k in 0..3 {
                if let Some([p, q]) = lattice.neighbour([i, j], k) {
                    sum -= 2.0 * entries.couplings[k][at].0[lane] * x[at] * x[lattice.at(p, q)];
                }
            }
        }
        sum
    }

    #[test]
    fn coarse_functions_have_the_same_energy_on_both_levels() {
        let (fine, coarse) = (Lattice::new(8), Lattice::new(4));
        let mut random = Random::new(3);
        let stencils: [Stencil; LANES] =
            std::array::from_fn(|_| std::array::from_fn(|_| random.between(0.0, 1.0)));
        let frozen: Vec<[bool; LANES]> =
            fine.all().map(|_| std::array::from_fn(|_| random.between(0.0, 1.0) < 0.3)).collect();
        let x: Vec<f64> = coarse.all().map(|_| random.between(0.0, 1.0)).collect();
        let prolonged = |lane: usize| -> Vec<f64> {
            let at = |point: [usize; 2]| {
                let [a, b] = parents(point).map(|[i, j]| x[coarse.at(i, j)]);
                let is_frozen = frozen[fine.at(point[0], point[1])][lane];
                if is_frozen { 0.0 } else { 0.5 * (a + b) }
            };
            fine.all().map(at).collect()
        };
        let whole = Entries::without(&stencils, &fine, |_| [false; LANES]);
        let cut = Entries::without(&stencils, &fine, |at| frozen[at]);
        let coarser = Galerkin::new(&fine).apply(&cut);
        for lane in 0..LANES {
            let expected = energy(&fine, &whole, &prolonged(lane), lane);
            let found = energy(&coarse, &coarser, &x, lane);
            assert!((found - expected).abs() < ROUNDING * (1.0 + expected), "{found} {expected}");
        }
        let uncut = Galerkin::new(&fine).apply(&whole);
        let expected = energy(&fine, &whole, &prolonged(0), 0);
        assert!((energy(&coarse, &uncut, &x, 0) - expected).abs() > 1e-3, "other hat functions are noticed");
    }
}
