//! The layers at one vertex: which of them touch, and what the actions between them are (section 2 of the notes on stacks).

use std::ops::Range;

/// A layer at a vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Layer {
    /// A missing obstacle.
    Absent,
    /// An obstacle, or a membrane where it is fixed: its height.
    Known(f64),
    /// A free membrane: the number of its unknown.
    Unknown(usize),
}

/// Free membranes that touch, from the top, between two open gaps, fixed membranes or obstacles.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Segment {
    /// The layers, all free.
    pub(crate) layers: Range<usize>,
    /// The height of what it touches above and below.
    pub(crate) above: Option<f64>,
    pub(crate) below: Option<f64>,
}

/// The segments of the layers `0 ..= N + 1` at a vertex, from the top, where `touches(k)` says whether layers `k` and `k + 1` touch.
pub(crate) fn segments<'l>(
    layers: &'l [Layer],
    touches: impl Fn(usize) -> bool + 'l,
) -> impl Iterator<Item = Segment> + 'l {
    let known = |layer: usize| match layers[layer] {
        Layer::Known(height) => Some(height),
        _ => None,
    };
    let is_free = |layer: usize| matches!(layers.get(layer), Some(Layer::Unknown(_)));
    let mut next = 0;
    std::iter::from_fn(move || {
        let first = (next..layers.len()).find(|&layer| is_free(layer))?;
        let mut end = first + 1;
        while is_free(end) && touches(end - 1) {
            end += 1;
        }
        next = end;
        let above = first.checked_sub(1).filter(|&gap| touches(gap)).and_then(known);
        let below = Some(end).filter(|&end| end < layers.len() && touches(end - 1)).and_then(known);
        Some(Segment { layers: first..end, above, below })
    })
}

impl Segment {
    /// The actions `y_k` in the gaps that it closes, from the residuals `r_i = (K_i u_i - F_i)_a = y_i - y_(i-1)` of its
    /// membranes: `action(k, y_k)`. What is left of their sum, where nothing rigid takes it up, is returned: the block balance.
    pub(crate) fn actions(&self, residual: impl Fn(usize) -> f64, mut action: impl FnMut(usize, f64)) -> f64 {
        let Range { start: p, end } = self.layers;
        let upto = |last: usize| (p..=last).map(&residual).sum::<f64>();
        match (self.above, self.below) {
            (None, below) => {
                for k in p..end - 1 {
                    action(k, upto(k));
                }
                match below {
                    Some(_) => action(end - 1, upto(end - 1)),
                    None => return upto(end - 1),
                }
            }
            (Some(_), None) => {
                let from = |first: usize| (first..end).map(&residual).sum::<f64>();
                for k in p - 1..end - 1 {
                    action(k, -from(k + 1));
                }
            }
            // Only differences are determined: the smallest actions that are not negative.
            (Some(_), Some(_)) => {
                let top = (p..end).map(|k| -upto(k)).fold(0.0, f64::max);
                action(p - 1, top);
                for k in p..end {
                    action(k, top + upto(k));
                }
            }
        }
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Layer::{Absent, Known, Unknown};

    fn closed_at(layers: &[Layer], closed: &[usize]) -> Vec<Segment> {
        segments(layers, |gap| closed.contains(&gap)).collect()
    }

    fn segment(layers: Range<usize>, above: Option<f64>, below: Option<f64>) -> Segment {
        Segment { layers, above, below }
    }

    #[test]
    fn segments_end_at_open_gaps_and_at_what_is_rigid() {
        let free = [Absent, Unknown(0), Unknown(1), Unknown(2), Known(0.5)];
        assert_eq!(closed_at(&free, &[]).len(), 3);
        assert_eq!(closed_at(&free, &[1]), [segment(1..3, None, None), segment(3..4, None, None)]);
        assert_eq!(closed_at(&free, &[1, 2, 3]), [segment(1..4, None, Some(0.5))]);
        let fixed_between = [Known(2.0), Unknown(0), Known(1.0), Unknown(1), Absent];
        let expected = [segment(1..2, None, Some(1.0)), segment(3..4, Some(1.0), None)];
        assert_eq!(closed_at(&fixed_between, &[1, 2]), expected);
        assert_eq!(closed_at(&fixed_between, &[0, 1])[0], segment(1..2, Some(2.0), Some(1.0)));
    }

    /// Residuals of given actions give these actions back, whatever the segment rests on.
    #[test]
    fn actions_are_found_from_residuals() {
        let y = [3.0, 1.0, 4.0, 0.5];
        let cases = [
            (segment(1..4, None, None), [0.0, y[1], y[2], 0.0]),
            (segment(1..4, None, Some(0.0)), [0.0, y[1], y[2], y[3]]),
            (segment(1..4, Some(0.0), None), [y[0], y[1], y[2], 0.0]),
        ];
        for (segment, y) in cases {
            let mut found = [0.0; 4];
            let balance = segment.actions(|i| y[i] - y[i - 1], |k, action| found[k] = action);
            assert_eq!((found, balance), (y, 0.0));
        }
        // Between two walls, a common part of all actions is not determined: the least one is zero.
        let mut found = [0.0; 4];
        segment(1..4, Some(0.0), Some(0.0)).actions(|i| y[i] - y[i - 1], |k, action| found[k] = action);
        assert_eq!(found, y.map(|y| y - 0.5));
        // A push from nowhere is what the balance sees.
        assert_eq!(segment(1..4, None, None).actions(|_| 1.0, |_, _| ()), 3.0);
    }
}
