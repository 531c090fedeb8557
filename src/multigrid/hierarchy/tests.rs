use super::*;
use crate::fem::stiffness;
use crate::mesh::samples::irregular;
use crate::mesh::{Mesh, MeshSize, Pattern, generate, rectangle};
use crate::numeric::largest;
use crate::problem::{ContactProblem, Domain};

/// Rounding of matrix entries and weights of size one.
const ROUNDING: f64 = 1e-12;

fn unit_square(size: f64) -> Mesh {
    let domain = Domain::Rectangle { lower: [0.0, 0.0], upper: [1.0, 1.0] };
    generate(&domain, MeshSize::EdgeLength { size, min_angle: 25.0 }).unwrap()
}

fn hierarchy_of(mesh: &Mesh) -> Hierarchy {
    let problem = ContactProblem::builder().tension(1.0, 1.0).load(1.0, 1.0).height(0.0).build().unwrap();
    Hierarchy::new(&PairDiscretization::new(&problem, mesh.clone()).unwrap())
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
    let fine = coarse.refine().unwrap().mesh;
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
    for mesh in [square, irregular(9).refine().unwrap().mesh, unit_square(0.05)] {
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
    let mesh = (0..3).fold(irregular(8), |mesh, _| mesh.refine().unwrap().mesh);
    let windows = |hierarchy: &Hierarchy| hierarchy.levels()[hierarchy.finest()].coloring.windows();
    let side = (mesh.points().len() as f64).sqrt();
    assert!(windows(&hierarchy_of(&mesh)) as f64 > side / NEAR_WINDOWS, "many windows");
    let k = stiffness(&mesh);
    let bandwidth = k.iter().map(|(_, (a, b))| a.abs_diff(b) as usize).max().unwrap();
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

/// The products of a level with a vector by runs, and row by row.
fn products(level: &Level, x: &[f64]) -> [Vec<f64>; 2] {
    let Level { pattern, values, coloring, runs, .. } = level;
    let mut by_runs = Vec::new();
    for (window, color) in (0..coloring.windows()).flat_map(|w| (0..coloring.colors()).map(move |c| (w, c))) {
        let rows: Vec<usize> = runs.of(window, color).flat_map(|run| runs.rows(run)).collect();
        assert!(rows.into_iter().eq(coloring.rows(window, color)), "the runs of a colour are its rows");
        for run in runs.of(window, color) {
            assert!(runs.rows(run).all(|i| runs.with_row(i) == run));
            let mut products = [0.0; LONGEST];
            by_runs.extend(values.off_diagonal_products((pattern, runs), run, x, &mut products));
        }
    }
    [by_runs, (0..x.len()).map(|i| values.off_diagonal_product(pattern, i, x)).collect()]
}

/// The part of the rows that are worked on by stencils.
fn shared(level: &Level) -> f64 {
    let runs = (0..level.values.shared.len()).filter(|&run| level.values.shared[run]);
    runs.map(|run| level.runs.rows(run).len()).sum::<usize>() as f64 / level.pattern.rows() as f64
}

/// Numbers without a pattern.
fn scattered(count: usize) -> Vec<f64> {
    (0..count).map(|i| (i as f64).sin()).collect()
}

#[test]
fn products_by_stencils_are_those_of_the_rows() {
    let uniform = |cells: usize| rectangle([0.0, 0.0], [1.0, 1.0], [cells; 2], Pattern::Right).unwrap();
    // (mesh, whether its finest level has common stencils, and whether the one below has)
    for (mesh, expected) in [
        (uniform(64), [true, true]),
        // A third is no binary fraction: entries differ by rounding, which only corrections may overlook.
        (uniform(48 * 3), [false, true]),
        (irregular(24).refine().unwrap().mesh, [false, false]),
    ] {
        let hierarchy = hierarchy_of(&mesh);
        for (below, expected) in expected.into_iter().enumerate() {
            let level = &hierarchy.levels()[hierarchy.finest() - below];
            assert_eq!(shared(level) > 0.5, expected, "{below} below: {}", shared(level));
            let [by_runs, by_rows] = products(level, &scattered(level.pattern.rows()));
            let defect = largest(by_runs.iter().zip(&by_rows).map(|(a, b)| (a - b).abs()));
            assert!(if below == 0 { defect == 0.0 } else { defect < ROUNDING }, "{below} below: {defect}");
        }
    }
}

#[test]
fn a_row_that_differs_has_no_part_in_a_stencil() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [64, 64], Pattern::Right).unwrap();
    let hierarchy = hierarchy_of(&mesh);
    let level = &hierarchy.levels()[hierarchy.finest()];
    let first = |run: usize| level.runs.rows(run).start;
    let has_stencil = |&run: &usize| level.values.shared[run] && !level.pattern.row(first(run)).is_empty();
    let run = (0..level.values.shared.len()).find(has_stencil).expect("there is a stencil");
    let changed = first(run) + 1;
    let mut values = level.values.clone();
    values.off_diagonal[level.pattern.range(changed)][0] *= 1.5;
    let mut other = Level { values, ..level.clone() };
    let x = scattered(level.pattern.rows());
    let differs = |level: &Level| {
        let [by_runs, by_rows] = products(level, &x);
        by_runs != by_rows
    };
    assert!(differs(&other), "the products know nothing of the change");
    other.values.part(run);
    assert!(!differs(&other));
    let found = Level::new(other.pattern, other.values, other.coloring, 0.0);
    assert!(!found.values.shared[found.runs.with_row(changed)]);
    assert!(!differs(&found));
}
