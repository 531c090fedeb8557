//! What holds where `K` has no positive entry off its diagonal: the comparison principle, and the discrete bound of Lewy and
//! Stampacchia for the action.

use membrane_contact::action::PairSolution;
use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::Mesh;

use super::random::{Draw, Formula};
use super::{EXACT, Property, holds, is_seen, solve};

/// Entries off the diagonal that are positive by rounding, relative to the diagonal.
const ROUNDING: f64 = 1e-12;

/// A Delaunay mesh like that of the problem.
fn delaunay_mesh(draw: &Draw) -> Result<Mesh, String> {
    let mesh = draw.mesh.delaunay().build()?;
    let d = draw.discretize(&mesh)?;
    let positive = |&a: &usize| {
        let row = d.stiffness().outer_view(a).expect("a vertex has a row");
        let diagonal = row.get(a).copied().unwrap_or(0.0);
        row.iter().any(|(b, &k)| b != a && k > ROUNDING * diagonal)
    };
    match d.interior().iter().find(|a| positive(a)) {
        Some(a) => Err(format!("row {a} of K has a positive entry off the diagonal")),
        None => Ok(mesh),
    }
}

/// The datum that is raised, by how much of its size, and the signs of the changes that follow: of `u1`, `u2`, gap, action.
struct Change {
    raise: fn(&mut Draw, f64),
    signs: [f64; 4],
}

/// More load on membrane 1 (upwards): everything goes up, and less push.
const FIRST_LOAD: Change =
    Change { raise: |draw, by| raise(&mut draw.load[0], by), signs: [1.0, 1.0, 1.0, -1.0] };
/// More load on membrane 2: everything goes up, the gap closes, and more push.
const SECOND_LOAD: Change =
    Change { raise: |draw, by| raise(&mut draw.load[1], by), signs: [1.0, 1.0, -1.0, 1.0] };
/// Membrane 1 fixed higher: it goes up, and lets the other follow.
const HEIGHT: Change = Change { raise: |draw, by| raise(&mut draw.height, by), signs: [1.0, 1.0, 1.0, -1.0] };

fn raise(formula: &mut Formula, by: f64) {
    let size = formula.constant.abs() + formula.slope[0].abs() + formula.wave.abs();
    formula.constant += by * if size > 0.0 { size } else { 0.1 };
}

/// Raises a datum and looks which way the solution goes.
fn is_monotone(draw: &Draw, Change { raise, signs }: &Change) -> Result<(), String> {
    let mesh = delaunay_mesh(draw)?;
    let mut raised = draw.clone();
    raise(&mut raised, 0.1);
    let [d, d_raised] = [draw.discretize(&mesh)?, raised.discretize(&mesh)?];
    let [before, after] = [solve(&d)?, solve(&d_raised)?];
    let length = EXACT.displacement * d.scales().displacement.max(d_raised.scales().displacement);
    let force = EXACT.action * d.scales().force_density.max(d_raised.scales().force_density);
    let values = |solution: &PairSolution| {
        let [u1, u2] = solution.displacement().clone();
        [u1, u2, solution.gap(), solution.lambda().to_vec()]
    };
    let allowed = [length, length, length, force];
    let names = ["u1", "u2", "the gap", "lambda"];
    for (k, (before, after)) in values(&before).iter().zip(&values(&after)).enumerate() {
        let against = |a: &usize| signs[k] * (after[*a] - before[*a]) < -allowed[k];
        if let Some(a) = (0..before.len()).find(against) {
            return Err(format!("{} goes from {:e} to {:e} at vertex {a}", names[k], before[a], after[a]));
        }
    }
    Ok(())
}

/// `0 <= lambda_a <= max(0, (mu1 F_2 - mu2 F_1)_a / ((mu1 + mu2) |D_a|))`, for the action times a factor.
fn is_bounded(draw: &Draw, factor: f64) -> Result<(), String> {
    let mesh = delaunay_mesh(draw)?;
    let d = draw.discretize(&mesh)?;
    let solution = solve(&d)?;
    let rounding = EXACT.action * d.scales().force_density;
    for &a in d.interior() {
        let (lambda, most) = (factor * solution.lambda()[a], most(&d, a));
        if !(-rounding..=most + rounding).contains(&lambda) {
            return Err(format!("lambda = {lambda:e} at vertex {a}, the bound is {most:e}"));
        }
    }
    Ok(())
}

fn most(d: &PairDiscretization, a: usize) -> f64 {
    let [mu1, mu2] = d.tension();
    let [f1, f2] = d.load();
    ((mu1 * f2[a] - mu2 * f1[a]) / ((mu1 + mu2) * d.dual_area()[a])).max(0.0)
}

holds!(monotone_in_the_first_load, |draw| super::is_monotone(draw, &super::FIRST_LOAD));
holds!(monotone_in_the_second_load, |draw| super::is_monotone(draw, &super::SECOND_LOAD));
holds!(monotone_in_the_height, |draw| super::is_monotone(draw, &super::HEIGHT));
holds!(lewy_stampacchia, |draw| super::is_bounded(draw, 1.0));

#[test]
fn each_sign_of_each_change_is_seen_when_it_is_wrong() {
    const WRONG: [Property; 4] = [
        |draw| is_monotone(draw, &Change { signs: [-1.0, 1.0, 1.0, -1.0], ..FIRST_LOAD }),
        |draw| is_monotone(draw, &Change { signs: [1.0, -1.0, 1.0, -1.0], ..HEIGHT }),
        |draw| is_monotone(draw, &Change { signs: [1.0, 1.0, 1.0, 1.0], ..SECOND_LOAD }),
        |draw| is_monotone(draw, &Change { signs: [1.0, 1.0, 1.0, 1.0], ..FIRST_LOAD }),
    ];
    WRONG.into_iter().for_each(is_seen);
}

#[test]
fn an_action_that_is_one_percent_too_large_is_seen() {
    is_seen(|draw| is_bounded(draw, 1.01));
}
