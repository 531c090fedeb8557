//! The colours: legible for the colour-blind and in grey, light membranes, dark contact.

/// Red, green, blue.
pub(super) type Rgb = [u8; 3];

/// Text and axes.
pub(super) const INK: Rgb = [30, 30, 30];
/// Thin auxiliary lines.
pub(super) const RULE: Rgb = [205, 205, 205];
/// The paper.
pub(super) const PAPER: Rgb = [255, 255, 255];
/// The domain where the membranes do not touch: just visible against the paper.
pub(super) const FREE: Rgb = [243, 243, 243];
/// Membrane 1, as a surface. Blue and orange are told apart in every common colour vision deficiency.
pub(super) const UPPER: Rgb = [112, 186, 240];
/// Membrane 1, as a line.
pub(super) const UPPER_LINE: Rgb = [0, 92, 175];
/// Membrane 2, as a surface.
pub(super) const LOWER: Rgb = [252, 202, 120];
/// Membrane 2, as a line.
pub(super) const LOWER_LINE: Rgb = [205, 92, 0];
/// Contact: the darkest of the colours, so that it is found in grey as well, and none of the colours of lambda.
pub(super) const CONTACT: Rgb = [52, 50, 58];
/// The stretch of a section in which the membranes touch, behind the curves.
pub(super) const CONTACT_BAND: Rgb = [226, 226, 230];

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
pub(super) fn force(place: f64) -> Rgb {
    let steps = VIRIDIS.len() - 1;
    let position = place.clamp(0.0, 1.0) * steps as f64;
    let below = (position as usize).min(steps - 1);
    mix(VIRIDIS[below], VIRIDIS[below + 1], position - below as f64)
}

/// `share` of `over` and the rest of `under`.
pub(super) fn mix(under: Rgb, over: Rgb, share: f64) -> Rgb {
    std::array::from_fn(|k| (f64::from(under[k]) * (1.0 - share) + f64::from(over[k]) * share).round() as u8)
}
