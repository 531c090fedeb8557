//! How many triangles are drawn: no more than can be seen.

use std::borrow::Cow;
use std::sync::Arc;

use crate::mesh::Parents;

/// A vertex for each pixel of a map of 480 x 500: more triangles make no difference to the eye.
const ENOUGH: usize = 2 * 480 * 500;

/// The triangles that are drawn: those of the coarsest mesh of the ancestry that has [`ENOUGH`] of them, or all that there are.
/// Their corners are numbered as in the finest mesh, of which a coarse vertex is a vertex.
pub(super) fn drawn<'a>(triangles: &'a [[usize; 3]], ancestry: &[Arc<Parents>]) -> Cow<'a, [[usize; 3]]> {
    drawn_of(triangles, ancestry, ENOUGH)
}

fn drawn_of<'a>(
    triangles: &'a [[usize; 3]],
    ancestry: &[Arc<Parents>],
    enough: usize,
) -> Cow<'a, [[usize; 3]]> {
    let mut drawn = Cow::Borrowed(triangles);
    // The number of a vertex of the mesh that is drawn in the finest one.
    let mut number: Option<Vec<usize>> = None;
    for parents in ancestry.iter().rev().take_while(|_| triangles.len() > enough) {
        let coarser = parents.coarser(&drawn);
        if coarser.len() < enough {
            break;
        }
        drawn = Cow::Owned(coarser);
        number = Some(kept(parents, number.as_deref()));
    }
    if let (Cow::Owned(triangles), Some(number)) = (&mut drawn, number) {
        triangles.iter_mut().flatten().for_each(|a| *a = number[*a]);
    }
    drawn
}

/// For each vertex of the coarser mesh its number in the finest one; `number` has that of those of the finer one.
fn kept(parents: &Parents, number: Option<&[usize]>) -> Vec<usize> {
    let mut kept = vec![0; parents.coarse_vertices()];
    for (v, &[a, b]) in parents.ends().iter().enumerate().filter(|(_, [a, b])| a == b) {
        kept[a.min(b) as usize] = number.map_or(v, |number| number[v]);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Bisection, Mesh, Pattern, disk, l_shape, rectangle};

    /// The triangles in their order, each from its least corner on.
    fn sorted(triangles: &[[usize; 3]]) -> Vec<[usize; 3]> {
        let rotated = |&[a, b, c]: &[usize; 3]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap();
        let mut sorted: Vec<[usize; 3]> = triangles.iter().map(rotated).collect();
        sorted.sort_unstable();
        sorted
    }

    fn is_coarser(fine: &Mesh, coarse: &Mesh) {
        let found = fine.ancestry().last().unwrap().coarser(fine.triangles());
        assert_eq!(sorted(&found), sorted(coarse.triangles()));
    }

    #[test]
    fn the_parts_of_refinements_are_put_together() {
        for pattern in [Pattern::Right, Pattern::Crossed] {
            let square = |cells: usize| rectangle([0.0; 2], [1.0, 2.0], [cells, 2 * cells], pattern).unwrap();
            is_coarser(&square(8), &square(4));
            is_coarser(&l_shape(1.0, 8, pattern).unwrap(), &l_shape(1.0, 4, pattern).unwrap());
            is_coarser(&square(3).refine().unwrap().mesh, &square(3));
        }
        is_coarser(&disk([0.0; 2], 1.0, 6).unwrap(), &disk([0.0; 2], 1.0, 3).unwrap());
    }

    #[test]
    fn bisected_triangles_are_put_together() {
        let mut bisection = Bisection::new(rectangle([0.0; 2], [1.0; 2], [4; 2], Pattern::Crossed).unwrap());
        for step in 0..6 {
            let coarse = bisection.mesh().clone();
            let marked: Vec<usize> = (step..coarse.triangles().len()).step_by(3 + step).collect();
            bisection.refine(&marked).unwrap();
            is_coarser(bisection.mesh(), &coarse);
        }
    }

    #[test]
    fn the_coarsest_mesh_with_enough_triangles_is_drawn() {
        let mesh = rectangle([0.0; 2], [1.0; 2], [32; 2], Pattern::Right).unwrap();
        let drawn = |enough| drawn_of(mesh.triangles(), mesh.ancestry(), enough);
        for (enough, cells) in [(512, 16), (400, 16), (128, 8), (100, 8), (2, 1)] {
            let coarse = rectangle([0.0; 2], [1.0; 2], [cells; 2], Pattern::Right).unwrap();
            let places = |mesh: &Mesh, triangles: &[[usize; 3]]| {
                let mut places = Vec::new();
                for corners in triangles {
                    let mut corners = corners.map(|a| mesh.points()[a].map(|x| (64.0 * x) as usize));
                    corners.sort_unstable();
                    places.push(corners);
                }
                places.sort_unstable();
                places
            };
            assert_eq!(places(&mesh, &drawn(enough)), places(&coarse, coarse.triangles()), "{enough}");
        }
        for enough in [513, 2048, 5000] {
            assert!(matches!(drawn(enough), Cow::Borrowed(triangles) if triangles == mesh.triangles()));
        }
        assert!(matches!(drawn_of(mesh.triangles(), &[], 2), Cow::Borrowed(_)), "nothing coarser is known");
    }
}
