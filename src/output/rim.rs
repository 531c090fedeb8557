//! The rims of contact sets as VTK polylines.

use std::io::{self, Write};

use crate::action::Rim;
use crate::formats::vtk::{DataArray, write_lines};

/// Writes `rim.vtp`: the polylines of the [rims](Rim) of all gaps, with the number of the gap as cell data `gap`, counted as
/// [`GapSolution`](crate::action::GapSolution) does; the one of a pair is 1. Contact lies on the left of a line. A closed line ends
/// at the point where it begins. Without contact, or with contact everywhere, there is no line. Binary, compressed by zlib; ParaView
/// and PyVista read it.
///
/// # Errors
/// When writing fails.
pub fn write_rim_vtp<'r>(
    rims: impl IntoIterator<Item = (usize, &'r Rim)>,
    out: impl Write,
) -> io::Result<()> {
    let of_gap = |(gap, rim): (usize, &'r Rim)| rim.lines().iter().map(move |line| (gap, line.as_slice()));
    let (gaps, lines): (Vec<usize>, Vec<&[[f64; 2]]>) = rims.into_iter().flat_map(of_gap).unzip();
    write_lines(out, &lines, &[DataArray::integers("gap", gaps.len(), |k| gaps[k])])
}
