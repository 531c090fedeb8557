//! What the file of a case says about it.

use std::sync::Arc;

use super::parameter::{CaseError, Parameter, Values};

/// Names, formulas, parameters of a case, and how the solution `S` is made of them.
pub(super) struct Description<S: ?Sized> {
    pub(super) name: &'static str,
    pub(super) title: &'static str,
    pub(super) letter: &'static str,
    pub(super) formulas: &'static [&'static str],
    pub(super) parameters: &'static [Parameter],
    pub(super) build: fn(&Values) -> Result<Arc<S>, CaseError>,
}
