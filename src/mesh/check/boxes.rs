//! Which of many boxes meet a given one.

use std::collections::{BTreeSet, HashMap};

/// A rectangle with sides along the axes: its lower left and its upper right corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    pub(super) lower: [f64; 2],
    pub(super) upper: [f64; 2],
}

impl Bounds {
    /// The smallest box around the points, widened by `margin` on every side.
    pub(super) fn around(points: impl IntoIterator<Item = [f64; 2]>, margin: f64) -> Self {
        let empty = Self { lower: [f64::INFINITY; 2], upper: [f64::NEG_INFINITY; 2] };
        let Self { lower, upper } = points.into_iter().fold(empty, Self::with);
        Self { lower: lower.map(|x| x - margin), upper: upper.map(|x| x + margin) }
    }

    /// The smallest box around this one and a point.
    pub(super) fn with(self, [x, y]: [f64; 2]) -> Self {
        let Self { lower, upper } = self;
        Self { lower: [lower[0].min(x), lower[1].min(y)], upper: [upper[0].max(x), upper[1].max(y)] }
    }

    pub(super) fn meets(&self, other: &Self) -> bool {
        (0..2).all(|axis| self.lower[axis] <= other.upper[axis] && other.lower[axis] <= self.upper[axis])
    }

    pub(super) fn longer_side(&self) -> f64 {
        (self.upper[0] - self.lower[0]).max(self.upper[1] - self.lower[1])
    }

    /// The exponent of the smallest power of two that is no smaller than the longer side.
    fn level(&self) -> i32 {
        self.longer_side().log2().ceil() as i32
    }
}

/// Boxes filed by size and place: each in the cells that it meets, at most four, of a grid whose cells are as large as
/// itself. Building it and asking for a box take linear time when boxes of one size do not crowd one place.
#[derive(Debug)]
pub(super) struct BoxIndex {
    boxes: Vec<Bounds>,
    filed: HashMap<(i32, [i64; 2]), Vec<usize>>,
    levels: BTreeSet<i32>,
}

impl BoxIndex {
    /// The boxes must have positive, finite sides.
    pub(super) fn new(boxes: Vec<Bounds>) -> Self {
        let mut filed: HashMap<_, Vec<usize>> = HashMap::new();
        let mut levels = BTreeSet::new();
        for (k, bounds) in boxes.iter().enumerate() {
            levels.insert(bounds.level());
            for cell in cells(bounds, bounds.level()) {
                filed.entry((bounds.level(), cell)).or_default().push(k);
            }
        }
        Self { boxes, filed, levels }
    }

    /// The boxes of at least about its own size that meet `bounds`: of two boxes that meet, one finds the other. A box may
    /// come more than once.
    pub(super) fn larger_meeting(&self, bounds: Bounds) -> impl Iterator<Item = usize> {
        self.levels
            .range(bounds.level()..)
            .flat_map(move |&level| cells(&bounds, level).map(move |cell| (level, cell)))
            .filter_map(|key| self.filed.get(&key))
            .flatten()
            .copied()
            .filter(move |&k| self.boxes[k].meets(&bounds))
    }
}

/// The cells of side `2^level` that meet a box.
fn cells(bounds: &Bounds, level: i32) -> impl Iterator<Item = [i64; 2]> + use<> {
    let size = f64::from(level).exp2();
    let cell = |corner: [f64; 2]| corner.map(|x| (x / size).floor() as i64);
    let ([i0, j0], [i1, j1]) = (cell(bounds.lower), cell(bounds.upper));
    (i0..=i1).flat_map(move |i| (j0..=j1).map(move |j| [i, j]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::Random;

    /// Of boxes of very different sizes, exactly the pairs that meet are found, each by one of the two at least.
    #[test]
    fn boxes_that_meet_find_each_other() {
        let mut random = Random::new(1);
        let boxes: Vec<Bounds> = (0..300)
            .map(|_| {
                let size = 10f64.powf(random.between(-4.0, 1.0));
                let corner = [random.between(-3.0, 3.0), random.between(-3.0, 3.0)];
                let opposite = corner.map(|x| x + size * random.between(0.0, 1.0));
                Bounds::around([corner, opposite], 1e-9)
            })
            .collect();
        let index = BoxIndex::new(boxes.clone());
        let finds = |k: usize, l: usize| index.larger_meeting(boxes[k]).any(|found| found == l);
        let mut meeting = 0;
        for k in 0..boxes.len() {
            for l in 0..k {
                assert_eq!(finds(k, l) || finds(l, k), boxes[k].meets(&boxes[l]), "boxes {k} and {l}");
                meeting += usize::from(boxes[k].meets(&boxes[l]));
            }
        }
        assert!((1000..300 * 299 / 2 - 1000).contains(&meeting), "both occur: {meeting}");
    }
}
