//! Every solver finds the same.

use membrane_contact::action::PairSolution;
use membrane_contact::discretization::PairDiscretization;
use membrane_contact::solver::ContactSolver;

use super::random::Draw;
use super::{Fields, Nearness, holds, is_seen, solve_by};
use crate::common::solvers;

/// How far solvers are from each other, in units of the data, that are certified at 1e-8: most are exact to rounding, multigrid
/// stops at the tolerance.
const NEAR: Nearness = Nearness { displacement: 1e-7, action: 1e-6 };

/// The certificate is one of forces: what they may be wrong by moves the softer membrane more than it would move the other.
fn nearness(d: &PairDiscretization) -> Nearness {
    let scales = d.scales();
    let (lower, upper) = d.mesh().bounding_box();
    let width = (upper[0] - lower[0]).min(upper[1] - lower[1]);
    let softer = d.tension()[0].min(d.tension()[1]);
    let moved = scales.force_density / softer * width * width / 8.0;
    Nearness { displacement: NEAR.displacement * (moved / scales.displacement).max(1.0), ..NEAR }
}

fn agree(draw: &Draw, change: fn(&mut Fields)) -> Result<(), String> {
    let mesh = draw.mesh.build()?;
    let d = draw.discretize(&mesh)?;
    let solve = |mut solver: Box<dyn ContactSolver>| solve_by(&mut *solver, &d);
    let solutions: Vec<PairSolution> = solvers().into_iter().map(solve).collect::<Result<_, _>>()?;
    let expected = Fields::from(&solutions[0]);
    for solution in &solutions[1..] {
        let mut found = Fields::from(solution);
        change(&mut found);
        expected.compare(&found, &d, nearness(&d)).map_err(|difference| {
            let [first, other] =
                [&solutions[0], solution].map(|solution| solution.statistics().solver.clone());
            format!("{first} and {other}: {difference}")
        })?;
    }
    Ok(())
}

holds!(all_solvers_agree, |draw| super::agree(draw, |_| {}));

#[test]
fn an_action_that_differs_by_one_percent_is_seen() {
    is_seen(|draw| agree(draw, |fields| fields.lambda.iter_mut().for_each(|lambda| *lambda *= 1.01)));
}

#[test]
fn a_contact_set_that_differs_is_seen() {
    is_seen(|draw| agree(draw, |fields| fields.contact.iter_mut().for_each(|contact| *contact = !*contact)));
}
