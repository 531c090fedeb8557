use super::*;
use crate::discretization::PairDiscretization;
use crate::mesh::samples::irregular;
use crate::mesh::{Bisection, Mesh, Pattern, rectangle};
use crate::multigrid::hierarchy::Level;
use crate::numeric::{Random, largest};
use crate::problem::ContactProblem;

/// Rounding of matrix entries and products of size ten.
const ROUNDING: f64 = 1e-12;

/// Rows of all visits of the levels in a cycle, as a multiple of those of the finest one: `1 + q + q^2 + ...` for the factor
/// [`SHRINKING`], and once each level for levels that are no smaller than that.
const CYCLE: f64 = 5.0;

fn hierarchy_of(mesh: Mesh) -> Hierarchy {
    let problem = ContactProblem::builder().load(1.0, 1.0).height(0.0).build().unwrap();
    Hierarchy::new(&PairDiscretization::new(&problem, mesh).unwrap())
}

fn square(cells: usize) -> Mesh {
    rectangle([0.0, 0.0], [1.0, 1.0], [cells; 2], Pattern::Right).unwrap()
}

/// Pairs of rows of one colour that are coupled.
fn coupled_pairs(level: &Level, values: &Values) -> usize {
    let mut color = vec![0; level.pattern.rows()];
    for (window, c) in
        (0..level.coloring.windows()).flat_map(|w| (0..level.coloring.colors()).map(move |c| (w, c)))
    {
        level.coloring.rows(window, c).for_each(|i| color[i] = c);
    }
    let is_coupled = |i: usize, j: u32, a: f64| {
        i < j as usize && color[i] == color[j as usize] && a.abs() > ROUNDING && !level.is_held(j as usize)
    };
    let pairs = |i: usize| {
        let entries = level.pattern.row(i).iter().zip(&values.off_diagonal[level.pattern.range(i)]);
        entries.filter(|&(&j, &a)| is_coupled(i, j, a)).count()
    };
    (0..color.len()).filter(|&i| !level.is_held(i)).map(pairs).sum()
}

/// `b - A x` at the rows that are not held.
fn residual(level: &Level, values: &Values, b: &[f64], x: &[f64]) -> Vec<f64> {
    let at = |i: usize| match level.is_held(i) {
        true => 0.0,
        false => b[i] - values.diagonal[i] * x[i] - values.off_diagonal_product(&level.pattern, i, x),
    };
    (0..x.len()).map(at).collect()
}

/// `1/2 x'A x - b'x`.
fn energy(level: &Level, values: &Values, b: &[f64], x: &[f64]) -> f64 {
    let r = residual(level, values, b, x);
    (0..x.len()).map(|i| -0.5 * x[i] * (r[i] + b[i])).sum()
}

/// A part of the vertices in contact, and the truncation by it.
fn truncated<'h>(
    hierarchy: &'h Hierarchy,
    random: &mut Random,
    one_in: usize,
) -> (Truncation<'h>, Vec<bool>) {
    let finest = hierarchy.finest();
    let mut truncation = Truncation::new(hierarchy, finest);
    truncation.reset(finest);
    let frozen: Vec<bool> = (0..hierarchy.vertex().len()).map(|_| random.below(one_in) == 0).collect();
    let changed: Vec<u32> = (0..frozen.len() as u32).filter(|&i| frozen[i as usize]).collect();
    truncation.update(finest, &frozen, &changed);
    (truncation, frozen)
}

/// A functional that is zero where a row is empty.
fn functional(level: &Level, values: &Values, random: &mut Random) -> Vec<f64> {
    let mut at = |i: usize| {
        let value = random.between(-1.0, 1.0);
        if level.is_held(i) || values.diagonal[i] == 0.0 { 0.0 } else { value }
    };
    (0..level.pattern.rows()).map(&mut at).collect()
}

/// The largest entry by which the functional that is handed down differs from `P'(b - A x)`.
fn handed_down_wrongly(level: &Level, values: &Values, b: &[f64]) -> f64 {
    let coarse_rows = level.transfer.restrict(b).len();
    let (mut x, mut coarse) = (vec![0.0; b.len()], vec![0.0; coarse_rows]);
    descend(level, values, b, &mut x, &mut coarse);
    let whole = level.transfer.restrict(&residual(level, values, b, &x));
    largest(coarse.iter().zip(&whole).map(|(a, b)| (a - b).abs()))
}

#[test]
fn rows_that_truncation_couples_hand_down_their_residual() {
    let mut random = Random::new(5);
    let oblong = rectangle([0.0, 0.0], [2.0, 1.0], [24, 40], Pattern::Right).unwrap();
    for mesh in [square(16), square(64), oblong] {
        let hierarchy = hierarchy_of(mesh);
        let l = hierarchy.finest() - 1;
        let level = &hierarchy.levels()[l];
        assert_eq!(coupled_pairs(level, &level.values), 0, "the colours are those of the whole matrix");
        let (truncation, _) = truncated(&hierarchy, &mut random, 9);
        let values = truncation.values(l);
        assert!(coupled_pairs(level, values) > 0, "there are coupled pairs");
        let b = functional(level, values, &mut random);
        assert!(handed_down_wrongly(level, values, &b) < ROUNDING);
        // The negative test: nobody knows that the rows were replaced.
        let unaware = Values { replaced: vec![false; values.replaced.len()], ..values.clone() };
        assert!(handed_down_wrongly(level, &unaware, &b) > 1e-3);
    }
}

/// The sweeps of `descend`, one row after the other.
fn relaxed_in_turn(level: &Level, values: &Values, b: &[f64]) -> Vec<f64> {
    /// As many as on every coarser level.
    const SWEEPS: usize = 2;
    let (windows, colors) = (level.coloring.windows(), level.coloring.colors());
    let mut x = vec![0.0; b.len()];
    for color in (0..SWEEPS).flat_map(|_| 0..colors) {
        for i in (0..windows).flat_map(|window| level.coloring.rows(window, color)) {
            x[i] = (b[i] - values.off_diagonal_product(&level.pattern, i, &x)) * values.inverse[i];
        }
    }
    x
}

/// A pair would lower the energy together as well; more rows that are coupled need not.
#[test]
fn rows_that_truncation_couples_are_relaxed_one_after_the_other() {
    let mut random = Random::new(6);
    for one_in in [3, 9] {
        let hierarchy = hierarchy_of(square(64));
        let l = hierarchy.finest() - 1;
        let level = &hierarchy.levels()[l];
        let (truncation, _) = truncated(&hierarchy, &mut random, one_in);
        let values = truncation.values(l);
        let b = functional(level, values, &mut random);
        let off = |values: &Values| {
            let (mut x, mut coarse) = (vec![0.0; b.len()], vec![0.0; level.transfer.restrict(&b).len()]);
            descend(level, values, &b, &mut x, &mut coarse);
            let expected = relaxed_in_turn(level, values, &b);
            largest(x.iter().zip(&expected).map(|(x, expected)| (x - expected).abs()))
        };
        assert!(off(values) < ROUNDING);
        // The negative test: nobody knows that the rows were replaced.
        assert!(off(&Values { replaced: vec![false; values.replaced.len()], ..values.clone() }) > 1e-3);
    }
}

/// One midpoint in contact: 0.25 between two coarse vertices of one colour, beside a diagonal of 4.5 and less.
#[test]
fn one_vertex_in_contact_couples_two_rows_of_a_colour() {
    let hierarchy = hierarchy_of(square(16));
    let (finest, l) = (hierarchy.finest(), hierarchy.finest() - 1);
    let mut truncation = Truncation::new(&hierarchy, finest);
    let mut most = 0;
    for i in 0..hierarchy.vertex().len() {
        truncation.reset(finest);
        let frozen: Vec<bool> = (0..hierarchy.vertex().len()).map(|j| j == i).collect();
        truncation.update(finest, &frozen, &[i as u32]);
        most = most.max(coupled_pairs(&hierarchy.levels()[l], truncation.values(l)));
    }
    assert!(most > 0, "seen");
}

#[test]
fn no_part_of_a_cycle_raises_the_energy() {
    let mut random = Random::new(11);
    for (mesh, one_in) in
        [(square(32), 3), (square(32), 20), (irregular(5).refine().unwrap().mesh.refine().unwrap().mesh, 8)]
    {
        let hierarchy = hierarchy_of(mesh);
        let (finest, top) = (hierarchy.finest(), hierarchy.finest() - 1);
        let (_, frozen) = truncated(&hierarchy, &mut random, one_in);
        let changed: Vec<u32> = (0..frozen.len() as u32).filter(|&i| frozen[i as usize]).collect();
        let mut coarse = CoarseLevels::new(&hierarchy, finest, true).unwrap();
        coarse.restart(finest).unwrap();
        for _ in 0..4 {
            let Matrices::Truncated(truncation) = &mut coarse.matrices else {
                unreachable!("with an obstacle")
            };
            truncation.update(finest, &frozen, &changed);
            coarse.b[top] = functional(&hierarchy.levels()[top], truncation.values(top), &mut random);
            coarse.solve(finest, &frozen, &[]).unwrap();
            for l in 1..finest {
                let level = &hierarchy.levels()[l];
                let values = coarse.matrices.values(l);
                let least = energy(level, values, &coarse.b[l], &coarse.x[l]);
                assert!(least <= 0.0, "level {l}: {least}");
                // The relaxations alone leave more.
                let (mut x, mut below) = (vec![0.0; coarse.x[l].len()], vec![0.0; coarse.x[l - 1].len()]);
                descend(level, values, &coarse.b[l], &mut x, &mut below);
                let relaxed = energy(level, values, &coarse.b[l], &x);
                assert!(relaxed <= 0.0 && least <= relaxed + ROUNDING, "level {l}: {least}, {relaxed}");
            }
            // The negative test: a correction that is twice too large raises it.
            let doubled: Vec<f64> = coarse.x[top].iter().map(|x| 2.5 * x).collect();
            let values = coarse.matrices.values(top);
            assert!(energy(&hierarchy.levels()[top], values, &coarse.b[top], &doubled) > 0.0);
        }
    }
}

/// A square bisected towards a corner: each step adds as many vertices, a small part of what is there.
fn bisected(steps: usize) -> Mesh {
    let mut bisection = Bisection::new(square(12));
    for step in 0..steps {
        let mesh = bisection.mesh();
        let reach = 0.5_f64.powi(step as i32);
        let is_near = |t: &usize| mesh.corners(*t).iter().any(|p| p[0].hypot(p[1]) < reach);
        let marked: Vec<usize> = (0..mesh.triangles().len()).filter(is_near).collect();
        bisection.refine(&marked).unwrap();
    }
    Mesh::clone(bisection.mesh())
}

#[test]
fn a_cycle_costs_a_few_times_the_finest_level() {
    for mesh in [square(64), bisected(20), irregular(40), bisected(6).refine().unwrap().mesh] {
        let hierarchy = hierarchy_of(mesh);
        let finest = hierarchy.finest();
        let rows = |l: usize| hierarchy.levels()[l].pattern.rows() as f64;
        for twice_up_to in [finest - 2, finest - 1, finest] {
            let counts: Vec<usize> =
                hierarchy.levels()[..=finest].iter().map(|level| level.pattern.rows()).collect();
            let visits = visits(&counts, twice_up_to);
            let work: f64 = (0..finest).map(|l| visits[l] as f64 * rows(l)).sum();
            assert!(work < CYCLE * rows(finest), "{visits:?}");
            assert!(visits[1] > 1, "levels have two corrections where they can: {visits:?}");
        }
    }
}

#[test]
fn levels_together_are_a_few_times_the_finest_one() {
    /// Each halves the unknowns at least; what is on the boundary comes on top on algebraic levels.
    const LEVELS: f64 = 3.0;
    for steps in [12, 18, 24] {
        let mesh = bisected(steps);
        let steps_together: usize = mesh.ancestry().iter().map(|parents| parents.coarse_vertices()).sum();
        let vertices = mesh.points().len() as f64;
        let hierarchy = hierarchy_of(mesh);
        let rows: usize = hierarchy.levels().iter().map(|level| level.pattern.rows()).sum();
        assert!((rows as f64) < LEVELS * vertices, "{steps} steps: {rows} rows for {vertices}");
        // The negative test: a level for each step would not do.
        assert!(steps_together as f64 > LEVELS * vertices, "{steps} steps: {steps_together} for {vertices}");
    }
}
