//! Logarithmic axes with powers of ten as ticks.

use super::axis::{Tick, superscript};

/// The least length of an axis in decades: values that differ by rounding only are drawn as one.
const SHORTEST: f64 = 0.5;
/// Up to this many decades 2 and 5 times a power of ten are labelled as well.
const FEW: f64 = 1.5;

/// The range of a positive quantity, as decimal logarithms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LogAxis {
    low: f64,
    high: f64,
}

impl LogAxis {
    /// The axis over decimal logarithms, from 0 to 1 if there are none; a short range is widened.
    pub(crate) fn over(logarithms: impl Iterator<Item = f64>) -> LogAxis {
        let start = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = logarithms.fold(start, |(low, high), value| (low.min(value), high.max(value)));
        if !(low <= high) {
            return LogAxis { low: 0.0, high: 1.0 };
        }
        let more = (SHORTEST - (high - low)).max(0.0) / 2.0;
        LogAxis { low: low - more, high: high + more }
    }

    /// The same axis with these parts of its length added below and above.
    pub(crate) fn widened(self, [below, above]: [f64; 2]) -> LogAxis {
        let length = self.high - self.low;
        LogAxis { low: self.low - below * length, high: self.high + above * length }
    }

    /// The same axis, from `low` if it began above.
    pub(crate) fn lowered(self, low: f64) -> LogAxis {
        LogAxis { low: self.low.min(low), ..self }
    }

    /// Where a logarithm lies: 0 at the low end, 1 at the high end.
    pub(crate) fn place(&self, logarithm: f64) -> f64 {
        (logarithm - self.low) / (self.high - self.low)
    }

    /// The logarithm at a place.
    pub(crate) fn at(&self, place: f64) -> f64 {
        self.low + place * (self.high - self.low)
    }

    /// The length in decades.
    pub(crate) fn length(&self) -> f64 {
        self.high - self.low
    }

    /// The labelled ticks, at most about `count`: every so many decades; of few decades also 2 and 5 times their powers.
    pub(crate) fn ticks(&self, count: usize) -> Vec<Tick> {
        let multiples: &[i32] = if self.length() <= FEW { &[1, 2, 5] } else { &[1] };
        let step = [1, 2, 5, 10, 20, 50, 100, 200]
            .into_iter()
            .find(|&step| self.length() <= f64::from(step) * count as f64)
            .unwrap_or(500);
        let exponents =
            (self.low.floor() as i32..=self.high.ceil() as i32).filter(|e| e.rem_euclid(step) == 0);
        let label = |multiple: i32, exponent: i32| match (multiple, exponent) {
            (_, 0) => multiple.to_string(),
            (1, 1) => "10".to_owned(),
            (1, _) => format!("10{}", superscript(exponent)),
            _ => format!("{multiple}·10{}", superscript(exponent)),
        };
        exponents
            .flat_map(|exponent| multiples.iter().map(move |&multiple| (multiple, exponent)))
            .map(|(m, e)| Tick { place: self.place(f64::from(m).log10() + f64::from(e)), label: label(m, e) })
            .filter(Tick::is_on_axis)
            .collect()
    }

    /// The places of 2, 3, ... 9 times the powers of ten, none if there would be too many.
    pub(crate) fn minor_ticks(&self) -> Vec<Tick> {
        const MOST_DECADES: f64 = 8.0;
        if self.length() > MOST_DECADES {
            return Vec::new();
        }
        (self.low.floor() as i32..=self.high.ceil() as i32)
            .flat_map(|exponent| (2..10).map(move |m| f64::from(m).log10() + f64::from(exponent)))
            .map(|logarithm| Tick { place: self.place(logarithm), label: String::new() })
            .filter(Tick::is_on_axis)
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of logarithms of order one.
    const ROUNDING: f64 = 1e-12;

    fn labels(low: f64, high: f64, count: usize) -> Vec<String> {
        let axis = LogAxis::over([low, high].into_iter());
        axis.ticks(count).into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_powers_of_ten() {
        assert_eq!(labels(-3.0, 1.0, 9), ["10⁻³", "10⁻²", "10⁻¹", "1", "10"]);
        assert_eq!(labels(-2.9, 0.9, 9), ["10⁻²", "10⁻¹", "1"]);
        assert_eq!(
            labels(-16.0, 0.0, 9),
            ["10⁻¹⁶", "10⁻¹⁴", "10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²", "1"]
        );
        assert_eq!(labels(-0.1, 0.8, 9), ["1", "2", "5"]);
        assert_eq!(labels(-2.0, -1.0, 9), ["10⁻²", "2·10⁻²", "5·10⁻²", "10⁻¹"]);
        assert!(labels(-324.0, 309.0, 9).len() > 3);
        assert!(labels(-324.0, 309.0, 9).len() < 10);
    }

    #[test]
    fn minor_ticks_divide_decades_unless_there_are_many() {
        let places = |high: f64| LogAxis::over([0.0, high].into_iter()).minor_ticks();
        assert_eq!(places(3.0).len(), 3 * 8);
        assert!((places(1.0)[0].place - 2f64.log10()).abs() < ROUNDING);
        assert!((places(1.0)[0].place - 0.2).abs() > ROUNDING);
        assert!(places(20.0).is_empty());
    }

    #[test]
    fn an_axis_without_extent_can_be_drawn() {
        let one = LogAxis::over([-3.0].into_iter());
        assert!((one.place(-3.0) - 0.5).abs() < ROUNDING && one.length() > 0.1);
        assert_eq!(one, LogAxis::over([-3.0, -3.0].into_iter()));
        let none = LogAxis::over(std::iter::empty());
        assert_eq!([none.at(0.0), none.at(1.0)], [0.0, 1.0]);
        let axis = LogAxis::over([-4.0, 0.0].into_iter());
        assert!((axis.place(-1.0) - 0.75).abs() < ROUNDING);
        assert!((axis.lowered(-8.0).place(-2.0) - 0.75).abs() < ROUNDING);
        assert_eq!(axis.lowered(-1.0), axis);
    }
}
