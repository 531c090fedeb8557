//! How a membrane is held on the boundary, curve by curve.

use thiserror::Error;

use super::{Function, Membrane, Support};
use crate::text::excerpt;

/// One value for each curve that is named, and one for the rest of the boundary.
#[derive(Debug, Clone)]
pub struct ByCurve<T> {
    /// The names, each once, and their values.
    pub parts: Vec<(String, T)>,
    /// The value on all curves that are not named.
    pub elsewhere: Option<T>,
}

impl<T> Default for ByCurve<T> {
    fn default() -> Self {
        Self { parts: Vec::new(), elsewhere: None }
    }
}

/// A line load acts on nothing that is free.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TractionError {
    /// On a curve that is held.
    #[error("acts on the curve `{}`, which is held", excerpt(curve))]
    OnHeldCurve {
        /// The curve.
        curve: String,
    },
    /// On all free curves, or all that are not named, and there are none.
    #[error("finds no {}free curve", if *is_further { "further " } else { "" })]
    NoFreeCurve {
        /// Whether others are named.
        is_further: bool,
    },
}

impl Membrane {
    /// The membrane held like this, and pulled by line loads where it is free (force per length, positive upwards). What is not named is
    /// held at height zero; a free curve that is not named is not pulled.
    ///
    /// # Errors
    /// [`TractionError`] for a line load that acts on nothing.
    pub fn held(
        mut self,
        supports: ByCurve<Support>,
        tractions: ByCurve<Function>,
    ) -> Result<Self, TractionError> {
        self.parts = supports.parts;
        self.elsewhere = supports.elsewhere.unwrap_or_else(|| Support::Fixed(0.0.into()));
        if let Some(everywhere) = tractions.elsewhere {
            let is_named = |curve: &str| tractions.parts.iter().any(|(name, _)| name == curve);
            let unnamed = self.parts.iter_mut().filter(|(name, _)| !is_named(name));
            let mut is_pulled = false;
            for support in unnamed.map(|(_, support)| support).chain([&mut self.elsewhere]) {
                if let Support::Free { traction } = support {
                    *traction = everywhere.clone();
                    is_pulled = true;
                }
            }
            if !is_pulled {
                return Err(TractionError::NoFreeCurve { is_further: !tractions.parts.is_empty() });
            }
        }
        for (curve, traction) in tractions.parts {
            let own = self.parts.iter_mut().find(|(name, _)| *name == curve).map(|(_, support)| support);
            if !matches!(own.as_deref().unwrap_or(&self.elsewhere), Support::Free { .. }) {
                return Err(TractionError::OnHeldCurve { curve });
            }
            match own {
                Some(support) => *support = Support::Free { traction },
                None => self.parts.push((curve, Support::Free { traction })),
            }
        }
        Ok(self)
    }
}
