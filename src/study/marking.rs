//! Which triangles to refine.

/// The fewest triangles that hold a fraction of the sum of squared indicators (Doerfler, SIAM J. Numer. Anal. 33 (1996)
/// 1106), in decreasing order of the indicators; of equal ones, that with the smaller number first. With a fraction below one
/// half or so, adaptive meshes reach the best possible rate.
///
/// # Panics
/// When the fraction is not between 0 and 1.
pub fn mark(squared_indicators: &[f64], fraction: f64) -> Vec<usize> {
    assert!((0.0..=1.0).contains(&fraction), "the fraction is between 0 and 1");
    let goal = fraction * squared_indicators.iter().sum::<f64>();
    let mut order: Vec<usize> = (0..squared_indicators.len()).collect();
    order.sort_unstable_by(|&s, &t| {
        squared_indicators[t].total_cmp(&squared_indicators[s]).then_with(|| s.cmp(&t))
    });
    let mut sum = 0.0;
    let enough = order.iter().position(|&t| {
        sum += squared_indicators[t];
        sum >= goal
    });
    order.truncate(enough.map_or(order.len(), |last| last + 1));
    order
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn the_largest_come_first_and_no_more_than_needed() {
        let indicators = [1.0, 4.0, 2.0, 4.0, 0.0];
        assert_eq!(mark(&indicators, 0.3), [1]);
        assert_eq!(mark(&indicators, 0.5), [1, 3]);
        assert_eq!(mark(&indicators, 0.9), [1, 3, 2]);
        assert_ne!(mark(&indicators, 0.95), [1, 3, 2]);
    }

    proptest! {
        #[test]
        fn they_hold_the_fraction_and_without_the_last_one_do_not(
            indicators in prop::collection::vec(0.0..1.0, 1..40), fraction in 0.01..0.99
        ) {
            let marked = mark(&indicators, fraction);
            let sum = |marked: &[usize]| marked.iter().map(|&t| indicators[t]).sum::<f64>();
            let goal = fraction * indicators.iter().sum::<f64>();
            // Sums are rounded in another order.
            prop_assert!(sum(&marked) >= goal * (1.0 - 1e-12));
            prop_assert!(sum(&marked[..marked.len() - 1]) < goal);
        }
    }
}
