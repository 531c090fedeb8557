//! The quadratic program, valid by construction.

use sprs::CsMat;
use thiserror::Error;

use crate::text::grouped;

/// `minimise 1/2 x'P x + q'x + c subject to A x >= b`, with `P` symmetric positive semidefinite.
///
/// Shapes: `P` is `variables x variables`, of which the upper triangle is stored; `A` is `constraints x variables`; both
/// in compressed columns.
#[derive(Debug, Clone)]
pub struct QpProblem {
    p_upper: CsMat<f64>,
    q: Vec<f64>,
    a: CsMat<f64>,
    b: Vec<f64>,
    constant: f64,
    primal_scale: f64,
    dual_scale: f64,
}

impl QpProblem {
    /// Checks the data. `p_upper` is the upper triangle of `P` with its diagonal.
    ///
    /// Backends accept a lower triangle, rows out of range, or NaN in silence and return a wrong answer as solved, so
    /// all of that is refused here. Convexity is not checked: it costs a factorisation, which the backends make.
    ///
    /// # Errors
    /// [`QpError`] for shapes that do not fit, matrices not in compressed columns, entries below the diagonal of
    /// `p_upper`, a negative diagonal, and numbers that are not finite.
    pub fn new(p_upper: CsMat<f64>, q: Vec<f64>, a: CsMat<f64>, b: Vec<f64>) -> Result<Self, QpError> {
        let (variables, constraints) = (q.len(), b.len());
        check_shape("P", p_upper.shape(), (variables, variables))?;
        check_shape("A", a.shape(), (constraints, variables))?;
        for (name, matrix) in [("P", &p_upper), ("A", &a)] {
            if !matrix.is_csc() {
                return Err(QpError::Storage { name });
            }
            check_finite(name, matrix.data())?;
        }
        for (name, vector) in [("q", &q), ("b", &b)] {
            check_finite(name, vector)?;
        }
        for (column, entries) in p_upper.outer_iterator().enumerate() {
            for (row, &value) in entries.iter() {
                if row > column {
                    return Err(QpError::LowerTriangle { row, column });
                }
                if row == column && value < 0.0 {
                    return Err(QpError::NotConvex { row });
                }
            }
        }
        Ok(Self { p_upper, q, a, b, constant: 0.0, primal_scale: 1.0, dual_scale: 1.0 })
    }

    /// States the typical sizes of `x` and of `P x + q`: residuals are measured against them, and backends get the
    /// problem in units in which both are 1.
    ///
    /// # Errors
    /// [`QpError::Scale`] when one is not positive and finite.
    pub fn with_scales(mut self, primal: f64, dual: f64) -> Result<Self, QpError> {
        for scale in [primal, dual] {
            if !(scale > 0.0 && scale.is_finite()) {
                return Err(QpError::Scale { scale });
            }
        }
        (self.primal_scale, self.dual_scale) = (primal, dual);
        Ok(self)
    }

    /// States the constant `c` of the objective, zero without this: it changes the optimum's value and nothing else.
    ///
    /// # Errors
    /// [`QpError::NotFinite`].
    pub fn with_constant(mut self, constant: f64) -> Result<Self, QpError> {
        check_finite("the constant", &[constant])?;
        self.constant = constant;
        Ok(self)
    }

    /// The upper triangle of `P`, compressed columns.
    pub fn p_upper(&self) -> &CsMat<f64> {
        &self.p_upper
    }

    /// The linear term. Shape: `variables`.
    pub fn q(&self) -> &[f64] {
        &self.q
    }

    /// The constraint matrix, compressed columns.
    pub fn a(&self) -> &CsMat<f64> {
        &self.a
    }

    /// The lower bounds. Shape: `constraints`.
    pub fn b(&self) -> &[f64] {
        &self.b
    }

    /// The constant of the objective.
    pub fn constant(&self) -> f64 {
        self.constant
    }

    /// The typical size of `x`.
    pub fn primal_scale(&self) -> f64 {
        self.primal_scale
    }

    /// The typical size of `P x + q` and of `A'y`.
    pub fn dual_scale(&self) -> f64 {
        self.dual_scale
    }

    /// The same problem in units in which `x` and `P x + q` have size 1: with `x = primal_scale z`, `y = dual_scale v`,
    /// `(z, v)` is optimal for it.
    pub fn nondimensional(&self) -> Self {
        let (primal, dual) = (self.primal_scale, self.dual_scale);
        Self {
            p_upper: self.p_upper.map(|value| value * (primal / dual)),
            q: self.q.iter().map(|q| q / dual).collect(),
            a: self.a.clone(),
            b: self.b.iter().map(|b| b / primal).collect(),
            constant: self.constant / primal / dual,
            primal_scale: 1.0,
            dual_scale: 1.0,
        }
    }

    /// `P x`.
    ///
    /// # Panics
    /// When `x` has not one entry for each variable.
    pub fn p_times(&self, x: &[f64]) -> Vec<f64> {
        assert_eq!(x.len(), self.q.len(), "one entry for each variable");
        let mut product = vec![0.0; x.len()];
        for (column, entries) in self.p_upper.outer_iterator().enumerate() {
            for (row, &value) in entries.iter() {
                product[row] += value * x[column];
                if row != column {
                    product[column] += value * x[row];
                }
            }
        }
        product
    }

    /// `A x`.
    ///
    /// # Panics
    /// When `x` has not one entry for each variable.
    pub fn a_times(&self, x: &[f64]) -> Vec<f64> {
        assert_eq!(x.len(), self.q.len(), "one entry for each variable");
        let mut product = vec![0.0; self.b.len()];
        for (entries, x) in self.a.outer_iterator().zip(x) {
            for (row, value) in entries.iter() {
                product[row] += value * x;
            }
        }
        product
    }

    /// `A'y`.
    ///
    /// # Panics
    /// When `y` has not one entry for each constraint.
    pub fn a_transposed_times(&self, y: &[f64]) -> Vec<f64> {
        assert_eq!(y.len(), self.b.len(), "one entry for each constraint");
        self.a
            .outer_iterator()
            .map(|entries| entries.iter().map(|(row, value)| value * y[row]).sum())
            .collect()
    }

    /// `1/2 x'P x + q'x + c`.
    ///
    /// # Panics
    /// When `x` has not one entry for each variable.
    pub fn objective(&self, x: &[f64]) -> f64 {
        let px = self.p_times(x);
        let sum: f64 = px.iter().zip(&self.q).zip(x).map(|((px, q), x)| (0.5 * px + q) * x).sum();
        sum + self.constant
    }
}

fn check_shape(name: &'static str, found: (usize, usize), expected: (usize, usize)) -> Result<(), QpError> {
    if found == expected { Ok(()) } else { Err(QpError::Shape { name, found, expected }) }
}

fn check_finite(name: &'static str, values: &[f64]) -> Result<(), QpError> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(QpError::NotFinite { name, index, value: values[index] }),
        None => Ok(()),
    }
}

/// Why data do not make a quadratic program.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum QpError {
    /// A matrix of the wrong shape.
    #[error(
        "{name} is {} x {}, but q and b ask for {} x {}",
        grouped(found.0), grouped(found.1), grouped(expected.0), grouped(expected.1)
    )]
    Shape {
        /// Which.
        name: &'static str,
        /// Its shape.
        found: (usize, usize),
        /// The shape that fits.
        expected: (usize, usize),
    },
    /// A matrix in compressed rows.
    #[error("{name} is stored in compressed rows: give it in compressed columns")]
    Storage {
        /// Which.
        name: &'static str,
    },
    /// An entry below the diagonal.
    #[error("P has an entry below the diagonal, at ({row}, {column}): give the upper triangle only")]
    LowerTriangle {
        /// Its row.
        row: usize,
        /// Its column.
        column: usize,
    },
    /// A negative diagonal entry.
    #[error("P has a negative diagonal entry in row {row}: the problem is not convex")]
    NotConvex {
        /// The row.
        row: usize,
    },
    /// NaN or an infinity.
    #[error("{name} holds {value} (entry {index}): all numbers must be finite")]
    NotFinite {
        /// Where.
        name: &'static str,
        /// The entry.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A scale out of range.
    #[error("the scale {scale} is not positive and finite")]
    Scale {
        /// The value given.
        scale: f64,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprs::TriMat;

    fn matrix(shape: (usize, usize), entries: &[(usize, usize, f64)]) -> CsMat<f64> {
        let mut triplets = TriMat::new(shape);
        for &(row, column, value) in entries {
            triplets.add_triplet(row, column, value);
        }
        triplets.to_csc()
    }

    #[test]
    fn valid_data_pass_and_each_fault_is_named() {
        let p = || matrix((2, 2), &[(0, 0, 2.0), (0, 1, 1.0), (1, 1, 2.0)]);
        let a = || matrix((1, 2), &[(0, 0, 1.0), (0, 1, -1.0)]);
        let (q, b) = (vec![1.0, 2.0], vec![0.0]);
        assert!(QpProblem::new(p(), q.clone(), a(), b.clone()).is_ok());

        let lower = matrix((2, 2), &[(0, 0, 2.0), (1, 0, 1.0), (1, 1, 2.0)]);
        let negative = matrix((2, 2), &[(0, 0, -2.0), (1, 1, 2.0)]);
        let not_finite = matrix((2, 2), &[(0, 0, f64::NAN)]);
        let refused = [
            (QpProblem::new(lower, q.clone(), a(), b.clone()), "below the diagonal"),
            (QpProblem::new(negative, q.clone(), a(), b.clone()), "not convex"),
            (QpProblem::new(not_finite, q.clone(), a(), b.clone()), "P holds NaN"),
            (QpProblem::new(p().to_csr(), q.clone(), a(), b.clone()), "compressed rows"),
            (QpProblem::new(p(), vec![1.0], a(), b.clone()), "P is 2 x 2"),
            (QpProblem::new(p(), q.clone(), a(), vec![]), "A is 1 x 2"),
            (QpProblem::new(p(), q.clone(), a(), vec![f64::INFINITY]), "b holds inf"),
            (QpProblem::new(p(), q.clone(), a(), b.clone()).unwrap().with_scales(0.0, 1.0), "scale"),
            (QpProblem::new(p(), q, a(), b).unwrap().with_constant(f64::NAN), "the constant holds NaN"),
        ];
        for (result, word) in refused {
            let message = result.expect_err(word).to_string();
            assert!(message.contains(word), "{message}");
        }
    }

    #[test]
    fn products_use_both_triangles() {
        let p = matrix((2, 2), &[(0, 0, 2.0), (0, 1, 1.0), (1, 1, 4.0)]);
        let a = matrix((1, 2), &[(0, 0, 1.0), (0, 1, -3.0)]);
        let qp = QpProblem::new(p, vec![1.0, -1.0], a, vec![0.0]).unwrap();
        let x = [1.0, 2.0];
        assert_eq!(qp.p_times(&x), [4.0, 9.0]);
        assert_eq!(qp.a_times(&x), [-5.0]);
        assert_eq!(qp.a_transposed_times(&[2.0]), [2.0, -6.0]);
        assert_eq!(qp.objective(&x), 0.5 * (4.0 + 18.0) + 1.0 - 2.0);
        let raised = qp.with_constant(0.5).unwrap().with_scales(2.0, 4.0).unwrap();
        assert_eq!(raised.objective(&x), 0.5 * (4.0 + 18.0) + 1.0 - 2.0 + 0.5);
        assert_eq!(8.0 * raised.nondimensional().objective(&[0.5, 1.0]), raised.objective(&x));
    }

    #[test]
    fn vectors_of_another_length_are_refused() {
        let p = matrix((2, 2), &[(0, 0, 2.0), (1, 1, 4.0)]);
        let a = matrix((1, 2), &[(0, 0, 1.0), (0, 1, -3.0)]);
        let qp = QpProblem::new(p, vec![1.0, -1.0], a, vec![0.0]).unwrap();
        let products: [fn(&QpProblem, &[f64]); 4] = [
            |qp, x| drop(qp.a_times(x)),
            |qp, x| drop(qp.p_times(x)),
            |qp, x| assert!(qp.objective(x).is_finite()),
            |qp, x| drop(qp.a_transposed_times(&x[1..])),
        ];
        for product in products {
            let is_refused = |length: usize| {
                std::panic::catch_unwind(|| product(&qp, &[1.0, 2.0, 3.0][..length])).is_err()
            };
            assert_eq!([1, 2, 3].map(is_refused), [true, false, true]);
        }
    }
}
