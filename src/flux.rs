//! Reconstructed fluxes `t_ih` in `RT_0(S_h)` (4.12): the finite-volume reading of the discrete problem.
//!
//! `-mu_i grad u_ih` is constant on each triangle `K` and its normal component jumps across the edges. A reconstruction
//! changes the fluxes through the segments that leave a vertex `a` (the halves of the edges of `T_h` and the segments to
//! the barycentres) and keeps those through the boundary of `D_a`; so each vertex is a problem of its own, and (4.18)
//! `int_{D_a} div t_ih = mu_i int grad u_ih . grad phi_a` holds for every choice.
//!
//! The paper leaves the fluxes through the half edges open; [`Reconstruction`] lists three computable choices.
//!
//! # Equilibrium and the load
//! On the wedge `D_a cap K` the load counts with `f_a|_K = (3 / |K|) int_K f_i phi_a`, the share that the load vector
//! gives it. So the balances close whatever the load is, and `div t_ih = f_a|_K - (-1)^i lambda_a` is exact. For a load
//! that is constant on each element, `f_a|_K` is `f_ih|_K` of (4.14). For any other, the three shares of `K` have the mean
//! `f_ih|_K`: the residual `f_i - (-1)^i lambda_h - div t_ih` has the mean zero on every `K`, as guaranteed bounds need
//! it, and (4.15) holds with its oscillation terms.

mod defects;
mod fan;
mod field;
mod reconstruct;
mod sectors;
#[cfg(test)]
mod tests;
mod wedges;

pub use defects::FluxDefects;
pub use field::{Flux, FluxCells};
pub use reconstruct::{Reconstructor, discrete_flux};

pub(crate) use field::{constant_outward, inner_product, value};
pub(crate) use sectors::{Balanced, MeetInAVertex, MembraneFlux};
pub(crate) use wedges::WedgeFluxes;

/// How the fluxes through the segments that leave a vertex are chosen.
///
/// All come next to `-mu_i grad u_ih`; what tells them apart is where the divergence is right. A residual on cells of the
/// diameter `h` costs a guaranteed bound `h / pi` times its norm: as much as the flux itself where only a larger cell
/// balances.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reconstruction {
    /// `div t_ih = f_a|_K - (-1)^i lambda_a` on every triangle of `S_h`; of the circulations around each vertex that this
    /// leaves open, the one next to `-mu_i grad u_ih` in `L2`. Gives guaranteed bounds.
    Full,
    /// (4.13) on every edge of `S_h` inside of a `K`; the same equilibrium on each `D_a cap K` as a whole, next to
    /// `-mu_i grad u_ih` likewise.
    PaperCompatible,
    /// (4.13), and through each half edge the mean of what `-mu_i grad u_ih` gives on either side: equilibrium on each
    /// `D_a` of an interior vertex as a whole only.
    Averaged,
}

impl Reconstruction {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Full, Self::PaperCompatible, Self::Averaged];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::PaperCompatible => "paper-compatible",
            Self::Averaged => "averaged",
        }
    }
}
