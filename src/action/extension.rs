//! The action on the dual cells of the boundary, where `lambda_h` is zero and the exact action need not be.

use crate::discretization::Discretization;
use crate::mesh::VertexKind;

/// Continues an action over vertices to the boundary, and tells where: `lambda_a` becomes the mean of the action at the
/// neighbours, triangle by triangle, if the membranes touch in all triangles around the boundary vertex `a`.
///
/// Neighbours are those inside; in a corner whose triangle has none, those on the boundary that have got theirs.
/// Where the membranes touch only on one side, or no neighbour knows an action, it stays zero. Linear time.
pub(crate) fn extend_to_boundary(
    d: &Discretization,
    [u1, u2]: &[Vec<f64>; 2],
    lambda: &mut [f64],
) -> Vec<bool> {
    let kind = d.mesh().kind();
    let is_boundary = |a: usize| kind[a] == VertexKind::Boundary;
    let at_boundary = |corners: &&[usize; 3]| corners.iter().any(|&a| is_boundary(a));
    let mut triangles: Vec<[usize; 3]> = d.mesh().triangles().iter().filter(at_boundary).copied().collect();
    let mut touches: Vec<bool> = kind.iter().map(|&kind| kind == VertexKind::Boundary).collect();
    for corners in &triangles {
        if corners.iter().any(|&a| u1[a] > u2[a]) {
            corners.iter().for_each(|&a| touches[a] = false);
        }
    }
    let mut known: Vec<bool> = kind.iter().map(|&kind| kind == VertexKind::Interior).collect();
    let mut sums = vec![(0.0, 0usize); if triangles.is_empty() { 0 } else { kind.len() }];
    loop {
        let is_open = |corners: &[usize; 3]| corners.iter().any(|&a| touches[a] && !known[a]);
        triangles.retain(is_open);
        let mut reached = Vec::new();
        for corners in &triangles {
            let of_known = corners.iter().filter(|&&b| known[b]);
            let (sum, count) = of_known.fold((0.0, 0), |(sum, count), &b| (sum + lambda[b], count + 1));
            for &a in corners.iter().filter(|&&a| count > 0 && touches[a] && !known[a]) {
                if sums[a].1 == 0 {
                    reached.push(a);
                }
                sums[a] = (sums[a].0 + sum, sums[a].1 + count);
            }
        }
        if reached.is_empty() {
            return (0..kind.len()).map(|a| touches[a] && is_boundary(a)).collect();
        }
        for a in reached {
            lambda[a] = sums[a].0 / sums[a].1 as f64;
            known[a] = true;
        }
    }
}
