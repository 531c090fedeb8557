//! The sizes that residuals are measured against.

/// Tensions, displacements and loads must lie between the inverse of this and this: energies must not overflow.
pub(super) const LARGEST: f64 = 1e40;

/// The sizes that the data give to the unknowns: residuals are measured against them, so that a tolerance means the
/// same on every mesh and in every unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// A bound of the displacements' size: `max g + max_i max|f_i| d^2 / (8 mu_i)`, the deflection of a strip of the
    /// width `d` of the domain. Unit: length.
    pub displacement: f64,
    /// The size of the loads as force per area: `max_i max_a |F_i,a| / |D_a|`, or what a varying height exerts,
    /// `8 mu1 (max g - min g) / d^2`, if that is more.
    pub force_density: f64,
    /// The largest dual cell, `max_a |D_a|`. Unit: area.
    pub dual_area: f64,
}
