//! Actions along lines.

use crate::discretization::StackDiscretization;
use crate::geometry::distance_sq;
use crate::mesh::Mesh;

/// The density `l_a` of the action in gap `k` along lines, over vertices; zero elsewhere. Unit: force per length.
///
/// On free edges in contact, and where tensions jump inside a contact zone, the action has a density along the line beside that
/// over the area, and both are in the nodal force: `y_a = lambda_a |D_a| + l_a L_a`, where `L_a` is half the length of the edges of such
/// lines at `a` of which both ends touch. What the area takes of it is told by the neighbours: `lambda_a` is the mean of
/// `y_b / |D_b|` over those that touch and lie on no such line; and `l_a` is not negative. Where there is no such neighbour, it is zero.
pub(super) fn line_density(d: &StackDiscretization, k: usize, force: &[f64], contact: &[bool]) -> Vec<f64> {
    let mesh = d.mesh();
    let mut length = vec![0.0; force.len()];
    for [a, b] in d.lines(k).into_iter().filter(|&[a, b]| contact[a] && contact[b]) {
        let half = 0.5 * distance_sq(mesh.points()[a], mesh.points()[b]).sqrt();
        length[a] += half;
        length[b] += half;
    }
    let mut density = vec![0.0; force.len()];
    if length.iter().all(|&length| length == 0.0) {
        return density;
    }
    let area = d.dual_area();
    let means = neighbour_means(mesh, &length, |b| contact[b].then(|| force[b] / area[b]));
    for a in (0..force.len()).filter(|&a| length[a] > 0.0) {
        if let Some(lambda) = means[a] {
            density[a] = ((force[a] - lambda * area[a]) / length[a]).max(0.0);
        }
    }
    density
}

/// For each vertex of positive `length`, the mean of `value` over its neighbours without one, edge by edge of the triangles.
fn neighbour_means(mesh: &Mesh, length: &[f64], value: impl Fn(usize) -> Option<f64>) -> Vec<Option<f64>> {
    let mut sums = vec![(0.0, 0usize); length.len()];
    for corners in mesh.triangles() {
        for &a in corners.iter().filter(|&&a| length[a] > 0.0) {
            for value in corners.iter().filter(|&&b| length[b] == 0.0).filter_map(|&b| value(b)) {
                sums[a] = (sums[a].0 + value, sums[a].1 + 1);
            }
        }
    }
    sums.into_iter().map(|(sum, count)| (count > 0).then(|| sum / count as f64)).collect()
}
