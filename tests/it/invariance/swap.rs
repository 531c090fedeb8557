//! The membranes exchanged and turned upside down: `u1' = g - u2`, `u2' = g - u1` for the loads `-f2`, `-f1`, the tensions
//! `mu2`, `mu1` and a height that is affine on the whole domain. The action is the same.

use membrane_contact::discretization::PairDiscretization;

use super::random::{Draw, Formula};
use super::{EXACT, Fields, holds, is_seen, solve};

/// The domains lie in a disk of this radius, so an affine function with this constant and a slope up to 1 is not negative.
const RADIUS: f64 = 3.0;

fn affine(height: &Formula) -> Formula {
    let steepest = height.slope[0].hypot(height.slope[1]);
    Formula { constant: height.constant.abs() + RADIUS * steepest, wave: 0.0, cut_off: false, ..*height }
}

/// Exchanges the membranes with this sign of the loads.
fn exchanges(draw: &Draw, sign: f64) -> Result<(), String> {
    let mesh = draw.mesh.build()?;
    let height = affine(&draw.height);
    let draw = Draw { height, ..draw.clone() };
    let d = draw.discretize(&mesh)?;
    let expected = Fields::from(&solve(&d)?);

    let [f1, f2] = draw.load;
    let [mu1, mu2] = draw.tension;
    let exchanged = Draw { tension: [mu2, mu1], load: [f2.times(sign), f1.times(sign)], ..draw };
    let d_exchanged =
        PairDiscretization::new(&exchanged.problem()?, mesh.clone()).map_err(|error| error.to_string())?;
    let found = Fields::from(&solve(&d_exchanged)?);
    let below_height =
        |u: &[f64]| mesh.points().iter().zip(u).map(|(&[x, y], u)| height.at(x, y) - u).collect();
    let [upper, lower] = &found.displacement;
    let found = Fields { displacement: [below_height(lower), below_height(upper)], ..found.clone() };
    expected.compare(&found, &d, EXACT)
}

holds!(exchange_of_the_membranes, |draw| super::exchanges(draw, -1.0));

#[test]
fn loads_with_the_wrong_sign_are_seen() {
    is_seen(|draw| exchanges(draw, 1.0));
}
