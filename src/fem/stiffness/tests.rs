use super::*;
use crate::mesh::samples::{irregular, renumbered, square, square_without};
use crate::mesh::{Pattern, VertexKind, disk, rectangle};
use crate::parallel::BLOCK;

/// Rounding of a row: a few operations on numbers of order one.
const ROUNDING: f64 = 1e-13;

fn slivers() -> Mesh {
    rectangle([0.0, 0.0], [1.0, 1e-3], [7, 9], Pattern::Crossed).unwrap()
}

/// `(K v)_a`.
fn row_times(k: &StiffnessMatrix, a: usize, v: impl Fn(usize) -> f64) -> f64 {
    k.outer_view(a).unwrap().iter().map(|(b, value)| value * v(b)).sum()
}

/// `u'K v`.
fn form(k: &StiffnessMatrix, u: &[f64], v: &[f64]) -> f64 {
    (0..u.len()).map(|a| u[a] * row_times(k, a, |b| v[b])).sum()
}

fn nodal(mesh: &Mesh, f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    mesh.points().iter().map(|&[x, y]| f(x, y)).collect()
}

/// The matrix to the last bit.
fn bits(k: &StiffnessMatrix) -> (Vec<u32>, Vec<u32>, Vec<u64>) {
    let values = k.data().iter().map(|value| value.to_bits()).collect();
    (k.indptr().into_raw_storage().to_vec(), k.indices().to_vec(), values)
}

#[test]
fn it_is_symmetric_to_the_last_bit() {
    for mesh in [irregular(9), slivers(), disk([0.3, 0.1], 0.7, 9).unwrap()] {
        let k = stiffness(&mesh);
        let transposed = k.transpose_view().to_csr();
        assert_eq!(bits(&k), bits(&transposed));
    }
    // The comparison sees a difference of rounding.
    let mut other = stiffness(&irregular(9));
    other.data_mut()[1] *= 1.0 + f64::EPSILON;
    assert_ne!(bits(&other), bits(&other.transpose_view().to_csr()));
}

#[test]
fn constants_have_no_gradient_and_linear_functions_are_harmonic() {
    for mesh in [irregular(9), slivers(), disk([0.3, 0.1], 0.7, 9).unwrap()] {
        let k = stiffness(&mesh);
        let linear = nodal(&mesh, |x, y| 2.0 * x - 3.0 * y + 1.0);
        let quadratic = nodal(&mesh, |x, y| x * x + y * y);
        for a in 0..mesh.points().len() {
            let size: f64 = k.outer_view(a).unwrap().iter().map(|(_, value)| value.abs()).sum();
            assert!(row_times(&k, a, |_| 1.0).abs() < ROUNDING * size);
            if mesh.kind()[a] == VertexKind::Interior {
                assert!(row_times(&k, a, |b| linear[b]).abs() < ROUNDING * 4.0 * size);
                assert!(row_times(&k, a, |b| quadratic[b]).abs() > 1e3 * ROUNDING * size);
            }
        }
    }
}

#[test]
fn right_angled_cells_give_the_five_point_stencil_without_their_diagonals() {
    // Dyadic, decimal, stretched; the coordinates of the latter two are rounded.
    let grids = [([0.0, 0.0], [1.0, 1.0]), ([0.1, -0.3], [0.7, 0.3]), ([0.1, 1.0], [4.3, 1.7])];
    for (lower, upper) in grids {
        let n = 7;
        let k = stiffness(&rectangle(lower, upper, [n, n], Pattern::Right).unwrap());
        // The ratios of the sides of a cell.
        let (slope, flat) =
            ((upper[1] - lower[1]) / (upper[0] - lower[0]), (upper[0] - lower[0]) / (upper[1] - lower[1]));
        for a in (1..n).flat_map(|j| (1..n).map(move |i| j * (n + 1) + i)) {
            let expected = [
                (a - n - 1, -flat),
                (a - 1, -slope),
                (a, 2.0 * (slope + flat)),
                (a + 1, -slope),
                (a + n + 1, -flat),
            ];
            let row: Vec<(usize, f64)> =
                k.outer_view(a).unwrap().iter().map(|(b, &value)| (b, value)).collect();
            assert_eq!(row.len(), 5, "{row:?}");
            for ((b, found), (column, expected)) in row.into_iter().zip(expected) {
                assert!(
                    b == column && (found - expected).abs() < ROUNDING * 10.0,
                    "{found} is not {expected}"
                );
            }
        }
        // Off the diagonal, exactly the sides of the cells.
        assert_eq!(k.nnz(), (n + 1) * (n + 1) + 2 * 2 * n * (n + 1));
    }
    let dyadic = stiffness(&square(8));
    assert_eq!(dyadic.get(10, 10), Some(&4.0));
    assert_eq!([dyadic.get(10, 11), dyadic.get(10, 19)], [Some(&-1.0), Some(&-1.0)]);
    // Where cells are not right-angled, their diagonals are there.
    let k = stiffness(&irregular(7));
    assert_eq!(k.nnz(), 8 * 8 + 2 * (2 * 7 * 8 + 7 * 7));
}

/// `int grad u . grad v` by hand, on the square of the diagonal `(0, 0)`, `(2, 2)`: gradients are constant on each half.
#[test]
fn energies_of_hand_made_functions() {
    let points = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let k = stiffness(&Mesh::new(points, vec![[0, 1, 2], [0, 2, 3]]).unwrap());
    // Below the diagonal grad u = (1, -3/2), grad v = (0, 1); above, grad u = (0, -1/2), grad v = (-1, 2); area 2 each.
    let (u, v) = ([0.0, 2.0, -1.0, -1.0], [0.0, 0.0, 2.0, 4.0]);
    assert_eq!(form(&k, &u, &v), 2.0 * -1.5 - 2.0);
    assert_eq!(form(&k, &v, &u), -5.0);
    assert_eq!(form(&k, &u, &u), 2.0 * (1.0 + 2.25) + 2.0 * 0.25);
    assert_ne!(form(&k, &v, &v), form(&k, &u, &u));
}

/// On `n x n` right-angled cells the interpolant of `x^2` has the energy `h sum_i ((2 i + 1) h)^2 = (4 - h^2) / 3`,
/// just below the function's own 4/3.
#[test]
fn the_energy_of_a_quadratic_is_known() {
    for n in [1, 4, 16, 64] {
        let (mesh, h) = (square(n), 1.0 / n as f64);
        let k = stiffness(&mesh);
        for u in [nodal(&mesh, |x, _| x * x), nodal(&mesh, |_, y| y * y)] {
            assert!((form(&k, &u, &u) - (4.0 - h * h) / 3.0).abs() < ROUNDING);
            assert!(form(&k, &u, &u) < 4.0 / 3.0 - 1e9 * f64::EPSILON);
        }
    }
}

#[test]
fn unused_vertices_have_empty_rows() {
    let points = [square(2).points(), &[[0.3, 0.3]]].concat();
    let k = stiffness(&Mesh::new(points, square(2).triangles().to_vec()).unwrap());
    assert_eq!(k.shape(), (10, 10));
    assert_eq!(k.outer_view(9).unwrap().nnz(), 0);
    assert_eq!(k.outer_view(4).unwrap().nnz(), 5);
}

#[test]
fn numbering_changes_the_order_alone() {
    let mesh = square_without(6, |i, j| i == 2 && j == 3);
    let (other, number) = renumbered(&mesh, 5);
    let (k, permuted) = (stiffness(&mesh), stiffness(&other));
    assert_eq!(k.nnz(), permuted.nnz());
    for (&value, (a, b)) in k.iter() {
        let found = permuted.get(number[a as usize], number[b as usize]).expect("the same entries");
        assert!((found - value).abs() < ROUNDING);
    }
    assert_ne!(bits(&k), bits(&permuted));
}

#[test]
fn it_does_not_depend_on_the_number_of_threads() {
    // More than two blocks of rows.
    let mesh = irregular(100);
    let with = |threads: usize, mesh: &Mesh| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        bits(&pool.install(|| stiffness(mesh)))
    };
    assert!(mesh.points().len() > 2 * BLOCK);
    assert!(with(1, &mesh) == with(2, &mesh) && with(1, &mesh) == with(5, &mesh));
    assert!(with(1, &mesh) != with(1, &irregular(101)));
}
