//! The paper's pair (1.1).

use super::{Function, Membrane, Support};

/// The data of (1.1): tensions, loads, boundary height.
#[derive(Debug, Clone)]
pub struct Pair {
    pub(super) tension: [f64; 2],
    pub(super) load: [Function; 2],
    pub(super) height: Function,
}

impl Pair {
    /// `[mu1, mu2]`, force per length, positive.
    pub fn tension(&self) -> [f64; 2] {
        self.tension
    }

    /// `[f1, f2]`, force per area, positive upwards.
    pub fn load(&self) -> &[Function; 2] {
        &self.load
    }

    /// `g`, the height at which membrane 1 is fixed on the boundary; its values elsewhere are not used.
    pub fn height(&self) -> &Function {
        &self.height
    }

    /// Two membranes without obstacles as the paper's pair, where they are one.
    pub(super) fn of([upper, lower]: [&Membrane; 2]) -> Option<Self> {
        let tension = [upper.tension.constant()?, lower.tension.constant()?];
        let load = [upper.load.function()?.clone(), lower.load.function()?.clone()];
        let without_foundation = [upper, lower].iter().all(|m| m.foundation.constant() == Some(0.0));
        let height = |membrane: &Membrane| match (&membrane.elsewhere, membrane.parts.as_slice()) {
            (Support::Fixed(height), []) => height.function().cloned(),
            _ => None,
        };
        let height_below = height(lower)?;
        let at_zero = matches!(height_below, Function::Constant(0.0));
        let height = height(upper)?;
        (without_foundation && at_zero).then_some(Self { tension, load, height })
    }
}
