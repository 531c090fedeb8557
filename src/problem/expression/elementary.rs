//! Sine, cosine and exponential at many points: polynomials that the compiler turns into vector instructions.
//!
//! They consist of additions, multiplications and moved bits only, so they give the same bits on every machine; and they are off by less
//! than one unit in the last place. Beyond the range in which the reduction of the argument is exact, and for arguments that are no
//! numbers, the portable functions of `libm` take over.

use std::f64::consts::{FRAC_2_PI, LOG2_E};

/// Adding it rounds a number below 2^51 to a whole one, which is then in the last bits.
const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52

/// `pi / 2` in three parts: the first two have 33 bits, so that multiples of up to 2^20 times them are exact.
const HALF_PI: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];

/// The largest argument of sine and cosine that is reduced by them.
const LARGEST_ANGLE: f64 = 1e6;

/// `ln 2` in two parts: the first has 32 bits.
const LN_2: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];

/// The largest argument of the exponential whose power of two is a normal number.
const LARGEST_EXPONENT: f64 = 700.0;

/// Sine of each.
pub(super) fn sines(x: &mut [f64]) {
    each(x, LARGEST_ANGLE, |x| sine_of_turn(x, 0), libm::sin);
}

/// Cosine of each: the sine a quarter of a turn further on.
pub(super) fn cosines(x: &mut [f64]) {
    each(x, LARGEST_ANGLE, |x| sine_of_turn(x, 1), libm::cos);
}

/// Exponential of each.
pub(super) fn exponentials(x: &mut [f64]) {
    each(x, LARGEST_EXPONENT, exponential, libm::exp);
}

/// Applies one function to arguments up to `largest`, and another to the others.
#[inline(always)]
fn each(x: &mut [f64], largest: f64, near: impl Fn(f64) -> f64, far: impl Fn(f64) -> f64) {
    if x.iter().all(|x| x.abs() <= largest) {
        x.iter_mut().for_each(|x| *x = near(*x));
    } else {
        x.iter_mut().for_each(|x| *x = if x.abs() <= largest { near(*x) } else { far(*x) });
    }
}

/// The sine of `x + quarters pi / 2`.
#[inline(always)]
fn sine_of_turn(x: f64, quarters: u64) -> f64 {
    let turns = x * FRAC_2_PI + ROUND;
    let multiple = turns - ROUND;
    let quarter = turns.to_bits().wrapping_add(quarters);
    // x = multiple pi / 2 + (r + rest) with |r| <= pi / 4
    let [first, second, third] = HALF_PI.map(|part| multiple * part);
    let exact = x - first;
    let nearly = exact - second;
    let lost = third - ((exact - nearly) - second);
    let r = nearly - lost;
    let rest = (nearly - r) - lost;
    // Chosen by masks: a branch would keep the compiler from working on several arguments at once.
    let [even, odd] = [sine(r, rest), cosine(r, rest)].map(f64::to_bits);
    let is_odd = (quarter & 1).wrapping_neg();
    f64::from_bits((even & !is_odd | odd & is_odd) ^ ((quarter & 2) << 62))
}

/// `sin(x + rest)` for `|x| <= pi / 4` and a `rest` that is no larger than its rounding (polynomial of fdlibm, Sun Microsystems 1993).
#[inline(always)]
fn sine(x: f64, rest: f64) -> f64 {
    let z = x * x;
    let tail = 0.008_333_333_333_322_49
        + z * (-0.000_198_412_698_298_579_5 + z * 2.755_731_370_707_006_8e-6)
        + z * (z * z) * (-2.505_076_025_340_686_3e-8 + z * 1.589_690_995_211_55e-10);
    let cube = z * x;
    x - ((z * (0.5 * rest - cube * tail) - rest) - cube * -0.166_666_666_666_666_32)
}

/// `cos(x + rest)`, likewise.
#[inline(always)]
fn cosine(x: f64, rest: f64) -> f64 {
    let z = x * x;
    let tail = z
        * (0.041_666_666_666_666_6 + z * (-0.001_388_888_888_887_411 + z * 2.480_158_728_947_673e-5))
        + (z * z)
            * (z * z)
            * (-2.755_731_435_139_066_3e-7
                + z * (2.087_572_321_298_175e-9 + z * -1.135_964_755_778_819_5e-11));
    let half = 0.5 * z;
    let leading = 1.0 - half;
    leading + (((1.0 - leading) - half) + (z * tail - x * rest))
}

/// `2^k exp(r)` with `|r| <= ln 2 / 2`.
#[inline(always)]
fn exponential(x: f64) -> f64 {
    let power = x * LOG2_E + ROUND;
    let k = power - ROUND;
    let high = x - k * LN_2[0];
    let low = k * LN_2[1];
    let r = high - low;
    let z = r * r;
    // The Taylor polynomial of degree 13: the first term that is left out is below 2^-57.
    let even = 1.0 / 2.0
        + z * (1.0 / 24.0
            + z * (1.0 / 720.0 + z * (1.0 / 40_320.0 + z * (1.0 / 3_628_800.0 + z * (1.0 / 479_001_600.0)))));
    let odd = 1.0 / 6.0
        + z * (1.0 / 120.0
            + z * (1.0 / 5_040.0
                + z * (1.0 / 362_880.0 + z * (1.0 / 39_916_800.0 + z * (1.0 / 6_227_020_800.0)))));
    // What rounding has taken from r is the largest error.
    let lost = (high - r) - low;
    let value = 1.0 + (r + (z * (even + r * odd) + lost));
    f64::from_bits(value.to_bits().wrapping_add(power.to_bits() << 52))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::Random;

    /// Units in the last place between two results that are each off by less than one.
    const APART: u64 = 1;

    type Function = (&'static str, fn(&mut [f64]), fn(f64) -> f64, f64);

    const FUNCTIONS: [Function; 3] = [
        ("sin", sines, libm::sin, LARGEST_ANGLE),
        ("cos", cosines, libm::cos, LARGEST_ANGLE),
        ("exp", exponentials, libm::exp, LARGEST_EXPONENT),
    ];

    fn apart(a: f64, b: f64) -> u64 {
        a.to_bits().abs_diff(b.to_bits())
    }

    /// Of all sizes, next to multiples of a quarter of a turn, and both signs.
    fn arguments(largest: f64) -> Vec<f64> {
        let mut random = Random::new(1);
        let of_all_sizes = (0..200_000).map(|_| largest * 10f64.powf(random.between(-20.0, 0.0)));
        let quarters = (0..20_000).map(|k| f64::from(k) * std::f64::consts::FRAC_PI_2);
        let uniform = (0..200_000).map(|k| largest * f64::from(k) / 200_000.0);
        let positive: Vec<f64> =
            of_all_sizes.chain(quarters.filter(|&x| x < largest)).chain(uniform).chain([largest]).collect();
        positive.iter().flat_map(|&x| [x, -x]).collect()
    }

    #[test]
    fn they_are_those_of_libm_up_to_the_last_place() {
        for (name, many, one, largest) in FUNCTIONS {
            let x = arguments(largest);
            let mut values = x.clone();
            many(&mut values);
            for (&x, &value) in x.iter().zip(&values) {
                assert!(apart(value, one(x)) <= APART, "{name}({x:e}) = {value:e}, not {:e}", one(x));
            }
            // Another argument is another value.
            assert!(apart(values[0], one(1.5 * x[0])) > APART);
        }
    }

    #[test]
    fn exact_values_and_arguments_out_of_range() {
        for (name, many, one, largest) in FUNCTIONS {
            let hard = [
                0.0,
                -0.0,
                1e-300,
                f64::INFINITY,
                f64::NEG_INFINITY,
                f64::NAN,
                1e22,
                -1e300,
                2.0 * largest,
                -2.0 * largest,
                745.2,
                -745.2,
                709.8,
                1.0,
            ];
            let mut values = hard;
            many(&mut values);
            for (x, value) in hard.into_iter().zip(values) {
                let expected = one(x);
                let is_same = apart(value, expected) <= APART || value.is_nan() && expected.is_nan();
                assert!(is_same, "{name}({x:e}) = {value:e}, not {expected:e}");
                let mut alone = [x];
                many(&mut alone);
                assert!(alone[0].to_bits() == value.to_bits() || value.is_nan(), "{name}({x:e}) alone");
            }
            assert_eq!(values[0], if name == "sin" { 0.0 } else { 1.0 });
        }
        let mut zero = [-0.0];
        sines(&mut zero);
        assert!(zero[0].is_sign_negative());
    }

    /// The bits of some values, made on x86-64: the same on every machine.
    #[test]
    fn their_bits_are_known() {
        for ((name, many, ..), expected) in FUNCTIONS.into_iter().zip([
            15_640_006_069_203_103_336,
            1_432_099_269_461_530_139,
            1_539_222_906_722_528_553,
        ]) {
            let mut values: Vec<f64> = (0..1000).map(|k| 0.37 * f64::from(k) - 185.0).collect();
            many(&mut values);
            let mixed = |sum: u64, value: &f64| sum.rotate_left(5) ^ value.to_bits();
            assert_eq!(values.iter().fold(0, mixed), expected, "{name}");
        }
    }
}
