//! Multigrid for membranes and obstacles that know of each other.

use web_time::Instant;

use super::actions::actions;
use crate::discretization::{Displacements, StackDiscretization};
use crate::multigrid::stack::{MAX_CYCLES, StackGoal, StackLevels, solve};
use crate::solver::{Candidate, SolverError, SolverOptions, Statistics};

/// The residuals may miss the tolerance by as much: the rest is for the rounding of the actions.
const SHARE: f64 = 0.5;

/// Solves on these levels; the time limit counts from `start`. The seconds in the statistics are left to others.
pub(in crate::solver) fn solve_on(
    levels: &StackLevels,
    d: &StackDiscretization,
    name: &str,
    options: &SolverOptions,
    start: Instant,
) -> Result<Candidate, SolverError> {
    let force = SHARE * options.tolerance * d.scales().force_density;
    let guess = options.warm_start.as_ref().filter(|guess| guess.fits_stack(d));
    let goal = StackGoal {
        weight: levels.hierarchy().to_rows(|a| 1.0 / (force * d.dual_area()[a])),
        start: match guess {
            Some(guess) => levels.to_entries(|i, a| guess.displacement[i][a]),
            None => {
                let start = at_rest(d);
                levels.to_entries(|i, a| start[i][a])
            }
        },
        is_guess: guess.is_some(),
    };
    let found = solve(levels, goal, &options.limits(MAX_CYCLES, start))?;
    let mut displacement: Displacements = vec![vec![0.0; d.dual_area().len()]; d.membranes()];
    for (&a, u) in levels.hierarchy().vertex().iter().zip(found.u.chunks_exact(d.membranes())) {
        displacement.iter_mut().zip(u).for_each(|(of_membrane, &u)| of_membrane[a as usize] = u);
    }
    let touches: Vec<bool> = d.rows().iter().map(|row| d.gap(&displacement, row) <= 0.0).collect();
    let [mut multiplier, _] = actions(d, &touches, &displacement);
    // What is left below zero is within the tolerance.
    multiplier.iter_mut().for_each(|y| *y = y.max(0.0));
    Ok(Candidate {
        displacement,
        multiplier,
        statistics: Statistics {
            iterations: found.cycles.last().copied().unwrap_or(0),
            level_iterations: found.cycles,
            energies: found.energies,
            ..Statistics::of(name, found.status)
        },
    })
}

/// Heights where membranes are fixed, and zero elsewhere; but those that nothing else holds on what they are pressed against.
fn at_rest(d: &StackDiscretization) -> Displacements {
    let vertices = d.dual_area().len();
    let height = |i: usize, a: usize| d.height(i, a).unwrap_or(0.0);
    let mut u: Displacements =
        (1..=d.membranes()).map(|i| (0..vertices).map(|a| height(i, a)).collect()).collect();
    let resting = d.resting();
    let mut layers = Vec::new();
    (0..vertices).for_each(|a| {
        for segment in d.segments(a, &resting, &mut layers) {
            if let Some(height) = segment.above.or(segment.below) {
                segment.layers.for_each(|i| u[i - 1][a] = height);
            }
        }
    });
    u
}
