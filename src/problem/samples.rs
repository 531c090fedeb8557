//! Problems drawn at random, for the tests of all rooms.

pub(crate) mod stack;

use proptest::prelude::*;

use super::{ContactProblem, Function};

/// Any problem: tensions over four decades, cubic loads that push the membranes together, apart, or both; `height` of a number up
/// to a twentieth is the height.
pub(crate) fn drawn(height: fn(f64) -> Function) -> impl Strategy<Value = ContactProblem> {
    let coefficients = || prop::array::uniform4(-20.0..20.0f64);
    ([-2.0..2.0f64, -2.0..2.0], coefficients(), coefficients(), 0.0..0.05f64).prop_map(
        move |([mu1, mu2], f1, f2, size)| {
            let cubic =
                |[a, b, c, d]: [f64; 4]| Function::from_fn(move |x, y| a + b * x * y + c * x * x * y + d * y);
            ContactProblem::builder()
                .tension(10f64.powf(mu1), 10f64.powf(mu2))
                .load(cubic(f1), cubic(f2))
                .height(height(size))
                .build()
                .unwrap()
        },
    )
}
