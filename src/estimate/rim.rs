//! How far a contact set and its rim are from the exact ones.

use super::norms::DEPTH;
use crate::action::Rim;
use crate::fem::CutRule;
use crate::geometry::{Curve, Interface};
use crate::mesh::Mesh;
use crate::parallel::sums;

/// The error of a contact set against an exact one that a curve bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RimError {
    /// The Hausdorff distance of the rim from the exact one, see [`Curve::hausdorff`]; `None` where nothing touches, or the rim
    /// lies outside of the mesh. Unit: length.
    pub hausdorff: Option<f64>,
    /// The Jaccard index of the sets: the area that is in both over that which is in one of them; 1 where they are the same.
    pub jaccard: f64,
    /// How much the last subdivision along the exact rim changes the index: of the order of its quadrature error.
    pub quadrature: f64,
}

impl RimError {
    /// Measures the set within `rim` on `mesh` against the one on the negative side of `exact`.
    pub fn new(mesh: &Mesh, rim: &Rim, exact: &Interface) -> Self {
        let lines = Curve::of_lines(rim.lines().iter().map(Vec::as_slice));
        let rule = CutRule::new(vec![*exact], None, DEPTH);
        let [deep, shallow] = [rule.clone(), rule.shallower()].map(|rule| jaccard(mesh, rim, exact, &rule));
        Self {
            hausdorff: lines.hausdorff(&Curve::of_interface(exact, mesh.bounding_box())),
            jaccard: deep,
            quadrature: (deep - shallow).abs(),
        }
    }
}

/// `|A and B| / |A or B|`; 1 when both are empty.
fn jaccard(mesh: &Mesh, rim: &Rim, exact: &Interface, rule: &CutRule) -> f64 {
    let inside = |triangle: [[f64; 2]; 3]| {
        let mut area = 0.0;
        rule.visit(triangle, &mut |[x, y], weight| {
            area += if exact.signed_distance(x, y) < 0.0 { weight } else { 0.0 };
        });
        area
    };
    let [of_exact, of_both] =
        sums(mesh.triangles().len(), |t| [inside(mesh.corners(t)), rim.part(mesh, t).map(inside).sum()]);
    let either = rim.area() + of_exact - of_both;
    if either > 0.0 { of_both / either } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::mesh::{Pattern, rectangle};

    fn error(gap: impl Fn(f64, f64) -> f64, exact: Interface) -> RimError {
        let mesh = rectangle([0.0; 2], [1.0; 2], [32; 2], Pattern::Crossed).unwrap();
        let gap: Vec<f64> = mesh.points().iter().map(|&[x, y]| gap(x, y)).collect();
        let contact: Vec<bool> = gap.iter().map(|&w| w == 0.0).collect();
        RimError::new(&mesh, &Rim::new(&mesh, &gap, &contact), &exact)
    }

    fn beyond(x0: f64) -> impl Fn(f64, f64) -> f64 {
        move |x, _| (x - x0).max(0.0).powi(2)
    }

    #[test]
    fn strips_share_what_is_left_of_both_lines() {
        let line = |x: f64| Interface::VerticalLine { x };
        let same = error(beyond(0.51), line(0.51));
        assert!((same.jaccard - 1.0).abs() < 1e-9 && same.hausdorff.unwrap() < 1e-5, "{same:?}");
        let other = error(beyond(0.51), line(0.41));
        assert!((other.jaccard - 41.0 / 51.0).abs() < 1e-9, "{other:?}");
        assert!((other.hausdorff.unwrap() - 0.1).abs() < 2e-3, "{other:?}");
        let apart = error(|_, _| 1.0, line(0.41));
        assert_eq!((apart.jaccard, apart.hausdorff), (0.0, None));
    }

    #[test]
    fn discs_share_their_lens() {
        let radius = 0.3;
        let gap = |x: f64, y: f64| {
            let d = (x - 0.5).hypot(y - 0.5) - radius;
            d.max(0.0).powi(2)
        };
        let shift: f64 = 0.1;
        let half = shift / 2.0;
        let lens = 2.0 * radius * radius * (half / radius).acos()
            - half * (4.0 * radius * radius - shift * shift).sqrt();
        let expected = lens / (2.0 * PI * radius * radius - lens);
        let exact = Interface::Circle { centre: [0.5 + shift, 0.5], radius };
        let error = error(gap, exact);
        assert!((error.jaccard - expected).abs() < 3e-3, "{error:?}, not {expected}");
        assert!((error.hausdorff.unwrap() - shift).abs() < 2e-3, "{error:?}");
        assert!(error.quadrature < 1e-4, "{error:?}");
    }
}
