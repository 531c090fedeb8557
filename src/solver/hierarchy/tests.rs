use super::*;
use crate::fem::stiffness;
use crate::mesh::samples::irregular;
use crate::mesh::{Mesh, MeshSize, Pattern, generate, rectangle};
use crate::problem::{ContactProblem, Domain};

/// Rounding of matrix entries and weights of size one.
const ROUNDING: f64 = 1e-12;

fn unit_square(size: f64) -> Mesh {
    let domain = Domain::Rectangle { lower: [0.0, 0.0], upper: [1.0, 1.0] };
    generate(&domain, MeshSize::EdgeLength { size, min_angle: 25.0 }).unwrap()
}

fn hierarchy_of(mesh: &Mesh) -> Hierarchy {
    let problem = ContactProblem::builder().tension(1.0, 1.0).load(1.0, 1.0).height(0.0).build().unwrap();
    Hierarchy::new(&Discretization::new(&problem, mesh).unwrap())
}

/// Every entry of the level's matrix, rows and columns by vertices of the mesh that it belongs to.
fn largest_difference(level: &Level, mesh: &Mesh, vertex: impl Fn(usize) -> usize) -> f64 {
    let k = stiffness(mesh);
    let entry = |a: usize, b: usize| k.get(a, b).copied().unwrap_or(0.0);
    let mut largest: f64 = 0.0;
    for i in (0..level.pattern.rows()).filter(|&i| !level.is_held(i)) {
        let a = vertex(i);
        largest = largest.max((level.values.diagonal[i] - entry(a, a)).abs());
        for (&j, value) in level.pattern.row(i).iter().zip(&level.values.off_diagonal[level.pattern.range(i)])
        {
            largest = largest.max((value - entry(a, vertex(j as usize))).abs());
        }
    }
    largest
}

#[test]
fn galerkin_products_on_nested_meshes_are_the_stiffness_of_the_coarse_mesh() {
    let coarse = irregular(5);
    let fine = coarse.refine().mesh;
    let hierarchy = hierarchy_of(&fine);
    let finest = &hierarchy.levels()[hierarchy.finest()];
    let below = &hierarchy.levels()[hierarchy.finest() - 1];
    assert!(largest_difference(finest, &fine, |i| hierarchy.vertex()[i] as usize) < ROUNDING);
    // A refinement keeps the coarse vertices as the first ones.
    let coarse_vertex = |a: usize| hierarchy.vertex()[finest.transfer.same_vertex(a)] as usize;
    assert!(largest_difference(below, &coarse, coarse_vertex) < ROUNDING);
    let turned = |a: usize| coarse.points().len() - 1 - coarse_vertex(a);
    assert!(largest_difference(below, &coarse, turned) > 0.1, "another numbering is noticed");
}

/// Whether rows of one colour are not coupled, and windows see their neighbours only.
fn is_colored(level: &Level, coloring: &Coloring) -> bool {
    let mut place = vec![(0, 0); level.pattern.rows()];
    for window in 0..coloring.windows() {
        for color in 0..coloring.colors() {
            coloring.rows(window, color).for_each(|i| place[i] = (window, color));
        }
    }
    (0..level.pattern.rows()).all(|i| {
        let entries = level.pattern.row(i).iter().zip(&level.values.off_diagonal[level.pattern.range(i)]);
        entries.filter(|&(&j, _)| !level.is_held(j as usize)).all(|(&j, a)| {
            let (near, coupled) = (place[i].0.abs_diff(place[j as usize].0) <= 1, a.abs() > ROUNDING);
            near && !(coupled && place[i].1 == place[j as usize].1)
        })
    })
}

#[test]
fn colours_and_windows_are_what_the_sweeps_rely_on() {
    let square = rectangle([0.0, 0.0], [1.0, 1.0], [24, 16], Pattern::Right).unwrap();
    for mesh in [square, irregular(9).refine().mesh, unit_square(0.05)] {
        let hierarchy = hierarchy_of(&mesh);
        for level in &hierarchy.levels()[1..] {
            assert!(is_colored(level, &level.coloring));
        }
        let finest = &hierarchy.levels()[hierarchy.finest()];
        let one_color = Coloring::new(finest.pattern.rows(), finest.pattern.rows(), |_| std::iter::empty()).0;
        assert!(!is_colored(finest, &one_color));
    }
}

#[test]
fn refined_meshes_are_numbered_so_that_neighbours_are_near() {
    let mesh = (0..3).fold(irregular(8), |mesh, _| mesh.refine().mesh);
    let windows = |hierarchy: &Hierarchy| hierarchy.levels()[hierarchy.finest()].coloring.windows();
    let side = (mesh.points().len() as f64).sqrt();
    assert!(windows(&hierarchy_of(&mesh)) as f64 > side / NEAR_WINDOWS, "many windows");
    let k = stiffness(&mesh);
    let bandwidth = k.iter().map(|(_, (a, b))| a.abs_diff(b)).max().unwrap();
    assert!(!is_banded(mesh.points().len(), bandwidth), "as it is, they are not near");
}

/// Layers of neighbours of a square are up to so many sides long.
const NEAR_WINDOWS: f64 = 5.0;

#[test]
fn algebraic_levels_keep_constants_and_signs() {
    let hierarchy = hierarchy_of(&unit_square(0.02));
    assert!(hierarchy.finest() > 3);
    let coarsest = hierarchy.levels()[0].unknowns();
    assert!(coarsest <= DIRECT, "{coarsest} unknowns on the coarsest level");
    for level in &hierarchy.levels()[2..] {
        for i in (0..level.pattern.rows()).filter(|&i| !level.is_held(i)) {
            level.transfer.for_each_parent(i, |_, weight| assert!(weight > 0.0));
        }
    }
    // Without positive couplings, what a vertex takes adds up to one.
    let finest = &hierarchy.levels()[hierarchy.finest()];
    let sums = (0..finest.pattern.rows()).filter(|&i| {
        let off = &finest.values.off_diagonal[finest.pattern.range(i)];
        !finest.is_held(i) && off.iter().all(|&a| a < 0.0)
    });
    let mut plain = 0;
    for i in sums {
        let mut sum = 0.0;
        finest.transfer.for_each_parent(i, |_, weight| sum += weight);
        assert!((sum - 1.0).abs() < ROUNDING, "{sum}");
        plain += 1;
    }
    assert!(plain > 100);
}
