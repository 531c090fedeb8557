//! Numbers of which none may be lost, and random ones for tests.

#[cfg(test)]
mod random;

#[cfg(test)]
pub(crate) use random::Random;

/// The number itself, or infinity for a NaN: as a defect, the worst.
pub(crate) fn or_infinite(x: f64) -> f64 {
    if x.is_nan() { f64::INFINITY } else { x }
}

/// The largest value, at least zero; infinite as soon as one is NaN, which `f64::max` would lose.
pub(crate) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(or_infinite).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nan_is_the_largest() {
        assert_eq!(largest([1.0, 3.0, -4.0]), 3.0);
        assert_eq!((largest([-1.0]), largest([])), (0.0, 0.0));
        for values in [[f64::NAN, 1.0], [1.0, f64::NAN], [1.0, f64::INFINITY]] {
            assert_eq!(largest(values), f64::INFINITY);
        }
    }
}
