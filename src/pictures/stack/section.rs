//! Where the stack is cut, and its layers along the cut.

use super::scene::{Gap, Layer, Scene};
use crate::pictures::drawing::raster;
use crate::pictures::plan::{Cells, Cut, middle, stretches};

/// The cut, at a round coordinate: of the lines that meet the contact of the most gaps that line through the middle of their
/// contact. Without contact it goes through the middle of the domain.
pub(super) fn cut(scene: &Scene, maps: &[Cells]) -> Cut {
    let domain = &scene.domain;
    let along = Cut::direction(domain);
    let across = 1 - along;
    let profiles = profiles(scene, maps, across);
    let lines = profiles.first().map_or(0, Vec::len);
    let met = |line: usize| profiles.iter().filter(|profile| profile[line] > 0).count();
    let most = (0..lines).map(met).max().unwrap_or(0);
    let on_line = |line: usize| {
        if met(line) == most { profiles.iter().map(|profile| profile[line]).sum() } else { 0 }
    };
    let [centre, reach] = middle(&(0..lines).map(on_line).collect::<Vec<usize>>());
    // Dual cells may be smaller than a pixel: the line goes through a vertex.
    let distance = |v: usize| (domain.place(v)[across] - centre).abs();
    let touching = |v: usize| scene.touching().any(|gap| gap.action.in_contact(v));
    let vertices = domain.used().iter().copied().filter(|&v| touching(v) && distance(v) <= reach);
    match vertices.min_by(|&v, &w| distance(v).total_cmp(&distance(w))) {
        Some(vertex) => {
            let reach = domain.half_width(vertex, across);
            Cut::at(domain, along, domain.place(vertex)[across], reach)
        }
        None => Cut::at(domain, along, centre, reach),
    }
}

/// For each gap with contact, its pixels on each line across `axis`; without any, those of the domain.
fn profiles(scene: &Scene, maps: &[Cells], axis: usize) -> Vec<Vec<usize>> {
    let of_contact = |(map, cells): (usize, &Cells)| {
        let gap = scene.gap_of_map(map).filter(|gap| gap.action.touching)?;
        Some(cells.profile(axis, |vertex| gap.action.in_contact(vertex)))
    };
    let contact: Vec<Vec<usize>> = maps.iter().enumerate().filter_map(of_contact).collect();
    if contact.is_empty() {
        maps.iter().take(1).map(|cells| cells.profile(axis, |_| true)).collect()
    } else {
        contact
    }
}

/// The stack at one point of the cut.
pub(super) struct Sample {
    /// Of the layers from the top.
    pub(super) heights: Vec<f64>,
    /// The vertex in whose dual cell the point lies.
    pub(super) vertex: usize,
}

/// The layers along a cut, at the middles of equal steps; `None` outside of the domain.
pub(super) struct Section {
    pub(super) cut: Cut,
    pub(super) samples: Vec<Option<Sample>>,
}

impl Section {
    /// Samples the layers at `steps` points.
    pub(super) fn new(scene: &Scene, cut: Cut, steps: usize) -> Section {
        let mut samples: Vec<Option<Sample>> = (0..steps).map(|_| None).collect();
        cut.walk(&scene.domain, steps, |step, corners, weights| {
            let height = |layer: &Layer| (0..3).map(|k| weights[k] * layer.height(corners[k])).sum();
            samples[step] = Some(Sample {
                heights: scene.layers.iter().map(height).collect(),
                vertex: corners[raster::nearest_corner(weights)],
            });
        });
        Section { cut, samples }
    }

    /// The ends of the stretches where a gap is closed, as places along the cut.
    pub(super) fn contacts(&self, gap: &Gap) -> Vec<[f64; 2]> {
        let closed = |step: usize| self.vertex(step).filter(|&v| gap.action.in_contact(v)).map(|_| ());
        stretches(self.samples.len(), closed).into_iter().map(|(ends, ())| ends).collect()
    }

    /// The stretches with one lambda where a gap is closed, as places along the cut, with that lambda.
    pub(super) fn forces(&self, gap: &Gap) -> Vec<([f64; 2], f64)> {
        let lambda = |step: usize| self.vertex(step).and_then(|v| gap.action.in_contact_lambda(v));
        stretches(self.samples.len(), lambda)
    }

    /// The place along the cut of a sample.
    pub(super) fn along(&self, step: usize) -> f64 {
        (step as f64 + 0.5) / self.samples.len() as f64
    }

    fn vertex(&self, step: usize) -> Option<usize> {
        self.samples[step].as_ref().map(|sample| sample.vertex)
    }
}
