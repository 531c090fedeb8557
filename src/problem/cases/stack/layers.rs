//! The form in which a case of a stack states its data and its solution.

use std::fmt::Debug;

use crate::geometry::Interface;
use crate::problem::{Domain, Field, Function};

/// A stack and its exact solution. Membranes are counted from 1 at the top, gap `k` lies between layers `k` and `k + 1`; the
/// floor, where there is one, is the last layer.
///
/// Everything is a formula that holds, or is at least finite, also slightly outside the domain.
pub(super) trait Layers: Debug + Send + Sync {
    /// The domain on which the formulas solve the problem.
    fn domain(&self) -> Domain;

    /// The data of the membranes from the top.
    fn sheets(&self) -> Vec<Sheet>;

    /// What no membrane is below.
    fn floor(&self) -> Option<Function> {
        None
    }

    /// The displacement of membrane `i`. Where layers touch, their values are equal to the last bit.
    fn surface(&self, i: usize, x: f64, y: f64) -> Surface;

    /// The action in gap `k` as far as it is a function, a force per area.
    fn action(&self, k: usize, x: f64, y: f64) -> f64;

    /// The densities of the action in gap `k` along curves, forces per length.
    fn line_actions(&self, _k: usize) -> Vec<LineAction> {
        Vec::new()
    }

    /// The curve that bounds the contact set of gap `k`: pressed on its negative side, apart on the positive one.
    fn rim(&self, k: usize) -> Option<Interface>;

    /// The curves across which the solution is less smooth.
    fn interfaces(&self) -> Vec<Interface>;
}

/// The data of a membrane. On the part of the boundary that is not free it is held at its displacement.
#[derive(Debug, Clone)]
pub(super) struct Sheet {
    pub(super) tension: Tension,
    pub(super) load: Function,
    pub(super) foundation: f64,
    /// The sides on which nothing holds it, with the line loads there.
    pub(super) free: Vec<(&'static str, Function)>,
}

impl Sheet {
    pub(super) fn new(tension: Tension, load: impl Into<Function>) -> Self {
        Self { tension, load: load.into(), foundation: 0.0, free: Vec::new() }
    }

    /// The same, free on these sides.
    pub(super) fn free_on<const N: usize>(mut self, sides: [&'static str; N]) -> Self {
        self.free.extend(sides.map(|side| (side, Function::Constant(0.0))));
        self
    }
}

/// A tension.
#[derive(Debug, Clone)]
pub(super) enum Tension {
    /// One function.
    Everywhere(Function),
    /// One number outside of a region and one in it.
    InRegion {
        /// What the mesh calls the region.
        name: &'static str,
        /// The curve beyond which it lies.
        beyond: Interface,
        /// Outside, inside.
        values: [f64; 2],
    },
}

impl Tension {
    pub(super) fn at(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::Everywhere(function) => finite(function, x, y),
            Self::InRegion { beyond, values, .. } => values[usize::from(beyond.signed_distance(x, y) > 0.0)],
        }
    }

    pub(super) fn field(&self) -> Field {
        match self {
            Self::Everywhere(function) => function.clone().into(),
            Self::InRegion { name, values: [outside, inside], .. } => {
                Field::by_region([(*name, *inside)]).elsewhere(*outside)
            }
        }
    }
}

impl From<f64> for Tension {
    fn from(value: f64) -> Self {
        Self::Everywhere(value.into())
    }
}

/// The value of a datum of a case, all of which are finite.
pub(super) fn finite(function: &Function, x: f64, y: f64) -> f64 {
    function.eval(x, y).unwrap_or(f64::NAN)
}

/// The value and the gradient of a displacement at a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Surface {
    pub(super) value: f64,
    pub(super) gradient: [f64; 2],
}

impl Surface {
    /// Of a function of `x` with this value and slope.
    pub(super) fn along_x([value, slope]: [f64; 2]) -> Self {
        Self { value, gradient: [slope, 0.0] }
    }

    /// Of a function of the distance from the origin.
    pub(super) fn around_origin(x: f64, y: f64, [value, slope]: [f64; 2]) -> Self {
        let r = x.hypot(y);
        let gradient = if r == 0.0 { [0.0; 2] } else { [slope * x / r, slope * y / r] };
        Self { value, gradient }
    }
}

/// A density of an action along a curve, a force per length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineAction {
    /// Where.
    pub curve: Interface,
    /// The density, the same along the curve inside the domain.
    pub density: f64,
}

/// `(0, 1) x (0, 1/2)`: the domain of stacks that depend on `x` alone.
pub(super) const STRIP: Domain = Domain::Rectangle { lower: [0.0, 0.0], upper: [1.0, 0.5] };

/// The long sides of the strip, on which nothing holds such a stack.
pub(super) const LONG_SIDES: [&str; 2] = ["bottom", "top"];

/// `{ r < 1 }`: the domain of stacks that depend on the distance from the origin alone.
pub(super) const UNIT_DISK: Domain = Domain::Disk { centre: [0.0, 0.0], radius: 1.0 };

pub(super) fn circle(radius: f64) -> Interface {
    Interface::Circle { centre: [0.0, 0.0], radius }
}
