//! The residual estimator, to compare the bound with.

use super::MeasureError;
use crate::discretization::{Displacement, PairDiscretization};
use crate::fem::gradient;
use crate::geometry::distance_sq;
use crate::mesh::HalfEdges;

/// The squared indicators of the residual estimator (Veeser, SIAM J. Numer. Anal. 39 (2001) 146; Bartels, Carstensen, Numer.
/// Math. 99 (2004) 225), summed over the membranes:
///
/// ```text
/// eta_K^2 = sum_i h_K^2 / mu_i ||f_ih - (-1)^i lambda_h||_K^2 + 1/2 sum_e h_e / mu_i ||[mu_i d_n u_ih]||_e^2
/// ```
///
/// over the interior edges `e` of `K`. The root of their sum is of the order of the energy error; the factor is not known, so it
/// bounds nothing. `displacement` and `lambda` are over vertices; with `lambda_h`, which is zero on the cells of the boundary, the
/// estimator does not fall where the membranes touch there, with [`ErrorBound::actions`](super::ErrorBound::actions) it does. Shape: `triangles`. Linear time.
///
/// # Errors
/// [`MeasureError::OtherMesh`] when the vectors are not over the vertices.
pub fn residual_indicators(
    d: &PairDiscretization,
    displacement: &Displacement,
    lambda: &[f64],
) -> Result<Vec<f64>, MeasureError> {
    MeasureError::check(d, [&displacement[0], &displacement[1], lambda])?;
    let mesh = d.mesh();
    let half_edges = HalfEdges::new(mesh.points().len(), mesh.triangles());
    let mut indicators = vec![0.0; mesh.triangles().len()];
    for (i, push) in [1.0, -1.0].into_iter().enumerate() {
        let mu = d.tension()[i];
        for (k, indicator) in indicators.iter_mut().enumerate() {
            let area = mesh.triangle_area(k);
            let mean = d.moments[i].on(mesh, k).integrals.iter().sum::<f64>() / area;
            let residual_sq = |&a: &usize| area / 3.0 * (mean + push * lambda[a]).powi(2);
            let on_wedges = mesh.triangles()[k].iter().map(residual_sq).sum::<f64>();
            *indicator += mesh.diameter_sq(k) / mu * on_wedges;
        }
        let slope = |k: usize| gradient(mesh.corners(k), mesh.triangles()[k].map(|a| displacement[i][a]));
        for (a, b, sides) in half_edges.edges() {
            let [one, other] = sides else { continue };
            let (p, q) = (slope(one.triangle()), slope(other.triangle()));
            // Along the edge, the slopes are the same.
            let jump_sq = distance_sq(p, q);
            let share = 0.5 * mu * distance_sq(mesh.points()[a], mesh.points()[b]) * jump_sq;
            indicators[one.triangle()] += share;
            indicators[other.triangle()] += share;
        }
    }
    Ok(indicators)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::ErrorNorms;
    use crate::estimate::tests::{exact, mesh, problem, solve};
    use crate::mesh::Mesh;
    use crate::problem::{Case, ContactProblem};

    /// Rounding of a few operations on numbers of order one.
    const ROUNDING: f64 = 1e-13;

    /// Two right triangles over the diagonal of the unit square; `u1 = 1` at one corner, `u2 = 0`, loads 3 and 0, no action.
    #[test]
    fn two_triangles_by_hand() {
        let points = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let mesh = Mesh::new(points, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
        let problem = ContactProblem::builder().tension(2.0, 1.0).load(3.0, 0.0).build().unwrap();
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let displacement = [vec![0.0, 1.0, 0.0, 0.0], vec![0.0; 4]];
        let found = residual_indicators(&d, &displacement, &[0.0; 4]).unwrap();
        // h_K^2 = 2, |K| = 1/2; the jump of the slopes is (1, -1), the edge has the length sqrt 2.
        let expected = 2.0 / 2.0 * 0.5 * 9.0 + 0.5 * 2.0 * 2.0 * 2.0;
        assert!(found.iter().all(|indicator| (indicator - expected).abs() < ROUNDING), "{found:?}");
        let pushed = residual_indicators(&d, &displacement, &[1.0; 4]).unwrap();
        let expected = expected + 2.0 / 2.0 * 0.5 * (16.0 - 9.0) + 2.0 * 0.5;
        assert!(pushed.iter().all(|indicator| (indicator - expected).abs() < ROUNDING), "{pushed:?}");
    }

    #[test]
    fn it_is_of_the_order_of_the_error_on_every_mesh() {
        let exact = exact(Case::Circle, &[]);
        let problem = problem(&exact);
        let ratio = |cells: usize| {
            let mesh = mesh(&exact.domain(), cells);
            let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
            let solution = solve(&d);
            let indicators = residual_indicators(&d, solution.displacement(), solution.lambda());
            let estimate = indicators.unwrap().iter().sum::<f64>().sqrt();
            estimate / ErrorNorms::new(&d, &solution, &exact).unwrap().energy
        };
        let [coarse, fine] = [ratio(16), ratio(48)];
        assert!((coarse / fine - 1.0).abs() < 0.1, "{coarse}, {fine}");
        assert!(coarse > 2.0, "but it is no measure of it: {coarse}");
    }
}
