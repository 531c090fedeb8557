//! Sample meshes for the tests of all layers.

use super::{Mesh, Parents, Pattern, VertexKind, rectangle};
use crate::numeric::{Random, largest};

/// The unit square in `cells x cells` cells of two right triangles.
pub(crate) fn square(cells: usize) -> Mesh {
    rectangle([0.0, 0.0], [1.0, 1.0], [cells; 2], Pattern::Right).unwrap()
}

/// The unit square in triangles of all shapes: [`square`] with every inner vertex moved by up to a fifth of a cell.
pub(crate) fn irregular(cells: usize) -> Mesh {
    let regular = square(cells);
    let mut random = Random::new(cells as u64);
    let reach = 0.2 / cells as f64;
    let moved = regular.points().iter().zip(regular.kind()).map(|(&point, kind)| match kind {
        VertexKind::Interior => point.map(|x| x + random.between(-reach, reach)),
        _ => point,
    });
    Mesh::new(moved.collect(), regular.triangles().to_vec()).unwrap()
}

/// The unit square in `cells x cells` cells without those that `removed` names by column and row.
pub(crate) fn square_without(cells: usize, removed: impl Fn(usize, usize) -> bool) -> Mesh {
    let square = square(cells);
    let kept = square.triangles().chunks(2).enumerate().filter(|(k, _)| !removed(k % cells, k / cells));
    Mesh::new(square.points().to_vec(), kept.flat_map(|(_, cell)| cell.to_vec()).collect()).unwrap()
}

/// The same mesh with vertices and triangles in another order, the corners of triangles turned and exchanged; and the new
/// number of each vertex.
pub(crate) fn renumbered(mesh: &Mesh, seed: u64) -> (Mesh, Vec<usize>) {
    let mut random = Random::new(seed);
    let number = random.permutation(mesh.points().len());
    let mut points = mesh.points().to_vec();
    for (a, &point) in mesh.points().iter().enumerate() {
        points[number[a]] = point;
    }
    let order = random.permutation(mesh.triangles().len());
    let shuffled = |t: &usize| {
        let corners = mesh.triangles()[*t].map(|a| number[a]);
        let corner = random.permutation(3);
        [corners[corner[0]], corners[corner[1]], corners[corner[2]]]
    };
    (Mesh::new(points, order.iter().map(shuffled).collect()).unwrap(), number)
}

/// A square with a hole, two holes that touch, components that touch, triangles of all shapes, an unused vertex.
pub(crate) fn assorted() -> Vec<Mesh> {
    let with_unused = [irregular(3).points(), &[[0.5, 0.5]]].concat();
    vec![
        square(3),
        irregular(4),
        square_without(3, |i, j| (i, j) == (1, 1)),
        square_without(4, |i, j| i == j && (i == 1 || i == 2)),
        square_without(4, |i, j| (i + j) % 2 == 0),
        Mesh::new(with_unused, irregular(3).triangles().to_vec()).unwrap(),
    ]
}

/// A mesh of the unit square with the region `patch` and the sides `west`, `north` and `east`.
pub(crate) fn with_sides_and_patch(mesh: Mesh) -> Mesh {
    let on = |distance: f64| distance.abs() < 1e-9;
    let mesh = mesh.with_region("patch", |[x, y]| x + 0.5 * y < 0.6).unwrap();
    let mesh = mesh.with_curve("west", |[x, _]| on(x)).unwrap();
    let mesh = mesh.with_curve("north", |[_, y]| on(1.0 - y)).unwrap();
    mesh.with_curve("east", |[x, _]| on(1.0 - x)).unwrap()
}

/// How far the vertices are from the means of their parents, where the coarsest vertices lie as in `coarsest`.
pub(crate) fn ancestry_defect(mesh: &Mesh, coarsest: &[[f64; 2]]) -> f64 {
    let prolong = |points: &[[f64; 2]], parents: &Parents| -> Vec<[f64; 2]> {
        let at = |end: u32| points[end as usize];
        let mean = |&[a, b]: &[u32; 2]| [0, 1].map(|axis| 0.5 * (at(a)[axis] + at(b)[axis]));
        parents.ends().iter().map(mean).collect()
    };
    let points = mesh.ancestry().iter().fold(coarsest.to_vec(), |points, parents| prolong(&points, parents));
    let distance = |(p, q): (&[f64; 2], &[f64; 2])| (p[0] - q[0]).abs().max((p[1] - q[1]).abs());
    largest(points.iter().zip(mesh.points()).map(distance))
}
