//! The unit of work: one product of the stiffness matrix with a vector.

use std::hint::black_box;

use web_time::Instant;

use crate::fem::StiffnessMatrix;

/// The least number of samples, of which the fastest counts.
const SAMPLES: usize = 10;

/// The least seconds of a sample: many ticks of any clock.
const SHORTEST_SAMPLE: f64 = 2e-5;

/// The least seconds of all samples: longer than a machine that has other work to do is usually away.
const SHORTEST: f64 = 0.02;

/// A sparse matrix as other libraries store it, for a fair unit of work: rows compressed, 64-bit values, 32-bit column
/// indices, and a product on one thread.
#[derive(Debug, Clone)]
pub struct CsrProduct {
    row_starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
    size: usize,
}

impl CsrProduct {
    /// A copy of a symmetric matrix `K` with compressed rows.
    pub fn new(matrix: &StiffnessMatrix) -> Self {
        Self {
            row_starts: matrix.indptr().raw_storage().to_vec(),
            columns: matrix.indices().to_vec(),
            values: matrix.data().to_vec(),
            size: matrix.cols(),
        }
    }

    /// The number of columns.
    pub fn size(&self) -> usize {
        self.size
    }

    /// `y = K x`.
    ///
    /// # Panics
    /// When `x` is shorter than the matrix is wide.
    pub fn apply(&self, x: &[f64], y: &mut [f64]) {
        for (y, ends) in y.iter_mut().zip(self.row_starts.windows(2)) {
            let row = ends[0] as usize..ends[1] as usize;
            let entries = self.columns[row.clone()].iter().zip(&self.values[row]);
            *y = entries.map(|(&column, value)| value * x[column as usize]).sum();
        }
    }

    /// The seconds of one product: the least of several samples.
    pub fn seconds(&self) -> f64 {
        let x: Vec<f64> = (0..self.size).map(|k| 1.0 + (k % 7) as f64).collect();
        let mut y = vec![0.0; self.size];
        let mut sample = |products: usize| {
            let start = Instant::now();
            for _ in 0..products {
                self.apply(black_box(&x), black_box(&mut y));
            }
            start.elapsed().as_secs_f64() / products as f64
        };
        // The first one also brings the matrix into the cache.
        sample(1);
        let products = (SHORTEST_SAMPLE / sample(1).max(f64::MIN_POSITIVE)).clamp(1.0, 1000.0) as usize;
        let start = Instant::now();
        let mut least = f64::INFINITY;
        let mut samples = 0;
        while samples < SAMPLES || start.elapsed().as_secs_f64() < SHORTEST {
            least = least.min(sample(products));
            samples += 1;
        }
        // A product of nothing could take no time at all.
        least.max(f64::EPSILON)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_product_is_that_of_the_matrix() {
        let matrix =
            StiffnessMatrix::new((3, 3), vec![0, 2, 2, 4], vec![0, 2, 0, 1], vec![1.0, 2.0, 3.0, 4.0]);
        let product = CsrProduct::new(&matrix);
        let mut y = vec![f64::NAN; 3];
        product.apply(&[1.0, 10.0, 100.0], &mut y);
        assert_eq!(y, [201.0, 0.0, 43.0]);
        assert_eq!(product.size(), 3);
        assert!(product.seconds() > 0.0);
    }
}
