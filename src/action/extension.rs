//! The action on the dual cells of the boundary, where `lambda_h` is zero and the exact action need not be.

use crate::discretization::{Displacement, PairDiscretization};
use crate::mesh::{Mesh, VertexKind};

/// Continues an action over vertices to the boundary, and tells where; see [`extend_to_held`].
pub(crate) fn extend_to_boundary(
    d: &PairDiscretization,
    [u1, u2]: &Displacement,
    lambda: &mut [f64],
) -> Vec<bool> {
    let is_boundary = |a: usize| d.mesh().kind()[a] == VertexKind::Boundary;
    extend_to_held(d.mesh(), is_boundary, |a| u1[a] > u2[a], lambda)
}

/// Continues an action over vertices to those where both layers are held, and tells where: `lambda_a` becomes the mean of the
/// action at the neighbours, triangle by triangle, if the layers touch in all triangles around such a vertex `a`.
///
/// Neighbours are those that are not held; in a corner whose triangle has none, those held that have got theirs.
/// Where the layers touch only on one side, or no neighbour knows an action, it stays zero. Linear time.
pub(crate) fn extend_to_held(
    mesh: &Mesh,
    is_held: impl Fn(usize) -> bool,
    are_apart: impl Fn(usize) -> bool,
    lambda: &mut [f64],
) -> Vec<bool> {
    let vertices = lambda.len();
    if (0..vertices).all(|a| !is_held(a) || are_apart(a)) {
        return vec![false; vertices];
    }
    let at_held = |corners: &&[usize; 3]| corners.iter().any(|&a| is_held(a));
    let mut triangles: Vec<[usize; 3]> = mesh.triangles().iter().filter(at_held).copied().collect();
    let mut touches: Vec<bool> = (0..vertices).map(&is_held).collect();
    for corners in &triangles {
        if corners.iter().any(|&a| are_apart(a)) {
            corners.iter().for_each(|&a| touches[a] = false);
        }
    }
    let mut known: Vec<bool> =
        (0..vertices).map(|a| mesh.kind()[a] != VertexKind::Unused && !is_held(a)).collect();
    let mut sums = vec![(0.0, 0usize); if triangles.is_empty() { 0 } else { vertices }];
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
            return (0..vertices).map(|a| touches[a] && is_held(a)).collect();
        }
        for a in reached {
            lambda[a] = sums[a].0 / sums[a].1 as f64;
            known[a] = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::samples::{assorted, square};
    use crate::mesh::{Mesh, disk};
    use crate::problem::{ContactProblem, Function};

    /// The action over vertices and where it has been continued to, of a gap and an action.
    fn extended(
        mesh: &Mesh,
        gap: impl Fn(f64, f64) -> f64 + Send + Sync + Clone + 'static,
        action: impl Fn(f64, f64) -> f64,
    ) -> (Vec<f64>, Vec<bool>) {
        let height = Function::from_fn(gap.clone());
        let d =
            PairDiscretization::new(&ContactProblem::builder().height(height).build().unwrap(), mesh.clone());
        let u1: Vec<f64> = mesh.points().iter().map(|&[x, y]| gap(x, y)).collect();
        let u2 = vec![0.0; u1.len()];
        let inside = |(&[x, y], &kind): (&[f64; 2], &VertexKind)| match kind {
            VertexKind::Interior => action(x, y),
            _ => 0.0,
        };
        let mut lambda: Vec<f64> = mesh.points().iter().zip(mesh.kind()).map(inside).collect();
        let at_boundary = extend_to_boundary(&d.unwrap(), &[u1, u2], &mut lambda);
        (lambda, at_boundary)
    }

    #[test]
    fn a_constant_action_is_continued_everywhere_also_into_corners() {
        let mut meshes = assorted();
        meshes.extend([square(2), disk([0.0, 0.0], 1.0, 3).unwrap()]);
        for mesh in meshes.iter().filter(|mesh| mesh.kind().contains(&VertexKind::Interior)) {
            let (lambda, at_boundary) = extended(mesh, |_, _| 0.0, |_, _| 1.5);
            for (a, &kind) in mesh.kind().iter().enumerate() {
                assert_eq!(lambda[a], if kind == VertexKind::Unused { 0.0 } else { 1.5 });
                assert_eq!(at_boundary[a], kind == VertexKind::Boundary);
            }
        }
    }

    #[test]
    fn it_is_the_mean_of_the_neighbours_and_ends_where_the_membranes_part() {
        let mesh = square(4);
        let (lambda, at_boundary) = extended(&mesh, |x, _| (x - 0.5).max(0.0), |_, y| y);
        let at = |x: f64, y: f64| mesh.points().iter().position(|&point| point == [x, y]).unwrap();
        // Triangles above the diagonals from lower left to upper right: (0, 1/4) has the neighbours (1/4, 1/4), (1/4, 1/2), one of
        // them in two triangles.
        let mean = lambda[at(0.0, 0.25)];
        assert!(at_boundary[at(0.0, 0.25)] && 0.25 < mean && mean < 0.5, "{mean}");
        assert!(at_boundary[at(0.25, 0.0)], "all its triangles touch");
        for apart in [at(0.5, 0.0), at(0.75, 0.0), at(1.0, 0.5), at(0.5, 1.0)] {
            assert!(!at_boundary[apart] && lambda[apart] == 0.0);
        }
        assert!(!at_boundary[at(0.25, 0.25)], "it is inside");
    }

    #[test]
    fn without_interior_vertices_there_is_no_action_to_continue() {
        let (lambda, at_boundary) = extended(&square(1), |_, _| 0.0, |_, _| 1.0);
        assert_eq!((lambda, at_boundary), (vec![0.0; 4], vec![true; 4]));
    }
}
