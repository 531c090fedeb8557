//! Files that Gmsh 4.15.2 wrote (`tests/data/gmsh/make.py`).

mod broken;
mod handmade;
mod shapes;
mod views;

use std::collections::HashSet;

use super::{GmshNote, GmshTriangulation, GmshView, ViewFault, ViewPlace, parse};

macro_rules! file {
    ($name:literal) => {
        include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/gmsh/", $name, ".msh")).as_slice()
    };
}

/// Gmsh prints 16 digits, which is up to one unit in the last place off; coordinates are of order one.
const PRINTED: f64 = 1e-15;
/// Rounding of an area of order one, summed over some ten triangles (thousands for the plate).
const AREA: f64 = 1e-12;

/// A file that can be read, and what is in it.
struct Valid {
    name: &'static str,
    bytes: &'static [u8],
    nodes: usize,
    triangles: usize,
    area: f64,
    /// Vertices - edges + triangles: the number of components less the number of holes.
    euler: isize,
}

macro_rules! valid {
    ($name:literal, $nodes:literal, $triangles:literal, $area:expr, $euler:literal) => {
        Valid {
            name: $name,
            bytes: file!($name),
            nodes: $nodes,
            triangles: $triangles,
            area: $area,
            euler: $euler,
        }
    };
}

const RECTANGLE: f64 = 1.2 * 0.8;

const VALID: &[Valid] = &[
    valid!("rectangle_22_ascii", 25, 34, RECTANGLE, 1),
    valid!("rectangle_22_binary", 25, 34, RECTANGLE, 1),
    valid!("rectangle_41_ascii", 25, 34, RECTANGLE, 1),
    valid!("rectangle_41_binary", 25, 34, RECTANGLE, 1),
    valid!("sparse_22_ascii", 5, 4, 1.0, 1),
    valid!("sparse_22_binary", 5, 4, 1.0, 1),
    valid!("sparse_41_ascii", 7, 4, 1.0, 1),
    valid!("sparse_41_binary", 7, 4, 1.0, 1),
    valid!("no_groups_41", 24, 32, RECTANGLE, 1),
    valid!("two_groups_22_ascii", 15, 18, RECTANGLE, 1),
    valid!("two_groups_22_binary", 15, 18, RECTANGLE, 1),
    valid!("two_groups_41", 15, 18, RECTANGLE, 1),
    valid!("materials_22_ascii", 14, 16, 1.6, 1),
    valid!("materials_22_binary", 14, 16, 1.6, 1),
    valid!("materials_40", 14, 16, 1.6, 1),
    valid!("materials_41_ascii", 14, 16, 1.6, 1),
    valid!("materials_41_binary", 14, 16, 1.6, 1),
    valid!("two_surfaces_41", 30, 36, 2.0 * RECTANGLE, 2),
    valid!("hole_41", 30, 40, RECTANGLE - 0.4 * 0.2, 0),
    valid!("height_41", 15, 18, RECTANGLE, 1),
    valid!("periodic_view_41_ascii", 15, 18, RECTANGLE, 1),
    valid!("periodic_view_41_binary", 15, 18, RECTANGLE, 1),
    valid!("parametric_41_ascii", 15, 18, RECTANGLE, 1),
    valid!("parametric_41_binary", 15, 18, RECTANGLE, 1),
    valid!("parametric_22", 15, 18, RECTANGLE, 1),
    valid!("version_40", 25, 34, RECTANGLE, 1),
    valid!("quadrangles_41", 20, 26, RECTANGLE, 1),
    valid!("quadrangles_22_binary", 20, 26, RECTANGLE, 1),
    valid!("second_order_41", 12, 14, RECTANGLE, 1),
    valid!("second_order_22_binary", 12, 14, RECTANGLE, 1),
    valid!("views_22_ascii", 15, 18, RECTANGLE, 1),
    valid!("views_22_binary", 15, 18, RECTANGLE, 1),
    valid!("views_41_ascii", 15, 18, RECTANGLE, 1),
    valid!("views_41_binary", 15, 18, RECTANGLE, 1),
    valid!("inclined_41", 15, 18, RECTANGLE, 1),
    valid!("partitioned_22", 15, 18, RECTANGLE, 1),
    valid!("partitioned_41_ascii", 15, 18, RECTANGLE, 1),
    valid!("partitioned_41_binary", 15, 18, RECTANGLE, 1),
];

fn area(mesh: &GmshTriangulation) -> f64 {
    let twice = |&[a, b, c]: &[usize; 3]| {
        let [[ax, ay], [bx, by], [cx, cy]] = [mesh.points[a], mesh.points[b], mesh.points[c]];
        ((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)).abs()
    };
    mesh.triangles.iter().map(twice).sum::<f64>() / 2.0
}

fn euler(mesh: &GmshTriangulation) -> isize {
    let vertices: HashSet<_> = mesh.triangles.iter().flatten().collect();
    let edges: HashSet<_> = mesh
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .map(|(a, b)| (a.min(b), a.max(b)))
        .collect();
    vertices.len() as isize - edges.len() as isize + mesh.triangles.len() as isize
}

/// Whether two meshes differ by the rounding of printed coordinates only.
fn same(one: &GmshTriangulation, other: &GmshTriangulation) -> bool {
    let close = |p: &[f64; 2], q: &[f64; 2]| (p[0] - q[0]).abs() <= PRINTED && (p[1] - q[1]).abs() <= PRINTED;
    one.points.len() == other.points.len()
        && one.points.iter().zip(&other.points).all(|(p, q)| close(p, q))
        && one.triangles == other.triangles
        && one.node_tags == other.node_tags
        && one.element_tags == other.element_tags
}

fn read(bytes: &[u8]) -> GmshTriangulation {
    parse(bytes).unwrap_or_else(|error| panic!("{error}"))
}

/// The message of a file that cannot be used: one line.
fn refused(bytes: &[u8]) -> String {
    let message = parse(bytes).expect_err("the file is accepted").to_string();
    assert!(!message.contains(char::is_control), "{message:?}");
    message
}

#[test]
fn every_file_has_its_nodes_triangles_area_and_topology() {
    for file in VALID {
        let mesh = read(file.bytes);
        assert_eq!((mesh.points.len(), mesh.triangles.len()), (file.nodes, file.triangles), "{}", file.name);
        assert_eq!((mesh.node_tags.len(), mesh.element_tags.len()), (file.nodes, file.triangles));
        assert!((area(&mesh) - file.area).abs() < AREA, "{}: area {}", file.name, area(&mesh));
        assert_eq!(euler(&mesh), file.euler, "{}", file.name);

        let mut torn = mesh.clone();
        torn.triangles.pop();
        assert!((area(&torn) - file.area).abs() > AREA);
    }
}

#[test]
fn all_encodings_give_the_same_triangulation() {
    let reference = read(file!("rectangle_41_binary"));
    for other in ["rectangle_41_ascii", "rectangle_22_ascii", "rectangle_22_binary", "version_40"] {
        let file = VALID.iter().find(|file| file.name == other).expect("it is valid");
        assert!(same(&reference, &read(file.bytes)), "{other}");
        assert_eq!(read(file.bytes).groups, reference.groups, "{other}");
    }
    let text = String::from_utf8(file!("rectangle_41_ascii").to_vec()).expect("ASCII");
    for (from, to) in [("0.2999999999993066", "0.2999999999993166"), ("\n18 6 13 20", "\n18 6 20 13")] {
        let changed = text.replace(from, to);
        assert_ne!(changed, text);
        assert!(!same(&reference, &read(changed.as_bytes())));
    }
}

/// Views as Gmsh appends them to one file.
#[test]
fn views_are_the_same_in_every_encoding() {
    for file in VALID.iter().filter(|file| file.name.starts_with("views")) {
        let mesh = read(file.bytes);
        let [history, number, pressure, wind] = &mesh.views[..] else { panic!("{:?}", mesh.views) };
        let names = [history, number, pressure, wind].map(|view| view.name.as_str());
        assert_eq!(names, ["history", "number", "pressure", "wind"], "{}", file.name);
        assert_eq!(history.data, Err(ViewFault::Steps { steps: [0, 1] }));
        assert_eq!(wind.data, Err(ViewFault::Components { components: 3 }));
        let pressure = pressure.data.as_ref().expect("one number for each node");
        assert_eq!((pressure.place, pressure.values.len(), pressure.left_out), (ViewPlace::Vertices, 15, 0));
        assert!(
            pressure
                .values
                .iter()
                .all(|&(k, p)| (p + 10.0 * mesh.points[k as usize][0]).abs() < 10.0 * PRINTED)
        );
        let number = number.data.as_ref().expect("one number for each element");
        assert_eq!((number.place, number.values.len(), number.left_out), (ViewPlace::Triangles, 18, 14));
        assert!(number.values.iter().all(|&(t, tag)| tag == mesh.element_tags[t as usize] as f64));
    }
}

#[test]
fn what_was_done_to_a_mesh_is_noted() {
    let notes = |bytes: &[u8]| read(bytes).notes.iter().map(GmshNote::to_string).collect::<Vec<_>>();
    assert_eq!(notes(file!("rectangle_41_binary")), [""; 0]);
    assert_eq!(notes(file!("height_41")), ["the mesh lies in the plane z = 1000.1: x and y are kept"]);
    let inclined =
        "the mesh lies in a plane in space; its coordinates there: x is now x, y is now 0.8 y + 0.6 z";
    assert_eq!(notes(file!("inclined_41")), [inclined]);
    for quadrangles in [file!("quadrangles_41"), file!("quadrangles_22_binary")] {
        assert_eq!(notes(quadrangles), ["quadrangles, cut in two along the shorter diagonal: 13"]);
    }
    for curved in [file!("second_order_41"), file!("second_order_22_binary")] {
        assert_eq!(notes(curved), ["elements of higher order, read by their corners: 22"]);
    }
}

#[test]
fn sections_around_the_mesh_do_not_change_it() {
    let view = read(file!("periodic_view_41_binary"));
    assert!(same(&view, &read(file!("periodic_view_41_ascii"))));
    // The sine of x at every node.
    for view in [&view, &read(file!("periodic_view_41_ascii"))] {
        let [GmshView { name, data: Ok(data) }] = &view.views[..] else { panic!("{:?}", view.views) };
        assert_eq!((name.as_str(), data.values.len(), data.left_out), ("height", 15, 0));
        assert!(
            data.values.iter().all(|&(k, value)| (value - view.points[k as usize][0].sin()).abs() < PRINTED)
        );
    }
    let parts = read(file!("partitioned_41_binary"));
    assert!(same(&parts, &read(file!("partitioned_41_ascii"))));
    let plain = read(file!("two_groups_41"));
    for parametric in [file!("parametric_41_ascii"), file!("parametric_41_binary"), file!("parametric_22")] {
        assert_eq!(read(parametric).triangles, plain.triangles);
    }
    assert_ne!(parts.node_tags, plain.node_tags);
}

#[test]
fn a_surface_in_two_groups_is_taken_once_from_msh_22() {
    let once = read(file!("two_groups_41"));
    for twice in [file!("two_groups_22_ascii"), file!("two_groups_22_binary")] {
        let mesh = read(twice);
        assert_eq!(mesh.triangles, once.triangles);
        // Ten lines come first, and each triangle takes two tags.
        assert_eq!(mesh.element_tags, (0..18).map(|k| 11 + 2 * k).collect::<Vec<_>>());
    }
}

/// The groups of a file, a word for each: dimension, tag and name.
fn groups(bytes: &[u8]) -> Vec<String> {
    let groups = read(bytes).groups;
    groups.iter().map(|group| format!("{} {} {group}", group.dimension, group.tag)).collect()
}

#[test]
fn groups_have_their_names_in_every_encoding() {
    let of_rectangle = ["0 3 gauge", "1 2 clamped edge", "1 4 stiffener", "2 1 membrane"];
    let of_materials =
        ["1 4 clamped", "1 5 free", "1 6 top", "1 7 curves 7", "2 1 rubber", "2 2 steel", "2 3 all of it"];
    let of_two = ["1 2 clamped edge", "2 1 membrane", "2 3 steel"];
    for file in VALID {
        let found = groups(file.bytes);
        match file.name {
            name if name.starts_with("rectangle") || name == "version_40" => assert_eq!(found, of_rectangle),
            name if name.starts_with("two_groups") => assert_eq!(found, of_two),
            name if name.starts_with("materials") => assert_eq!(found, of_materials),
            name if name.starts_with("partitioned") => assert_eq!(found, of_two[..2], "{name}"),
            name if name.starts_with("no_groups") || name.starts_with("sparse") => assert!(found.is_empty()),
            _ => {}
        }
    }
    let text = String::from_utf8(file!("rectangle_41_ascii").to_vec()).expect("ASCII");
    let (front, behind) = text.split_once("$PhysicalNames").expect("there are names");
    let (_, behind) = behind.split_once("$EndPhysicalNames").expect("they end");
    let unnamed = ["0 3 points 3", "1 2 curves 2", "1 4 curves 4", "2 1 surfaces 1"];
    assert_eq!(groups((front.to_owned() + behind).as_bytes()), unnamed);
}

#[test]
fn sparse_tags_and_unused_nodes_keep_their_place() {
    for bytes in [file!("sparse_41_ascii"), file!("sparse_41_binary")] {
        let mesh = read(bytes);
        assert_eq!(mesh.node_tags, [7, 9_000_000, 12, 400, 5, 1_000_003, 33]);
        assert_eq!(mesh.triangles, [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]);
        assert_eq!(mesh.element_tags, [50, 2_000_000, 3, 9]);
        assert_eq!(mesh.points[5..], [[2.0, 2.0], [3.0, 0.0]]);
    }
    // MSH 2.2 has the used nodes only, sorted by tag.
    for bytes in [file!("sparse_22_ascii"), file!("sparse_22_binary")] {
        let mesh = read(bytes);
        assert_eq!(mesh.node_tags, [5, 7, 12, 400, 9_000_000]);
        assert_eq!(mesh.triangles, [[1, 4, 0], [4, 2, 0], [2, 3, 0], [3, 1, 0]]);
    }
}

#[test]
fn line_ends_of_windows_and_empty_lines_are_read() {
    for file in VALID.iter().filter(|file| file.bytes.is_ascii() && !file.bytes.contains(&0)) {
        let text = str::from_utf8(file.bytes).expect("ASCII");
        let mesh = read(file.bytes);
        assert_eq!(read(text.replace('\n', "\r\n").as_bytes()), mesh, "{}", file.name);
        assert_eq!(read(text.replace('\n', " \n\n").as_bytes()), mesh, "{}", file.name);
        refused(text.replace('\n', " ").as_bytes());
    }
}

#[test]
fn files_without_a_plane_triangulation_are_refused_with_a_remedy() {
    let table = [
        (file!("version_1"), "MSH version 1 is not read", "gmsh old.msh -save -format msh41"),
        (file!("tetrahedra_41"), "volume elements (element type 4)", "gmsh -2"),
        (file!("tetrahedra_41_binary"), "volume elements (element type 4)", "gmsh -2"),
        (
            file!("not_flat_41"),
            "not flat: node 9 is 3.536e-1 away from the plane through the nodes",
            "a plane one",
        ),
        (file!("not_flat_22"), "not flat", "a plane one"),
        (
            file!("only_curves_41"),
            "no triangle or quadrangle among the elements (10 points and lines)",
            "Mesh.SaveAll = 1",
        ),
        (
            file!("only_curves_22"),
            "no triangle or quadrangle among the elements (10 points and lines)",
            "Mesh.SaveAll = 1",
        ),
    ];
    for (bytes, reason, remedy) in table {
        let message = refused(bytes);
        assert!(message.contains(reason) && message.contains(remedy), "{message}");
    }
}

#[test]
fn the_plate_of_the_examples_is_read_as_by_meshio() {
    let mesh = read(include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/plate.msh")));
    // By meshio 5.3.5.
    assert_eq!((mesh.points.len(), mesh.triangles.len()), (2411, 4500));
    assert!((area(&mesh) - 1.7210238159722744).abs() < AREA, "area {}", area(&mesh));
    assert_eq!(euler(&mesh), 1 - 3);
}
