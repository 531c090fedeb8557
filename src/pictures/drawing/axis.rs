//! Axes: the range of one quantity, its power of ten, and round ticks.

/// Magnitudes below this are drawn as zero: smaller ones lose their digits in `f64`.
const SMALLEST: f64 = 1e-300;

/// A range narrower than this, relative to its magnitude, holds rounding errors only.
const FLAT: f64 = 1e-12;

/// The range of a quantity, in units of a power of ten chosen so that tick labels stay short.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    low: f64,
    high: f64,
    exponent: i32,
    unit: f64,
}

/// A tick: its place on the axis (0 at the low end, 1 at the high end) and its label.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub(crate) place: f64,
    pub(crate) label: String,
}

impl Tick {
    /// Whether the tick lies between the ends of its axis.
    pub(crate) fn is_on_axis(&self) -> bool {
        const NEARLY: f64 = 1e-9;
        (-NEARLY..=1.0 + NEARLY).contains(&self.place)
    }
}

impl Axis {
    /// The axis from `low` to `high`; a range without extent is widened so that it can be drawn.
    pub(crate) fn new(low: f64, high: f64) -> Axis {
        let magnitude = low.abs().max(high.abs());
        if magnitude < SMALLEST {
            return Axis { low: 0.0, high: 1.0, exponent: 0, unit: 1.0 };
        }
        let digits = magnitude.log10().floor() as i32;
        let exponent = if (-2..=3).contains(&digits) { 0 } else { digits };
        let unit = 10f64.powi(exponent);
        let (low, high) = (low / unit, high / unit);
        let magnitude = magnitude / unit;
        if high - low > FLAT * magnitude {
            Axis { low, high, exponent, unit }
        } else {
            Axis { low: low - magnitude / 2.0, high: high + magnitude / 2.0, exponent, unit }
        }
    }

    /// The axis over all `values`, zero included if `from_zero`.
    pub(crate) fn over(values: impl Iterator<Item = f64>, from_zero: bool) -> Axis {
        let start = if from_zero { (0.0, 0.0) } else { (f64::INFINITY, f64::NEG_INFINITY) };
        let (low, high) = values.fold(start, |(low, high), value| (low.min(value), high.max(value)));
        if low <= high { Axis::new(low, high) } else { Axis::new(0.0, 0.0) }
    }

    /// The same axis with these parts of its length added below and above.
    pub(crate) fn widened(self, [below, above]: [f64; 2]) -> Axis {
        let length = self.high - self.low;
        Axis { low: self.low - below * length, high: self.high + above * length, ..self }
    }

    /// Where `value` lies: 0 at the low end, 1 at the high end.
    pub(crate) fn place(&self, value: f64) -> f64 {
        (value / self.unit - self.low) / (self.high - self.low)
    }

    /// The length of the axis, in the unit of the data.
    pub(crate) fn length(&self) -> f64 {
        (self.high - self.low) * self.unit
    }

    /// The power of ten as a suffix of the axis title, empty for 1.
    pub(crate) fn suffix(&self) -> String {
        if self.exponent == 0 { String::new() } else { format!("  ({})", self.power()) }
    }

    /// The power of ten that the labels are to be multiplied by, empty for 1.
    pub(crate) fn power(&self) -> String {
        if self.exponent == 0 { String::new() } else { format!("×10{}", superscript(self.exponent)) }
    }

    /// A tick at a value, to a thousandth of the length.
    pub(crate) fn tick_at(&self, value: f64) -> Tick {
        let step = round_step((self.high - self.low) / 1000.0);
        Tick { place: self.place(value), label: number(value / self.unit, step) }
    }

    /// Round ticks, about `count` of them.
    pub(crate) fn ticks(&self, count: usize) -> Vec<Tick> {
        let step = round_step((self.high - self.low) / count.max(1) as f64);
        let nearly = 1e-6;
        let first = (self.low / step - nearly).ceil() as i64;
        let last = (self.high / step + nearly).floor() as i64;
        let tick = |k: i64| {
            let value = k as f64 * step;
            Tick { place: (value - self.low) / (self.high - self.low), label: number(value, step) }
        };
        (first..=last).map(tick).collect()
    }

    /// The round number next to the place `place`, to a hundredth of the length or to less where that is farther off than
    /// `reach`: its place and its label.
    pub(crate) fn round(&self, place: f64, reach: f64) -> Tick {
        const FINEST: i32 = 10;
        let at = |digits: i32| self.rounded(place, 10f64.powi(-digits));
        let near = |tick: &Tick| (tick.place - place).abs() <= reach;
        (2..FINEST).map(at).find(near).unwrap_or_else(|| at(FINEST))
    }

    /// The round number next to the place `place`, to this part of the length.
    fn rounded(&self, place: f64, part: f64) -> Tick {
        let step = round_step((self.high - self.low) * part);
        let value = ((self.low + place * (self.high - self.low)) / step).round() * step;
        let place = (value - self.low) / (self.high - self.low);
        let digits = number(value, step);
        if digits == "0" {
            return Tick { place, label: digits };
        }
        let digits =
            if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { &digits };
        Tick { place, label: format!("{digits}{}", self.power()) }
    }
}

/// The smallest of 1, 2, 5 times a power of ten that is at least `step`.
fn round_step(step: f64) -> f64 {
    let power = 10f64.powf(step.log10().floor());
    let multiple = step / power * (1.0 - 1e-9);
    power
        * if multiple <= 1.0 {
            1.0
        } else if multiple <= 2.0 {
            2.0
        } else if multiple <= 5.0 {
            5.0
        } else {
            10.0
        }
}

/// A multiple of `step` with the decimals that the step needs and a true minus sign.
fn number(value: f64, step: f64) -> String {
    if value.abs() < step / 2.0 {
        return "0".to_owned();
    }
    let decimals = (1e-9 - step.log10().floor()).max(0.0) as usize;
    format!("{value:.decimals$}").replace('-', "−")
}

/// A positive number by two digits, in powers of ten where it is small or large.
pub(crate) fn scientific(value: f64) -> String {
    times(value).trim_start_matches('×').to_owned()
}

/// A factor by two digits, such as "×2.5", "×40" or "×1.2·10⁻⁷".
pub(crate) fn times(factor: f64) -> String {
    let exponent = factor.log10().floor();
    if !(-3.0..4.0).contains(&exponent) {
        let digits = format!("{factor:.1e}");
        let (digits, power) = digits.split_once('e').unwrap_or((&digits, "0"));
        return format!("×{digits}·10{}", superscript(power.parse().unwrap_or(0)));
    }
    let unit = 10f64.powf(exponent - 1.0);
    let decimals = (1.0 - exponent).max(0.0) as usize;
    let digits = format!("{:.decimals$}", (factor / unit).round() * unit);
    let short =
        if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { &digits };
    format!("×{short}")
}

/// A number in lowered digits.
pub(crate) fn subscript(number: usize) -> String {
    let lower = |c: char| char::from_u32('₀' as u32 + c as u32 - '0' as u32).unwrap_or(c);
    number.to_string().chars().map(lower).collect()
}

/// An integer in raised digits.
pub(crate) fn superscript(exponent: i32) -> String {
    let raise = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => char::from_u32('⁰' as u32 + c as u32 - '0' as u32).unwrap_or(c),
    };
    exponent.to_string().chars().map(raise).collect()
}
