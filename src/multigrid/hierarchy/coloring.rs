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
        let mut color = vec![u8::MAX; rows];
        let mut colors = 1;
        for i in 0..rows {
            let taken = coupled(i).filter(|&j| j < i).fold(0u64, |taken, j| taken | 1 << color[j]);
            color[i] = taken.trailing_ones() as u8;
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
