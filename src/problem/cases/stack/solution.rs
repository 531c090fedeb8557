//! The exact solution of a stack, with the problem that it solves.

use std::sync::Arc;

use super::layers::{Layers, LineAction, Sheet, Tension, finite};
use crate::geometry::Interface;
use crate::problem::{ContactProblem, Domain, Function, Membrane, ProblemError};

/// The exact solution of a [`StackCase`](super::StackCase), with the data of the problem that it solves. Membranes are counted
/// from 1 at the top; gap `k` lies between layers `k` and `k + 1`, of which the last one may be a floor.
#[derive(Debug, Clone)]
pub struct ExactStack {
    layers: Arc<dyn Layers>,
    sheets: Arc<[Sheet]>,
    floor: Option<Function>,
}

impl ExactStack {
    pub(super) fn new(layers: Arc<dyn Layers>) -> Self {
        Self { sheets: layers.sheets().into(), floor: layers.floor(), layers }
    }

    /// How many membranes there are, `N`.
    pub fn membranes(&self) -> usize {
        self.sheets.len()
    }

    /// The gaps that there are: between two membranes, and above a floor.
    pub fn gaps(&self) -> std::ops::RangeInclusive<usize> {
        1..=self.membranes() - usize::from(self.floor.is_none())
    }

    /// The domain.
    pub fn domain(&self) -> Domain {
        self.layers.domain()
    }

    /// The regions that a mesh has to name for the data, each with the curve beyond which it lies: see
    /// [`Mesh::with_region`](crate::mesh::Mesh::with_region).
    pub fn regions(&self) -> Vec<(&'static str, Interface)> {
        let region = |sheet: &Sheet| match sheet.tension {
            Tension::InRegion { name, beyond, .. } => Some((name, beyond)),
            Tension::Everywhere(_) => None,
        };
        self.sheets.iter().filter_map(region).collect()
    }

    /// The curves across which the solution is less smooth: rims of contact sets, and jumps of tensions.
    pub fn interfaces(&self) -> Vec<Interface> {
        self.layers.interfaces()
    }

    /// The displacement `u_i` at a point, for `i = N + 1` the floor.
    ///
    /// # Panics
    /// When there is no such layer.
    pub fn u(&self, i: usize, x: f64, y: f64) -> f64 {
        if i <= self.membranes() {
            return self.layers.surface(i, x, y).value;
        }
        finite(self.floor.as_ref().expect("a layer that there is"), x, y)
    }

    /// The gradient of `u_i` at a point; not of the floor.
    pub fn grad_u(&self, i: usize, x: f64, y: f64) -> [f64; 2] {
        self.layers.surface(i, x, y).gradient
    }

    /// The gap `u_k - u_(k+1)` at a point: exactly zero where the layers touch.
    pub fn gap(&self, k: usize, x: f64, y: f64) -> f64 {
        self.u(k, x, y) - self.u(k + 1, x, y)
    }

    /// The action `lambda_k` at a point as far as it is a function, a force per area: see [`line_actions`](Self::line_actions).
    pub fn lambda(&self, k: usize, x: f64, y: f64) -> f64 {
        self.layers.action(k, x, y)
    }

    /// The curves along which the action in gap `k` has a density of its own.
    pub fn line_actions(&self, k: usize) -> Vec<LineAction> {
        self.layers.line_actions(k)
    }

    /// The curve that bounds the contact set of gap `k`, its layers pressed on the negative side of it and apart on the positive
    /// one; `None` where there is no such curve.
    pub fn rim(&self, k: usize) -> Option<Interface> {
        self.layers.rim(k)
    }

    /// The tension `mu_i` at a point.
    pub fn tension(&self, i: usize, x: f64, y: f64) -> f64 {
        self.sheets[i - 1].tension.at(x, y)
    }

    /// The load `f_i` at a point.
    pub fn load(&self, i: usize, x: f64, y: f64) -> f64 {
        finite(&self.sheets[i - 1].load, x, y)
    }

    /// The stiffness `c_i` of the foundation, the same everywhere.
    pub fn foundation(&self, i: usize) -> f64 {
        self.sheets[i - 1].foundation
    }

    /// The line load `t_i` on a free side at a point of it; `None` where the membrane is held.
    pub fn traction(&self, i: usize, side: &str, x: f64, y: f64) -> Option<f64> {
        let found = self.sheets[i - 1].free.iter().find(|(name, _)| *name == side);
        found.map(|(_, traction)| finite(traction, x, y))
    }

    /// The problem that it solves, on a mesh that names its [`regions`](Self::regions).
    ///
    /// # Errors
    /// When parameters are so large that data are not finite.
    pub fn problem(&self) -> Result<ContactProblem, ProblemError> {
        let membranes = (1..).zip(self.sheets.iter()).map(|(i, sheet)| self.membrane(i, sheet));
        let stack = membranes.fold(ContactProblem::stack(), |stack, membrane| stack.membrane(membrane));
        match &self.floor {
            Some(floor) => stack.floor(floor.clone()).build(),
            None => stack.build(),
        }
    }

    fn membrane(&self, i: usize, sheet: &Sheet) -> Membrane {
        let exact = self.clone();
        let height = Function::from_fn(move |x, y| exact.u(i, x, y));
        let membrane = Membrane::new(sheet.tension.field())
            .load(sheet.load.clone())
            .foundation(sheet.foundation)
            .height(height);
        sheet
            .free
            .iter()
            .fold(membrane, |membrane, (side, traction)| membrane.traction_on(*side, traction.clone()))
    }
}
