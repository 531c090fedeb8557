//! What cannot be posed, and what data become on a mesh.

use super::{GapRow, IntegrationRule, StackDiscretization, StackError};
use crate::mesh::samples::square;
use crate::mesh::{Mesh, Pattern, ViewPlace, rectangle};
use crate::problem::{ContactProblem, Field, Function, Membrane, StackBuilder};

/// Rounding of sums of a few dozen terms.
const ROUNDING: f64 = 1e-13;

/// The unit square in 4 x 4 cells, with the regions `west` and `north`, which overlap, and `east`.
fn mesh() -> Mesh {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [4, 4], Pattern::Right).unwrap();
    let mesh = mesh.with_region("west", |[x, _]| x < 0.5).unwrap();
    mesh.with_region("north", |[_, y]| y > 0.5).unwrap().with_region("east", |[x, _]| x > 0.5).unwrap()
}

fn posed(problem: &ContactProblem) -> Result<StackDiscretization, StackError> {
    StackDiscretization::new(problem, mesh())
}

fn one(membrane: Membrane) -> Result<StackDiscretization, StackError> {
    posed(&ContactProblem::stack().membrane(membrane).build().unwrap())
}

fn over(floor: impl Into<Field>) -> Result<StackDiscretization, StackError> {
    posed(&ContactProblem::obstacle(Membrane::new(1.0), floor).unwrap())
}

#[test]
fn each_datum_that_does_not_fit_is_named() {
    let sheet = || Membrane::new(1.0);
    let parts = |names: [&str; 2]| Field::by_region(names.map(|name| (name, 1.0)));
    let refused: Vec<(Result<StackDiscretization, StackError>, &str)> = vec![
        (one(sheet().load(parts(["west", "wast"]))), "load f1 is given in the region `wast`"),
        (one(sheet().load(parts(["west", "north"]))), "load f1 is given twice, in `west` and in `north`"),
        (one(Membrane::new(Field::by_region([("west", 1.0)]))), "tension mu1 is not given at"),
        (
            one(sheet().load(Field::PerVertex([1.0; 24].into()))),
            "load f1 has 24 values, but the mesh has 25 vertices",
        ),
        (
            one(sheet().foundation(Field::PerTriangle([1.0; 31].into()))),
            "foundation c1 has 31 values, but the mesh has 32",
        ),
        (one(sheet().height(Field::PerTriangle([1.0; 32].into()))), "height g1 is given by triangle"),
        (over(Field::PerTriangle([-1.0; 32].into())), "the floor is given by triangle"),
        (one(sheet().height_on("rim", 0.0)), "the support of membrane 1 is given on the curve `rim`"),
        (one(sheet().height(Function::from_fn(|x, _| 1.0 / (x - 1.0)))), "height g1 is"),
        (
            one(sheet().free_on("left").traction_on("right", Function::from_fn(|_, _| f64::NAN))),
            "line load t1 is NaN",
        ),
        (one(sheet().height_on("left", 1e-6)), "the height of membrane 1 jumps at vertex"),
        (one(sheet().free()), "nothing holds membrane 1"),
        (one(sheet().load(1e45)), "the forces per area have the size"),
        (one(Membrane::new(1e45)), "the tension mu1 is"),
        (over(1e-6), "membrane 1 is at 0 and the floor above it at 1e-6"),
    ];
    for (result, words) in refused {
        let message = result.map(|_| ()).unwrap_err().to_string();
        assert!(message.starts_with(words) && !message.contains('\n'), "{message}");
    }
    assert!(one(sheet().load(parts(["west", "east"]))).is_ok());
    assert!(one(sheet().load(Field::PerVertex([1.0; 25].into()))).is_ok());
    // Heights that differ by rounding meet, and so do an obstacle and a height.
    assert!(one(sheet().height(1.0).height_on("left", 1.0 + 1e-12)).is_ok());
    assert!(over(1e-15).is_err(), "nothing has a size that it could be small against");
    let raised = Membrane::new(1.0).height(1.0);
    let moved = posed(&ContactProblem::obstacle(raised, 1.0 + 1e-14).unwrap()).unwrap();
    assert!(moved.rows().iter().all(|row| row.bound <= 1.0 + 1e-14));
    let heights = moved.obstacles()[1].unwrap();
    assert_eq!((heights[0], heights[12]), (1.0, 1.0 + 1e-14), "at the boundary and inside");
}

/// The same mesh with views, one of which is given by a file for some vertices only.
fn viewed() -> Mesh {
    let [vertices, triangles] = [ViewPlace::Vertices, ViewPlace::Triangles];
    let affine: Vec<f64> = mesh().points().iter().map(|[x, y]| 3.0 + x - 2.0 * y).collect();
    let mesh = mesh().with_view("affine", vertices, affine).unwrap();
    mesh.with_view("two", triangles, [2.0; 32]).unwrap().with_view("minus", vertices, [-1.0; 25]).unwrap()
}

#[test]
fn a_view_means_what_its_values_mean_also_on_a_refined_mesh() {
    let membrane =
        |field: Field, load: Field| Membrane::new(field.clone()).load(load).foundation(field).height(1.0);
    let posed_on = |mesh: Mesh, membrane: Membrane| {
        let problem = ContactProblem::stack().membrane(membrane).floor(Field::from(-9.0)).build().unwrap();
        StackDiscretization::new(&problem, mesh).unwrap()
    };
    let affine = || Field::from(Function::from_fn(|x, y| 3.0 + x - 2.0 * y));
    for mesh in [viewed(), viewed().refine().unwrap().mesh] {
        let by_views = [
            Field::view("affine"),
            Field::by_region([("west", Field::view("two"))]).elsewhere(Field::view("two")),
        ];
        let by_values = [affine(), 2.0.into()];
        let [one, other] =
            [by_views, by_values].map(|[field, load]| posed_on(mesh.clone(), membrane(field, load)));
        for a in 0..mesh.points().len() {
            assert!((one.load(1)[a] - other.load(1)[a]).abs() < ROUNDING);
            assert!((one.diagonal(1, a) - other.diagonal(1, a)).abs() < ROUNDING);
        }
    }
    // Heights and obstacles, at vertices.
    let over = |field: Field, floor: Field| {
        StackDiscretization::new(
            &ContactProblem::obstacle(Membrane::new(1.0).height(field), floor).unwrap(),
            viewed(),
        )
        .unwrap()
    };
    let heights = over(Field::view("affine"), Field::view("minus"));
    let expected = over(affine(), Field::from(-1.0));
    assert_eq!(heights.obstacles()[1], expected.obstacles()[1]);
    let bounds = |d: &StackDiscretization| d.rows().iter().map(|row| row.bound).collect::<Vec<_>>();
    assert_eq!(bounds(&heights), bounds(&expected));
}

#[test]
fn a_view_that_does_not_fit_is_named() {
    let refused = |membrane: Membrane| {
        let problem = ContactProblem::stack().membrane(membrane).build().unwrap();
        StackDiscretization::new(&problem, viewed()).unwrap_err()
    };
    let sheet = || Membrane::new(1.0);
    let table = [
        (
            sheet().load(Field::view("afine")),
            "load f1 is the data view `afine`, which the mesh does not have: its data views are `affine`, `minus`, `two`",
        ),
        (
            sheet().height(Field::view("two")),
            "height g1 is given by triangle, but it is needed at the vertices",
        ),
        (Membrane::new(Field::view("minus")), "tension mu1 is -1 on the triangle at"),
        (sheet().foundation(Field::view("minus")), "foundation c1 is -1 on the triangle at"),
    ];
    for (membrane, words) in table {
        let message = refused(membrane).to_string();
        assert!(message.starts_with(words), "{message}");
    }
    let none = StackDiscretization::new(
        &ContactProblem::stack().membrane(sheet().load(Field::view("p"))).build().unwrap(),
        mesh(),
    );
    assert!(
        none.unwrap_err().to_string().ends_with("which the mesh does not have: it has no named data views")
    );
}

/// Values at the vertices of an affine function, and of a constant on triangles, are that function.
#[test]
fn values_on_the_mesh_mean_what_functions_mean() {
    let affine = |x: f64, y: f64| 3.0 + x - 2.0 * y;
    let values: Vec<f64> = mesh().points().iter().map(|&[x, y]| affine(x, y)).collect();
    let of = |field: Field| one(Membrane::new(field.clone()).load(field)).unwrap();
    let [function, values] = [of(Function::from_fn(affine).into()), of(Field::PerVertex(values.into()))];
    let same = |one: f64, other: f64| (one - other).abs() < ROUNDING;
    for a in 0..25 {
        assert!(same(function.load(1)[a], values.load(1)[a]));
        assert!(same(function.diagonal(1, a), values.diagonal(1, a)));
    }
    let [constant, on_triangles] = [of(2.0.into()), of(Field::PerTriangle([2.0; 32].into()))];
    assert_eq!(constant.load(1), on_triangles.load(1));
    // By the vertices, the load is f(a) |D_a|; by quadrature it is not.
    let problem = ContactProblem::stack().membrane(Membrane::new(1.0).load(Function::from_fn(affine)));
    let lumped =
        StackDiscretization::by_rule(&problem.build().unwrap(), mesh(), IntegrationRule::Vertices).unwrap();
    let at = |a: usize| affine(mesh().points()[a][0], mesh().points()[a][1]) * lumped.dual_area()[a];
    assert!((0..25).all(|a| same(lumped.load(1)[a], at(a))));
    assert!((0..25).any(|a| !same(function.load(1)[a], at(a))));
}

/// A linear line load on the right side: the whole of it, and its moment about the lower end.
#[test]
fn line_loads_are_integrated_against_the_hat_functions() {
    let held = Membrane::new(1.0).traction_on("right", Function::from_fn(|_, y| 2.0 + 6.0 * y));
    let d = one(held).unwrap();
    let [total, moment] = (0..25).fold([0.0; 2], |[total, moment], a| {
        [total + d.load(1)[a], moment + d.load(1)[a] * mesh().points()[a][1]]
    });
    assert!((total - 5.0).abs() < ROUNDING && (moment - 3.0).abs() < ROUNDING, "{total} {moment}");
    assert!(d.free_vertices(1).contains(&14), "the middle of the side is free");
    assert!(!d.free_vertices(1).contains(&4) && !d.free_vertices(1).contains(&24), "its ends are held");
}

/// Where regions meet whose obstacles differ, the stricter one counts.
#[test]
fn obstacles_of_regions_meet_at_the_stricter_one() {
    let by_region = Field::by_region([("west", -0.5), ("east", -0.2)]);
    let problem = ContactProblem::stack().membrane(Membrane::new(1.0));
    let ceiling = Field::by_region([("west", 0.5), ("east", 0.2)]);
    let d = posed(&problem.floor(by_region).ceiling(ceiling).build().unwrap()).unwrap();
    let [ceiling, floor] = d.obstacles().map(|obstacle| obstacle.unwrap());
    for (a, &[x, _]) in mesh().points().iter().enumerate() {
        let expected = if x < 0.5 { [0.5, -0.5] } else { [0.2, -0.2] };
        assert_eq!([ceiling[a], floor[a]], expected);
    }
    // The borders of the regions may carry actions of their own.
    assert_eq!(d.lines(1).len(), 4);
}

/// Rows come by gap and vertex, and a side that is known is in the bound.
#[test]
fn each_gap_has_a_row_where_a_side_is_free() {
    let upper = Membrane::new(1.0).height(0.3).free_on("left");
    let stack = ContactProblem::stack().membrane(upper).membrane(Membrane::new(1.0)).ceiling(2.0);
    let d = posed(&stack.build().unwrap()).unwrap();
    assert_eq!((d.gaps(), d.unknowns()), (vec![0, 1], 12 + 9));
    let row = |k: usize, a: usize| d.row(k, a).map(|row| d.rows()[row]);
    // Vertex 10 is the middle of the left side, 12 that of the square, 2 that of the lower side.
    let upper = d.unknown(1, 10);
    assert_eq!(row(0, 10), Some(GapRow { gap: 0, vertex: 10, upper: None, lower: upper, bound: -2.0 }));
    assert_eq!(row(1, 10), Some(GapRow { gap: 1, vertex: 10, upper, lower: None, bound: 0.0 }));
    let [upper, lower] = [d.unknown(1, 12), d.unknown(2, 12)];
    assert_eq!(row(1, 12), Some(GapRow { gap: 1, vertex: 12, upper, lower, bound: 0.0 }));
    assert_eq!((row(0, 2), row(1, 2), row(2, 12)), (None, None, None));
    assert_eq!(d.rows().len(), 12 + 12);
}

/// Tensions in proportion share a matrix; others do not.
#[test]
fn membranes_share_a_matrix_where_their_tensions_are_in_proportion() {
    let matrices = |tensions: [Field; 2]| {
        let membranes = tensions.map(Membrane::new);
        let [upper, lower] = membranes;
        let stack = ContactProblem::stack().membrane(upper).membrane(lower).floor(-1.0);
        posed(&stack.build().unwrap()).unwrap().stiffness.len()
    };
    let split = |west: f64, east: f64| Field::by_region([("west", west), ("east", east)]);
    assert_eq!(matrices([1.0.into(), 3.7.into()]), 1);
    assert_eq!(matrices([split(1.0, 2.0), split(4.0, 8.0)]), 1);
    assert_eq!(matrices([split(1.0, 2.0), split(4.0, 4.0)]), 2);
}

/// What nothing holds must be meant so, and pressed against something that is held.
#[test]
fn membranes_that_are_not_pressed_are_refused() {
    let loose = |load: f64| Membrane::new(1.0).load(load).free().pressed();
    let held = || Membrane::new(1.0);
    let stack = |membranes: Vec<Membrane>, floor: Option<f64>| {
        let stack = membranes.into_iter().fold(ContactProblem::stack(), StackBuilder::membrane);
        let stack = floor.into_iter().fold(stack, StackBuilder::floor);
        StackDiscretization::new(&stack.build().unwrap(), square(4)).map(|d| d.is_held())
    };
    let accepted = [
        (vec![loose(-1.0), held()], None),
        (vec![held(), loose(1.0)], None),
        (vec![loose(-1.0)], Some(-1.0)),
        (vec![loose(-3.0), loose(2.0), held()], None),
        (vec![held(), loose(-1.0), held()], None),
    ];
    for (membranes, floor) in accepted {
        assert_eq!(stack(membranes, floor), Ok(false));
    }
    assert_eq!(stack(vec![held(), held()], None), Ok(true));
    let refused = [
        // Nothing to rest on, pulled away, the lower one alone pulled up, without a force, between two without one.
        (vec![loose(-1.0)], None),
        (vec![loose(1.0), held()], None),
        (vec![loose(2.0), loose(-3.0), held()], None),
        (vec![loose(0.0), held()], None),
        (vec![held(), loose(0.0), held()], None),
    ];
    for (membranes, floor) in refused {
        assert!(matches!(stack(membranes, floor), Err(StackError::NotPressed { .. })));
    }
    let unmarked = Membrane::new(1.0).load(-1.0).free();
    let error = stack(vec![unmarked, held()], None).unwrap_err();
    assert!(error.to_string().contains("say that it is pressed"), "{error}");
}
