//! Stacks of membranes with a known solution.

mod ball;
mod foundation;
mod graded;
mod layers;
mod lines;
mod manufactured;
mod nested;
mod solution;

use std::collections::BTreeMap;
use std::fmt;

pub use layers::LineAction;
pub use solution::ExactStack;

use super::description::Description;
use super::parameter::{CaseError, Parameter, Values};
use layers::Layers;

/// A stack with a known solution. The name in a case file stands in brackets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum StackCase {
    /// Unit disk, one membrane on a floor (`floor-disk`).
    FloorDisk,
    /// Square, one membrane over a ball (`ball`).
    Ball,
    /// Strip, three membranes, nodally exact on aligned meshes (`three-strips`).
    ThreeStrips,
    /// Unit disk, three membranes, contact in nested discs (`three-discs`).
    ThreeDiscs,
    /// Unit disk, a tension that grows from the middle, on a floor (`graded-disk`).
    GradedDisk,
    /// Unit disk, two tensions that are not in proportion (`two-tensions`).
    TwoTensions,
    /// Strip, a line action where a tension jumps (`tension-jump`).
    TensionJump,
    /// Strip, two membranes over a floor, nodally exact on aligned meshes (`strip-on-floor`).
    StripOnFloor,
    /// Strip, one membrane on an elastic foundation and on a floor (`foundation`).
    Foundation,
    /// Strip, a line action on a free side (`free-end`).
    FreeEnd,
    /// Unit square, one to five membranes, contact in overlapping discs (`manufactured`).
    Manufactured,
    /// Unit square, contact without any action in the left half (`biactive-stack`).
    BiactiveStack,
}

impl StackCase {
    /// Every case, in the order in which they are listed.
    pub const ALL: [Self; 12] = [
        Self::FloorDisk,
        Self::Ball,
        Self::ThreeStrips,
        Self::ThreeDiscs,
        Self::GradedDisk,
        Self::TwoTensions,
        Self::TensionJump,
        Self::StripOnFloor,
        Self::Foundation,
        Self::FreeEnd,
        Self::Manufactured,
        Self::BiactiveStack,
    ];

    /// Printable lines (ASCII, at most 76 columns) on the notation that all [`StackCase::formulas`] share.
    pub const NOTATION: &'static [&'static str] = &[
        "u1 >= u2 >= ... >= uN >= floor; gap k lies below membrane k,",
        "w_k = u_k - u_(k+1), lambda_k >= 0, lambda_k w_k = 0, lambda_0 = 0,",
        "-div(mu_i grad u_i) + c u_i = f_i + lambda_i - lambda_(i-1),",
        "u_i as given on the boundary, mu_i d_n u_i = t_i where it is free.",
    ];

    /// The name in case files.
    pub fn name(self) -> &'static str {
        self.description().name
    }

    /// What the case is about, in one line.
    pub fn title(self) -> &'static str {
        self.description().title
    }

    /// The number under which the mathematical notes list the case: `S1` to `S13`.
    pub fn letter(self) -> &'static str {
        self.description().letter
    }

    /// The solution and its data, as printable lines (ASCII, at most 76 columns) in [`StackCase::NOTATION`].
    pub fn formulas(self) -> &'static [&'static str] {
        self.description().formulas
    }

    /// What can be chosen.
    pub fn parameters(self) -> &'static [Parameter] {
        self.description().parameters
    }

    /// The exact solution for the given parameters; those not given have their default.
    ///
    /// # Errors
    /// [`CaseError::UnknownParameter`] for a name that is not among [`StackCase::parameters`], and
    /// [`CaseError::OutOfRange`] for a value outside its range, NaN included.
    pub fn solution(self, parameters: &BTreeMap<String, f64>) -> Result<ExactStack, CaseError> {
        let Description { name, parameters: known, build, .. } = self.description();
        let values = Values::new(name, known, parameters)?;
        Ok(ExactStack::new(build(&values)?))
    }

    fn description(self) -> &'static Description<dyn Layers> {
        match self {
            Self::FloorDisk => &nested::FLOOR_DISK,
            Self::Ball => &ball::BALL,
            Self::ThreeStrips => &nested::THREE_STRIPS,
            Self::ThreeDiscs => &nested::THREE_DISCS,
            Self::GradedDisk => &graded::GRADED_DISK,
            Self::TwoTensions => &graded::TWO_TENSIONS,
            Self::TensionJump => &lines::TENSION_JUMP,
            Self::StripOnFloor => &nested::STRIP_ON_FLOOR,
            Self::Foundation => &foundation::FOUNDATION,
            Self::FreeEnd => &lines::FREE_END,
            Self::Manufactured => &manufactured::MANUFACTURED,
            Self::BiactiveStack => &manufactured::BIACTIVE_STACK,
        }
    }
}

impl fmt::Display for StackCase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
