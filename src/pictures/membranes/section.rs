//! Where the domain is cut, and the solution along the cut.

use super::scene::Scene;
use crate::pictures::drawing::raster;
use crate::pictures::plan::{Cut, middle, stretches};

/// The cut, at a round coordinate, through the greatest lambda: of several such vertices that one nearest to the centre of
/// the contact region. Without a force it goes through that centre, without contact through that of the domain; of several
/// regions it takes the largest, unless they lie side by side.
///
/// `profile` counts the pixels of the region on each line across an axis.
pub(super) fn cut_through(scene: &Scene, profile: impl FnOnce(usize) -> Vec<usize>) -> Cut {
    let along = Cut::direction(&scene.domain);
    let across = 1 - along;
    let [centre, _] = middle(&profile(across));
    let (place, reach) = match peak(scene, across, centre) {
        Some(vertex) => (scene.domain.place(vertex)[across], scene.domain.half_width(vertex, across)),
        None => (centre, f64::INFINITY),
    };
    Cut::at(&scene.domain, along, place, reach)
}

/// The vertex of the greatest lambda; of those where it is as great to the eye, the one whose coordinate `axis` is nearest to
/// `centre`.
fn peak(scene: &Scene, axis: usize, centre: f64) -> Option<usize> {
    const AS_GREAT: f64 = 0.999;
    let vertices = scene.domain.triangles().iter().flatten().copied();
    let pressed = vertices.filter(|&v| scene.action.in_contact(v));
    let greatest = scene.action.greatest;
    let distance = |v: usize| (scene.domain.place(v)[axis] - centre).abs();
    let peaks = pressed.filter(|&v| greatest > 0.0 && scene.action.lambda(v) >= AS_GREAT * greatest);
    peaks.min_by(|&v, &w| distance(v).total_cmp(&distance(w)))
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
        cut.walk(&scene.domain, steps, |step, corners, weights| {
            let nearest = corners[raster::nearest_corner(weights)];
            let interpolate =
                |membrane: usize| (0..3).map(|k| weights[k] * scene.heights(corners[k])[membrane]).sum();
            samples[step] = Some(Sample {
                heights: [interpolate(0), interpolate(1)],
                lambda: scene.action.lambda(nearest),
                contact: scene.action.in_contact(nearest),
            });
        });
        Section { cut, samples }
    }

    /// The ends of the stretches in contact, as places along the cut.
    pub(super) fn contacts(&self) -> Vec<[f64; 2]> {
        let touching = |step: usize| self.samples[step].filter(|sample| sample.contact).map(|_| ());
        stretches(self.samples.len(), touching).into_iter().map(|(ends, ())| ends).collect()
    }

    /// The stretch of the steps with one lambda in contact, as places along the cut, with that lambda.
    pub(super) fn forces(&self) -> Vec<([f64; 2], f64)> {
        let force = |step: usize| self.samples[step].filter(|sample| sample.contact);
        stretches(self.samples.len(), |step| force(step).map(|sample| sample.lambda))
    }

    /// The place along the cut of a sample.
    pub(super) fn along(&self, step: usize) -> f64 {
        (step as f64 + 0.5) / self.samples.len() as f64
    }
}
