//! Stacks drawn at random: up to five membranes, with regions, free sides, foundations, obstacles.

use proptest::prelude::*;

use crate::problem::{ContactProblem, Field, Function, Membrane};

/// The numbers of a membrane.
#[derive(Debug, Clone)]
pub(crate) struct Numbers {
    pub(crate) tension: [f64; 2],
    pub(crate) load: [f64; 3],
    pub(crate) foundation: f64,
    pub(crate) free: [bool; 3],
    pub(crate) traction: f64,
    pub(crate) step: f64,
}

fn numbers() -> impl Strategy<Value = Numbers> {
    let tension = prop::array::uniform2(-1.0..1.0f64);
    let load = prop::array::uniform3(-30.0..30.0f64);
    let foundation = prop_oneof![Just(0.0), 0.0..20.0f64];
    (tension, load, foundation, prop::array::uniform3(any::<bool>()), -3.0..3.0f64, 0.0..0.05f64).prop_map(
        |(tension, load, foundation, free, traction, step)| Numbers {
            tension: tension.map(|exponent| 10f64.powf(exponent)),
            load,
            foundation,
            free,
            traction,
            step,
        },
    )
}

/// Membranes from the bottom up, each held a little higher than the one below, and whether there are floor and ceiling.
#[derive(Debug, Clone)]
pub(crate) struct Drawn {
    pub(crate) membranes: Vec<Numbers>,
    pub(crate) obstacles: [bool; 2],
}

pub(crate) fn drawn() -> impl Strategy<Value = Drawn> {
    (prop::collection::vec(numbers(), 1..=5), prop::array::uniform2(any::<bool>()))
        .prop_map(|(membranes, obstacles)| Drawn { membranes, obstacles })
}

impl Drawn {
    /// The problem, with loads and heights times `size` and a further `push` on all membranes.
    pub(crate) fn problem(&self, size: f64, push: f64) -> ContactProblem {
        let mut heights = Vec::new();
        let mut height = 0.0;
        for numbers in self.membranes.iter().rev() {
            heights.push(height);
            height += numbers.step;
        }
        let mut stack = ContactProblem::stack();
        if self.obstacles[0] {
            stack = stack.ceiling(size * (height + 0.1));
        }
        for (numbers, height) in self.membranes.iter().zip(heights.into_iter().rev()) {
            let [f, fx, fxy] = numbers.load;
            let load = Function::from_fn(move |x, y| size * (f + push + fx * x + fxy * x * y));
            let tension = Field::by_region([("patch", numbers.tension[0])]).elsewhere(numbers.tension[1]);
            let mut membrane =
                Membrane::new(tension).load(load).foundation(numbers.foundation).height(size * height);
            for (side, free) in ["west", "north", "east"].into_iter().zip(numbers.free) {
                if free {
                    membrane = membrane.traction_on(side, size * numbers.traction);
                }
            }
            stack = stack.membrane(membrane);
        }
        if self.obstacles[1] {
            stack = stack.floor(Field::from(Function::from_fn(move |x, y| size * (-0.2 + 0.1 * x * y))));
        }
        stack.build().unwrap()
    }
}
