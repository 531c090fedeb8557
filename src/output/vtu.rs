//! The solution as a VTK unstructured grid.

use std::io::{self, Write};

use crate::action::PairSolution;
use crate::estimate::ErrorBound;
use crate::formats::vtk::{Cells, DataArray, Location, write_grid};
use crate::mesh::Mesh;

/// Writes `solution.vtu`: the mesh, with point data `u1`, `u2`, `gap`, `lambda` (zero on the boundary) and `contact` (0 or
/// 1, where an interior vertex has the gap zero), vertices in the order of the mesh, and cell data `error_indicator`, whose sum of squares is that of the
/// bound. Binary, compressed by zlib; ParaView, PyVista and meshio read it.
///
/// # Errors
/// When writing fails.
pub fn write_vtu(
    mesh: &Mesh,
    solution: &PairSolution,
    bound: &ErrorBound,
    out: impl Write,
) -> io::Result<()> {
    let ([u1, u2], vertices) = (solution.displacement(), mesh.points().len());
    let data = [
        DataArray::floats("u1", vertices, |a| u1[a]),
        DataArray::floats("u2", vertices, |a| u2[a]),
        DataArray::floats("gap", vertices, |a| u1[a] - u2[a]),
        DataArray::floats("lambda", vertices, |a| solution.lambda()[a]),
        DataArray::flags("contact", vertices, |a| solution.contact()[a]),
    ];
    let triangles = mesh.triangles();
    let indicators = [DataArray::floats("error_indicator", triangles.len(), |t| bound.indicators[t].sqrt())];
    write_grid(
        out,
        mesh.points(),
        &Cells::triangles(triangles),
        &[(Location::Points, &data), (Location::Cells, &indicators)],
    )
}

#[cfg(all(test, feature = "clarabel", feature = "pictures"))]
mod tests {
    use super::super::{Seconds, Summary};
    use super::*;
    use crate::action::{ContactSolution, certify_pair};
    use crate::discretization::Discretization;

    use crate::estimate::ErrorBounds;
    use crate::formats::vtk::samples::{floats, read_array};
    use crate::mesh::{Pattern, VertexKind, rectangle};
    use crate::pictures::membranes::Picture;
    use crate::problem::ContactProblem;
    use crate::qp::Clarabel;
    use crate::solver::{ActiveSet, Auto, ContactSolver, Multigrid, QpSolver, SolverOptions};

    fn solvers() -> Vec<Box<dyn ContactSolver>> {
        vec![
            Box::new(QpSolver::new(Clarabel)),
            #[cfg(feature = "osqp")]
            Box::new(QpSolver::new(crate::qp::Osqp)),
            Box::new(ActiveSet),
            Box::new(Multigrid),
            Box::new(Auto),
        ]
    }

    /// Contact is one set in every output: where the gap in the file is zero. There, and nowhere else, may the file have an action.
    #[test]
    fn the_files_the_summary_and_the_picture_have_one_contact_set() {
        let problem = ContactProblem::builder().load(-15.0, 10.0).height(0.2).build().unwrap();
        let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [48; 2], Pattern::Right).unwrap();
        let posed = Discretization::new(&problem, mesh.clone()).unwrap();
        let d = posed.as_pair().unwrap();
        for mut solver in solvers() {
            for polish in [true, false] {
                let options = SolverOptions { polish, ..SolverOptions::default() };
                let solution = certify_pair(d, solver.solve_pair(d, &options).unwrap(), 1e-8).unwrap();
                let bound = ErrorBounds::new(&problem, None, d).of_solution(&solution).unwrap();
                let of_pair = ContactSolution::Pair(solution.clone());
                let (seconds, known) = (Seconds::default(), Some(Ok(&bound)));
                let summary = Summary::new("", &posed, 1e-8, Ok(&of_pair), seconds, known);
                let mut file = Vec::new();
                write_vtu(&mesh, &solution, &bound, &mut file).unwrap();
                let file = String::from_utf8(file).unwrap();
                let array = |name: &str| read_array(&file, name).unwrap();
                let [u1, u2, gap, lambda] = ["u1", "u2", "gap", "lambda"].map(|name| floats(&array(name)));
                let flags: Vec<bool> = array("contact").iter().map(|&flag| flag == 1).collect();
                for (a, &touches) in flags.iter().enumerate() {
                    let inside = mesh.kind()[a] == VertexKind::Interior;
                    assert_eq!(gap[a], u1[a] - u2[a]);
                    assert_eq!(touches, inside && gap[a] == 0.0, "{} {a}", solver.name());
                    assert!(lambda[a] >= 0.0 && lambda[a] * gap[a] == 0.0, "{} {a}", solver.name());
                    assert_eq!(bound.actions[0][a], lambda[a], "there is a gap all around the boundary");
                }
                let count = |is: &dyn Fn(usize) -> bool| Some((0..flags.len()).filter(|&a| is(a)).count());
                assert_eq!(summary.contact_vertices, count(&|a| flags[a]));
                assert_eq!(summary.pressed_vertices, count(&|a| lambda[a] > 0.0));
                assert_eq!(Picture::of("", &mesh, &solution).contact, flags);
                let area: f64 = (0..flags.len()).filter(|&a| flags[a]).map(|a| d.dual_area()[a]).sum();
                assert!((summary.contact_area.unwrap() - area).abs() < 1e-12 && area > 0.1);
            }
        }
    }
}
