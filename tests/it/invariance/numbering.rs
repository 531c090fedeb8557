//! Vertices and triangles in another order: the same membranes.

use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::Mesh;

use super::random::Draw;
use super::{EXACT, Fields, holds, is_seen, solve};
use crate::random::Random;

/// Solves on a mesh whose vertices are numbered by a permutation, its triangles and their corners in another order. `read`
/// says under which number a vertex is looked up afterwards.
fn survives(draw: &Draw, read: impl Fn(&[usize], usize) -> usize) -> Result<(), String> {
    let mesh = draw.mesh.build()?;
    let d = draw.discretize(&mesh)?;
    let expected = Fields::from(&solve(&d)?);

    let mut random = Random::new(draw.tension[0].to_bits());
    let number = random.permutation(mesh.points().len());
    let renumbered = renumbered(&mesh, &number, &mut random)?;
    let d_renumbered =
        PairDiscretization::new(&draw.problem()?, renumbered.clone()).map_err(|error| error.to_string())?;
    let found = Fields::from(&solve(&d_renumbered)?);
    let at = |a: usize| read(&number, a);
    let vertices = || 0..number.len();
    let found = Fields {
        displacement: found.displacement.map(|u| vertices().map(|a| u[at(a)]).collect()),
        lambda: vertices().map(|a| found.lambda[at(a)]).collect(),
        contact: vertices().map(|a| found.contact[at(a)]).collect(),
    };
    expected.compare(&found, &d, EXACT)
}

fn renumbered(mesh: &Mesh, number: &[usize], random: &mut Random) -> Result<Mesh, String> {
    let mut points = mesh.points().to_vec();
    for (a, &point) in mesh.points().iter().enumerate() {
        points[number[a]] = point;
    }
    let order = random.permutation(mesh.triangles().len());
    let triangles = order.into_iter().map(|t| {
        let corners = mesh.triangles()[t].map(|a| number[a]);
        let turned = random.permutation(3);
        [corners[turned[0]], corners[turned[1]], corners[turned[2]]]
    });
    Mesh::new(points, triangles.collect()).map_err(|error| error.to_string())
}

holds!(renumbering, |draw| super::survives(draw, |number, a| number[a]));

#[test]
fn a_number_that_is_not_translated_is_seen() {
    is_seen(|draw| survives(draw, |_, a| a));
}
