//! The solution of a stack as a VTK unstructured grid.

use std::io::{self, Write};

use crate::action::StackSolution;
use crate::discretization::StackDiscretization;
use crate::estimate::ErrorBound;
use crate::formats::vtk::{Cells, DataArray, Location, write_grid};
use crate::mesh::Mesh;

/// Writes `solution.vtu` of a stack: the mesh, with point data `u1` ... `uN`, `ceiling` and `floor` where they are; for each
/// gap `gap`, `lambda`, `force` (the nodal forces), `line_density` and `contact`, with the number of the gap behind the name (`gap_1`) when
/// there are several. With a bound, cell data `error_indicator` as in [`write_vtu`](super::write_vtu); with `groups`, each curve of the mesh as point data `curve NAME` and each region as cell data
/// `region NAME` (0 or 1). Binary, compressed by zlib; ParaView, PyVista and meshio read it.
///
/// # Errors
/// When writing fails.
pub fn write_stack_vtu(
    d: &StackDiscretization,
    solution: &StackSolution,
    bound: Option<&ErrorBound>,
    groups: bool,
    out: impl Write,
) -> io::Result<()> {
    let mesh = d.mesh();
    let (vertices, triangles) = (mesh.points().len(), mesh.triangles());
    let displacements = (1..).zip(solution.displacement());
    let mut points: Vec<DataArray> =
        displacements.map(|(i, u)| DataArray::floats(format!("u{i}"), vertices, |a| u[a])).collect();
    for (name, obstacle) in ["ceiling", "floor"].into_iter().zip(d.obstacles()) {
        points.extend(obstacle.map(|heights| DataArray::floats(name, vertices, |a| heights[a])));
    }
    let several = solution.gaps().len() > 1;
    for gap in solution.gaps() {
        let named = |name: &str| if several { format!("{name}_{}", gap.number) } else { name.into() };
        points.push(DataArray::floats(named("gap"), vertices, |a| gap.gap[a]));
        points.push(DataArray::floats(named("lambda"), vertices, |a| gap.lambda[a]));
        points.push(DataArray::floats(named("force"), vertices, |a| gap.force[a]));
        points.push(DataArray::floats(named("line_density"), vertices, |a| gap.line_density[a]));
        points.push(DataArray::flags(named("contact"), vertices, |a| gap.contact[a]));
    }
    let mut cells = Vec::new();
    cells.extend(
        bound.map(|bound| {
            DataArray::floats("error_indicator", triangles.len(), |t| bound.indicators[t].sqrt())
        }),
    );
    if groups {
        points.extend(curves(mesh));
        cells.extend(regions(mesh));
    }
    write_grid(
        out,
        mesh.points(),
        &Cells::triangles(triangles),
        &[(Location::Points, &points), (Location::Cells, &cells)],
    )
}

/// Whether a vertex lies on each curve.
fn curves(mesh: &Mesh) -> impl Iterator<Item = DataArray<'_>> {
    let names = mesh.groups().curves().iter();
    names.map(|name| {
        let mut on_curve = vec![false; mesh.points().len()];
        let edges = mesh.groups().curve(name).into_iter().flatten();
        edges.flatten().for_each(|a| on_curve[a] = true);
        DataArray::flags(format!("curve {name}"), on_curve.len(), move |a| on_curve[a])
    })
}

/// Whether a triangle lies in each region.
fn regions(mesh: &Mesh) -> impl Iterator<Item = DataArray<'_>> {
    let names = mesh.groups().regions().iter();
    names.map(|name| {
        let mut in_region = vec![false; mesh.triangles().len()];
        mesh.groups().region(name).into_iter().flatten().for_each(|t| in_region[t] = true);
        DataArray::flags(format!("region {name}"), in_region.len(), move |t| in_region[t])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::action::certify_stack;
    use crate::formats::vtk::samples::{floats, read_array};
    use crate::mesh::{Pattern, rectangle};
    use crate::problem::{ContactProblem, Membrane};
    use crate::solver::{Auto, ContactSolver, SolverOptions};

    fn file(problem: &ContactProblem, groups: bool) -> (String, StackSolution) {
        let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [8; 2], Pattern::Right).unwrap();
        let mesh = mesh.with_region("left & half", |[x, _]| x < 0.5).unwrap();
        let d = StackDiscretization::new(problem, mesh).unwrap();
        let candidate = Auto.solve_stack(&d, &SolverOptions::default()).unwrap();
        let solution = certify_stack(&d, candidate, 1e-8).unwrap();
        let mut file = Vec::new();
        write_stack_vtu(&d, &solution, None, groups, &mut file).unwrap();
        (String::from_utf8(file).unwrap(), solution)
    }

    #[test]
    fn one_gap_has_the_names_of_the_pair_and_several_have_numbers() {
        let sheet = || Membrane::new(1.0).load(-20.0);
        let (one, solution) = file(&ContactProblem::obstacle(sheet(), -0.2).unwrap(), false);
        for (name, expected) in [("u1", &solution.displacement()[0]), ("lambda", &solution.gaps()[0].lambda)]
        {
            assert_eq!(&floats(&read_array(&one, name).unwrap()), expected);
        }
        assert_eq!(floats(&read_array(&one, "floor").unwrap()), vec![-0.2; 81]);
        let absent = ["u2", "gap_1", "ceiling", "curve left", "region left &amp; half"];
        assert!(absent.iter().all(|name| read_array(&one, name).is_none()));

        let two = ContactProblem::stack().membrane(sheet()).membrane(sheet().load(1.0)).floor(-0.2);
        let (two, solution) = file(&two.build().unwrap(), true);
        for gap in solution.gaps() {
            let read = |name: &str| read_array(&two, &format!("{name}_{}", gap.number)).unwrap();
            assert_eq!((floats(&read("gap")), floats(&read("force"))), (gap.gap.clone(), gap.force.clone()));
            let contact: Vec<bool> = read("contact").iter().map(|&flag| flag == 1).collect();
            assert_eq!(contact, gap.contact);
        }
        assert!(read_array(&two, "gap").is_none());
        let count = |name: &str| read_array(&two, name).unwrap().iter().filter(|&&flag| flag == 1).count();
        assert_eq!((count("curve left"), count("region left &amp; half")), (9, 64));
    }
}
