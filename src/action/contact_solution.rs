//! A certified solution of any problem.

use super::certificate::{Rejected, certify_pair};
use super::projection::CutOff;
use super::residuals::Residuals;
use super::solution::PairSolution;
use super::stack::{StackSolution, certify_stack};
use crate::discretization::Discretization;
use crate::solver::{Candidate, Statistics};

/// A certified solution: of the paper's pair, or of any other stack.
#[derive(Debug, Clone)]
pub enum ContactSolution {
    /// Of the pair.
    Pair(PairSolution),
    /// Of any other stack.
    Stack(StackSolution),
}

/// What happens in one gap, over the vertices of the mesh.
#[derive(Debug, Clone, Copy)]
pub struct Gap<'s> {
    /// `k`: the gap lies between layers `k` and `k + 1`, counted from the ceiling, layer 0.
    pub number: usize,
    /// `lambda_k`. Unit: force per area.
    pub lambda: &'s [f64],
    /// Whether the layers touch, with a force or without.
    pub contact: &'s [bool],
    /// The area of the dual cells in contact.
    pub contact_area: f64,
    /// `int lambda_k`, actions along lines included.
    pub total_force: f64,
}

/// Checks a candidate against the data and hands it out as a solution when every residual, beyond what rounding explains, is at most
/// `tolerance`: [`certify_pair`] or [`certify_stack`].
///
/// # Errors
/// [`Rejected`].
pub fn certify(
    d: &Discretization,
    candidate: Candidate,
    tolerance: f64,
) -> Result<ContactSolution, Box<Rejected>> {
    Ok(match d {
        Discretization::Pair(d) => ContactSolution::Pair(certify_pair(d, candidate, tolerance)?),
        Discretization::Stack(d) => ContactSolution::Stack(certify_stack(d, candidate, tolerance)?),
    })
}

impl ContactSolution {
    /// The displacements from the top, over vertices, fixed values included. Unit: length.
    pub fn displacement(&self) -> &[Vec<f64>] {
        match self {
            Self::Pair(solution) => solution.displacement(),
            Self::Stack(solution) => solution.displacement(),
        }
    }

    /// The gaps that there are, from the top.
    pub fn gaps(&self) -> Vec<Gap<'_>> {
        match self {
            Self::Pair(solution) => vec![Gap {
                number: 1,
                lambda: solution.lambda(),
                contact: solution.contact(),
                contact_area: solution.contact_area(),
                total_force: solution.total_force(),
            }],
            Self::Stack(solution) => solution
                .gaps()
                .iter()
                .map(|gap| Gap {
                    number: gap.number,
                    lambda: &gap.lambda,
                    contact: &gap.contact,
                    contact_area: gap.contact_area,
                    total_force: gap.total_force,
                })
                .collect(),
        }
    }

    /// Gap `k`, between layers `k` and `k + 1`: 1 is the one between the two membranes of a pair.
    pub fn gap(&self, k: usize) -> Option<Gap<'_>> {
        self.gaps().into_iter().find(|gap| gap.number == k)
    }

    /// The action `lambda_k` in gap `k`, over vertices. Unit: force per area.
    pub fn action(&self, k: usize) -> Option<&[f64]> {
        self.gap(k).map(|gap| gap.lambda)
    }

    /// The area of the dual cells in contact, in all gaps together.
    pub fn contact_area(&self) -> f64 {
        // The sum of none is -0.
        0.0 + self.gaps().iter().map(|gap| gap.contact_area).sum::<f64>()
    }

    /// The force of all actions together.
    pub fn total_force(&self) -> f64 {
        0.0 + self.gaps().iter().map(|gap| gap.total_force).sum::<f64>()
    }

    /// The energy `J(u_h)`.
    pub fn energy(&self) -> f64 {
        match self {
            Self::Pair(solution) => solution.energy(),
            Self::Stack(solution) => solution.energy(),
        }
    }

    /// What was cut off to make the solution exactly complementary.
    pub fn cut_off(&self) -> CutOff {
        match self {
            Self::Pair(solution) => solution.cut_off(),
            Self::Stack(solution) => solution.cut_off(),
        }
    }

    /// The residuals that were certified.
    pub fn residuals(&self) -> &Residuals {
        match self {
            Self::Pair(solution) => solution.residuals(),
            Self::Stack(solution) => solution.residuals(),
        }
    }

    /// How the solution was found.
    pub fn statistics(&self) -> &Statistics {
        match self {
            Self::Pair(solution) => solution.statistics(),
            Self::Stack(solution) => solution.statistics(),
        }
    }

    /// That of the pair, if it is one.
    pub fn as_pair(&self) -> Option<&PairSolution> {
        match self {
            Self::Pair(solution) => Some(solution),
            Self::Stack(_) => None,
        }
    }

    /// That of another stack than the pair, if it is one.
    pub fn as_stack(&self) -> Option<&StackSolution> {
        match self {
            Self::Pair(_) => None,
            Self::Stack(solution) => Some(solution),
        }
    }

    /// The displacements and the actions by gap, over vertices, whose residuals were certified: certified again, they give this
    /// solution again.
    pub fn certified(&self) -> (&[Vec<f64>], Vec<&[f64]>) {
        match self {
            Self::Pair(solution) => {
                let (displacement, lambda) = solution.certified();
                (displacement, vec![lambda])
            }
            Self::Stack(solution) => {
                (solution.displacement(), solution.gaps().iter().map(|gap| gap.lambda.as_slice()).collect())
            }
        }
    }
}
