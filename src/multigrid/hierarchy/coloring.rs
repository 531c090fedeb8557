//! The numbering of a level: windows of rows that see their neighbours only, and colours within them.
//!
//! Rows of one colour are not coupled. So a Gauss-Seidel sweep runs colour by colour without one row waiting for another, and
//! smooths better than row by row; windows let its stages follow each other closely through the memory.

use std::ops::Range;

/// Where the rows of each window and colour lie.
#[derive(Debug, Clone, Default)]
pub(crate) struct Coloring {
    colors: usize,
    /// The first row of each window and colour, the colours of a window together; at the end the number of rows.
    start: Vec<u32>,
}

impl Coloring {
    /// Colours the rows greedily, in windows of `bandwidth` rows. Returns also the rows in their new order.
    ///
    /// `coupled(i)` are the columns that row `i` is coupled to; none is further away than `bandwidth`.
    pub(crate) fn new<I: Iterator<Item = usize>>(
        rows: usize,
        bandwidth: usize,
        coupled: impl Fn(usize) -> I,
    ) -> (Self, Vec<u32>) {
        let mut color = vec![0u32; rows];
        let mut colors = 1;
        for i in 0..rows {
            color[i] = least_free(coupled(i).filter(|&j| j < i).map(|j| color[j]), || {
                coupled(i).filter(|&j| j < i).map(|j| color[j]).collect()
            });
            colors = colors.max(color[i] as usize + 1);
        }
        let mut start = vec![0];
        let mut order = Vec::with_capacity(rows);
        for window in (0..rows).step_by(bandwidth.max(1)) {
            let window = window..(window + bandwidth.max(1)).min(rows);
            for c in 0..colors {
                order.extend(window.clone().filter(|&i| color[i] as usize == c).map(|i| i as u32));
                start.push(order.len() as u32);
            }
        }
        (Self { colors, start }, order)
    }

    pub(crate) fn colors(&self) -> usize {
        self.colors
    }

    pub(crate) fn windows(&self) -> usize {
        (self.start.len() - 1) / self.colors
    }

    /// The rows of a colour in a window.
    pub(crate) fn rows(&self, window: usize, color: usize) -> Range<usize> {
        let at = window * self.colors + color;
        self.start[at] as usize..self.start[at + 1] as usize
    }

    /// All rows of a window.
    pub(crate) fn window(&self, window: usize) -> Range<usize> {
        self.start[window * self.colors] as usize..self.start[(window + 1) * self.colors] as usize
    }

    /// Runs the stages over all windows, each at the distance of one window behind the one before it: what it reads is
    /// finished by then, and still in the cache.
    #[inline(always)]
    pub(crate) fn pipeline(&self, stages: usize, mut run: impl FnMut(usize, usize)) {
        let windows = self.windows();
        for step in 0..(windows + stages).saturating_sub(1) {
            for stage in step.saturating_sub(windows - 1)..stages.min(step + 1) {
                run(stage, step - stage);
            }
        }
    }
}

/// The least colour that is not taken. Up to 64 colours, which are all that a triangulation needs, fit in a word; `all` are those
/// taken once more.
fn least_free(taken: impl Iterator<Item = u32>, all: impl Fn() -> Vec<u32>) -> u32 {
    let word = taken.fold(0u64, |word, color| word | 1u64.checked_shl(color).unwrap_or(0));
    if word != u64::MAX {
        return word.trailing_ones();
    }
    let mut all = all();
    all.sort_unstable();
    all.dedup();
    (0..).zip(&all).take_while(|&(free, &color)| free == color).count() as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether no two rows of a colour are coupled.
    fn is_proper(coloring: &Coloring, order: &[u32], coupled: impl Fn(usize, usize) -> bool) -> bool {
        (0..coloring.windows())
            .flat_map(|window| (0..coloring.colors()).map(move |color| (window, color)))
            .all(|(window, color)| {
                let rows = || coloring.rows(window, color).map(|k| order[k] as usize);
                rows().all(|i| rows().all(|j| i == j || !coupled(i, j)))
            })
    }

    #[test]
    fn there_may_be_more_than_64_colours() {
        for rows in [63, 64, 65, 66, 130, 300] {
            // All rows coupled; and two such sets that know nothing of each other, one after the other and in turn.
            let sets: [fn(usize, usize) -> bool; 3] =
                [|_, _| true, |i, j| (i < 65) == (j < 65), |i, j| i % 2 == j % 2];
            for coupled in sets {
                let neighbours = |i: usize| (0..rows).filter(move |&j| j != i && coupled(i, j));
                let (coloring, order) = Coloring::new(rows, rows, neighbours);
                let largest = (0..rows).map(|i| neighbours(i).count() + 1).max().unwrap();
                assert_eq!(coloring.colors(), largest);
                assert!(is_proper(&coloring, &order, coupled));
            }
            let (one, order) = Coloring::new(rows, rows, |_| std::iter::empty());
            assert!(!is_proper(&one, &order, |_, _| true), "one colour is not enough");
        }
    }
}
