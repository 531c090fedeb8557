//! The reconstructed fluxes on the sub-triangulation `S_h` as a VTK unstructured grid.

use std::io::{self, Write};

use crate::action::PairSolution;
use crate::flux::Flux;
use crate::formats::vtk::{Cells, DataArray, Location, write_grid};
use crate::mesh::SubTriangulation;

/// Writes `flux.vtu`: the triangles of `S_h` with cell data `t1`, `t2` (the fluxes of both membranes at the barycentres,
/// which are their means), `div_t1`, `div_t2`, and `lambda` (that of the dual cell). Binary, compressed by zlib; ParaView,
/// PyVista and meshio read it.
///
/// # Errors
/// When writing fails.
pub fn write_flux_vtu(
    sub: &SubTriangulation,
    [t1, t2]: &[Flux; 2],
    solution: &PairSolution,
    out: impl Write,
) -> io::Result<()> {
    let mesh = sub.mesh();
    let (t1, t2) = (t1.cells(), t2.cells());
    let (triangles, count) = (mesh.triangles(), mesh.triangles().len());
    let data = [
        DataArray::vectors("t1", count, |t| t1.value[t]),
        DataArray::vectors("t2", count, |t| t2.value[t]),
        DataArray::floats("div_t1", count, |t| t1.divergence[t]),
        DataArray::floats("div_t2", count, |t| t2.divergence[t]),
        DataArray::floats("lambda", count, |t| solution.lambda()[sub.vertex_of(t)]),
    ];
    write_grid(out, mesh.points(), &Cells::triangles(triangles), &[(Location::Cells, &data)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::action::certify_pair;
    use crate::discretization::PairDiscretization;
    use crate::fem::element_loads;
    use crate::flux::{Reconstruction, Reconstructor};
    use crate::formats::vtk::samples::{floats, read_array};
    use crate::mesh::{Pattern, rectangle};
    use crate::problem::ContactProblem;
    use crate::solver::{ActiveSet, ContactSolver, SolverOptions};

    /// Fluxes of size 1 on triangles of size 1/50: rounding over their area.
    const ROUNDING: f64 = 1e-10;

    #[test]
    fn the_file_holds_the_equilibrium_of_the_full_reconstruction() {
        let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [8, 8], Pattern::Right).unwrap();
        let problem =
            ContactProblem::builder().tension(1.0, 3.0).load(-15.0, 10.0).height(0.1).build().unwrap();
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let candidate = ActiveSet.solve_pair(&d, &SolverOptions::default()).unwrap();
        let solution = certify_pair(&d, candidate, 1e-8).unwrap();
        let sub = SubTriangulation::new(&mesh).unwrap();
        let loads =
            [0, 1].map(|i| element_loads(&mesh, &problem.as_pair().expect("a pair").load()[i]).unwrap());
        let fluxes =
            Reconstructor::new(&d, &sub, loads).reconstruct(solution.displacement(), Reconstruction::Full);
        let mut file = Vec::new();
        write_flux_vtu(&sub, &fluxes, &solution, &mut file).unwrap();

        let file = String::from_utf8(file).unwrap();
        let array = |name: &str| floats(&read_array(&file, name).expect("the array is there"));
        let (lambda, div_t1, div_t2) = (array("lambda"), array("div_t1"), array("div_t2"));
        assert_eq!((lambda.len(), array("t1").len()), (6 * 128, 3 * 6 * 128));
        assert!(lambda.iter().any(|&lambda| lambda > 1.0), "there is contact");
        let interior = (0..lambda.len()).filter(|&t| d.interior().binary_search(&sub.vertex_of(t)).is_ok());
        for t in interior {
            assert!((div_t1[t] - (-15.0 + lambda[t])).abs() < ROUNDING, "div t_1 = f_1 + lambda");
            assert!((div_t2[t] - (10.0 - lambda[t])).abs() < ROUNDING, "div t_2 = f_2 - lambda");
        }
        assert_ne!(array("t1"), array("t2"));
    }
}
