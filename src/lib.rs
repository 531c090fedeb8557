//! Unilateral contact between two elastic membranes: discretised by P1 finite elements, solved as a sparse convex
//! quadratic program, certified.
//!
//! The modules stand in the order of the data; each uses only those before it. Start with
//! [`ContactProblem`](problem::ContactProblem), a [`Mesh`](mesh::Mesh), the
//! [`PairDiscretization`](discretization::PairDiscretization) of the two, a [`ContactSolver`](solver::ContactSolver) such as
//! [`QpSolver`](solver::QpSolver), and [`certify`](action::certify). Numbers in round brackets are those of F. Ben
//! Belgacem, C. Bernardi, A. Blouza, M. Vohralik, Math. Model. Nat. Phenom. 4 (2009).
#![deny(missing_docs)]

mod text;
mod numeric;
mod parallel;
pub mod geometry;
pub mod problem;
pub mod formats;
pub mod mesh;
pub mod fem;
pub mod discretization;
pub mod qp;
mod multigrid;
pub mod solver;
pub mod action;
pub mod flux;
pub mod estimate;
pub mod study;
#[cfg(feature = "files")]
pub mod output;
#[cfg(feature = "pictures")]
pub mod pictures;
#[cfg(feature = "cli")]
pub mod cli;

pub use sprs;

/// What most programs need: `use membrane_contact::prelude::*`.
pub mod prelude {
    pub use crate::action::{ContactSolution, PairSolution, StackSolution, certify};
    pub use crate::discretization::{Discretization, PairDiscretization, StackDiscretization};
    pub use crate::estimate::ErrorBound;
    pub use crate::mesh::{Mesh, MeshSize, Pattern, disk, generate, l_shape, polygon, rectangle};
    pub use crate::problem::{ContactProblem, Domain, Expression, Field, Function, Membrane};
    pub use crate::solver::{ActiveSet, Auto, ContactSolver, Multigrid, QpSolver, SolverOptions};
    pub use crate::study::{Solved, solve};
}

/// The README's code is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
