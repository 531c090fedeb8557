//! Data that the mesh knows too little of.

use std::fmt;

use crate::discretization::{PairDiscretization, StackDiscretization};
use crate::fem::LoadMoments;

/// Why the bound may not hold: the quadrature has not seen enough of a load, or the mesh of a height.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum DataWarning {
    /// Two quadrature rules find loads that differ by more than the bound.
    Unresolved {
        /// From 1.
        membrane: usize,
        /// By how much, in the energy norm.
        difference: f64,
        /// The bound.
        bound: f64,
    },
    /// A load that is no constant is zero wherever the quadrature looks.
    Vanishing {
        /// From 1.
        membrane: usize,
    },
    /// A height of a stack is not affine along the edges of the mesh.
    BentHeight {
        /// From 1.
        membrane: usize,
    },
}

impl DataWarning {
    /// Those of both loads of `d`, beside a bound of the energy error on its mesh.
    pub(crate) fn all(d: &PairDiscretization, bound: f64) -> Vec<Self> {
        let loads = d.moments.iter().zip(d.quadrature_difference());
        (1..).zip(loads).filter_map(|(i, (load, difference))| Self::of(i, load, difference, bound)).collect()
    }

    /// Those of all loads and heights of a stack.
    pub(crate) fn of_stack(d: &StackDiscretization, bound: f64) -> Vec<Self> {
        let of = |(i, difference)| Self::of(i, d.moments(i), difference, bound);
        let of_loads = (1..).zip(d.quadrature_difference()).filter_map(of);
        let bent = (1..=d.membranes()).filter(|&i| d.held(i).bends);
        of_loads.chain(bent.map(|membrane| Self::BentHeight { membrane })).collect()
    }

    fn of(membrane: usize, load: &LoadMoments, difference: f64, bound: f64) -> Option<Self> {
        if difference > bound {
            Some(Self::Unresolved { membrane, difference, bound })
        } else {
            load.sees_nothing().then_some(Self::Vanishing { membrane })
        }
    }
}

impl fmt::Display for DataWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unresolved { membrane, difference, bound } => write!(
                f,
                "load f{membrane}: two quadrature rules differ by {difference:.1e}, more than the bound {bound:.1e}, \
                 which does not hold then: refine the mesh where the load acts"
            ),
            Self::BentHeight { membrane } => write!(
                f,
                "height g{membrane} is not affine along the edges of the mesh: the bound is one of the stack whose height is"
            ),
            Self::Vanishing { membrane } => write!(
                f,
                "load f{membrane} is zero at all points of the quadrature: write 0 if that is meant, else refine the \
                 mesh where the load acts"
            ),
        }
    }
}
