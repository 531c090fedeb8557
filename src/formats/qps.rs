//! Quadratic programs in QPS form.

use std::io::{self, Write};

use sprs::CsMat;

/// `minimise 1/2 x'P x + q'x + constant subject to A x >= b`, in parts: `P` by its upper triangle; matrices in compressed
/// columns.
pub(crate) struct Qps<'a> {
    pub(crate) p_upper: &'a CsMat<f64>,
    pub(crate) q: &'a [f64],
    pub(crate) a: &'a CsMat<f64>,
    pub(crate) b: &'a [f64],
    pub(crate) constant: f64,
}

impl Qps<'_> {
    /// Writes the program in free QPS form (Maros, Meszaros, Optim. Methods Softw. 11 (1999) 671): variables `x1`, `x2`, ... without
    /// bounds, rows `c1`, `c2`, ... of kind `G`, one triangle of `P` under `QUADOBJ`, the constant as the negative right-hand
    /// side of the objective.
    pub(crate) fn write(&self, name: &str, mut out: impl Write) -> io::Result<()> {
        let Self { p_upper, q, a, b, constant } = self;
        writeln!(out, "NAME {name}\nROWS\n N obj")?;
        (1..=b.len()).try_for_each(|row| writeln!(out, " G c{row}"))?;
        writeln!(out, "COLUMNS")?;
        for (column, (entries, q)) in a.outer_iterator().zip(*q).enumerate() {
            writeln!(out, " x{} obj {q:e}", column + 1)?;
            entries
                .iter()
                .try_for_each(|(row, value)| writeln!(out, " x{} c{} {value:e}", column + 1, row + 1))?;
        }
        writeln!(out, "RHS")?;
        if *constant != 0.0 {
            writeln!(out, " rhs obj {:e}", -constant)?;
        }
        for (row, b) in b.iter().enumerate().filter(|(_, b)| **b != 0.0) {
            writeln!(out, " rhs c{} {b:e}", row + 1)?;
        }
        writeln!(out, "BOUNDS")?;
        (1..=q.len()).try_for_each(|column| writeln!(out, " FR bnd x{column}"))?;
        writeln!(out, "QUADOBJ")?;
        for (value, (row, column)) in p_upper.iter() {
            writeln!(out, " x{} x{} {value:e}", row + 1, column + 1)?;
        }
        writeln!(out, "ENDATA")?;
        out.flush()
    }
}
