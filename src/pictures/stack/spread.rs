//! Places side by side.

/// How much more than all others together a place weighs that is not to be moved.
const IMMOVABLE: f64 = 1e6;

/// The places nearest to `wanted` (least squares) of which each lies at least `apart` beyond the one before: where they are
/// farther apart already, these themselves; where they are closer or out of order, side by side around their mean. Those that
/// are `fixed` stay where they are as long as they are in order with each other.
pub(super) fn spread(wanted: &[f64], fixed: impl Fn(usize) -> bool, apart: f64) -> Vec<f64> {
    // What is left to be found is an ascending sequence: neighbours out of order share their mean.
    let mut blocks: Vec<Block> = Vec::new();
    for (i, place) in wanted.iter().enumerate() {
        let weight = if fixed(i) { IMMOVABLE * wanted.len() as f64 } else { 1.0 };
        let mut block = Block { mean: place - i as f64 * apart, weight, count: 1 };
        while let Some(before) = blocks.pop_if(|before| before.mean > block.mean) {
            block = before.joined(block);
        }
        blocks.push(block);
    }
    let ascending = blocks.into_iter().flat_map(|block| std::iter::repeat_n(block.mean, block.count));
    ascending.enumerate().map(|(i, place)| place + i as f64 * apart).collect()
}

/// Places that share their mean.
struct Block {
    mean: f64,
    weight: f64,
    count: usize,
}

impl Block {
    fn joined(self, next: Block) -> Block {
        let weight = self.weight + next.weight;
        let mean = (self.mean * self.weight + next.mean * next.weight) / weight;
        Block { mean, weight, count: self.count + next.count }
    }
}

/// Likewise between `low` and `high`, where they have room.
pub(super) fn spread_between(wanted: &[f64], apart: f64, [low, high]: [f64; 2]) -> Vec<f64> {
    let last = wanted.len().saturating_sub(1) as f64 * apart;
    let kept = |(i, place): (usize, f64)| {
        let before = i as f64 * apart;
        (place - before).min(high - last).max(low) + before
    };
    spread(wanted, |_| false, apart).into_iter().enumerate().map(kept).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_move_no_more_than_they_must() {
        let spread = |wanted: &[f64], apart: f64| spread(wanted, |_| false, apart);
        assert_eq!(spread(&[1.0, 5.0, 9.0], 2.0), [1.0, 5.0, 9.0]);
        assert_eq!(spread(&[3.0, 3.0, 9.0], 2.0), [2.0, 4.0, 9.0]);
        assert_eq!(spread(&[3.0, 3.0, 4.5, 9.0], 2.0), [1.5, 3.5, 5.5, 9.0]);
        assert_eq!(spread(&[4.0, 2.0], 0.0), [3.0, 3.0]);
        assert!(spread(&[], 2.0).is_empty());
        // The order is kept.
        assert_ne!(spread(&[4.0, 2.0], 1.0), [4.0, 2.0]);
    }

    #[test]
    fn fixed_places_stay() {
        let moved = |fixed: usize| {
            let places = spread(&[3.0, 3.0, 3.0], |i| i == fixed, 2.0);
            [0, 1, 2].map(|i| (places[i] - 3.0).round() as i32)
        };
        assert_eq!(moved(0), [0, 2, 4]);
        assert_eq!(moved(2), [-4, -2, 0]);
        assert_eq!(moved(usize::MAX), [-2, 0, 2]);
    }

    #[test]
    fn places_stay_between_the_limits() {
        assert_eq!(spread_between(&[0.0, 0.0, 0.0], 2.0, [0.0, 9.0]), [0.0, 2.0, 4.0]);
        assert_eq!(spread_between(&[8.0, 9.0], 2.0, [0.0, 9.0]), [7.0, 9.0]);
        assert_eq!(spread_between(&[4.0, 5.0], 2.0, [0.0, 9.0]), spread(&[4.0, 5.0], |_| false, 2.0));
    }
}
