//! The solution as a VTK unstructured grid.

use std::io::{self, Write};

use super::vtk::{Cells, DataArray, Location, VTK_TRIANGLE, write_grid};
use crate::action::ContactSolution;
use crate::error::ErrorBound;
use crate::mesh::Mesh;

/// Writes `solution.vtu`: the mesh, with point data `u1`, `u2`, `gap`, `lambda` (zero on the boundary) and `contact` (0 or
/// 1, where an interior vertex has the gap zero), vertices in the order of the mesh, and cell data `error_indicator`, whose sum of squares is that of the
/// bound. Binary, compressed by zlib; ParaView, PyVista and meshio read it.
///
/// # Errors
/// When writing fails.
pub fn write_vtu(
    mesh: &Mesh,
    solution: &ContactSolution,
    bound: &ErrorBound,
    out: impl Write,
) -> io::Result<()> {
    let [u1, u2] = solution.displacement();
    let data = [
        DataArray::floats("u1", u1.iter().copied()),
        DataArray::floats("u2", u2.iter().copied()),
        DataArray::floats("gap", solution.gap()),
        DataArray::floats("lambda", solution.lambda().iter().copied()),
        DataArray::flags("contact", solution.contact().iter().copied()),
    ];
    let cells = Cells::new(VTK_TRIANGLE, mesh.triangles().iter().copied());
    let indicators =
        [DataArray::floats("error_indicator", bound.indicators.iter().map(|square| square.sqrt()))];
    write_grid(out, mesh.points(), &cells, &[(Location::Points, &data), (Location::Cells, &indicators)])
}
