use super::field::Field;
use super::finest::Frozen;
use super::lanes::{Lanes, Real};
use super::levels::Coarser;
use super::matrix::Matrix;
use super::transfer::{prolong_inside, prolong_interface};
use super::*;
use crate::fem::{stiffness, weighted_stiffness};
use crate::mesh::samples::{irregular, square};
use crate::mesh::{Pattern, disk, rectangle};
use crate::multigrid::hierarchy::inside;
use crate::numeric::Random;

/// Rounding of energies in single precision.
const SINGLE_ROUNDING: f64 = 1e-5;

fn refined(mesh: Mesh, times: usize) -> Mesh {
    (0..times).fold(mesh, |mesh, _| mesh.refine().unwrap().mesh)
}

fn of_size(patches: usize, mesh: &Mesh, k: &StiffnessMatrix, free: &[bool]) -> Option<Patches> {
    Patches::of_size(patches, STORED + 1, mesh, k, free)
}

fn patches(mesh: &Mesh) -> Option<Patches> {
    of_size(2, mesh, &stiffness(mesh), &inside(mesh))
}

/// All kinds: a group that is full and one that is not, obtuse triangles, a hole.
fn meshes() -> Vec<Mesh> {
    let obtuse = vec![[0.0, 0.0], [1.0, 0.0], [0.5, 0.15], [0.6, -0.2]];
    vec![
        square(32),
        refined(irregular(2), 5),
        refined(Mesh::new(obtuse, vec![[0, 1, 2], [0, 3, 1]]).unwrap(), 4),
        refined(crate::mesh::samples::square_without(3, |i, j| i == 1 && j == 1), 4),
    ]
}

#[test]
fn patches_are_found_where_there_are_some() {
    assert!(meshes().iter().all(|mesh| patches(mesh).is_some()));
    let without = [
        ("not refined", irregular(16)),
        ("too few refinements", refined(irregular(4), 3)),
        ("another pattern", rectangle([0.0; 2], [1.0; 2], [32; 2], Pattern::Crossed).unwrap()),
        ("round", disk([0.0; 2], 1.0, 32).unwrap()),
        ("graded", square(32).graded([0.0; 2], 2.0).unwrap()),
    ];
    for (why, mesh) in without {
        assert!(patches(&mesh).is_none(), "{why}");
    }
    let mesh = square(32);
    let free = inside(&mesh);
    // One triangle differs from its patch: inside, or at a corner.
    for odd in [0, mesh.triangles().len() / 2, 700] {
        let k = weighted_stiffness(&mesh, |t| if t == odd { 1.0 + 1e-8 } else { 1.0 });
        assert!(of_size(2, &mesh, &k, &free).is_none(), "triangle {odd}");
    }
    // A tension for each patch is one stencil for each.
    let halves =
        weighted_stiffness(
            &mesh,
            |t| if mesh.corners(t).iter().all(|p| p[0] < 0.5 + 1e-9) { 1.0 } else { 7.0 },
        );
    assert!(of_size(8, &mesh, &halves, &free).is_some());
    assert!(of_size(2, &mesh, &halves, &free).is_none(), "two patches have two tensions each");
    // A vertex inside a patch is held, or one alone on an edge.
    for held in [[3, 5], [3, 0]] {
        let held = held.map(|k| f64::from(k) / 32.0);
        let free: Vec<bool> =
            mesh.points().iter().map(|p| (0..2).any(|k| (p[k] - held[k]).abs() > 1e-9)).collect();
        assert!(of_size(2, &mesh, &stiffness(&mesh), &free).is_none());
    }
}

/// Some random points frozen, in parts of all sizes.
fn frozen(patches: &Patches, random: &mut Random) -> (Frozen, Vec<usize>) {
    let grid = patches.finest_grid();
    let before = Frozen::nothing(grid);
    let mut frozen = before.clone();
    let wide = random.below(2) == 0;
    for lanes in &mut frozen.patches {
        *lanes = if wide { [random.below(3) == 0; LANES] } else { lanes.map(|_| random.below(9) == 0) };
    }
    for (is_frozen, is_held) in frozen.interface.iter_mut().zip(&grid.is_held) {
        *is_frozen = !is_held && random.below(3) == 0;
    }
    let changed = frozen.changed_groups(grid, &before);
    (frozen, changed)
}

fn drawn<T: Real>(grid: &Grid, random: &mut Random) -> Field<T> {
    let mut field = Field::zero(grid);
    let mut draw = || T::of(random.between(-1.0, 1.0));
    for g in 0..grid.groups() {
        for (lane, _) in grid.partition.group(g) {
            let points = field.group_mut(grid, g);
            grid.lattice.inside().for_each(|[i, j]| points[grid.lattice.at(i, j)].0[lane] = draw());
        }
    }
    for (x, is_held) in field.interface.iter_mut().zip(&grid.is_held) {
        *x = if *is_held { T::default() } else { draw() };
    }
    field
}

/// A function of the next grid.
fn prolonged(grids: [&Grid; 2], mut x: Field<f64>) -> Field<f64> {
    let mut fine = Field::zero(grids[1]);
    prolong_interface(grids, &x.interface, |a, value| fine.interface[a] = value);
    x.gather(grids[0]);
    for g in 0..grids[1].groups() {
        let points = fine.group_mut(grids[1], g);
        prolong_inside(grids, x.group(grids[0], g), |at, value| points[at] = value);
    }
    fine
}

fn to_double(x: &Field<f32>) -> Field<f64> {
    Field {
        patches: x.patches.iter().map(|lanes| lanes.scaled(1.0)).collect(),
        interface: x.interface.iter().map(|&x| x.into()).collect(),
    }
}

/// `1/2 x'A x` on the finest grid.
fn energy(patches: &Patches, x: &Field<f64>) -> f64 {
    let grid = patches.finest_grid();
    let matrix = Matrix::new(grid, &patches.stencils, 1.0);
    -0.5 * matrix.residual(grid, x, &Field::zero(grid)).dot(grid, x)
}

/// A function of a coarser grid on the finest one, without its values at frozen points.
fn on_finest(patches: &Patches, l: usize, x: Field<f64>, frozen: &Frozen) -> Field<f64> {
    let grids = &patches.grids;
    let mut x = (l..patches.finest()).fold(x, |x, l| prolonged([&grids[l], &grids[l + 1]], x));
    for (x, is_frozen) in x.patches.iter_mut().zip(&frozen.patches) {
        *x = Lanes(std::array::from_fn(|lane| if is_frozen[lane] { 0.0 } else { x.0[lane] }));
    }
    for (x, is_frozen) in x.interface.iter_mut().zip(&frozen.interface) {
        *x = if *is_frozen { 0.0 } else { *x };
    }
    x
}

/// `P' T A T P` on all levels: the energy of a coarse function is that of its truncated prolongation.
#[test]
fn truncated_matrices_have_the_energies_of_truncated_functions() {
    for mesh in meshes() {
        let patches = patches(&mesh).unwrap();
        let mut random = Random::new(5);
        let mut coarser = Coarser::new(&patches, true, 1.0).unwrap();
        coarser.restart(patches.finest()).unwrap();
        for round in 0..3 {
            let (frozen, changed) = frozen(&patches, &mut random);
            let nothing = Frozen::nothing(&patches.grids[patches.finest()]);
            coarser.truncate(patches.finest(), &frozen, &changed).unwrap();
            for l in 0..patches.finest() {
                let x = drawn::<f32>(&patches.grids[l], &mut random);
                let found = coarser.energy(l, &x);
                let expected = energy(&patches, &on_finest(&patches, l, to_double(&x), &frozen));
                let error = (found - expected).abs();
                assert!(error < SINGLE_ROUNDING * expected, "round {round}, level {l}: {found} {expected}");
                let whole = energy(&patches, &on_finest(&patches, l, to_double(&x), &nothing));
                assert!((whole - expected).abs() > 100.0 * SINGLE_ROUNDING * whole, "truncation is noticed");
            }
            let groups: Vec<usize> = (0..patches.stencils.len()).collect();
            coarser.truncate(patches.finest(), &nothing, &groups).unwrap();
            for l in 0..patches.finest() {
                let x = drawn::<f32>(&patches.grids[l], &mut random);
                let expected = energy(&patches, &on_finest(&patches, l, to_double(&x), &nothing));
                assert!((coarser.energy(l, &x) - expected).abs() < SINGLE_ROUNDING * expected, "and undone");
            }
        }
    }
}

/// A correction `c` has `1/2 c'A c < b'c`, on truncated levels, too.
#[test]
fn corrections_lower_the_energy() {
    for mesh in meshes() {
        let patches = patches(&mesh).unwrap();
        let mut random = Random::new(9);
        let finest = patches.finest();
        let mut coarser = Coarser::new(&patches, true, 1.0).unwrap();
        coarser.restart(finest).unwrap();
        for round in 0..4 {
            let (frozen, changed) = frozen(&patches, &mut random);
            if round > 0 {
                coarser.truncate(finest, &frozen, &changed).unwrap();
            }
            let below = finest - 1;
            let b = drawn::<f32>(&patches.grids[below], &mut random);
            *coarser.below(finest).b = b.clone();
            coarser.solve(finest, true, round > 0).unwrap();
            let c = coarser.below(finest).x.clone();
            let grid = &patches.grids[below];
            let work = to_double(&b).dot(grid, &to_double(&c)) / coarser.scale();
            let energy = coarser.energy(below, &c);
            assert!(energy < work * (1.0 + SINGLE_ROUNDING), "round {round}: {energy} {work}");
            assert!(energy > 0.0 && work > 0.0);
        }
    }
}
