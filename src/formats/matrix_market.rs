//! MatrixMarket files of sparse matrices and of vectors.

use std::io::{self, Write};

use sprs::CsMat;

/// Writes a matrix in MatrixMarket coordinate form; of a symmetric one, given by its upper triangle, the lower triangle,
/// as that format wants it.
pub(crate) fn write_coordinates(
    matrix: &CsMat<f64>,
    is_symmetric: bool,
    out: &mut impl Write,
) -> io::Result<()> {
    let symmetry = if is_symmetric { "symmetric" } else { "general" };
    writeln!(out, "%%MatrixMarket matrix coordinate real {symmetry}")?;
    writeln!(out, "{} {} {}", matrix.rows(), matrix.cols(), matrix.nnz())?;
    for (value, (row, column)) in matrix.iter() {
        let (row, column) = if is_symmetric { (column, row) } else { (row, column) };
        writeln!(out, "{} {} {value:e}", row + 1, column + 1)?;
    }
    Ok(())
}

/// Writes a vector as a dense matrix of one column.
pub(crate) fn write_array(values: &[f64], out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "%%MatrixMarket matrix array real general")?;
    writeln!(out, "{} 1", values.len())?;
    values.iter().try_for_each(|value| writeln!(out, "{value:e}"))
}
