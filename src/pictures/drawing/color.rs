//! The colours: legible for the colour-blind and in grey, light membranes, dark contact.

/// Red, green, blue.
pub(crate) type Rgb = [u8; 3];

/// Text and axes.
pub(crate) const INK: Rgb = [30, 30, 30];
/// Thin auxiliary lines.
pub(crate) const RULE: Rgb = [205, 205, 205];
/// The paper.
pub(crate) const PAPER: Rgb = [255, 255, 255];
/// The domain where the membranes do not touch: just visible against the paper.
pub(crate) const FREE: Rgb = [243, 243, 243];
/// Membrane 1, as a surface. Blue and orange are told apart in every common colour vision deficiency.
pub(crate) const UPPER: Rgb = [112, 186, 240];
/// Membrane 1, as a line.
pub(crate) const UPPER_LINE: Rgb = [0, 92, 175];
/// Membrane 2, as a surface.
pub(crate) const LOWER: Rgb = [252, 202, 120];
/// Membrane 2, as a line.
pub(crate) const LOWER_LINE: Rgb = [205, 92, 0];
/// Contact: the darkest of the colours, so that it is found in grey as well, and none of the colours of lambda.
pub(crate) const CONTACT: Rgb = [52, 50, 58];
/// The stretch of a section in which the membranes touch, behind the curves.
pub(crate) const CONTACT_BAND: Rgb = [226, 226, 230];

/// The triangulation `T_h`.
pub(crate) const TRIANGULATION: Rgb = [150, 150, 150];
/// The dual mesh `D_h`, as lines.
pub(crate) const DUAL: Rgb = [0, 92, 175];
/// The cells of the dual mesh.
pub(crate) const DUAL_CELL: Rgb = [236, 243, 250];
/// The cells of the dual mesh in contact: darker than the others in grey as well.
pub(crate) const DUAL_CONTACT: Rgb = [250, 206, 130];

/// The rim of the contact over the colours of [`force`]: none of them, and of middle brightness.
pub(crate) const RIM: Rgb = [213, 94, 0];

/// The membranes of a stack from the top (M. Okabe, K. Ito, 2008): neighbours are dark and light by turns in grey; blue, orange,
/// green, sky blue, red, purple.
pub(crate) const LAYERS: [Rgb; 6] =
    [[0, 114, 178], [230, 159, 0], [0, 158, 115], [86, 180, 233], [213, 94, 0], [204, 121, 167]];
/// An obstacle: its body, the hatching on it, and its surface.
pub(crate) const WALL: [Rgb; 3] = [[226, 226, 226], [170, 170, 170], [110, 110, 110]];

/// Curves (M. Okabe, K. Ito, 2008), those first that differ most in grey: dark blue, orange, black, sky blue, red, purple,
/// green.
pub(crate) const CURVES: [Rgb; 7] = [
    [0, 114, 178],
    [230, 159, 0],
    [30, 30, 30],
    [86, 180, 233],
    [213, 94, 0],
    [204, 121, 167],
    [0, 158, 115],
];

/// The colour map viridis (S. van der Walt, N. Smith) at equal steps, from its light end to its dark one.
const VIRIDIS: [Rgb; 11] = [
    [253, 231, 37],
    [189, 223, 38],
    [122, 209, 81],
    [68, 191, 112],
    [34, 168, 132],
    [33, 145, 140],
    [42, 120, 142],
    [53, 95, 141],
    [65, 68, 135],
    [72, 36, 117],
    [68, 1, 84],
];

/// The colour of the contact force at `place` on its axis: light for none, dark for the greatest.
pub(crate) fn force(place: f64) -> Rgb {
    let steps = VIRIDIS.len() - 1;
    let position = place.clamp(0.0, 1.0) * steps as f64;
    let below = (position as usize).min(steps - 1);
    mix(VIRIDIS[below], VIRIDIS[below + 1], position - below as f64)
}

/// `share` of `over` and the rest of `under`.
pub(crate) fn mix(under: Rgb, over: Rgb, share: f64) -> Rgb {
    let channel = |k: usize| (f64::from(under[k]) * (1.0 - share) + f64::from(over[k]) * share + 0.5) as u8;
    [channel(0), channel(1), channel(2)]
}
