use super::*;
use crate::formats::gmsh::{GmshError, parse};
use crate::geometry::distance_sq;
use crate::mesh::GmshMesh;

macro_rules! file {
    ($name:literal) => {
        include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/gmsh/", $name, ".msh")).as_slice()
    };
}

/// Gmsh puts vertices on a side within this distance, relative to its length.
const PLACED: f64 = 1e-9;

fn read(bytes: &[u8]) -> Mesh {
    GmshMesh::new(parse(bytes).unwrap()).unwrap().mesh
}

fn refused(text: &str) -> GmshError {
    match parse(text.as_bytes()).map(GmshMesh::new) {
        Err(error) => error,
        Ok(_) => panic!("accepted"),
    }
}

/// The names of regions with their areas, and of curves with their lengths.
type Measures<'a> = &'a [(&'a str, f64)];

/// Those of a mesh.
fn measures(mesh: &Mesh) -> Vec<(&str, f64)> {
    let groups = mesh.groups();
    let area = |name: &str| groups.region(name).unwrap().map(|t| mesh.triangle_area(t)).sum();
    let edge = |[a, b]: [usize; 2]| distance_sq(mesh.points()[a], mesh.points()[b]).sqrt();
    let length = |name: &str| groups.curve(name).unwrap().map(edge).sum();
    let regions = groups.regions().iter().map(|name| (name, area(name)));
    regions.chain(groups.curves().iter().map(|name| (name, length(name)))).collect()
}

#[track_caller]
fn assert_measures(mesh: &Mesh, expected: Measures) {
    let found = measures(mesh);
    let close = |((name, size), (other, expected)): (&(&str, f64), &(&str, f64))| {
        name == other && (size - expected).abs() <= PLACED * expected
    };
    assert!(found.len() == expected.len() && found.iter().zip(expected).all(close), "{found:?}");
}

#[test]
fn files_in_every_encoding_have_the_groups_that_they_state() {
    let materials = [
        ("rubber", 0.8),
        ("steel", 0.8),
        ("all of it", 1.6),
        ("clamped", 2.8),
        ("free", 1.8),
        ("top", 2.0),
        ("curves 7", 0.8),
    ];
    let rectangle = [("membrane", 0.96), ("clamped edge", 4.0), ("stiffener", 0.29f64.sqrt())];
    let two = [("membrane", 0.96), ("steel", 0.96), ("clamped edge", 4.0)];
    let one = [("membrane", 0.96), ("clamped edge", 4.0)];
    let table: [(&[&[u8]], Measures); 7] = [
        (
            &[
                file!("materials_22_ascii"),
                file!("materials_22_binary"),
                file!("materials_40"),
                file!("materials_41_ascii"),
                file!("materials_41_binary"),
            ],
            &materials,
        ),
        (
            &[
                file!("rectangle_22_ascii"),
                file!("rectangle_22_binary"),
                file!("version_40"),
                file!("rectangle_41_ascii"),
                file!("rectangle_41_binary"),
            ],
            &rectangle,
        ),
        (&[file!("two_groups_22_ascii"), file!("two_groups_22_binary"), file!("two_groups_41")], &two),
        (&[file!("partitioned_22"), file!("partitioned_41_ascii"), file!("partitioned_41_binary")], &one),
        (&[file!("hole_41")], &[("membrane", 0.96 - 0.08), ("clamped edge", 4.0 + 1.2)]),
        (&[file!("two_surfaces_41")], &[("membrane", 1.92), ("clamped edge", 8.0)]),
        (&[file!("no_groups_41"), file!("sparse_41_binary"), file!("sparse_22_ascii")], &[]),
    ];
    for (files, expected) in table {
        let of_first = read(files[0]);
        for file in files {
            let mesh = read(file);
            assert_measures(&mesh, expected);
            assert_measures(&mesh.refine().unwrap().mesh, expected);
            for name in mesh.groups().regions().iter() {
                let triangles = |groups: &Groups| groups.region(name).unwrap().collect::<Vec<_>>();
                assert!(
                    triangles(mesh.groups()) == triangles(of_first.groups()) || expected.is_empty(),
                    "{name}"
                );
            }
        }
    }
    // A triangle in two regions, an edge in two curves, one inside.
    let mesh = read(file!("materials_41_binary"));
    assert_eq!(mesh.groups().regions_of(0), ["rubber", "all of it"]);
    assert_eq!(
        [[2, 7], [9, 2], [1, 2], [4, 8]].map(|ends| mesh.groups().curves_of(ends)),
        [vec!["clamped", "top"], vec!["free", "top"], vec!["curves 7"], vec![]]
    );
}

/// A square in two triangles, its nodes 1 to 4 and an unused one; elements are to be added.
fn square(version: &str, entities: &str, elements: &str) -> String {
    let nodes = match version {
        "2.2" => "5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 7 7 0\n",
        _ => "1 5 1 5\n2 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n7 7 0\n",
    };
    format!(
        "$MeshFormat\n{version} 0 8\n$EndMeshFormat\n{entities}$Nodes\n{nodes}$EndNodes\n$Elements\n{elements}$EndElements\n"
    )
}

/// Elements of MSH 2.2: the two triangles in group 7, and others.
fn msh22(names: &str, others: &[&str]) -> String {
    let lines: String = others.iter().map(|line| format!("{line}\n")).collect();
    let elements = format!("{}\n{lines}8 2 2 7 1 1 2 3\n9 2 2 7 1 1 3 4\n", others.len() + 2);
    square("2.2", names, &elements)
}

#[test]
fn lines_that_are_no_edges_are_left_out_and_names_stay() {
    let names = "$PhysicalNames\n2\n1 1 \"all\"\n1 2 \"none\"\n$EndPhysicalNames\n";
    let lines = [
        "1 1 2 1 1 2 1",  // reversed
        "2 1 2 1 1 1 2",  // twice
        "3 1 2 -1 1 3 1", // inside, of a group turned round
        "4 1 2 2 1 2 4",  // across a triangle
        "5 1 2 2 1 1 5",  // to a node of no triangle
        "6 1 2 2 1 1 1",  // to itself
        "7 1 2 0 1 1 4",  // in no group
    ];
    let mesh = read(msh22(names, &lines).as_bytes());
    assert_eq!(mesh.groups().curves(), ["all", "none"]);
    assert_eq!(mesh.groups().curve("all").unwrap().collect::<Vec<_>>(), [[0, 1], [0, 2]]);
    assert_eq!(mesh.groups().curve("none").unwrap().count(), 0);
    assert_eq!(mesh.groups().regions(), ["surfaces 7"]);
    assert!(mesh.groups().curves_of([0, 3]).is_empty());
}

#[test]
fn groups_that_are_called_alike_are_one() {
    let names = "$PhysicalNames\n5\n1 1 \"edge\"\n1 2 \"edge\"\n1 3 \"curves 4\"\n2 7 \"edge\"\n2 8 \"empty\"\n$EndPhysicalNames\n";
    let lines = ["1 1 2 1 1 1 2", "2 1 2 2 1 2 3", "3 1 2 3 1 3 4", "4 1 2 4 1 4 1"];
    let mesh = read(msh22(names, &lines).as_bytes());
    assert_eq!(mesh.groups().curves(), ["edge", "curves 4"]);
    assert_eq!(mesh.groups().curve("edge").unwrap().collect::<Vec<_>>(), [[0, 1], [1, 2]]);
    assert_eq!(mesh.groups().curve("curves 4").unwrap().collect::<Vec<_>>(), [[0, 3], [2, 3]]);
    assert_eq!(mesh.groups().regions(), ["edge", "empty"]);
    assert_eq!(mesh.groups().region("empty").unwrap().count(), 0);
}

/// A curve in the groups 1 and 2, another one in 2 and one in none; surface 1 in group 7.
const ENTITIES: &str = "$Entities\n0 3 1 0\n1 0 0 0 1 0 0 2 1 -2 0\n2 0 0 0 1 0 0 1 2 0\n3 0 0 0 1 0 0 0 0\n1 0 0 0 1 1 0 1 7 0\n$EndEntities\n";

/// Lines in the three curves and one in the surface, one of them in two curves; the triangles in surface 1.
const BLOCKS: &str = "5 7 1 7\n1 1 1 1\n1 1 2\n1 2 1 2\n2 2 1\n3 2 3\n1 3 1 1\n4 3 4\n2 1 1 1\n5 4 1\n2 1 2 2\n8 1 2 3\n9 1 3 4\n";

#[test]
fn elements_are_in_the_groups_of_their_entity() {
    let check = |text: &str| {
        let mesh = read(text.as_bytes());
        let curve = |name: &str| mesh.groups().curve(name).unwrap().collect::<Vec<_>>();
        assert_eq!(mesh.groups().curves(), ["curves 1", "curves 2"]);
        assert_eq!(curve("curves 1"), [[0, 1]]);
        assert_eq!(curve("curves 2"), [[0, 1], [1, 2]], "each once");
        assert_eq!(mesh.groups().region("surfaces 7").unwrap().collect::<Vec<_>>(), [0, 1]);
    };
    let text = square("4.1", ENTITIES, BLOCKS);
    check(&text);
    // The entities may come later, and one of them twice.
    let later = square("4.1", "", BLOCKS) + ENTITIES;
    check(&later);
    let twice = ENTITIES
        .replace("0 3 1 0\n1 0 0 0 1 0 0 2 1 -2 0\n", "0 4 1 0\n1 0 0 0 1 0 0 1 2 0\n1 0 0 0 1 0 0 1 1 0\n");
    check(&square("4.1", &twice, BLOCKS));
    // Without entities nothing belongs to a group.
    assert!(read(square("4.1", "", BLOCKS).as_bytes()).groups().is_empty());
}

#[test]
fn a_line_of_a_group_has_two_nodes_that_are_there() {
    let message = |text: &str| refused(text).to_string();
    let expected = |line: usize, element: usize| {
        format!(
            "line {line}, $Elements: line {element} names the node 66, which is not in $Nodes; write the file again with Gmsh"
        )
    };
    assert_eq!(message(&msh22("", &["1 1 2 1 1 1 2", "2 1 2 1 1 2 66"])), expected(15, 2));
    assert!(parse(msh22("", &["1 1 2 0 1 2 66"]).as_bytes()).is_ok(), "it is in no group");
    for (from, to, element) in [("\n1 1 2\n", "\n1 66 2\n", Some(1)), ("\n4 3 4\n", "\n4 3 66\n", None)] {
        for text in [square("4.1", ENTITIES, BLOCKS), square("4.1", "", BLOCKS) + ENTITIES] {
            let broken = text.replace(from, to);
            assert_ne!(broken, text);
            match element {
                Some(element) => {
                    let line = 1 + broken[..broken.find(to).unwrap() + 1].matches('\n').count();
                    assert_eq!(message(&broken), expected(line, element));
                }
                None => assert!(parse(broken.as_bytes()).is_ok(), "its curve is in no group"),
            }
        }
    }
}
