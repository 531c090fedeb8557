//! Where the domain is cut, and what lies on the cut.

use super::domain::Domain;
use crate::pictures::drawing::raster;

/// A straight cut through the domain, parallel to its longer side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    /// The coordinate that runs along the cut: 0 for x, 1 for y.
    pub(crate) along: usize,
    /// The place of the cut on the axis of the other coordinate.
    pub(crate) place: f64,
    /// By how much that may be rounded, to stay in the dual cell that it goes through.
    pub(crate) reach: f64,
}

impl Cut {
    /// The cut at a round coordinate next to `place`, no farther off than `reach`.
    pub(crate) fn at(domain: &Domain, along: usize, place: f64, reach: f64) -> Cut {
        Cut { along, place: domain.plane[1 - along].round(place, reach).place, reach }
    }

    /// The coordinate of the longer side.
    pub(crate) fn direction(domain: &Domain) -> usize {
        const NEARLY_SQUARE: f64 = 0.999;
        if domain.aspect(f64::MAX) > NEARLY_SQUARE { 0 } else { 1 }
    }

    /// The place in the domain's rectangle at the place `along` on the cut.
    pub(crate) fn point(&self, along: f64) -> [f64; 2] {
        if self.along == 0 { [along, self.place] } else { [self.place, along] }
    }

    /// A place in the domain's rectangle on the parallel to the cut at `place`.
    pub(crate) fn parallel(&self, place: f64) -> [f64; 2] {
        Cut { place, ..*self }.point(0.5)
    }

    /// Calls `visit(step, corners, barycentric coordinates)` for the middles of those of `steps` equal steps along the cut that
    /// lie in the domain.
    pub(crate) fn walk(
        &self,
        domain: &Domain,
        steps: usize,
        mut visit: impl FnMut(usize, &[usize; 3], [f64; 3]),
    ) {
        for corners in domain.triangles() {
            // A grid of one row whose centre line is the cut.
            let points = corners.map(|v| {
                let place = domain.place(v);
                [place[self.along] * steps as f64, place[1 - self.along] - self.place + 0.5]
            });
            raster::triangle(points, [steps, 1], |step, _, weights| visit(step, corners, weights));
        }
    }
}

/// The middle of the largest region in a profile, and how far it is from there to its nearer end; a profile has the pixels of
/// regions on lines across the domain, from low to high, and regions are apart where lines have none.
pub(crate) fn middle(profile: &[usize]) -> [f64; 2] {
    let lines: Vec<(usize, usize)> = profile.iter().copied().enumerate().collect();
    let area = |region: &[(usize, usize)]| region.iter().map(|(_, count)| count).sum::<usize>();
    let regions = lines.chunk_by(|a, b| (a.1 > 0) == (b.1 > 0));
    let region = regions.max_by_key(|region| area(region)).unwrap_or(&[]);
    let moment: usize = region.iter().map(|(line, count)| line * count).sum();
    let centre = moment as f64 / area(region).max(1) as f64 + 0.5;
    let first = region.first().map_or(0, |(line, _)| *line) as f64;
    let reach = (centre - first).min(first + region.len() as f64 - centre);
    [centre, reach].map(|lines| lines / profile.len() as f64)
}

/// The stretches of equal steps with one value, as places along the cut from 0 to 1, with that value.
pub(crate) fn stretches<T: PartialEq>(
    steps: usize,
    value: impl Fn(usize) -> Option<T>,
) -> Vec<([f64; 2], T)> {
    let mut stretches: Vec<([usize; 2], T)> = Vec::new();
    for step in 0..steps {
        let Some(value) = value(step) else { continue };
        match stretches.last_mut() {
            Some((ends, same)) if ends[1] == step && *same == value => ends[1] = step + 1,
            _ => stretches.push(([step, step + 1], value)),
        }
    }
    let place = |step: usize| step as f64 / steps as f64;
    stretches.into_iter().map(|(ends, value)| (ends.map(place), value)).collect()
}
