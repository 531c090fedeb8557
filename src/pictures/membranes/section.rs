//! Where the domain is cut, and the solution along the cut.

use super::scene::Scene;
use crate::pictures::drawing::raster;

/// A straight cut through the domain, parallel to its longer side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// The coordinate that runs along the cut: 0 for x, 1 for y.
    pub(super) along: usize,
    /// The place of the cut on the axis of the other coordinate.
    pub(super) place: f64,
    /// By how much that may be rounded, to stay in the dual cell that it goes through.
    pub(super) reach: f64,
}

impl Cut {
    /// The cut, at a round coordinate, through the greatest lambda: of several such vertices that one nearest to the centre of
    /// the contact region. Without a force it goes through that centre, without contact through that of the domain; of several
    /// regions it takes the largest, unless they lie side by side.
    ///
    /// `profile` counts the pixels of the region on each line across an axis.
    pub(super) fn through(scene: &Scene, profile: impl FnOnce(usize) -> Vec<usize>) -> Cut {
        const NEARLY_SQUARE: f64 = 0.999;
        let along = if scene.aspect(f64::MAX) > NEARLY_SQUARE { 0 } else { 1 };
        let profile = profile(1 - along);
        let lines: Vec<(usize, usize)> = profile.iter().copied().enumerate().collect();
        let area = |region: &[(usize, usize)]| region.iter().map(|(_, count)| count).sum::<usize>();
        let regions = lines.chunk_by(|a, b| (a.1 > 0) == (b.1 > 0));
        let region = regions.max_by_key(|region| area(region)).unwrap_or(&[]);
        let moment: usize = region.iter().map(|(line, count)| line * count).sum();
        let centre = (moment as f64 / area(region).max(1) as f64 + 0.5) / profile.len() as f64;
        let (place, reach) = match peak(scene, 1 - along, centre) {
            Some(vertex) => (scene.place(vertex)[1 - along], half_width(scene, vertex, 1 - along)),
            None => (centre, f64::INFINITY),
        };
        Cut { along, place: scene.plane[1 - along].round(place, reach).place, reach }
    }

    /// The place in the domain's rectangle at the place `along` on the cut.
    pub(super) fn point(&self, along: f64) -> [f64; 2] {
        if self.along == 0 { [along, self.place] } else { [self.place, along] }
    }

    /// A place in the domain's rectangle on the parallel to the cut at `place`.
    pub(super) fn parallel(&self, place: f64) -> [f64; 2] {
        Cut { place, ..*self }.point(0.5)
    }

    /// The coordinates of a place in the domain's rectangle along and across the cut.
    pub(super) fn split(&self, place: [f64; 2]) -> [f64; 2] {
        [place[self.along], place[1 - self.along]]
    }
}

/// The vertex of the greatest lambda; of those where it is as great to the eye, the one whose coordinate `axis` is nearest to
/// `centre`.
fn peak(scene: &Scene, axis: usize, centre: f64) -> Option<usize> {
    const AS_GREAT: f64 = 0.999;
    let pressed = || scene.triangles().iter().flatten().copied().filter(|&v| scene.in_contact(v));
    let greatest = scene.greatest;
    let distance = |v: usize| (scene.place(v)[axis] - centre).abs();
    let peaks = pressed().filter(|&v| greatest > 0.0 && scene.lambda(v) >= AS_GREAT * greatest);
    peaks.min_by(|&v, &w| distance(v).total_cmp(&distance(w)))
}

/// How far from a vertex its dual cell reaches at least in the direction of `axis`: a third of the way to the farthest vertex
/// on the nearer side, less what the slant of its triangles may take.
fn half_width(scene: &Scene, vertex: usize, axis: usize) -> f64 {
    const SLANT: f64 = 0.5;
    let around = scene.triangles().iter().filter(|corners| corners.contains(&vertex)).flatten();
    let offsets = around.map(|&v| scene.place(v)[axis] - scene.place(vertex)[axis]);
    let [below, above] = offsets.fold([0.0f64; 2], |[low, high], x| [low.min(x), high.max(x)]);
    SLANT * above.min(-below) / 3.0
}

/// The solution at one point of the cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// `u1` and `u2`.
    pub(super) heights: [f64; 2],
    pub(super) lambda: f64,
    pub(super) contact: bool,
}

/// The solution along a cut, at the middles of equal steps; `None` outside of the domain.
pub(super) struct Section {
    pub(super) cut: Cut,
    pub(super) samples: Vec<Option<Sample>>,
}

impl Section {
    /// Samples the solution at `steps` points.
    pub(super) fn new(scene: &Scene, cut: Cut, steps: usize) -> Section {
        let mut samples = vec![None; steps];
        for corners in scene.triangles() {
            // A grid of one row whose centre line is the cut.
            let points = corners.map(|v| {
                let [along, across] = cut.split(scene.place(v));
                [along * steps as f64, across - cut.place + 0.5]
            });
            raster::triangle(points, [steps, 1], |step, _, weights| {
                let nearest = corners[raster::nearest_corner(weights)];
                let interpolate =
                    |membrane: usize| (0..3).map(|k| weights[k] * scene.heights(corners[k])[membrane]).sum();
                samples[step] = Some(Sample {
                    heights: [interpolate(0), interpolate(1)],
                    lambda: scene.lambda(nearest),
                    contact: scene.in_contact(nearest),
                });
            });
        }
        Section { cut, samples }
    }

    /// The ends of the stretches in contact, as places along the cut.
    pub(super) fn contacts(&self) -> Vec<[f64; 2]> {
        let touching = |step: usize| self.samples[step].is_some_and(|sample| sample.contact);
        let mut stretches: Vec<[usize; 2]> = Vec::new();
        for step in (0..self.samples.len()).filter(|&step| touching(step)) {
            match stretches.last_mut() {
                Some(last) if last[1] == step => last[1] = step + 1,
                _ => stretches.push([step, step + 1]),
            }
        }
        let steps = self.samples.len() as f64;
        stretches.into_iter().map(|ends| ends.map(|step| step as f64 / steps)).collect()
    }

    /// The stretch of the steps with one lambda in contact, as places along the cut, with that lambda.
    pub(super) fn forces(&self) -> Vec<([f64; 2], f64)> {
        let force =
            |sample: &Option<Sample>| sample.filter(|sample| sample.contact).map(|sample| sample.lambda);
        let steps = self.samples.len() as f64;
        let mut start = 0;
        let stretches = self.samples.chunk_by(|a, b| force(a) == force(b));
        let stretch = |samples: &[Option<Sample>]| {
            let ends = [start, start + samples.len()].map(|step| step as f64 / steps);
            start += samples.len();
            Some((ends, force(&samples[0])?))
        };
        stretches.filter_map(stretch).collect()
    }

    /// The place along the cut of a sample.
    pub(super) fn along(&self, step: usize) -> f64 {
        (step as f64 + 0.5) / self.samples.len() as f64
    }
}
