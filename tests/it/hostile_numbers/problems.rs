//! Problems with numbers that nobody would choose on purpose, but that users have.

use membrane_contact::fem::DEGREE_4;
use membrane_contact::mesh::{Mesh, Pattern, polygon, rectangle};
use membrane_contact::problem::{ContactProblem, ContactProblemBuilder, Expression, Function};

/// A problem and the mesh that it is posed on.
pub struct Hostile {
    pub name: &'static str,
    pub problem: ContactProblem,
    pub mesh: Mesh,
}

fn hostile(name: &'static str, problem: ContactProblemBuilder, mesh: Mesh) -> Hostile {
    let problem = problem.build().unwrap_or_else(|error| panic!("{name}: {error}"));
    Hostile { name, problem, mesh }
}

/// Two plates that touch on a part of the unit square.
pub fn base() -> ContactProblemBuilder {
    ContactProblem::builder().tension(1.0, 3.0).load(-15.0, 10.0).height(0.1)
}

/// Two plates that touch likewise on a square of another size: the displacements are those of [`base`].
pub fn plates_on(side: f64) -> ContactProblemBuilder {
    let per_area = 1.0 / (side * side);
    base().load(-15.0 * per_area, 10.0 * per_area)
}

pub fn formula(source: &str) -> Function {
    Expression::parse(source).expect("a formula").into()
}

pub fn grid(lower: [f64; 2], upper: [f64; 2], cells: [usize; 2]) -> Mesh {
    rectangle(lower, upper, cells, Pattern::Right).expect("a grid")
}

pub fn square(side: f64) -> Mesh {
    grid([0.0; 2], [side; 2], [12; 2])
}

fn mesh(points: &[[f64; 2]], triangles: &[[usize; 3]]) -> Mesh {
    Mesh::new(points.to_vec(), triangles.to_vec()).expect("a mesh")
}

/// The cells of the unit square in `n x n` that are kept, by column and row.
pub fn square_of(n: usize, kept: impl Fn(usize, usize) -> bool) -> Mesh {
    let square = grid([0.0; 2], [1.0; 2], [n; 2]);
    let cells = square.triangles().chunks(2).enumerate().filter(|(k, _)| kept(k % n, k / n));
    mesh(square.points(), &cells.flat_map(|(_, cell)| cell.to_vec()).collect::<Vec<_>>())
}

/// The height over a base of length 1 of a triangle with an angle of 0.01 degrees.
fn sliver() -> f64 {
    0.01_f64.to_radians().tan()
}

/// The unit square, with a vertex so near to the middle of its lower side that the triangle between has two angles of
/// 0.01 degrees: its stiffness has large positive entries off the diagonal.
fn flat_triangle() -> Mesh {
    let apex = [0.5, 0.5 * sliver()];
    mesh(
        &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], apex, [0.5, 0.5]],
        &[[0, 1, 4], [0, 4, 5], [4, 1, 5], [1, 2, 5], [2, 3, 5], [3, 0, 5]],
    )
}

/// A fan of needles: 36 triangles around one vertex, of which one in two has an angle of 0.01 degrees there.
fn needles() -> Mesh {
    let sectors = 18;
    let needle = 0.01_f64.to_radians();
    let corner = |k: usize| {
        let angle = std::f64::consts::TAU * (k / 2) as f64 / sectors as f64 + (k % 2) as f64 * needle;
        [angle.cos(), angle.sin()]
    };
    let points: Vec<_> = std::iter::once([0.0; 2]).chain((0..2 * sectors).map(corner)).collect();
    let triangles: Vec<_> = (0..2 * sectors).map(|k| [0, 1 + k, 1 + (k + 1) % (2 * sectors)]).collect();
    mesh(&points, &triangles)
}

/// A convex polygon in triangles from its first corner: every vertex is on the boundary.
fn fan(corners: usize) -> Mesh {
    let corner = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / corners as f64;
        [angle.cos(), angle.sin()]
    };
    let triangles: Vec<_> = (1..corners - 1).map(|k| [0, k, k + 1]).collect();
    mesh(&(0..corners).map(corner).collect::<Vec<_>>(), &triangles)
}

/// Tensions, loads and heights of all sizes.
fn data() -> Vec<Hostile> {
    let plates = |name, problem| hostile(name, problem, square(1.0));
    vec![
        plates("tensions 1 and 1e12", with_tensions([1.0, 1e12])),
        plates("tensions 1e12 and 1", with_tensions([1e12, 1.0])),
        plates("tensions 1e-6 and 1e6", with_tensions([1e-6, 1e6])),
        plates("tensions and loads apart by 1e12", with_tensions([1.0, 1e12]).load(-15.0, 1e13)),
        plates("loads of 1e-30", base().load(-15e-30, 10e-30).height(1e-31)),
        plates("loads of 1e30", base().load(-15e30, 10e30).height(1e29)),
        plates("loads of 1e30 on a height of 0.1", base().load(-15e30, 10e30)),
        plates("loads of 1e-30 on a height of 0.1", base().load(-15e-30, 10e-30)),
        plates("a load of 1e-300 beside one of 10", base().load(-1e-300, 10.0)),
        plates("a load below the normal numbers", base().load(-5e-324, 10.0)),
        plates("loads that cancel", base().load(-1e20, 1e20).height(0.1)),
        plates("the smallest tensions", with_tensions([1e-39, 1e-39]).load(-1e-38, 1e-38)),
        plates("the largest tensions", with_tensions([1e39, 1e39]).load(-1e39, 1e39)),
        plates("a height of 1e-300", base().height(1e-300)),
        plates("a height of 1e12", base().height(1e12)),
        plates("a height of 1e30", base().height(1e30)),
        plates("a height of 1e30 at one corner", base().height(formula("if(x == 0 and y == 0, 1e30, 0.1)"))),
        plates("no height", base().height(0.0)),
        plates("no height and no load", base().load(0.0, 0.0).height(0.0)),
        plates("no load", base().load(0.0, 0.0)),
        plates("no load, a height on a part", base().load(0.0, 0.0).height(formula("max(0, x - 0.5)"))),
        plates("loads that pull apart, no height", base().load(10.0, -10.0).height(0.0)),
        plates(
            "a load with a pole outside of the points",
            base().load(formula("-1/((x-0.5)^2+(y-0.5)^2)"), 10.0),
        ),
        plates("a load that jumps by 1e12", base().load(formula("if(x < 0.5, -1e12, -1)"), 10.0)),
    ]
}

fn with_tensions([mu1, mu2]: [f64; 2]) -> ContactProblemBuilder {
    base().tension(mu1, mu2)
}

/// Meshes of all sizes and shapes.
fn meshes() -> Vec<Hostile> {
    let unit = |name, mesh| hostile(name, base(), mesh);
    let pinched = |i: usize, j: usize| !(i == j && (i == 2 || i == 3));
    let two = mesh(
        &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5], [5.0, 0.0], [6.0, 0.0], [5.0, 1.0]],
        &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [5, 6, 7]],
    );
    let holes = [vec![[0.2, 0.2], [0.4, 0.2], [0.3, 0.4]], vec![[0.6, 0.6], [0.8, 0.6], [0.7, 0.8]]];
    let outer = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    vec![
        hostile("a square of 1e-9", plates_on(1e-9), square(1e-9)),
        hostile("a square of 1e9", plates_on(1e9), square(1e9)),
        hostile("a square of 1e-9 under loads of size 1", base(), square(1e-9)),
        hostile("a square of 1e9 under loads of size 1", base(), square(1e9)),
        hostile("a square of 1e-15", plates_on(1e-15), square(1e-15)),
        hostile("a square of 1e15", plates_on(1e15), square(1e15)),
        hostile("a square of 1e-37", base(), square(1e-37)),
        hostile("a square of 1e39 under tensions of 1e39", with_tensions([1e39, 3e39]), square(1e39)),
        hostile(
            "a square of 1e-3 that lies 1e6 from the origin",
            plates_on(1e-3),
            grid([1e6; 2], [1e6 + 1e-3; 2], [12; 2]),
        ),
        unit("right triangles with an angle of 0.01 degrees", grid([0.0; 2], [1.0, sliver()], [8; 2])),
        hostile(
            "the same, pressed together",
            base().load(-15.0 / sliver().powi(2), 10.0 / sliver().powi(2)),
            grid([0.0; 2], [1.0, sliver()], [8; 2]),
        ),
        hostile(
            "many cells, stretched a hundred times",
            base().load(-1.5e5, 1e5),
            grid([0.0; 2], [1.0, 0.01], [48; 2]),
        ),
        unit("a triangle with two angles of 0.01 degrees", flat_triangle()),
        unit("needles of 0.01 degrees", needles()),
        unit("one triangle", mesh(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], &[[0, 1, 2]])),
        unit("boundary vertices only", fan(7)),
        unit("one interior vertex", four_triangles()),
        unit("two pieces, one without unknowns", two),
        unit("two pieces", square_of(9, |i, _| i != 4)),
        unit("pieces that touch at vertices", square_of(6, |i, j| (i + j) % 2 == 0)),
        unit("holes that touch", square_of(8, pinched)),
        unit("holes", polygon(&outer, &holes, 0.08, 25.0).expect("a polygon with holes")),
        hostile(
            "holes without a height",
            base().height(0.0),
            polygon(&outer, &holes, 0.08, 25.0).expect("a polygon"),
        ),
    ]
}

/// A square in four triangles.
fn four_triangles() -> Mesh {
    mesh(
        &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5]],
        &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
    )
}

/// Problems that must come out certified.
pub fn solvable() -> Vec<Hostile> {
    let mut all = data();
    all.extend(meshes());
    all
}

/// Problems that cannot be computed with, and what the error has to say: what is wrong, and the remedy.
pub fn refused() -> Vec<(Hostile, &'static [&'static str])> {
    let plates = |name, problem| hostile(name, problem, square(1.0));
    let units: &[&str] = &["out of the range", "choose other units"];
    let finite: &[&str] = &["load f1 is NaN at the point", "finite on the whole domain"];
    let on_boundary: &[&str] = &["height g is", "at the boundary vertex", "max(0, ...)"];
    let point = a_quadrature_point(&square(1.0));
    let at_one_point =
        move |value: f64| Function::from_fn(move |x, y| if [x, y] == point { value } else { -15.0 });
    vec![
        (plates("loads of 1e300", base().load(-1e300, 1e300)), units),
        (plates("a load of 1e300 beside one of 10", base().load(-1e300, 10.0)), units),
        (plates("loads of 1e-300", base().load(-1e-300, 1e-300)), units),
        (plates("a height of 1e300", base().height(1e300)), units),
        (plates("a tension of 1e-300", with_tensions([1e-300, 1.0])), units),
        (plates("a tension of 1e300", with_tensions([1.0, 1e300])), units),
        (hostile("loads that overflow with the square", base().load(-1e30, 0.0), square(1e20)), units),
        (
            hostile(
                "a height that exerts forces below the numbers",
                with_tensions([1e-39, 1e-39]).load(0.0, 0.0).height(formula("x")),
                square(1e38),
            ),
            units,
        ),
        (plates("a load that is NaN at one point", base().load(at_one_point(f64::NAN), 10.0)), finite),
        (
            plates("a load that is infinite at one point", base().load(at_one_point(f64::INFINITY), 10.0)),
            &["load f1 is inf at the point", "finite on the whole domain"],
        ),
        (
            plates(
                "a height that is negative at one vertex",
                base().height(formula("if(x == 0.5 and y == 0, -1e-300, 0.1)")),
            ),
            on_boundary,
        ),
        (
            plates(
                "a height that is NaN at one vertex",
                base().height(formula("if(x == 0.5 and y == 0, 0/0, 0.1)")),
            ),
            on_boundary,
        ),
        (plates("a height that is infinite at one vertex", base().height(formula("1/(x + y)"))), on_boundary),
    ]
}

/// A point where a load on this mesh is evaluated.
fn a_quadrature_point(mesh: &Mesh) -> [f64; 2] {
    let corners = mesh.corners(mesh.triangles().len() / 2);
    let barycentric = DEGREE_4.points[0];
    [0, 1].map(|axis| (0..3).map(|i| barycentric[i] * corners[i][axis]).sum())
}
