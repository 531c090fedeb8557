//! The wedges `D_a cap K` around each vertex, in order.

use crate::mesh::SubTriangulation;

/// Wedges that follow one another counterclockwise around a vertex: around an interior one they close, at a boundary
/// vertex there is one fan for each sector of the domain.
///
/// Wedge `w = 3 K + i` is `D_a cap K` for corner `i` of the triangle `K`; its halves are the sub-triangles `2 w`, `2 w + 1`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fan {
    pub(super) wedges: Vec<usize>,
    pub(super) closed: bool,
}

/// All fans; each wedge is in one of them. Linear time.
pub(super) fn fans(sub: &SubTriangulation) -> Vec<Fan> {
    let following = following(sub);
    let mut is_first = vec![true; following.len()];
    following.iter().flatten().for_each(|&w| is_first[w] = false);
    let mut seen = vec![false; following.len()];
    let firsts = (0..following.len()).filter(|&w| is_first[w]);
    // What is not seen from a first wedge lies in a fan without one.
    let starts = firsts.map(|w| (w, false)).chain((0..following.len()).map(|w| (w, true)));
    let mut fans = Vec::new();
    for (start, closed) in starts {
        let mut wedges = Vec::new();
        let mut wedge = Some(start);
        while let Some(w) = wedge.filter(|&w| !seen[w]) {
            seen[w] = true;
            wedges.push(w);
            wedge = following[w];
        }
        if !wedges.is_empty() {
            fans.push(Fan { wedges, closed });
        }
    }
    fans
}

/// The next wedge counterclockwise around the same vertex; none at the boundary.
fn following(sub: &SubTriangulation) -> Vec<Option<usize>> {
    let triangles = sub.mesh().triangles();
    let vertex = |w: usize| sub.vertex_of(2 * w);
    let wedges = 0..triangles.len() / 2;
    // At a midpoint begins one wedge at either end of the edge.
    let mut beginning = vec![[None; 2]; sub.mesh().points().len()];
    for w in wedges.clone() {
        let [_, midpoint, _] = triangles[2 * w];
        let [one, other] = &mut beginning[midpoint];
        *(if one.is_none() { one } else { other }) = Some(w);
    }
    let next = |w: usize| {
        let [_, _, midpoint] = triangles[2 * w + 1];
        beginning[midpoint].into_iter().flatten().find(|&next| vertex(next) == vertex(w))
    };
    wedges.map(next).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::samples::{irregular, renumbered, square, square_without};
    use crate::mesh::{Mesh, VertexKind};

    /// The fans of a mesh, and the vertex of each.
    fn fans_of(mesh: &Mesh) -> Vec<(usize, Fan)> {
        let sub = SubTriangulation::new(mesh).unwrap();
        fans(&sub).into_iter().map(|fan| (sub.vertex_of(2 * fan.wedges[0]), fan)).collect()
    }

    #[test]
    fn every_wedge_is_in_one_fan_which_closes_around_interior_vertices() {
        for mesh in [renumbered(&irregular(5), 3).0, square_without(4, |i, j| i == j && (i == 1 || i == 2))] {
            let mut times = vec![0; 3 * mesh.triangles().len()];
            for (a, fan) in fans_of(&mesh) {
                assert_eq!(fan.closed, mesh.kind()[a] == VertexKind::Interior);
                fan.wedges.iter().for_each(|&w| times[w] += 1);
                assert!(fan.wedges.iter().all(|w| mesh.triangles()[w / 3][w % 3] == a));
                for pair in fan.wedges.windows(2) {
                    // The last edge of a wedge is the first one of the next.
                    let corner = |w: usize, i: usize| mesh.triangles()[w / 3][(w + i) % 3];
                    let [before, after] = [pair[0], pair[1]].map(|w| (3 * (w / 3), w % 3));
                    assert_eq!(corner(before.0 + before.1, 2), corner(after.0 + after.1, 1));
                    assert_ne!(corner(before.0 + before.1, 1), corner(after.0 + after.1, 2));
                }
            }
            assert!(times.iter().all(|&times| times == 1));
        }
    }

    #[test]
    fn where_holes_touch_there_are_two_fans() {
        let mesh = square_without(4, |i, j| i == j && (i == 1 || i == 2));
        let touching = mesh.points().iter().position(|&point| point == [0.5, 0.5]).unwrap();
        let at = |mesh: &Mesh, a: usize| fans_of(mesh).iter().filter(|(vertex, _)| *vertex == a).count();
        assert_eq!(at(&mesh, touching), 2);
        assert_eq!(at(&square(4), touching), 1);
    }
}
