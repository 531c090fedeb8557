//! The action on the dual mesh as a VTK unstructured grid of polygons.

use std::io::{self, Write};

use crate::action::PairSolution;
use crate::formats::vtk::{Cells, DataArray, Location, write_grid};
use crate::mesh::DualMesh;

/// Writes `dual.vtu`: the cells `D_a` of the dual mesh as polygons, with cell data `lambda` (the piecewise constant
/// `lambda_h` itself), `vertex` (the number of `a` in the mesh), `contact` (0 or 1) and `area` (`|D_a|`). The points are those of
/// the polygons. A cell may be concave: VTK measures such cells wrongly, so integrate with `area`. Binary, compressed by zlib; ParaView, PyVista
/// and meshio read it.
///
/// # Errors
/// When writing fails.
pub fn write_dual_vtu(dual: &DualMesh, solution: &PairSolution, out: impl Write) -> io::Result<()> {
    let cells = || (0..dual.vertices().len()).map(|k| dual.cell(k).iter().copied());
    let mut used = vec![false; dual.points().len()];
    cells().flatten().for_each(|point| used[point] = true);
    // Vertices of the mesh and what lies on its boundary belong to no polygon: readers would count them to its extent.
    let mut points = Vec::new();
    let number: Vec<usize> = used
        .iter()
        .zip(dual.points())
        .map(|(&used, &point)| {
            points.extend(used.then_some(point));
            points.len().saturating_sub(1)
        })
        .collect();
    let polygons = Cells::polygons(cells().map(|cell| cell.map(|point| number[point])));
    let (at, count) = (dual.vertices(), dual.vertices().len());
    let data = [
        DataArray::floats("lambda", count, |k| solution.lambda()[at[k]]),
        DataArray::integers("vertex", count, |k| at[k]),
        DataArray::flags("contact", count, |k| solution.contact()[at[k]]),
        DataArray::floats("area", count, |k| dual.area(k)),
    ];
    write_grid(out, &points, &polygons, &[(Location::Cells, &data)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::action::certify_pair;
    use crate::discretization::PairDiscretization;
    use crate::formats::vtk::samples::{floats, integers, read_array};
    use crate::mesh::{Mesh, SubTriangulation, VertexKind, samples};
    use crate::problem::ContactProblem;
    use crate::solver::{ActiveSet, ContactSolver, SolverOptions};

    /// Areas of cells are sums of a few rounded terms below 1, the total force of a few hundred.
    const ROUNDING: f64 = 1e-12;

    fn written(mesh: &Mesh) -> (PairSolution, String) {
        let problem =
            ContactProblem::builder().tension(1.0, 3.0).load(-15.0, 10.0).height(0.1).build().unwrap();
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let candidate = ActiveSet.solve_pair(&d, &SolverOptions::default()).unwrap();
        let solution = certify_pair(&d, candidate, 1e-8).unwrap();
        let dual = DualMesh::new(mesh, &SubTriangulation::new(mesh).unwrap());
        let mut file = Vec::new();
        write_dual_vtu(&dual, &solution, &mut file).unwrap();
        (solution, String::from_utf8(file).unwrap())
    }

    /// The areas of the polygons in the file, and the number of its points.
    fn areas(file: &str) -> (Vec<f64>, usize) {
        let array = |name: &str| read_array(file, name).expect("the array is there");
        let coordinates = floats(&array("Points"));
        let points: Vec<[f64; 2]> = coordinates.chunks_exact(3).map(|p| [p[0], p[1]]).collect();
        let corners = integers(&array("connectivity"));
        let mut start = 0;
        let area = |end: i64| {
            let cell = &corners[start..end as usize];
            start = end as usize;
            let cross = |k: usize| {
                let [p, q] = [cell[k], cell[(k + 1) % cell.len()]].map(|corner| points[corner as usize]);
                0.5 * (p[0] * q[1] - q[0] * p[1])
            };
            (0..cell.len()).map(cross).sum()
        };
        (integers(&array("offsets")).into_iter().map(area).collect(), points.len())
    }

    #[test]
    fn the_file_integrates_to_the_contact_area_and_the_total_force() {
        let mesh = samples::irregular(12);
        let (solution, file) = written(&mesh);
        let (areas, _) = areas(&file);
        let array = |name: &str| read_array(&file, name).expect("the array is there");
        let contact: Vec<f64> = array("contact").into_iter().map(f64::from).collect();
        let integral = |values: &[f64]| areas.iter().zip(values).map(|(area, v)| area * v).sum::<f64>();
        let lambda = floats(&array("lambda"));
        let written = floats(&array("area"));
        assert!(areas.iter().zip(&written).all(|(area, written)| (area - written).abs() < ROUNDING));
        assert!((integral(&contact) - solution.contact_area()).abs() < ROUNDING);
        assert!((integral(&lambda) - solution.total_force()).abs() < ROUNDING);
        let shifted: Vec<f64> = lambda[1..].to_vec();
        assert!((integral(&shifted) - solution.total_force()).abs() > ROUNDING, "each value has its cell");
        assert!(
            solution.contact_area() > 0.1 && solution.contact_area() < 0.9,
            "both kinds of cells are there"
        );
    }

    #[test]
    fn each_cell_names_its_vertex_and_no_point_is_left_over() {
        let mesh = samples::irregular(7);
        let (solution, file) = written(&mesh);
        let vertices = integers(&read_array(&file, "vertex").unwrap());
        let interior: Vec<i64> = (0..)
            .zip(mesh.kind())
            .filter(|(_, kind)| **kind == VertexKind::Interior)
            .map(|(a, _)| a)
            .collect();
        assert_eq!(vertices, interior);
        assert_ne!(vertices[0], 0, "vertex 0 lies on the boundary and has no cell");
        for (&a, lambda) in vertices.iter().zip(floats(&read_array(&file, "lambda").unwrap())) {
            assert_eq!(lambda, solution.lambda()[a as usize]);
        }
        // The barycentres, but in two corners where a triangle has no vertex inside; the midpoints of the edges, but of those
        // on the boundary and of two that cut off a corner.
        let barycentres = 2 * 7 * 7 - 2;
        let midpoints = (3 * 7 * 7 + 2 * 7) - (4 * 7 + 2);
        assert_eq!(areas(&file).1, barycentres + midpoints);
    }
}
