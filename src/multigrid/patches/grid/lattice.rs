//! The points of a triangle that has been refined uniformly.

/// The directions from a point to three of its neighbours, along the sides from the first corner to the second, from the first to
/// the third and from the third to the second; the other three are opposite to them.
pub(in crate::multigrid) const DIRECTIONS: [[isize; 2]; 3] = [[1, 0], [0, 1], [1, -1]];

/// The points `(i, j)` with `i, j >= 0`, `i + j <= segments`, row by row. The corners are `(0, 0)`, `(segments, 0)` and
/// `(0, segments)`.
#[derive(Debug)]
pub(in crate::multigrid) struct Lattice {
    pub(in crate::multigrid) segments: usize,
    /// Where each row starts; and where there would be one more.
    start: Vec<usize>,
    /// The points between the corners, along the first side, the second and the third.
    pub(in crate::multigrid) rim: Vec<RimPoint>,
}

/// A point on a side.
#[derive(Debug)]
pub(in crate::multigrid) struct RimPoint {
    pub(in crate::multigrid) at: usize,
    /// The couplings to its neighbours away from the side.
    pub(in crate::multigrid) inward: [Coupling; 2],
}

/// The coupling of a point to a neighbour.
#[derive(Debug, Clone, Copy)]
pub(in crate::multigrid) struct Coupling {
    /// The neighbour.
    pub(in crate::multigrid) to: usize,
    pub(in crate::multigrid) direction: usize,
    /// Which of the two points the direction starts from.
    pub(in crate::multigrid) from: usize,
}

impl Lattice {
    pub(in crate::multigrid) fn new(segments: usize) -> Self {
        let start = (0..segments + 2).map(|j| j * (segments + 1) - j * j.saturating_sub(1) / 2).collect();
        let mut lattice = Self { segments, start, rim: Vec::new() };
        let at = |i: usize, j: usize| lattice.at(i, j);
        let coupling = |direction, to, from| Coupling { to, direction, from };
        let first = (1..segments).map(|t| {
            let (here, up, left) = (at(t, 0), at(t, 1), at(t - 1, 1));
            RimPoint { at: here, inward: [coupling(1, up, here), coupling(2, left, left)] }
        });
        let second = (1..segments).map(|t| {
            let (here, right, below) = (at(0, t), at(1, t), at(1, t - 1));
            RimPoint { at: here, inward: [coupling(0, right, here), coupling(2, below, here)] }
        });
        let third = (1..segments).map(|t| {
            let [i, j] = [segments - t, t];
            let (here, left, below) = (at(i, j), at(i - 1, j), at(i, j - 1));
            RimPoint { at: here, inward: [coupling(0, left, left), coupling(1, below, below)] }
        });
        lattice.rim = first.chain(second).chain(third).collect();
        lattice
    }

    /// The number of a point.
    #[inline(always)]
    pub(in crate::multigrid) fn at(&self, i: usize, j: usize) -> usize {
        self.start[j] + i
    }

    /// How many points there are.
    pub(in crate::multigrid) fn points(&self) -> usize {
        self.start[self.segments + 1]
    }

    /// Where the row below row `j`, that row and the one above it start.
    #[inline(always)]
    pub(in crate::multigrid) fn rows(&self, j: usize) -> [usize; 3] {
        [self.start[j - 1], self.start[j], self.start[j + 1]]
    }

    pub(in crate::multigrid) fn corners(&self) -> [usize; 3] {
        [self.at(0, 0), self.at(self.segments, 0), self.at(0, self.segments)]
    }

    /// All points.
    pub(in crate::multigrid) fn all(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let segments = self.segments;
        (0..=segments).flat_map(move |j| (0..=segments - j).map(move |i| [i, j]))
    }

    /// The points that are not on a side.
    pub(in crate::multigrid) fn inside(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let segments = self.segments;
        (1..segments).flat_map(move |j| (1..segments - j).map(move |i| [i, j]))
    }

    /// The neighbour of a point in a direction.
    pub(in crate::multigrid) fn neighbour(&self, [i, j]: [usize; 2], direction: usize) -> Option<[usize; 2]> {
        let [di, dj] = DIRECTIONS[direction];
        let [i, j] = [i.checked_add_signed(di)?, j.checked_add_signed(dj)?];
        (i + j <= self.segments).then_some([i, j])
    }

    /// The point of a side that is so many segments away from where the side starts.
    pub(in crate::multigrid) fn along_side(&self, side: usize, t: usize) -> usize {
        match side {
            0 => self.at(t, 0),
            1 => self.at(0, t),
            _ => self.at(self.segments - t, t),
        }
    }
}

/// The two points of the lattice with half the segments of which a point is the midpoint; twice the same where it is one of them.
#[inline(always)]
pub(in crate::multigrid) fn parents([i, j]: [usize; 2]) -> [[usize; 2]; 2] {
    let [h, k] = [i / 2, j / 2];
    match [i % 2, j % 2] {
        [0, 0] => [[h, k], [h, k]],
        [1, 0] => [[h, k], [h + 1, k]],
        [0, _] => [[h, k], [h, k + 1]],
        _ => [[h + 1, k], [h, k + 1]],
    }
}
