//! Unilateral contact between two elastic membranes: discretised by P1 finite elements, solved as a sparse convex
//! quadratic program, certified.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod problem;
pub mod mesh;
pub mod fem;
pub mod discretization;
pub mod qp;
pub mod solver;
pub mod action;
pub mod output;
#[cfg(feature = "cli")]
pub mod cli;

pub use sprs;
