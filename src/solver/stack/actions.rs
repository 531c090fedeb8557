//! The actions in rows that touch, from displacements.

use crate::discretization::{Segment, StackDiscretization};

/// Calls `visit` with the segments at each vertex.
pub(super) fn for_segments(d: &StackDiscretization, active: &[bool], mut visit: impl FnMut(usize, Segment)) {
    let mut layers = Vec::new();
    for a in 0..d.dual_area().len() {
        d.segments(a, active, &mut layers).for_each(|segment| visit(a, segment));
    }
}

/// The actions in the `closed` rows, and the size of the terms that cancel in them, from the residuals of the membranes (section 2 of the
/// notes on stacks); zero in the others.
pub(super) fn actions(d: &StackDiscretization, closed: &[bool], displacement: &[Vec<f64>]) -> [Vec<f64>; 2] {
    let mut multiplier = vec![0.0; closed.len()];
    let mut terms = vec![0.0; closed.len()];
    let mut sides: Vec<[f64; 2]> = Vec::new();
    for_segments(d, closed, |a, segment| {
        sides.clear();
        sides.extend(segment.layers.clone().map(|i| d.imbalance(i, a, &displacement[i - 1])));
        let first = segment.layers.start;
        let of_segment = sides.iter().map(|[_, terms]| terms).sum::<f64>();
        segment.actions(
            |i| sides[i - first][0],
            |k, action| {
                if let Some(row) = d.row(k, a) {
                    (multiplier[row], terms[row]) = (action, of_segment);
                }
            },
        );
    });
    [multiplier, terms]
}
