//! Sparse Cholesky factorisation of a symmetric positive definite matrix, by faer.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use sprs::CsMat;

/// Steps of iterative refinement after a solve: one brings the residual down to rounding.
const REFINEMENTS: usize = 1;

/// A solve whose residual is above this fraction of the terms that cancel in it has gone wrong: a factor of faer's is not
/// trusted unseen. Rounding leaves 1e-15 or so.
const SOLVED: f64 = 1e-9;

/// One thread: the fronts of plane problems are too small to gain from more, and results stay the same everywhere.
const PAR: Par = Par::Seq;

/// `A = L L'` of a matrix with fill-reducing ordering. The symbolic factorisation is made once for a pattern.
pub(crate) struct Cholesky {
    matrix: CsMat<f64>,
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
}

/// The matrix is not positive definite to working precision, or memory is short, or the factor proved to be wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NotFactored;

impl Cholesky {
    /// Factors `matrix`, symmetric with both triangles stored.
    pub(crate) fn new(matrix: CsMat<f64>) -> Result<Self, NotFactored> {
        let mut cholesky = Self::symbolic(matrix)?;
        cholesky.factor()?;
        Ok(cholesky)
    }

    /// Prepares the factorisation of matrices with the pattern of `matrix`: call [`refactor`](Self::refactor) next.
    pub(crate) fn symbolic(matrix: CsMat<f64>) -> Result<Self, NotFactored> {
        let parameters = CholeskySymbolicParams::default();
        let pattern = symbolic_ref(&matrix);
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, SymmetricOrdering::Amd, parameters)
            .map_err(|_| NotFactored)?;
        Ok(Self { matrix, symbolic, factor: Vec::new() })
    }

    /// Factors a matrix of the same pattern, with these values in the order of compressed rows.
    pub(crate) fn refactor(&mut self, values: impl IntoIterator<Item = f64>) -> Result<(), NotFactored> {
        for (value, new) in self.matrix.data_mut().iter_mut().zip(values) {
            *value = new;
        }
        self.factor()
    }

    fn factor(&mut self) -> Result<(), NotFactored> {
        self.factor.resize(self.symbolic.len_val(), 0.0);
        let scratch = self.symbolic.factorize_numeric_llt_scratch::<f64>(PAR, Default::default());
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| NotFactored)?;
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                SparseColMatRef::new(symbolic_ref(&self.matrix), self.matrix.data()),
                Side::Lower,
                LltRegularization::default(),
                PAR,
                MemStack::new(&mut memory),
                Default::default(),
            )
            .map_err(|_| NotFactored)?;
        Ok(())
    }

    /// `A^-1 b`, refined, its residual checked.
    pub(crate) fn solve(&self, b: &[f64]) -> Result<Vec<f64>, NotFactored> {
        let mut x = b.to_vec();
        self.solve_in_place(&mut x)?;
        for _ in 0..REFINEMENTS {
            let mut correction = self.residual(b, &x);
            self.solve_in_place(&mut correction)?;
            for (x, correction) in x.iter_mut().zip(&correction) {
                *x += correction;
            }
        }
        let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let terms = largest(self.matrix.data()) * largest(&x) + largest(b);
        let residual = self.residual(b, &x);
        if residual.iter().all(|r| r.abs() <= SOLVED * terms) { Ok(x) } else { Err(NotFactored) }
    }

    fn residual(&self, b: &[f64], x: &[f64]) -> Vec<f64> {
        let rows = self.matrix.outer_iterator().zip(b);
        rows.map(|(row, b)| b - row.iter().map(|(column, value)| value * x[column]).sum::<f64>()).collect()
    }

    fn solve_in_place(&self, x: &mut [f64]) -> Result<(), NotFactored> {
        let rows = x.len();
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(1, PAR);
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| NotFactored)?;
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, rows, 1),
            PAR,
            MemStack::new(&mut memory),
        );
        Ok(())
    }
}

/// The pattern of a symmetric matrix: its compressed rows are its compressed columns.
fn symbolic_ref(matrix: &CsMat<f64>) -> SymbolicSparseColMatRef<'_, usize> {
    let (rows, columns) = matrix.shape();
    SymbolicSparseColMatRef::new_checked(
        rows,
        columns,
        matrix.indptr().into_raw_storage(),
        None,
        matrix.indices(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprs::TriMat;

    /// Rounding of a small well conditioned system.
    const ROUNDING: f64 = 1e-14;

    fn matrix(diagonal: f64) -> CsMat<f64> {
        let mut triplets = TriMat::new((3, 3));
        for i in 0..3 {
            triplets.add_triplet(i, i, diagonal);
        }
        triplets.add_triplet(0, 1, -1.0);
        triplets.add_triplet(1, 0, -1.0);
        triplets.to_csr()
    }

    #[test]
    fn factors_are_made_anew_for_other_values() {
        let mut cholesky = Cholesky::new(matrix(2.0)).unwrap();
        let x = cholesky.solve(&[1.0, 1.0, 4.0]).unwrap();
        assert!(x.iter().zip([1.0, 1.0, 2.0]).all(|(x, expected)| (x - expected).abs() < ROUNDING));
        cholesky.refactor(matrix(4.0).data().iter().copied()).unwrap();
        let x = cholesky.solve(&[3.0, 3.0, 4.0]).unwrap();
        assert!(x.iter().all(|x| (x - 1.0).abs() < ROUNDING));
    }

    #[test]
    fn what_is_not_positive_definite_or_not_finite_is_refused() {
        assert!(Cholesky::new(matrix(0.5)).is_err());
        assert!(Cholesky::new(matrix(2.0)).unwrap().solve(&[f64::NAN, 0.0, 0.0]).is_err());
    }

    #[test]
    fn a_wrong_factor_is_seen_by_the_residual() {
        let mut cholesky = Cholesky::new(matrix(2.0)).unwrap();
        cholesky.factor.iter_mut().for_each(|value| *value *= 3.0);
        assert_eq!(cholesky.solve(&[1.0, 1.0, 4.0]), Err(NotFactored));
    }
}
