//! The domain seen from above, and what happens in one gap on it: shared by the pictures of solutions.

mod action;
mod bars;
mod cells;
mod cut;
mod detail;
mod domain;
mod error;

pub(crate) use action::Action;
pub(crate) use bars::Bars;
pub(crate) use cells::{Cells, MOST_ELONGATED, color_bar};
pub(crate) use cut::{Cut, middle, stretches};
pub(crate) use domain::Domain;
pub use error::PictureError;
