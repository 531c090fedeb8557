//! The wedges `D_a cap K` around each vertex, in order.

use crate::mesh::{Mesh, corner_of};

/// Wedges that follow one another counterclockwise around a vertex: around an interior one they close, at a boundary
/// vertex there is one fan for each sector of the domain.
///
/// Wedge `w = 3 K + i` is `D_a cap K` for corner `i` of the triangle `K`; its halves are the sub-triangles `2 w`, `2 w + 1`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fan {
    pub(super) wedges: Vec<usize>,
    pub(super) closed: bool,
}

/// All fans; each wedge is in one of them. Linear time, but for sorting many triangles around one vertex.
pub(super) fn fans(mesh: &Mesh) -> Vec<Fan> {
    let (mut walk, mut sides, mut fans) = (Walk::default(), Vec::new(), Vec::new());
    for a in 0..mesh.points().len() {
        let triangles = mesh.around().of(a);
        sides.clear();
        sides.extend(mesh.around().triangles(a).map(|k| wedge_of(mesh, k, a).1));
        walk.fans(&sides, |fan, closed| {
            let wedge = |&place: &usize| {
                let k = triangles[place] as usize;
                3 * k + wedge_of(mesh, k, a).0
            };
            fans.push(Fan { wedges: fan.iter().map(wedge).collect(), closed });
        });
    }
    fans
}

/// Which corner of triangle `k` vertex `a` is, and the two others counterclockwise.
pub(super) fn wedge_of(mesh: &Mesh, k: usize, a: usize) -> (usize, [usize; 2]) {
    let triangle = mesh.triangles()[k];
    let corner = corner_of(triangle, a);
    (corner, [1, 2].map(|j| triangle[(corner + j) % 3]))
}

/// Among so many wedges the next one is found by looking at each.
const FEW: usize = 16;

/// Memory for walks around vertices.
#[derive(Default)]
pub(super) struct Walk {
    /// The first corner after the vertex and the number of the wedge, sorted, where there are many: so successors are found.
    by_next: Vec<(usize, usize)>,
    is_first: Vec<bool>,
    seen: Vec<bool>,
    /// One fan, counterclockwise.
    fan: Vec<usize>,
}

impl Walk {
    /// Calls `each(fan, closed)` for the fans of a vertex. A fan is given by the numbers of its wedges, a wedge by the two corners
    /// of its triangle that follow the vertex counterclockwise.
    pub(super) fn fans(&mut self, sides: &[[usize; 2]], mut each: impl FnMut(&[usize], bool)) {
        let Self { by_next, is_first, seen, fan } = self;
        by_next.clear();
        if sides.len() > FEW {
            by_next.extend(sides.iter().enumerate().map(|(k, &[next, _])| (next, k)));
            by_next.sort_unstable();
        }
        let following = |k: usize| {
            let last = sides[k][1];
            if sides.len() <= FEW {
                return sides.iter().position(|&[next, _]| next == last);
            }
            let found = by_next.binary_search_by_key(&last, |&(next, _)| next);
            found.ok().map(|place| by_next[place].1)
        };
        is_first.clear();
        is_first.resize(sides.len(), true);
        seen.clear();
        seen.resize(sides.len(), false);
        (0..sides.len()).filter_map(following).for_each(|k| is_first[k] = false);
        // What is not seen from a first wedge lies in a fan without one.
        for closed in [false, true] {
            for start in 0..sides.len() {
                if seen[start] || !(closed || is_first[start]) {
                    continue;
                }
                fan.clear();
                let mut wedge = Some(start);
                while let Some(k) = wedge.filter(|&k| !seen[k]) {
                    seen[k] = true;
                    fan.push(k);
                    wedge = following(k);
                }
                each(fan, closed);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::VertexKind;
    use crate::mesh::samples::{irregular, renumbered, square, square_without};

    /// The fans of a mesh, and the vertex of each.
    fn fans_of(mesh: &Mesh) -> Vec<(usize, Fan)> {
        let vertex = |w: usize| mesh.triangles()[w / 3][w % 3];
        fans(mesh).into_iter().map(|fan| (vertex(fan.wedges[0]), fan)).collect()
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
    fn many_wedges_close_around_a_hub() {
        let spokes = 3 * FEW;
        let on_circle = |k: usize| {
            let angle = std::f64::consts::TAU * k as f64 / spokes as f64;
            [angle.cos(), angle.sin()]
        };
        let points = [[0.0; 2]].into_iter().chain((0..spokes).map(on_circle)).collect();
        let triangles = (0..spokes).map(|k| [0, 1 + k, 1 + (k + 1) % spokes]).collect();
        let (mesh, _) = renumbered(&Mesh::new(points, triangles).unwrap(), 7);
        let fans = fans_of(&mesh);
        let closed: Vec<&Fan> = fans.iter().map(|(_, fan)| fan).filter(|fan| fan.closed).collect();
        assert!(closed.len() == 1 && closed[0].wedges.len() == spokes);
        assert_eq!(fans.len(), 1 + spokes, "and an open one at each vertex of the boundary");
        for pair in closed[0].wedges.windows(2) {
            let corner = |w: usize, j: usize| mesh.triangles()[w / 3][(w % 3 + j) % 3];
            assert_eq!(corner(pair[0], 2), corner(pair[1], 1));
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
