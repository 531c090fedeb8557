//! Places side by side.

/// The places nearest to `wanted` (least squares) of which each lies at least `apart` beyond the one before: where they are
/// farther apart already, these themselves; where they are closer or out of order, side by side around their mean.
pub(super) fn spread(wanted: &[f64], apart: f64) -> Vec<f64> {
    // What is left to be found is an ascending sequence: neighbours out of order share their mean.
    let mut blocks: Vec<(f64, usize)> = Vec::new();
    for (i, place) in wanted.iter().enumerate() {
        let mut block = (place - i as f64 * apart, 1);
        while let Some(&(mean, count)) = blocks.last().filter(|(mean, _)| *mean > block.0) {
            let total = count + block.1;
            block = ((mean * count as f64 + block.0 * block.1 as f64) / total as f64, total);
            blocks.pop();
        }
        blocks.push(block);
    }
    let ascending = blocks.into_iter().flat_map(|(mean, count)| std::iter::repeat_n(mean, count));
    ascending.enumerate().map(|(i, place)| place + i as f64 * apart).collect()
}

/// Likewise between `low` and `high`, where they have room.
pub(super) fn spread_between(wanted: &[f64], apart: f64, [low, high]: [f64; 2]) -> Vec<f64> {
    let last = wanted.len().saturating_sub(1) as f64 * apart;
    let kept = |(i, place): (usize, f64)| {
        let before = i as f64 * apart;
        (place - before).min(high - last).max(low) + before
    };
    spread(wanted, apart).into_iter().enumerate().map(kept).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_move_no_more_than_they_must() {
        assert_eq!(spread(&[1.0, 5.0, 9.0], 2.0), [1.0, 5.0, 9.0]);
        assert_eq!(spread(&[3.0, 3.0, 9.0], 2.0), [2.0, 4.0, 9.0]);
        assert_eq!(spread(&[3.0, 3.0, 4.5, 9.0], 2.0), [1.5, 3.5, 5.5, 9.0]);
        assert_eq!(spread(&[4.0, 2.0], 0.0), [3.0, 3.0]);
        assert!(spread(&[], 2.0).is_empty());
        // The order is kept.
        assert_ne!(spread(&[4.0, 2.0], 1.0), [4.0, 2.0]);
    }

    #[test]
    fn places_stay_between_the_limits() {
        assert_eq!(spread_between(&[0.0, 0.0, 0.0], 2.0, [0.0, 9.0]), [0.0, 2.0, 4.0]);
        assert_eq!(spread_between(&[8.0, 9.0], 2.0, [0.0, 9.0]), [7.0, 9.0]);
        assert_eq!(spread_between(&[4.0, 5.0], 2.0, [0.0, 9.0]), spread(&[4.0, 5.0], 2.0));
    }
}
