//! Loads element by element: their integrals against the hat functions, their means.

use super::load::element_loads;
use crate::mesh::Mesh;
use crate::problem::{EvaluationError, Function};

/// The means `f_h|_K` of `f` on the triangles (4.14), by the quadrature of [`load`](super::load()).
///
/// Shape: `triangles`. Unit: force per area. Linear time, in parallel.
///
/// # Errors
/// As [`load`](super::load()).
pub fn element_means(mesh: &Mesh, f: &Function) -> Result<Vec<f64>, EvaluationError> {
    // The hat functions of the three corners add up to one.
    let mean = |(k, integrals): (usize, [f64; 3])| integrals.iter().sum::<f64>() / mesh.triangle_area(k);
    Ok(element_loads(mesh, f)?.into_iter().enumerate().map(mean).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fem::load;
    use crate::mesh::samples::irregular;
    use crate::numeric::largest;

    /// Rounding of means and sums of loads of order one, and of abscissae of 16 digits.
    const ROUNDING: f64 = 1e-14;

    fn largest_difference(found: &[f64], expected: impl Fn(usize) -> f64) -> f64 {
        largest((0..found.len()).map(|k| (found[k] - expected(k)).abs()))
    }

    #[test]
    fn the_mean_of_a_linear_function_is_its_value_at_the_barycentre() {
        let mesh = irregular(5);
        let means = element_means(&mesh, &Function::from_fn(|x, y| 2.0 + x - 3.0 * y)).unwrap();
        let at_barycentre = |k: usize| {
            let [x, y] = [0, 1].map(|axis| mesh.corners(k).iter().map(|p| p[axis]).sum::<f64>() / 3.0);
            2.0 + x - 3.0 * y
        };
        assert_eq!(means.len(), mesh.triangles().len());
        assert!(largest_difference(&means, at_barycentre) < ROUNDING);
        let squares = element_means(&mesh, &Function::from_fn(|x, _| x * x)).unwrap();
        let square_of = |k: usize| (mesh.corners(k).iter().map(|p| p[0]).sum::<f64>() / 3.0).powi(2);
        assert!(largest_difference(&squares, square_of) > 1e4 * ROUNDING, "but not of others");
    }

    /// `int_K x phi_i` on the reference triangle is 1/24, 1/12, 1/24, and `int_K x` is 1/6.
    #[test]
    fn one_triangle_by_hand() {
        let mesh = Mesh::new(vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], vec![[0, 1, 2]]).unwrap();
        let x = Function::from_fn(|x, _| x);
        let integrals = element_loads(&mesh, &x).unwrap()[0];
        assert!(largest_difference(&integrals, |i| [1.0 / 24.0, 1.0 / 12.0, 1.0 / 24.0][i]) < ROUNDING);
        assert!(largest_difference(&element_means(&mesh, &x).unwrap(), |_| 1.0 / 3.0) < ROUNDING);
        assert!(largest_difference(&element_means(&mesh, &x).unwrap(), |_| 1.0 / 6.0) > ROUNDING);
    }

    #[test]
    fn integrals_add_up_to_the_load_vector() {
        // More triangles than one block.
        let mesh = irregular(30);
        let f = Function::from_fn(|x, y| (3.0 * x).sin() - y * y);
        let mut sums = vec![0.0; mesh.points().len()];
        for (corners, integrals) in mesh.triangles().iter().zip(element_loads(&mesh, &f).unwrap()) {
            corners.iter().zip(integrals).for_each(|(&a, integral)| sums[a] += integral);
        }
        let expected = load(&mesh, &f).unwrap();
        assert!(largest_difference(&sums, |a| expected[a]) < ROUNDING);
        assert!(largest_difference(&sums, |a| -expected[a]) > 1e4 * ROUNDING);
    }

    #[test]
    fn a_pole_is_named() {
        let f = Function::from_fn(|x, _| if x > 0.5 { f64::NAN } else { 1.0 });
        let error = element_means(&irregular(4), &f).unwrap_err();
        let EvaluationError::NotFinite { point, value } = error else { panic!("it does not fail") };
        assert!(value.is_nan() && point[0] > 0.5);
        assert!(element_means(&irregular(4), &Function::from_fn(|x, _| 1.0 / (2.0 - x))).is_ok());
    }
}
