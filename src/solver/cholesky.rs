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

/// One thread: the fronts of plane problems are too small to gain from more, and results stay the same everywhere.
const PAR: Par = Par::Seq;

/// `A = L L'` of a matrix with fill-reducing ordering.
pub(crate) struct Cholesky<'a> {
    matrix: &'a CsMat<f64>,
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

/// The matrix is not positive definite to working precision, or memory is short.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NotFactored;

impl<'a> Cholesky<'a> {
    /// Factors `matrix`, symmetric with both triangles stored.
    pub(crate) fn new(matrix: &'a CsMat<f64>) -> Result<Self, NotFactored> {
        let a = symbolic_ref(matrix);
        let parameters = CholeskySymbolicParams::default();
        let symbolic = factorize_symbolic_cholesky(a, Side::Lower, SymmetricOrdering::Amd, parameters)
            .map_err(|_| NotFactored)?;
        let mut values = vec![0.0; symbolic.len_val()];
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(PAR, Default::default());
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| NotFactored)?;
        symbolic
            .factorize_numeric_llt(
                &mut values,
                SparseColMatRef::new(a, matrix.data()),
                Side::Lower,
                LltRegularization::default(),
                PAR,
                MemStack::new(&mut memory),
                Default::default(),
            )
            .map_err(|_| NotFactored)?;
        Ok(Self { matrix, symbolic, values })
    }

    /// `A^-1 b`, refined.
    pub(crate) fn solve(&self, b: &[f64]) -> Result<Vec<f64>, NotFactored> {
        let mut x = b.to_vec();
        self.solve_in_place(&mut x)?;
        for _ in 0..REFINEMENTS {
            let mut correction: Vec<f64> = self
                .matrix
                .outer_iterator()
                .zip(b)
                .map(|(row, b)| b - row.iter().map(|(column, value)| value * x[column]).sum::<f64>())
                .collect();
            self.solve_in_place(&mut correction)?;
            for (x, correction) in x.iter_mut().zip(&correction) {
                *x += correction;
            }
        }
        Ok(x)
    }

    fn solve_in_place(&self, x: &mut [f64]) -> Result<(), NotFactored> {
        let rows = x.len();
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(1, PAR);
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| NotFactored)?;
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
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
