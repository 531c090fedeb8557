//! Named problems whose solution is known exactly, for tests and convergence studies.
//!
//! Each case is given through the decoupled form of the problem: the gap `w = u1 - u2`, the action
//! `lambda`, and either `u2` or the weighted sum `s = mu1 u1 + mu2 u2`. Displacements and loads follow from
//! these in one place, [`ExactSolution`].

mod annulus;
mod decoupled;
mod description;
mod disk;
mod jet;
mod l_shape;
mod limits;
mod parameter;
mod solution;
mod stack;
mod strip;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::fmt;

pub use parameter::{CaseError, Parameter, Range};
pub use solution::ExactSolution;
pub use stack::{ExactStack, LineAction, StackCase};

use super::Domain;
use crate::geometry::Interface;
use crate::text::{excerpt, nearest};
use decoupled::Decoupled;
use description::Description;
use parameter::{Values, listed};

/// A problem with a known solution. The name in a case file stands in brackets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Case {
    /// Unit disk, constant data, contact in a smaller disk (`disk`).
    Disk,
    /// Unit square, contact in a strip, nodally exact on aligned meshes (`strip`).
    Strip,
    /// Unit square, contact in a disk, discontinuous action (`circle`).
    Circle,
    /// Unit square, neither gap nor action in an annulus, continuous action (`annulus`).
    Annulus,
    /// L-shape, corner singularity in the gap, biactive ring (`l-shape`).
    LShape,
    /// L-shape, corner singularity, nowhere in contact (`l-shape-free`).
    LShapeFree,
    /// Unit square, nowhere in contact (`no-contact`).
    NoContact,
    /// Unit square, everywhere in contact (`full-contact`).
    FullContact,
    /// Unit square, everywhere in contact without any action (`biactive`).
    Biactive,
}

impl Case {
    /// Every case, in the order in which they are listed.
    pub const ALL: [Self; 9] = [
        Self::Disk,
        Self::Strip,
        Self::Circle,
        Self::Annulus,
        Self::LShape,
        Self::LShapeFree,
        Self::NoContact,
        Self::FullContact,
        Self::Biactive,
    ];

    /// Printable lines (ASCII, at most 76 columns) on the notation that all [`Case::formulas`] share.
    pub const NOTATION: &'static [&'static str] = &[
        "M = mu1 + mu2, m = mu1 mu2 / M, w = u1 - u2, s = mu1 u1 + mu2 u2,",
        "u1 = (s + mu2 w)/M, u2 = (s - mu1 w)/M, u1 = g and u2 = 0 on the boundary,",
        "f1 = -mu1 Lap u1 - lambda, f2 = -mu2 Lap u2 + lambda,",
        "F = (mu2 f1 - mu1 f2)/M = -m Lap w - lambda, (v)_+ = max(v, 0).",
    ];

    /// The case called `name`.
    ///
    /// # Errors
    /// [`CaseError::UnknownCase`], with the nearest known name.
    pub fn from_name(name: &str) -> Result<Self, CaseError> {
        find(name, Self::ALL.into_iter(), Self::name)
    }

    /// The name in case files.
    pub fn name(self) -> &'static str {
        self.description().name
    }

    /// What the case is about, in one line.
    pub fn title(self) -> &'static str {
        self.description().title
    }

    /// The letter under which the mathematical notes list the case: `B` to `H3`.
    pub fn letter(self) -> &'static str {
        self.description().letter
    }

    /// The solution and its data, as printable lines (ASCII, at most 76 columns) in [`Case::NOTATION`].
    pub fn formulas(self) -> &'static [&'static str] {
        self.description().formulas
    }

    /// What can be chosen: always `mu1` and `mu2`, then the parameters of the case.
    pub fn parameters(self) -> &'static [Parameter] {
        self.description().parameters
    }

    /// The exact solution for the given parameters; those not given have their default.
    ///
    /// # Errors
    /// [`CaseError::UnknownParameter`] for a name that is not among [`Case::parameters`], and
    /// [`CaseError::OutOfRange`] for a value outside its range, NaN included.
    pub fn solution(self, parameters: &BTreeMap<String, f64>) -> Result<ExactSolution, CaseError> {
        let Description { name, parameters: known, build, .. } = self.description();
        let values = Values::new(name, known, parameters)?;
        Ok(ExactSolution::new(values.tension(), build(&values)?))
    }

    fn description(self) -> &'static Description<dyn Decoupled> {
        match self {
            Self::Disk => &disk::DISK,
            Self::Strip => &strip::STRIP,
            Self::Circle => &disk::CIRCLE,
            Self::Annulus => &annulus::ANNULUS,
            Self::LShape => &l_shape::L_SHAPE,
            Self::LShapeFree => &l_shape::L_SHAPE_FREE,
            Self::NoContact => &limits::NO_CONTACT,
            Self::FullContact => &limits::FULL_CONTACT,
            Self::Biactive => &limits::BIACTIVE,
        }
    }
}

/// The case called `name` among all.
fn find<C: Copy>(
    name: &str,
    mut all: impl Iterator<Item = C> + Clone,
    name_of: fn(C) -> &'static str,
) -> Result<C, CaseError> {
    let known = all.clone().map(name_of);
    all.find(|&case| name_of(case) == name).ok_or_else(|| CaseError::UnknownCase {
        name: excerpt(name),
        nearest: nearest(name, known.clone()).map_or("", |(known, _)| known),
        known: listed(known),
    })
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A case of either kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NamedCase {
    /// A pair.
    Pair(Case),
    /// A stack.
    Stack(StackCase),
}

impl NamedCase {
    /// Every case, in the order in which they are listed.
    pub fn all() -> impl Iterator<Item = Self> + Clone {
        let stacks = StackCase::ALL.into_iter().map(Self::Stack);
        Case::ALL.into_iter().map(Self::Pair).chain(stacks)
    }

    /// The case called `name`.
    ///
    /// # Errors
    /// [`CaseError::UnknownCase`], with the nearest known name.
    pub fn from_name(name: &str) -> Result<Self, CaseError> {
        find(name, Self::all(), Self::name)
    }

    /// The name in case files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pair(case) => case.name(),
            Self::Stack(case) => case.name(),
        }
    }

    /// What the case is about, in one line.
    pub fn title(self) -> &'static str {
        match self {
            Self::Pair(case) => case.title(),
            Self::Stack(case) => case.title(),
        }
    }

    /// The letter or number under which the mathematical notes list the case.
    pub fn letter(self) -> &'static str {
        match self {
            Self::Pair(case) => case.letter(),
            Self::Stack(case) => case.letter(),
        }
    }

    /// The notation that the formulas use, as printable lines.
    pub fn notation(self) -> &'static [&'static str] {
        match self {
            Self::Pair(_) => Case::NOTATION,
            Self::Stack(_) => StackCase::NOTATION,
        }
    }

    /// The solution and its data, as printable lines.
    pub fn formulas(self) -> &'static [&'static str] {
        match self {
            Self::Pair(case) => case.formulas(),
            Self::Stack(case) => case.formulas(),
        }
    }

    /// What can be chosen.
    pub fn parameters(self) -> &'static [Parameter] {
        match self {
            Self::Pair(case) => case.parameters(),
            Self::Stack(case) => case.parameters(),
        }
    }

    /// The exact solution for the given parameters; those not given have their default.
    ///
    /// # Errors
    /// As [`Case::solution`] and [`StackCase::solution`].
    pub fn solution(self, parameters: &BTreeMap<String, f64>) -> Result<Exact, CaseError> {
        match self {
            Self::Pair(case) => case.solution(parameters).map(Exact::Pair),
            Self::Stack(case) => case.solution(parameters).map(Exact::Stack),
        }
    }
}

/// The exact solution of a case of either kind.
#[derive(Debug, Clone)]
pub enum Exact {
    /// Of a pair.
    Pair(ExactSolution),
    /// Of a stack.
    Stack(ExactStack),
}

impl Exact {
    /// The domain.
    pub fn domain(&self) -> Domain {
        match self {
            Self::Pair(exact) => exact.domain(),
            Self::Stack(exact) => exact.domain(),
        }
    }

    /// The regions that a mesh has to name: see [`ExactStack::regions`].
    pub fn regions(&self) -> Vec<(&'static str, Interface)> {
        match self {
            Self::Pair(_) => Vec::new(),
            Self::Stack(exact) => exact.regions(),
        }
    }

    /// That of a pair.
    pub fn pair(&self) -> Option<&ExactSolution> {
        match self {
            Self::Pair(exact) => Some(exact),
            Self::Stack(_) => None,
        }
    }
}
