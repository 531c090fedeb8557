//! The optimality conditions, recomputed.

use super::QpProblem;
use crate::numeric::largest;

/// How far a pair `(x, y)` is from optimal: componentwise maxima, in units of the problem's scales (`P x + q` and `y` of
/// [`dual_scale`](QpProblem::dual_scale), `A x` of [`primal_scale`](QpProblem::primal_scale)).
///
/// A NaN anywhere makes the residuals that it enters infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KktResiduals {
    /// `max |P x + q - A'y|`.
    pub stationarity: f64,
    /// `max (b - A x)^+`.
    pub primal: f64,
    /// `max (-y)^+`: a multiplier of the wrong sign.
    pub dual_sign: f64,
    /// `max |y_k (A x - b)_k|`.
    pub complementarity: f64,
}

impl KktResiduals {
    /// Recomputes the residuals of `(x, y)` from the data of `qp`.
    ///
    /// # Panics
    /// When `x` or `y` has the wrong length.
    pub fn new(qp: &QpProblem, x: &[f64], y: &[f64]) -> Self {
        assert!(x.len() == qp.q().len() && y.len() == qp.b().len(), "x or y of the wrong length");
        let (primal, dual) = (qp.primal_scale(), qp.dual_scale());
        let px = qp.p_times(x);
        let aty = qp.a_transposed_times(y);
        let slack: Vec<f64> = qp.a_times(x).iter().zip(qp.b()).map(|(ax, b)| ax - b).collect();
        let imbalance = px.iter().zip(qp.q()).zip(&aty).map(|((px, q), aty)| (px + q - aty).abs());
        Self {
            stationarity: largest(imbalance) / dual,
            primal: largest(slack.iter().map(|s| -s)) / primal,
            dual_sign: largest(y.iter().map(|y| -y)) / dual,
            complementarity: largest(y.iter().zip(&slack).map(|(y, s)| (y / dual * (s / primal)).abs())),
        }
    }

    /// The largest of the four.
    pub fn worst(&self) -> f64 {
        largest([self.stationarity, self.primal, self.dual_sign, self.complementarity])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprs::TriMat;

    /// `min 1/2 x^2 - 2 x` subject to `-x >= -1`: optimal at `x = 1` with `y = 1`.
    fn one_variable() -> QpProblem {
        let entry = |value: f64| {
            let mut triplets = TriMat::new((1, 1));
            triplets.add_triplet(0, 0, value);
            triplets.to_csc()
        };
        QpProblem::new(entry(1.0), vec![-2.0], entry(-1.0), vec![-1.0]).unwrap()
    }

    #[test]
    fn the_optimum_has_no_residual_and_each_fault_has_its_own() {
        let qp = one_variable();
        assert_eq!(KktResiduals::new(&qp, &[1.0], &[1.0]).worst(), 0.0);

        let flipped = KktResiduals::new(&qp, &[3.0], &[-1.0]);
        assert_eq!((flipped.stationarity, flipped.primal, flipped.dual_sign), (0.0, 2.0, 1.0));
        let slack = KktResiduals::new(&qp, &[0.0], &[2.0]);
        assert_eq!((slack.stationarity, slack.complementarity), (0.0, 2.0));
        assert_eq!(KktResiduals::new(&qp, &[0.5], &[1.0]).stationarity, 0.5);
    }

    #[test]
    fn nan_never_passes() {
        let qp = one_variable();
        assert_eq!(KktResiduals::new(&qp, &[f64::NAN], &[1.0]).stationarity, f64::INFINITY);
        assert_eq!(KktResiduals::new(&qp, &[1.0], &[f64::NAN]).dual_sign, f64::INFINITY);
    }

    #[test]
    fn residuals_do_not_depend_on_the_units() {
        let qp = one_variable().with_scales(4.0, 0.5).unwrap();
        let (x, y) = ([0.75], [0.25]);
        let scaled = KktResiduals::new(&qp.nondimensional(), &[x[0] / 4.0], &[y[0] / 0.5]);
        assert_eq!(KktResiduals::new(&qp, &x, &y), scaled);
    }
}
