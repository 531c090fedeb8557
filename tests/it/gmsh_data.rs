//! What other people's mesh files have beside triangles in the plane: data views, quadrangles, elements of higher order, planes in
//! space.

use std::fs;

use membrane_contact::action::certify_stack;
use membrane_contact::discretization::StackDiscretization;
use membrane_contact::mesh::{GmshMesh, Mesh};
use membrane_contact::prelude::{Auto, ContactSolver, Field, SolverOptions};
use membrane_contact::problem::{ContactProblem, Membrane};

use super::common::{TOLERANCE, distance};
use super::mesh_files::{folder_with, msh2, msh4, square, summary};
use super::program::run;

/// Cells along a side of the square.
const N: usize = 6;

/// A membrane over a floor: load, tension, foundation, floor and height are to be filled in.
fn case(tension: &str, load: &str, floor: &str, rest: &str) -> String {
    format!(
        "membrane = [{{ tension = {tension}, load = {load}{rest} }}]\nobstacle = {{ floor = {floor} }}\ndomain = {{ mesh = \"plate.msh\" }}\n"
    )
}

/// A section of data with one value for each point of the square (`NodeData`), or each triangle.
fn view(section: &str, name: &str, values: &[f64]) -> String {
    let records: String =
        (1..).zip(values).map(|(tag, value): (usize, _)| format!("{tag} {value}\n")).collect();
    format!("${section}\n1\n\"{name}\"\n1\n0\n3\n0\n1\n{}\n{records}$End{section}\n", values.len())
}

fn points() -> Vec<[f64; 2]> {
    let at = |k: usize| k as f64 / N as f64;
    (0..(N + 1) * (N + 1)).map(|k| [at(k % (N + 1)), at(k / (N + 1))]).collect()
}

/// Of an affine function at the nodes.
fn at_nodes(name: &str, value: impl Fn(f64, f64) -> f64) -> String {
    view("NodeData", name, &points().iter().map(|&[x, y]| value(x, y)).collect::<Vec<_>>())
}

/// Of a value on each triangle.
fn on_elements(name: &str, value: impl Fn(usize) -> f64) -> String {
    view("ElementData", name, &(0..2 * N * N).map(value).collect::<Vec<_>>())
}

/// The square in both versions.
fn meshes() -> [String; 2] {
    [msh2("2.2", N, 1), msh4("4.1", N, [(N + 1) * (N + 1), 2 * N * N])]
}

/// The energy of a case on a mesh, and what the terminal shows.
fn solved(case: &str, mesh: &str) -> (f64, String) {
    let folder = folder_with(case, mesh);
    let shown = run(folder.path(), "solve case.toml").success();
    (summary(folder.path())["energy"].as_f64().expect("a number"), shown)
}

fn refused(case: &str, mesh: &str) -> String {
    let folder = folder_with(case, mesh);
    let run = run(folder.path(), "solve case.toml");
    assert_eq!((run.code, run.stderr.lines().count()), (Some(2), 1), "{run:?}");
    run.stderr
}

#[test]
fn views_are_the_functions_whose_values_they_are_also_on_refined_meshes() {
    let views = at_nodes("pressure", |x, y| -20.0 - 10.0 * x + 3.0 * y)
        + &at_nodes("stiffness", |x, y| 1.0 + x + 0.5 * y)
        + &at_nodes("ground", |x, _| -0.3 + 0.1 * x)
        + &at_nodes("rig", |x, y| 0.1 * x - 0.05 * y)
        + &on_elements("soil", |_| 2.0)
        + &on_elements("spare", |t| t as f64);
    let by_views = case(
        "{ view = \"stiffness\" }",
        "{ view = \"pressure\" }",
        "{ view = \"ground\" }",
        ", foundation = { view = \"soil\" }, height = { view = \"rig\" }",
    );
    let by_formulas = case(
        "\"1 + x + 0.5*y\"",
        "\"-20 - 10*x + 3*y\"",
        "\"-0.3 + 0.1*x\"",
        ", foundation = 2, height = \"0.1*x - 0.05*y\"",
    );
    for refine in ["", "mesh = { refine = 2 }\n"] {
        for mesh in meshes() {
            let [by_views, by_formulas] = [&by_views, &by_formulas]
                .map(|case| solved(&(case.clone() + refine), &(mesh.clone() + &views)));
            assert!((by_views.0 / by_formulas.0 - 1.0).abs() < 1e-9, "{} {}", by_views.0, by_formulas.0);
            assert!(by_views.1.contains("\n  data views not used: spare\n"), "{}", by_views.1);
            let all = "\n  data views not used: ground, pressure, rig, soil, spare, and 1 more\n";
            assert!(by_formulas.1.contains(all), "{}", by_formulas.1);
        }
    }
    // Another view is another load, and on triangles it is constant on each.
    let [mesh, _] = meshes();
    let patch = on_elements("patch", |t| if t < N * N { -20.0 } else { 0.0 });
    let (patch, whole) = (
        solved(&case("1", "{ view = \"patch\" }", "-9", ""), &(mesh.clone() + &patch)).0,
        solved(&case("1", "-20", "-9", ""), &mesh).0,
    );
    assert!(patch < 0.0 && patch > 0.6 * whole, "half of the load: {patch} {whole}");
}

#[test]
fn a_view_that_cannot_be_used_says_why() {
    let [mesh, _] = meshes();
    let of = |section: &str| mesh.clone() + section;
    let load = case("1", "{ view = \"p\" }", "-1", "");
    let p = at_nodes("p", |_, _| -1.0);
    let table = [
        (
            load.clone(),
            of(&at_nodes("q", |x, _| x)),
            "load f1 is the data view `p`, which the mesh does not have: its data views are `q`",
        ),
        (
            load.clone(),
            mesh.clone(),
            "load f1 is the data view `p`, which the mesh does not have: it has no named data views",
        ),
        (
            load.clone(),
            of(&p.replace("\n0\n1\n", "\n0\n3\n").replace(" -1\n", " 1 2 3\n")),
            "load f1 is the data view `p`, which has 3 components",
        ),
        (
            load.clone(),
            of(&(p.clone() + &p.replace("\n3\n0\n1\n", "\n3\n5\n1\n"))),
            "has several time steps, 0 and 5 among them",
        ),
        (
            load.clone(),
            of(&p.replace("\n7 -1\n", "\n7 nan\n")),
            "is NaN at Gmsh's number 7: it must be finite",
        ),
        (load.clone(), of(&p.replace("\n7 -1\n", "\n8 -2\n")), "is -2 and -1 at Gmsh's number 8"),
        (
            load.clone(),
            of(&p.replace("\n7 -1\n", "\n777 -1\n")),
            "has no value at (1, 0), vertex 6: save one, or name regions where it has values (vertex 6 is Gmsh's node 7)",
        ),
        (
            case("1", "1", "{ view = \"p\" }", ""),
            of(&on_elements("p", |_| -1.0)),
            "the floor is given by triangle, but it is needed at the vertices",
        ),
        (case("{ view = \"p\" }", "1", "-1", ""), of(&p), "tension mu1 is -1 on the triangle at"),
        (
            load.replace("mesh = \"plate.msh\"", "shape = \"square\""),
            mesh.clone(),
            "the data view `p` has to be in a mesh file, but there is none",
        ),
    ];
    for (case, mesh, words) in table {
        let message = refused(&case, &mesh);
        assert!(message.contains(words), "{message}");
    }
    // Where nobody asks for the view, nothing is wrong; where it says nothing, a region may do without it.
    let (_, shown) = solved(&case("1", "-1", "-1", ""), &of(&p.replace("\n7 -1\n", "\n7 nan\n")));
    assert!(shown.contains("data views not used: p\n"), "{shown}");
    let (_, shown) =
        solved(&load, &of(&(p.replace("\n49\n", "\n50\n").replace("$EndNodeData", "777 5\n$EndNodeData"))));
    assert!(
        shown.contains(
            "values of the view `p` at what is no vertex or triangle of the mesh, left out:\n    1\n"
        ),
        "{shown}"
    );
    let half = on_elements("p", |_| -1.0);
    let half = half
        .split_inclusive('\n')
        .filter(|line| !line.starts_with("72 "))
        .collect::<String>()
        .replace("\n72\n", "\n71\n");
    assert!(refused(&load, &of(&half)).contains("triangle 71"));
}

/// The square of quadrangles, cut along the diagonal that rises: the triangles of [`square`].
#[test]
fn quadrangles_give_the_same_bytes_as_the_triangles_that_they_are_cut_into() {
    let (nodes, triangles) = square(N, 1);
    let nodes: String = (1..).zip(&nodes).map(|(k, node): (usize, _)| format!("{k} {node}\n")).collect();
    let quadrangles: String = (1..)
        .zip(triangles.chunks(2))
        .map(|(k, cell): (usize, _)| {
            let [[a, b, c], [_, _, d]] = [cell[0], cell[1]];
            format!("{k} 3 2 1 1 {a} {b} {c} {d}\n")
        })
        .collect();
    let of_quadrangles = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{nodes}$EndNodes\n$Elements\n{}\n{quadrangles}$EndElements\n",
        (N + 1) * (N + 1),
        N * N
    );
    let case = case("1", "{ view = \"p\" }", "-0.05", "");
    let [triangles, quadrangles] = [
        (msh2("2.2", N, 1), on_elements("p", |t| -20.0 - (t / 2) as f64)),
        (of_quadrangles, view("ElementData", "p", &(0..N * N).map(|t| -20.0 - t as f64).collect::<Vec<_>>())),
    ]
    .map(|(mesh, view)| {
        let folder = folder_with(&case, &(mesh + &view));
        let shown = run(folder.path(), "solve case.toml").success();
        (fs::read(folder.path().join("out/case/solution.vtu")).unwrap(), shown)
    });
    assert!(triangles.0 == quadrangles.0);
    assert!(
        quadrangles.1.contains("\n  quadrangles, cut in two along the shorter diagonal: 36\n"),
        "{}",
        quadrangles.1
    );
    assert!(!triangles.1.contains("cut in two"));
}

/// The square with a node in the middle of each side of each triangle, which lies off the side.
#[test]
fn triangles_of_second_order_give_the_same_bytes_as_their_corners() {
    let (mut nodes, triangles) = square(N, 1);
    let corners = nodes.len();
    let mut elements = String::new();
    for (k, t) in triangles.iter().enumerate() {
        elements += &format!("{} 9 2 1 1 {} {} {}", k + 1, t[0], t[1], t[2]);
        for _ in 0..3 {
            nodes.push(format!("0.{k} 0.25 0"));
            elements += &format!(" {}", nodes.len());
        }
        elements += "\n";
    }
    assert!(nodes.len() > corners);
    let nodes: String = (1..).zip(&nodes).map(|(k, node): (usize, _)| format!("{k} {node}\n")).collect();
    let curved = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{nodes}$EndNodes\n$Elements\n{}\n{elements}$EndElements\n",
        nodes.lines().count(),
        triangles.len()
    );
    let case = case("1", "-20", "-0.05", "");
    let [straight, curved] = [msh2("2.2", N, 1), curved].map(|mesh| {
        let folder = folder_with(&case, &mesh);
        let shown = run(folder.path(), "solve case.toml").success();
        assert_eq!(summary(folder.path())["vertices"], corners);
        (fs::read(folder.path().join("out/case/solution.vtu")).unwrap(), shown)
    });
    assert!(straight.0 == curved.0);
    assert!(curved.1.contains("\n  elements of higher order, read by their corners: 72\n"), "{}", curved.1);
}

/// The square in planes of space: as it is, upright, and inclined.
#[test]
fn a_mesh_in_any_plane_has_the_same_action() {
    let (_, triangles) = square(N, 1);
    let elements: String = (1..)
        .zip(&triangles)
        .map(|(k, [a, b, c]): (usize, _)| format!("{k} 2 2 1 1 {a} {b} {c}\n"))
        .collect();
    let placed = |origin: [f64; 3], axes: [[f64; 3]; 2]| {
        let at = |[x, y]: [f64; 2]| [0, 1, 2].map(|k| origin[k] + x * axes[0][k] + y * axes[1][k]);
        let line =
            |(k, point): (usize, [f64; 2])| format!("{k} {}\n", at(point).map(|x| x.to_string()).join(" "));
        let nodes: String = (1..).zip(points()).map(line).collect();
        format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{nodes}$EndNodes\n$Elements\n{}\n{elements}$EndElements\n",
            points().len(),
            triangles.len()
        )
    };
    let lambda = |mesh: Mesh, load: f64| {
        let problem = ContactProblem::obstacle(Membrane::new(1.0).load(load), Field::from(-0.05)).unwrap();
        let d = StackDiscretization::new(&problem, mesh).unwrap();
        let solution =
            certify_stack(&d, Auto.solve_stack(&d, &SolverOptions::default()).unwrap(), TOLERANCE).unwrap();
        solution.gap(1).unwrap().lambda.clone()
    };
    let [sine, cosine] = [0.7_f64.sin(), 0.7_f64.cos()];
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let flat = lambda(Mesh::from_gmsh(placed([0.0; 3], [x, y]).as_bytes()).unwrap(), -20.0);
    assert!(flat.iter().any(|&action| action > 1.0), "there is contact");
    for axes in [
        [x, y],
        [x, z],
        [y, z],
        [[cosine, 0.0, sine], y],
        [[0.6 * cosine, 0.8 * cosine, sine], [-0.8, 0.6, 0.0]],
    ] {
        let mesh = GmshMesh::new(
            membrane_contact::formats::gmsh::parse(placed([0.5, -1.0, 2.0], axes).as_bytes()).unwrap(),
        )
        .unwrap();
        assert_eq!(mesh.notes.len(), 1, "{:?}", mesh.notes);
        assert!(distance(&lambda(mesh.mesh, -20.0), &flat) < 1e-9);
    }
    let other = lambda(Mesh::from_gmsh(placed([0.0; 3], [x, z]).as_bytes()).unwrap(), -20.1);
    assert!(distance(&other, &flat) > 1e-3);
    let (_, shown) = solved(&case("1", "-20", "-0.05", ""), &placed([0.0; 3], [x, z]));
    assert!(
        shown.contains("\n  the mesh lies in a plane in space; its coordinates there: x is now x"),
        "{shown}"
    );
    // What is bent is refused.
    let bent = placed([0.0; 3], [x, z]).replace("\n9 0.16666666666666666 0 ", "\n9 0.16666666666666666 0.2 ");
    let message = refused(&case("1", "-20", "-0.05", ""), &bent);
    assert!(
        message.contains("the mesh is not flat: node 9 is 2.000e-1 away from the plane through the nodes"),
        "{message}"
    );
}
