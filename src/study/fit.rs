//! Powers, fitted.

/// The exponent `p` of `y = c x^p` through points `[x, y]`: the slope of the line through their logarithms by least
/// squares; `None` with fewer than two different `x`, or when a logarithm does not exist.
pub fn exponent(points: impl IntoIterator<Item = [f64; 2]>) -> Option<f64> {
    let points: Vec<[f64; 2]> = points.into_iter().map(|point| point.map(f64::ln)).collect();
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
    let [mean_x, mean_y] = [mean(0), mean(1)];
    let covariance: f64 = points.iter().map(|[x, y]| (x - mean_x) * (y - mean_y)).sum();
    let variance: f64 = points.iter().map(|[x, _]| (x - mean_x).powi(2)).sum();
    let exponent = covariance / variance;
    exponent.is_finite().then_some(exponent)
}
